"""Half an hour of a random sea, with water by linear theory, few pictures kept."""

import numpy as np
import pytest

from lab.naval.linear_water import linear_motion
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


def test_half_an_hour_of_a_random_sea(tmp_path, monkeypatch):
    """She rolls as the spectrum says that linear theory multiplies the sea's by, σ² = ∫ |H|² S dω.

    A tenth, which is twice the scatter of a band 0.3 rad/s wide over 1800 s; 2 % was found. The recording stays small.
    """
    # Not asked: her roll with frozen water, which is stepped outside the kernels and takes longer than the run.
    monkeypatch.setattr("lab.measures.ship_frozen.frozen", lambda recording: None)
    run_preset("ship/barge-two-tanks", SEA, tmp_path, video=False, plots=False, quiet=True)
    assert (tmp_path / FILE_NAME).stat().st_size < 30e6
    with open_recording(tmp_path) as recording:
        assert recording.complete
        time, roll = recording.series["time"], recording.series["pose"][:, 0, 2]
        preset = recording.preset
    omega = np.linspace(0.5 * PEAK, 3.0 * PEAK, 4000)
    square = np.abs(linear_motion(preset, omega)[:, 2]) ** 2
    wanted = np.sqrt(np.trapezoid(square * jonswap(HEIGHT, PEAK, 2.0)(omega), omega))
    assert roll[time > 60.0].std() == pytest.approx(wanted, rel=0.1)
