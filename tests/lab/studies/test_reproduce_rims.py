"""Low walls in the report: losses against the slide of other beds, and against that of their own."""

import numpy as np
import pytest

from lab.measures.value import over_worlds
from lab.studies.reproduce.claims import experiments
from lab.studies.reproduce.estimates import Verdict
from lab.studies.reproduce.runs import Outcome


def run(**angles):
    return [Outcome({}, None, "complete", {name: over_worlds(found, "deg") for name, found in angles.items()}, {})]


def told(upturns, slides, others):
    low = run(spill_upturn_angle=upturns, critical_angle=slides)
    found = {"smooth tank, low walls": low, "smooth tank, high walls": run(critical_angle=others)}
    return experiments("granular")["tilt-rim"].report(found).rows


def test_the_lead_has_the_error_of_both_means():
    """21 less 18 with standard deviations of 2 and 1 over four beds each: 3 ± √(4/4 + 1/4)."""
    two, one = np.array([-1.0, 1.0, -1.0, 1.0]) * np.sqrt(3.0), np.array([-1.0, 1.0, -1.0, 1.0]) * np.sqrt(0.75)
    lead = told(18.0 + two, [18.0] * 4, 21.0 + one)[3]
    value, error = (float(part) for part in lead.ours.removesuffix(" deg (s.e.)").split(" ± "))
    assert value == pytest.approx(3.0, abs=0.05) and error == pytest.approx(np.sqrt(1.25), abs=0.06)
    assert lead.apart.endswith("deg (95 %)") and lead.tolerance.startswith("1.7 to 6.8 deg")


@pytest.mark.parametrize(
    ("slide", "said"), [(14.0, Verdict.DIFFERS), (22.0, Verdict.AGREES), (20.0, Verdict.CANNOT_TELL)]
)
def test_a_lead_agrees_if_its_whole_interval_does(slide, said):
    """Of 1.7 to 6.8 deg, with eight beds that scatter by a degree."""
    beds = np.tile([-1.0, 1.0], 4)
    assert told(18.0 + beds, 18.0 + beds, slide + beds)[3].verdict is said


def test_lags_are_taken_bed_by_bed():
    """Beds that slide at 15 to 30 deg and lose 2 deg later; one that never loses is left out."""
    lag = told([17.0, 22.0, np.nan, 32.0], [15.0, 20.0, 25.0, 30.0], [20.0, 21.0])[1]
    assert lag.ours == "2 ± 0 deg (3 of 4 beds)"
