"""The prismatic tank: how runs are compared with the finest, and when water is at the roof."""

import numpy as np
import pytest

from lab.measures.value import Value
from lab.studies.reproduce import experiments
from lab.studies.reproduce.estimates import Verdict
from lab.studies.reproduce.water import prismatic
from tests.lab.studies.test_reproduce_water import ran


def swayed(spacing: float, extra: float, highest: float = 100.0, preset: str = "sloshing/source-p-25"):
    """A run whose pressure at P1 is 300 Pa and a sine of 200 Pa of the motion's frequency, and `extra` (Pa) of it."""
    time = np.arange(0.0, 20.0, 1e-3)
    pressure = 300.0 + (200.0 + extra) * np.sin(2.0 * np.pi * 1.08 * time)
    one = ran(preset, {"water.spacing": f"{spacing} mm"}, time=time, gauge_pressure=pressure[:, None, None])
    one.measures["highest_water"] = Value(highest, "mm")
    return [one]


def test_the_difference_from_the_finest_run_is_root_mean_square():
    found = {"4 mm": swayed(4.0, 100.0), "2.4 mm": swayed(2.4, 50.0), "1.6 mm": swayed(1.6, 0.0)}
    told = prismatic.convergence(found)
    assert [row.verdict for row in told.rows] == [Verdict.AGREES]
    cells = dict(zip(told.table[0], told.table[1], strict=True))
    assert cells["off 1.6 mm"] == "71 Pa" and cells["mean at P1"] == "300 Pa"  # 100/√2
    assert cells["mean peak of 9 cycles"] == "600 Pa"


def test_a_finer_run_that_is_farther_off_differs():
    found = {"4 mm": swayed(4.0, 50.0), "2.4 mm": swayed(2.4, 100.0), "1.6 mm": swayed(1.6, 0.0)}
    assert [row.verdict for row in prismatic.convergence(found).rows] == [Verdict.DIFFERS]


@pytest.mark.parametrize(("highest", "verdict"), [(207.0, Verdict.AGREES), (208.0, Verdict.DIFFERS)])
def test_water_within_a_spacing_of_the_roof_touches_it(highest, verdict):
    found = {"25 %, roll": swayed(2.4, 0.0, highest, "sloshing/source-p-25-roll")}
    told = experiments("water")["prismatic-roof"].tell(found)
    assert [row.verdict for row in told.rows] == [verdict]
    assert dict(zip(*told.table, strict=True))["highest water"] == f"{highest:.0f} mm"


def test_all_runs_of_the_study_are_of_presets_that_exist():
    names = {name: one.batches(False) for name, one in experiments("water").items()}
    counted = {one: len(names[f"prismatic-{one}"]) for one in ("sway", "sound", "fine", "cost", "roof", "half")}
    assert counted == {"sway": 3, "sound": 4, "fine": 4, "cost": 3, "roof": 2, "half": 2}
