"""Liquid in a tank by linear theory: its limits, its closed form in sway, and that it only takes energy."""

import numpy as np
import pytest

from solvers.ship.potential.sloshing import SloshingLiquid

G = 9.81


def test_slowly_moved_liquid_is_a_solid_in_sway_and_has_a_free_surface_in_roll():
    liquid = SloshingLiquid(width=0.9, depth=0.3, centre=(0.1, -0.4))
    slow = liquid.added_mass(np.array([1e-2]))[0]
    mass = 1000.0 * 0.9 * 0.3
    assert slow[0, 0] == pytest.approx(mass, rel=1e-4)
    assert slow[1, 1] == pytest.approx(mass)
    assert slow[0, 2] == pytest.approx(slow[2, 0])
    lost = -liquid.stiffness()[2, 2] - mass * G * (-0.4 - 0.15)
    assert lost == pytest.approx(1000.0 * G * 0.9**3 / 12.0)
    # The whole answer to a slow roll is the stiffness: the modes' shares sum up to ρ g l³/12.
    assert np.isfinite(slow[2, 2]) and abs(slow[2, 2]) < 10.0 * mass


def test_sway_is_the_sum_of_graham_and_rodriguez():
    width, depth = 0.9, 0.093
    liquid, omega = SloshingLiquid(width, depth), np.array([1.0, 2.5, 4.0, 8.0])
    n = 2.0 * np.arange(200) + 1.0
    own = G * n * np.pi / width * np.tanh(n * np.pi * depth / width)
    shares = 8.0 * np.tanh(n * np.pi * depth / width) / (n**3 * np.pi**3 * depth / width)
    square = omega[:, None] ** 2
    wanted = 1000.0 * width * depth * (1.0 + (shares * square / (own - square)).sum(axis=1))
    np.testing.assert_allclose(liquid.added_mass(omega)[:, 0, 0], wanted, rtol=1e-4)
    assert not liquid.damping(omega).any()


def test_deep_narrow_liquid_turns_as_a_solid_and_shallow_one_only_where_its_floor_lifts():
    """At high frequencies the surface stays level over the earth: no swing, and pressure zero there."""
    narrow = SloshingLiquid(width=0.02, depth=1.0)._lidded()
    assert narrow == pytest.approx(1000.0 * 0.02 * 1.0**3 / 3.0, rel=0.02)
    shallow = SloshingLiquid(width=1.0, depth=0.01)._lidded()
    assert shallow == pytest.approx(1000.0 * 0.01 * 1.0**3 / 12.0, rel=1e-4)


def test_roll_about_a_far_point_is_sway():
    """About an axle far above, a small roll moves the tank to and fro."""
    far = 1e3
    liquid, omega = SloshingLiquid(0.9, 0.2, centre=(0.0, -far), share=0.01), np.array([3.0])
    near = SloshingLiquid(0.9, 0.2, share=0.01)
    turned = liquid.added_mass(omega)[0, 2, 2] + 1j * liquid.damping(omega)[0, 2, 2] / omega[0]
    swayed = near.added_mass(omega)[0, 0, 0] + 1j * near.damping(omega)[0, 0, 0] / omega[0]
    # The tank's weight is a pendulum's: its stiffness m g (z + d/2) is taken out of the added mass.
    assert turned / far**2 == pytest.approx(swayed, rel=5e-3)


def test_the_liquid_takes_energy_from_any_motion():
    liquid = SloshingLiquid(0.9, 0.2, centre=(0.05, -0.3), share=0.02)
    for one in liquid.damping(np.linspace(0.5, 20.0, 40)):
        np.testing.assert_allclose(one, one.T, atol=1e-9)
        assert np.linalg.eigvalsh(one).min() > -1e-9
