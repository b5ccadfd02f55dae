"""Ships without upright stability: the angle of loll in a run, by hydrostatics, and on naval sheets."""

import numpy as np
import pytest

from lab.assembly.scene import vessels
from lab.naval import sheet
from lab.naval.condition import condition
from lab.naval.loaded import Loaded
from lab.naval.weights import Weights
from lab.preset.find import load
from lab.recording import open_recording
from lab.report.hull import facts
from lab.report.ship import judged
from lab.runs.runner import run_preset
from solvers.ship.motion import sail, start
from solvers.ship.naval.form import prism
from solvers.ship.section import box
from solvers.ship.water import Water
from tests.oracles.presets import error_of

BREADTH, DRAUGHT = 0.34, 0.0396  # m, of ship/barge-empty; wall-sided up to 13 deg
BM, KB = BREADTH**2 / (12.0 * DRAUGHT), 0.5 * DRAUGHT


def barge(height: float, **more) -> dict[str, object]:
    """Changes of ship/barge-empty that give her this GM (m), in calm water."""
    return {"ship.gravity_height": f"{1e3 * (KB + BM - height):.9f} mm", "waves.amplitude": "0 mm"} | more


def of(height: float, **more):
    return load("ship/barge-empty", barge(height, **more)).resolved


def loll(height: float, bm: float) -> float:
    """Wall-sided: tan φ = √(−2 GM/BM)."""
    return float(np.arctan(np.sqrt(-2.0 * height / bm)))


@pytest.mark.parametrize("freedom", ["sway-heave-roll", "roll"])
@pytest.mark.parametrize("height", [-1e-3, -5e-3])
def test_a_wall_sided_ship_rests_at_her_angle_of_loll(height, freedom):
    (vessel,) = vessels(of(height, **{"ship.freedom": freedom}))
    assert vessel.rest == vessel.heel == pytest.approx(loll(height, BM), rel=1e-6)
    assert vessel.release > 0.0  # heeled there by the time at which she is let go


def test_a_ship_let_go_beside_upright_settles_to_the_loll_of_that_side():
    """From 4 deg to starboard in calm water, 15 s after she has fallen over: e^(−0.7 × 15) of the way is left."""
    damped = {"ship.damping": 0.7, "ship.quadratic_damping": 0.0, "ship.radiation": "none", "ship.freedom": "roll"}
    (vessel,) = vessels(of(-5e-3, **damped))
    began = start(vessel.ship, vessel.heave(vessel.ship.body, -0.07), -0.07)
    assert sail(vessel.ship, began, 0.02, 20.0).roll[-1] == pytest.approx(-loll(-5e-3, BM), rel=1e-3)


def test_a_run_starts_at_the_loll_and_its_report_tells_it(tmp_path, monkeypatch):
    monkeypatch.setattr("lab.report.plots.write_plots", lambda *_: {})
    changes = barge(-5e-3, **{"ship.release": "0.2 s", "run.duration": "1 s", "record.series_rate": "50 Hz"})
    run_preset("ship/barge-empty", changes, tmp_path / "run", video=False, quiet=True)
    with open_recording(tmp_path / "run") as recording:
        free = recording.series["time"] > 0.2
        roll = recording.series["pose"][free, 0, 2]
        rows, told, _ = judged(recording)
    assert roll == pytest.approx(loll(-5e-3, BM), rel=1e-4)
    assert dict(told)["lolls"] == f"to {np.degrees(loll(-5e-3, BM)):.1f} deg, as GM is negative"
    assert {row.criterion.verdict for row in rows if row.criterion.rule == "IS Code A 2.2.4"} == {"fail"}


def test_naval_sheets_have_the_angle_of_loll():
    preset = of(-1e-3)
    found = condition(preset, vessels(preset)[0])
    assert found.metacentric_height == pytest.approx(-1e-3, rel=1e-6)
    assert found.levers.equilibrium() == pytest.approx(loll(-1e-3, BM), rel=1e-4)  # a spline through whole degrees
    draught, bm = 8.0, 27.0**2 / (12.0 * 8.0)
    mass, kg = 1.025 * 130.0 * 27.0 * draught, 0.5 * draught + bm + 0.1
    ship = Loaded(prism(box(27.0, 14.0), 130.0), Water(1025.0), Weights(mass, 65.0, 0.0, kg, 0.0))
    assert abs(ship.heel_angle) == pytest.approx(loll(-0.1, bm), rel=1e-4)
    assert dict(facts(ship))["list"].startswith(f"{np.degrees(loll(-0.1, bm)):.1f} deg to ")
    assert "a loll: her GM is negative" in dict(facts(ship))["list"]
    assert not any(row.criterion.passed for row in sheet.rows(ship) if row.criterion.rule == "IS Code A 2.2.4")


def test_heel_and_release_that_are_given_stay():
    (vessel,) = vessels(of(-5e-3, **{"ship.heel": "-4 deg", "ship.release": "0.5 s"}))
    assert (vessel.heel, vessel.release) == pytest.approx((np.radians(-4.0), 0.5))
    (upright,) = vessels(of(5e-3))
    assert (upright.rest, upright.heel, upright.release) == (0.0, 0.0, 0.0)


@pytest.mark.parametrize(
    ("height", "more", "words"),
    [
        (-0.2, {}, "ship.gravity_height: so high she neither stands upright nor lolls by up to 90 deg; lower it."),
        (-5e-3, {"ship.capsize": "10 deg"}, "nor lolls by up to 10 deg"),
        (-5e-3, {"ship.openings": [["160 mm", "70 mm"]]}, "so high she lolls to 11.46 deg, with an opening under"),
        (-5e-3, {"ship.excitation": "wave-slope"}, "ship.excitation: wave-slope acts by GM, which is negative here"),
    ],
)
def test_ships_that_do_not_loll_safely_are_one_sentence(height, more, words):
    assert words in error_of(vessels, of(height, **more))
