"""Long runs of the barge: half an hour of a random sea, and waves of her own period with loads handed over."""

import numpy as np
import pytest

from lab.measures.water_residual import measure as account
from lab.naval.linear_water import linear_motion
from lab.preset.schema import Preset
from lab.recording import FILE_NAME, open_recording
from lab.runs.runner import run_preset
from solvers.ship.waves import jonswap

pytestmark = pytest.mark.slow
HEIGHT, PEAK = 0.01, 3.927  # m, rad/s
SEA = {
    "water.model": "linear",
    "waves.kind": "jonswap",
    "waves.height": f"{HEIGHT} m",
    "waves.amplitude": False,
    "waves.frequency": f"{PEAK} rad/s",
    "waves.peakedness": 2.0,
    "run.duration": "1800 s",
    "run.threads": 1,
    "record.series_rate": "20 Hz",
    "record.picture_rate": "0.1 Hz",
}


@pytest.fixture(autouse=True)
def not_asked(monkeypatch):
    """Her roll with frozen water, which is stepped outside the kernels and takes longer than the run."""
    monkeypatch.setattr("lab.measures.ship_frozen.frozen", lambda recording: None)


def test_half_an_hour_of_a_random_sea(tmp_path):
    """She rolls as the spectrum says that linear theory multiplies the sea's by, σ² = ∫ |H|² S dω.

    A tenth, which is twice the scatter of a band 0.3 rad/s wide over 1800 s; 2 % was found. The recording stays small.
    """
    run_preset("ship/barge-two-tanks", SEA, tmp_path, video=False, plots=False, quiet=True)
    assert (tmp_path / FILE_NAME).stat().st_size < 30e6
    with open_recording(tmp_path) as recording:
        assert recording.complete
        time, roll = recording.series["time"], recording.series["pose"][:, 0, 2]
        preset = recording.preset
    assert roll[time > 60.0].std() == pytest.approx(linear_roll(preset, HEIGHT), rel=0.1)


@pytest.mark.parametrize(("length", "agree"), [(25, 1.2e-3), (500, 1.5e-3)], ids=["light", "heavy"])
def test_loads_handed_over(tmp_path, length, agree):
    """Eight seconds of waves with particles: the staggered coupling and the load of each instant agree so far at 5 ms.

    With light water, 1.9 kg/m in a ship of 108, steps of 10 ms agree with those of 5 ms to 0.1 % in roll and sway. With
    twenty times that they do not: it answers within such a step, and is heavier than `growth` allows.
    """
    poses = {}
    for step in (None, 0.005, 0.01):
        changes = {"tank.length": f"{length} mm", "run.duration": "8 s", "run.threads": 1}
        if step:
            changes |= {"ship.coupling": "staggered", "ship.coupling_step": f"{step} s"}
        run_preset("ship/barge-two-tanks-quick", changes, tmp_path / str(step), video=False, plots=False, quiet=True)
        with open_recording(tmp_path / str(step)) as recording:
            poses[step] = recording.series["pose"][:, 0]
    whole = np.abs(poses[None]).max(axis=0)
    assert (np.abs(poses[0.005] - poses[None]).max(axis=0) < agree * whole).all()
    apart = np.abs(poses[0.01] - poses[0.005]).max(axis=0) / whole
    assert apart.max() < 1e-3 if length == 25 else apart.max() > 1e-2


def test_half_an_hour_by_particles(tmp_path):
    """Seven layers of water that slosh for half an hour in the source's sea lose neither their depth nor their energy.

    Their centre lies as high in the last five minutes as in the second five, to a twentieth of a layer, some ten times
    what the sea scatters. Roll is that of linear theory to a quarter: the layers damp some 14 % (their order is 1.24),
    and waves in the tank break.
    """
    height, rows = 0.066, 7
    changes = SEA | {"water.model": "sph", "waves.height": f"{height} m", "water.spacing": f"{190.0 / rows:.6g} mm"}
    run_preset("ship/barge-two-tanks", changes, tmp_path, video=False, plots=False, quiet=True)
    assert (tmp_path / FILE_NAME).stat().st_size < 60e6
    with open_recording(tmp_path) as recording:
        assert recording.complete
        time, roll = recording.series["time"], recording.series["pose"][:, 0, 2]
        centre = recording.series["water_centre"][:, 0, 1]
        lost = account(recording)["water_residual"].value  # %
        preset = recording.preset
    early, late = (time > 300.0) & (time <= 600.0), time > 1500.0
    assert lost < 1.0
    assert centre[late].mean() == pytest.approx(centre[early].mean(), abs=0.05 * preset.water.spacing)
    assert roll[time > 60.0].std() == pytest.approx(linear_roll(preset, height), rel=0.25)


def linear_roll(preset: Preset, height: float) -> float:
    """Standard deviation of roll (rad) in the sea by linear theory, σ² = ∫ |H|² S dω."""
    omega = np.linspace(0.5 * PEAK, 3.0 * PEAK, 4000)
    square = np.abs(linear_motion(preset, omega)[:, 2]) ** 2
    return float(np.sqrt(np.trapezoid(square * jonswap(height, PEAK, 2.0)(omega), omega)))
