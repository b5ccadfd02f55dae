"""Damping recovered from decay tests, and the classification of rolls."""

from math import pi

import numpy as np
import pytest

from solvers.machine.errors import Unavailable
from solvers.ship.body import Body
from solvers.ship.loads import Floating
from solvers.ship.motion import Radiation, RollDamping, Ship, sail, start
from solvers.ship.outcome import CYCLES, outcome
from solvers.ship.section import box
from solvers.ship.water import Water
from tests.oracles.decay import fit_decay


def decaying(linear, quadratic, roll=0.3, frequency=4.9, interval=0.01, count=3000, heel=0.0):
    """φ̈ + b₁ φ̇ + b₂ φ̇|φ̇| + ω² φ = 0 by small steps that keep energy where there is no damping."""
    fine = 10
    step = interval / fine
    angle, speed, rolls = roll, 0.0, []
    for k in range(count * fine):
        if k % fine == 0:
            rolls.append(angle + heel)
        speed += -0.5 * step * (frequency**2 * angle + (linear + quadratic * abs(speed)) * speed)
        angle += step * speed
        speed += -0.5 * step * (frequency**2 * angle + (linear + quadratic * abs(speed)) * speed)
    return interval * np.arange(count), np.array(rolls)


@pytest.mark.parametrize(("linear", "quadratic"), [(0.2, 0.0), (0.05, 0.4), (0.3, 0.2)])
def test_damping_is_recovered_from_a_decay(linear, quadratic):
    found = fit_decay(*decaying(linear, quadratic, count=1500, heel=0.04))
    assert found.frequency == pytest.approx(np.sqrt(4.9**2 - 0.25 * linear**2), rel=2e-3)
    assert found.linear == pytest.approx(linear, abs=0.01)
    assert found.quadratic == pytest.approx(quadratic, abs=0.02)


@pytest.mark.slow
def test_damping_is_recovered_from_the_decay_of_a_hull():
    """B₁ and B₂ of the equations of motion, by the inertia with added mass; from 6°, where a box is still linear."""
    added, damping = np.diag([40.0, 50.0, 0.2]), RollDamping(0.08, 0.3)
    load = Floating(box(0.34, 0.30), Water(), (0.0, 0.11))
    body, axis = Body(37.4, (0.0, 0.0926), 0.55), (False, False, True)
    ship = Ship(body, load, Radiation(added, np.zeros((3, 3))), (0.0, 0.11), damping, free=axis)
    voyage = sail(ship, start(ship, -0.11, 0.1), 0.025, 18.0)
    found, inertia = fit_decay(voyage.time, voyage.roll), ship.inertia(0.0)[2, 2]
    assert found.linear * inertia == pytest.approx(damping.linear, rel=0.05)
    assert found.quadratic * inertia == pytest.approx(damping.quadratic, rel=0.05)


def test_decay_of_too_few_swings_is_refused():
    with pytest.raises(Unavailable, match="swings"):
        fit_decay(*decaying(0.1, 0.0, count=150))


OMEGA = 4.5
TIME = np.arange(0.0, 40.0, 0.01)
ROLL = 0.3 * np.cos(OMEGA * TIME)


@pytest.mark.parametrize(
    ("roll", "kind", "several"),
    [
        (ROLL, "upright", False),
        (ROLL + 0.04 * np.cos(3.0 * OMEGA * TIME), "upright", False),
        (ROLL + 0.03, "biased", False),
        (ROLL - 0.03 + 0.1 * np.cos(0.5 * OMEGA * TIME), "biased", True),
        (ROLL * (1.0 + 0.3 * np.cos(0.9 * TIME)), "upright", True),
        (ROLL + 0.3 * np.exp(-TIME) * np.cos(3.1 * TIME), "upright", False),
    ],
)
def test_outcomes_are_classified(roll, kind, several):
    found = outcome(TIME, roll, OMEGA)
    assert (found.kind, found.several) == (kind, several)
    last = slice(np.searchsorted(TIME, TIME[-1] - CYCLES * 2.0 * pi / OMEGA), None)
    assert found.largest == np.abs(roll[last]).max()


def test_numbers_of_an_outcome():
    found = outcome(TIME, ROLL + 0.05, OMEGA)
    assert (found.mean, found.amplitude) == (pytest.approx(0.05, abs=1e-6), pytest.approx(0.3, rel=1e-3))
    growing = outcome(TIME, ROLL * TIME / TIME[-1], OMEGA)  # on average as it was five periods before the end
    assert growing.amplitude == pytest.approx(0.3 * (1.0 - 5.0 * 2.0 * pi / OMEGA / TIME[-1]), rel=0.01)
    assert outcome(TIME[:500], ROLL[:500], OMEGA, "capsized").kind == "capsized"
    with pytest.raises(Unavailable, match="periods"):
        outcome(TIME[:500], ROLL[:500], OMEGA)
