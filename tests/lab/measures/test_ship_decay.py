"""Natural frequency and damping of a made free roll."""

import numpy as np
import pytest

from lab.measures.ship_decay import decay
from solvers.ship.motion import runge_kutta

NATURAL, STEP = 1.3, 0.05


def roll(linear: float, quadratic: float, lean: float = 0.0, lasts: float = 120.0):
    """Time (s) and roll (rad) of φ̈ + 2ζω₀φ̇ + b φ̇|φ̇| + ω₀²(φ − lean) = 0, let go at 20 deg."""

    def slope(state, _):
        resisted = (2.0 * linear * NATURAL + quadratic * abs(state[1])) * state[1]
        return np.array([state[1], -resisted - NATURAL**2 * (state[0] - lean)])

    time, state = np.arange(0.0, lasts, STEP), np.array([np.radians(20.0) + lean, 0.0])
    rolls = []
    for now in time:
        rolls.append(state[0])
        state = runge_kutta(slope, state, now, STEP)
    return time, np.array(rolls)


@pytest.mark.parametrize(("linear", "quadratic"), [(0.02, 0.0), (0.05, 0.0), (0.02, 0.15), (0.01, 0.3)])
def test_damping_is_found_again(linear, quadratic):
    """Frequency to 0.5 %, both dampings to 3 % of the whole; it leans, as cargo that has shifted makes her."""
    found = decay(*roll(linear, quadratic, np.radians(2.0)))
    whole = linear + 4.0 / (3.0 * np.pi) * quadratic * np.radians(15.0)
    assert found.frequency == pytest.approx(NATURAL * np.sqrt(1.0 - linear**2), rel=5e-3)
    assert found.line[0] == pytest.approx(linear, abs=0.06 * whole)
    assert found.line[0] + found.line[1] * np.radians(15.0) == pytest.approx(whole, rel=0.05)


def test_too_few_swings_are_none():
    assert decay(*roll(0.4, 0.0)) is None
    assert decay(np.arange(10.0), np.zeros(10)) is None
