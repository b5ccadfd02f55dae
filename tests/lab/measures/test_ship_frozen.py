"""The ship with frozen cargo, computed in long steps and sampled in between."""

from dataclasses import replace

import numpy as np
import pytest

from lab.measures.ship_frozen import INTERVAL, LONGEST, STEPS, _sampled, step_of
from solvers.ship.motion import sail, start
from tests.solvers.motion.test_water_aboard import ship

LASTS = 4.0  # s


def voyages(vessel, step: float):
    """The ship alone, let go with her heel: in steps (s) of one length with samples between, and in short steps."""
    whole, begin = vessel.ship, vessel.release
    state = start(whole, vessel.heave(whole.body, vessel.heel), vessel.heel)
    long = sail(whole, state, step, step * np.ceil(LASTS / step), vessel.limits, begin)
    return _sampled(long, vessel, LASTS), sail(whole, state, INTERVAL, LASTS, vessel.limits, begin)


def test_samples_between_long_steps_are_those_of_short_ones():
    """Roll every 10 ms from steps of 20 ms, 36 in her shortest period for STEPS: to (40/36)⁴ of 1e-4 of the swing."""
    vessel, step = ship(heel=0.05), 2.0 * INTERVAL
    assert step > vessel.shortest_period / STEPS >= step_of(vessel)
    ours, exact = voyages(vessel, step)
    assert ours.time == pytest.approx(exact.time)
    assert ours.roll == pytest.approx(exact.roll, abs=1.5e-4 * np.ptp(exact.roll))


def test_she_is_lost_at_the_sample_not_at_the_end_of_the_step():
    """The time at which she passes a limit of roll does not hang on the step."""
    vessel = ship(heel=0.05, limits=(-0.02, 1.0))
    ours, exact = voyages(vessel, 5.0 * INTERVAL)
    assert exact.capsized is not None
    assert ours.capsized == pytest.approx(exact.capsized, abs=1.5 * INTERVAL)
    assert ours.roll[-1] < -0.02 <= ours.roll[:-1].min()


def test_a_top_heavy_ship_that_does_not_swing_is_stepped_as_well():
    """Free in roll alone, and without stability, she has no period; the step stays short."""
    vessel = ship()
    body = replace(vessel.ship.body, centre=(0.0, 1.0))
    falls = replace(vessel, ship=replace(vessel.ship, body=body, free=(False, False, True)))
    held = replace(vessel, ship=replace(vessel.ship, free=(False, False, False)))
    assert [step_of(falls), step_of(held)] == pytest.approx([LONGEST, LONGEST])
