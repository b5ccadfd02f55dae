"""Natural frequency and damping of a made free roll."""

import numpy as np
import pytest

from lab.measures.ship_decay import PER, decay
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


@pytest.mark.parametrize(("linear", "quadratic"), [(0.02, 0.0), (0.05, 0.0), (0.02, 0.15), (0.01, 0.3), (0.0, 0.3)])
@pytest.mark.parametrize("lasts", [13.0, 17.0, 120.0])
def test_damping_is_found_again(linear, quadratic, lasts):
    """Of five swings and more, as a ship leans whose cargo has shifted; averaging leaves 2ζ² and 0.13 (bφ)² of b."""
    found = decay(*roll(linear, quadratic, np.radians(2.0), lasts))
    assert found.frequency == pytest.approx(NATURAL * np.sqrt(1.0 - linear**2), rel=5e-3)
    assert found.line[0] == pytest.approx(linear, abs=LINEAR)
    assert PER * found.line[1] == pytest.approx(quadratic, abs=QUADRATIC)


LINEAR, QUADRATIC = 5e-4, 0.02  # promised of five swings or more


@pytest.mark.parametrize("lasts", [8.0, 15.0, 16.0, 30.0, 60.0])
@pytest.mark.parametrize("samples", [10, 13, 150])
def test_a_record_need_not_hold_whole_swings(lasts, samples):
    """φ = φ_0 e^(−ζωt) cos(ωt + ε) + φ_r with ζ 0.02, ω 2 rad/s, whatever its length, phase and rest."""
    time = np.arange(0.0, lasts, np.pi / samples)
    for phase, rest in ((0.0, 0.0), (0.9, -3.0), (2.2, 12.0)):
        swing = 10.0 * np.exp(-0.04 * time) * np.cos(2.0 * time + phase)
        found = decay(time, np.radians(swing + rest))
        assert found.line[0] == pytest.approx(0.02, abs=LINEAR)
        assert PER * found.line[1] == pytest.approx(0.0, abs=QUADRATIC)


def test_noise_is_in_the_error():
    """Twenty records with noise of 0.5 % of the first roll: the damping is off by no more than the errors told."""
    time, away = np.arange(0.0, 30.0, 0.03), []
    for seed in range(20):
        noise = 0.005 * np.random.default_rng(seed).standard_normal(len(time))
        found = decay(time, np.radians(10.0) * (np.exp(-0.04 * time) * np.cos(2.0 * time) + noise))
        away.append((found.line[0] - 0.02) / found.errors[0])
    assert np.sqrt(np.mean(np.square(away))) < 1.6  # of 1: five standard errors of the root mean square of 20


def test_a_roll_that_does_not_die_away_has_no_damping():
    time = np.arange(0.0, 20.0, 0.05)
    found = decay(time, 0.1 * np.cos(2.0 * time))
    assert (found.line[0], found.line[1]) == (pytest.approx(0.0, abs=LINEAR), pytest.approx(0.0, abs=QUADRATIC))


def test_too_few_swings_are_none():
    assert decay(*roll(0.4, 0.0)) is None
    assert decay(np.arange(10.0), np.zeros(10)) is None
