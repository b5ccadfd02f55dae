"""The measured section in its flume's train: what the report says of it rests on."""

import numpy as np
import pytest

from lab.assembly.scene import vessels
from lab.preset.find import load
from lab.studies.reproduce.estimates import Verdict
from lab.studies.reproduce.ships.section import compared, counted_within, explained, window
from lab.studies.reproduce.ships.section_terms import (
    MEASUREMENTS,
    PRESET,
    Term,
    estimated,
    potential_flow,
    rubbed,
    usual,
)

PEAK = [test for test in MEASUREMENTS if 5.0 < test.frequency < 5.5]


@pytest.fixture(scope="module", params=["the first", pytest.param("all", marks=pytest.mark.slow)])
def peak(request):
    """Tests at the peak, and roll in them with friction alone, with eddies, and with the least that is usual."""
    tests = PEAK if request.param == "all" else PEAK[:1]
    models = (rubbed(), estimated(), usual()[0])
    return tests, [[model.sailed(test)[2] for test in tests] for model in models]


@pytest.mark.slow
def test_damping_estimated_from_the_shape_brackets_the_measured_peak(peak):
    """Both readings lie between friction alone and friction with eddies, or within 5 % of that; nothing is fitted."""
    tests, (friction, eddies, _) = peak
    for k, test in enumerate(tests):
        for reading in (test.camera[2], test.accelerometers[2]):
            assert 0.95 * eddies[k] < reading < 1.05 * friction[k]


@pytest.mark.slow
def test_damping_usual_for_ships_is_too_large_for_the_section(peak):
    """Told as it is: 2 % of the critical damping leaves less roll than either instrument reads."""
    tests, (_, _, rolls) = peak
    for k, test in enumerate(tests):
        assert rolls[k] < min(test.camera[2], test.accelerometers[2])


def test_the_peak_is_not_steady_when_measured():
    """At 5.075 rad/s steady waves roll the section more than half again as far as the train has by then."""
    test, base = PEAK[0], potential_flow()
    assert base.steady(np.array([test.frequency]))[0, 2] > 1.5 * base.small(test)[2]


def test_after_the_transient_a_train_is_a_steady_wave():
    """Off the resonance, where transients are gone, the train's window gives the steady response, to 1 %."""
    test = MEASUREMENTS[4]
    assert potential_flow().small(test) == pytest.approx(potential_flow().steady(np.array([7.004]))[0], rel=0.01)


def test_the_preset_has_the_estimated_damping():
    ship, wanted = vessels(load(PRESET).resolved)[0].ship, estimated().ship.damping
    assert ship.damping.linear == pytest.approx(wanted.linear, rel=0.03)
    assert ship.damping.quadratic == pytest.approx(wanted.quadratic, rel=0.01)


def test_windows_lie_between_the_ramp_and_the_returning_waves():
    """As the measured ones, to a second or two."""
    for test in MEASUREMENTS[1:]:
        assert window(test.frequency)[0] == pytest.approx(test.window[0], abs=1.0)


def test_verdicts_and_explained_shares():
    """An amplitude that was read agrees, one 11 % below both does not; a term that takes all the excess is 100 %."""
    camera = np.array([test.camera for test in MEASUREMENTS])
    assert all(row.verdict is Verdict.AGREES for row in compared(camera))
    least = [[min(v for v in pair if v) for pair in zip(t.camera, t.accelerometers, strict=True)] for t in MEASUREMENTS]
    assert all(row.verdict is Verdict.DIFFERS for row in compared(0.89 * np.array(least)))
    assert counted_within(1.15 * camera)[0].ours == "0 and 24 of 24"
    rows = explained(1.5 * camera, 1.2 * camera, {Term("all", "sure", None): camera})
    assert rows[0].ours == "+50 %, +50 %, +50 %"
    assert rows[2].ours == "+100 %, +100 %, +100 %"
