"""Low walls in the report: losses against the slide of other beds, and against that of their own."""

import numpy as np
import pytest

from lab.measures.value import over_worlds
from lab.reproduce.runs import Outcome
from lab.reproduce.tilting import SMOOTH, rims


def run(**angles):
    return [Outcome({}, None, "complete", {name: over_worlds(found, "deg") for name, found in angles.items()}, {})]


def told(upturns, slides, others):
    low = run(spill_upturn_angle=upturns, critical_angle=slides)
    return rims({f"{SMOOTH}, low walls": low, f"{SMOOTH}, high walls": run(critical_angle=others)}).rows


def test_the_lead_has_the_error_of_both_means():
    """21 less 18 with standard deviations of 2 and 1 over four beds each: 3 ± √(4/4 + 1/4)."""
    two, one = np.array([-1.0, 1.0, -1.0, 1.0]) * np.sqrt(3.0), np.array([-1.0, 1.0, -1.0, 1.0]) * np.sqrt(0.75)
    lead = told(18.0 + two, [18.0] * 4, 21.0 + one)[3]
    value, error = (float(part) for part in lead.ours.removesuffix(" deg").split(" ± "))
    assert value == pytest.approx(3.0, abs=0.05) and error == pytest.approx(np.sqrt(1.25), abs=0.06)


@pytest.mark.parametrize(("slide", "agrees"), [(14.0, False), (21.0, True), (40.0, False)])
def test_a_lead_agrees_within_twice_its_error(slide, agrees):
    """Of 1.7 to 6.8 deg, with beds that scatter by a degree."""
    assert told([17.0, 19.0], [17.0, 19.0], [slide - 1.0, slide + 1.0])[3].agrees is agrees


def test_a_bed_lags_behind_its_own_slide_however_beds_differ():
    """Beds that slide at 15 to 30 deg and lose 2 deg later; one that never loses is left out."""
    lag = told([17.0, 22.0, np.nan, 32.0], [15.0, 20.0, 25.0, 30.0], [20.0, 21.0])[1]
    assert lag.ours == "2 deg (3 beds)"
