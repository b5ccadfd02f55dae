"""Viscous roll damping: its estimate from a section's shape, and the usual range for bare hulls."""

import numpy as np
import pytest

from solvers.machine.errors import Unavailable
from solvers.ship.viscous import COMMON_ANGLE, common_damping, eddy_coefficient, estimated_damping, friction_damping


def test_eddy_damping_of_a_sharp_box_agrees_with_measurements():
    """Ikeda (1978): a box of 280 by 112 mm about its waterline, B_E (3π/8) √(B/2g)/(ρ ∇ B²) is 0.042 at 0.175 rad."""
    breadth, draught, roll = 0.28, 0.112, 0.175
    quadratic = estimated_damping(breadth, draught, 0.0, draught, 1.0).quadratic
    frequency = np.sqrt(2.0 * 9.81 / breadth)
    linear = 8.0 / (3.0 * np.pi) * frequency * roll * quadratic
    found = linear / (1000.0 * breadth * draught * breadth**2) / frequency * 3.0 * np.pi / 8.0
    assert found == pytest.approx(0.042, rel=0.1)


def test_round_bilges_have_less_eddy_damping():
    """The eddy damping decreases with the bilge radius."""
    found = [eddy_coefficient(0.4, 0.2, radius, 0.106) for radius in (0.01, 0.03, 0.051, 0.08)]
    assert np.all(np.diff(found) < 0.0) and found[-1] > 0.0


def test_friction_grows_with_the_root_of_the_frequency():
    """As for a laminar boundary layer; for a model it is a fraction of a per cent of the critical damping."""
    slow, fast = (friction_damping(0.4, 0.2, 0.051, 0.106, omega) for omega in (2.0, 8.0))
    assert fast / slow == pytest.approx(2.0)
    assert 0.001 < friction_damping(0.4, 0.2, 0.051, 0.106, 5.0) / (2.0 * 5.0 * 2.0) < 0.005


def test_usual_damping_dissipates_its_stated_energy():
    """In a swing of 15 deg the stronger one takes 5 % of critical damping's energy, π B ω a², summed over a period."""
    frequency, inertia = 5.0, 2.0
    low, high = common_damping(frequency, inertia)
    assert low.linear == pytest.approx(0.02 * 2.0 * frequency * inertia) and low.quadratic == 0.0
    phase = np.linspace(0.0, 2.0 * np.pi, 20001)[:-1]
    speed = frequency * COMMON_ANGLE * np.sin(phase)
    work = np.mean((high.linear + high.quadratic * np.abs(speed)) * speed**2) * 2.0 * np.pi / frequency
    share = work / (np.pi * frequency * COMMON_ANGLE**2) / (2.0 * frequency * inertia)
    assert share == pytest.approx(0.05, rel=1e-4)


def test_a_bilge_must_fit_the_section():
    with pytest.raises(Unavailable, match="radius"):
        eddy_coefficient(0.4, 0.2, 0.25, 0.106)
