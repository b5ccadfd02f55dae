"""Roll in a random sea: stochastic linearisation and the largest of many rolls, by closed forms and samples."""

import numpy as np
import pytest

from solvers.machine.errors import Unavailable
from solvers.ship.damping.random_roll import LINEARISED, Afloat, random_roll, rayleigh_largest
from solvers.ship.potential.radiation import Hydrodynamics

OMEGA = np.linspace(0.2, 1.5, 6001)


def oscillator(radiated: float = 0.0) -> Afloat:
    """Roll alone, ω₀ = 0.6 rad/s, inertia 2, moment 1 per metre of wave."""
    n = len(OMEGA)
    none, force = np.zeros((n, 3, 3)), np.zeros((n, 3), complex)
    force[:, 2] = 1.0
    damping = none.copy()
    damping[:, 2, 2] = radiated
    table = Hydrodynamics(OMEGA, none, damping, force, force, force, np.zeros((3, 3)))
    return Afloat(table, 1.0, 2.0, 1.0, 2.0 * 0.36)


def test_roll_in_white_waves_has_the_variance_of_theory():
    """Of a lightly damped oscillator: ∫|H|² S dω = π S F²/(2 B C) for a moment F per metre of wave."""
    found = random_roll(oscillator(), lambda omega: np.full_like(omega, 0.01), 0.02, 0.0)
    assert found.zeroth == pytest.approx(np.pi * 0.01 / (2.0 * 0.02 * 0.72), rel=0.01)
    assert found.period == pytest.approx(2.0 * np.pi / 0.6, rel=0.02)


def test_quadratic_damping_is_that_of_the_speed_found():
    found = random_roll(oscillator(), lambda omega: np.full_like(omega, 0.01), 0.01, 0.05)
    assert found.damping == pytest.approx(0.01 + LINEARISED * np.sqrt(found.second) * 0.05, rel=1e-6)


def test_linearised_damping_takes_the_energy_of_the_quadratic_one():
    """Of a Gaussian speed: E(|v| v²) = √(8/π) σ E(v²)."""
    speed = np.random.default_rng(1).normal(0.0, 0.3, 2_000_000)
    assert np.mean(np.abs(speed) ** 3) / np.mean(speed**2) == pytest.approx(LINEARISED * 0.3, rel=0.005)


def test_largest_of_rayleigh_maxima():
    """4000 records of 800 maxima: mean largest within 0.5 %, the level for 95 % exceeded by 5 ± 1 %."""
    random = np.random.default_rng(2)
    largest = np.array([random.rayleigh(2.0, 800).max() for _ in range(4000)])
    likely, mean, sure = rayleigh_largest(2.0, 800.0)
    assert largest.mean() == pytest.approx(mean, rel=0.005)
    assert likely < mean < sure
    assert np.mean(largest > sure) == pytest.approx(0.05, abs=0.01)


def test_too_short_a_time_has_no_largest():
    with pytest.raises(Unavailable, match="hours"):
        rayleigh_largest(1.0, 2.0)
