"""The flows that water may start with: velocities without divergence, and the pressure that they take."""

import numpy as np
import pytest

from solvers.fluid.given import Water
from solvers.fluid.start.flow import compressed, stirred, torsion, vortex_pressure, vortices
from solvers.fluid.states import STATES

STEP = 1e-4  # m, of differences
SQUARE = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]])


def places(count: int = 40) -> np.ndarray:
    """Places (n, 2) m inside of the square."""
    return np.random.default_rng(3).uniform(0.3, 1.7, (count, 2))


def series(place: np.ndarray, side: float) -> np.ndarray:
    """The torsion function of a square as a double series (Le Touzé et al. 2013), y and z from a corner."""
    wave = np.arange(1, 202, 2)
    along_y, along_z = (np.sin(np.pi * wave * c[:, None] / side) for c in place.T)
    n, m = np.meshgrid(wave, wave, indexing="ij")
    weight = 32.0 / (n * m * np.pi**2 * (np.pi / side) ** 2 * (n**2 + m**2))
    return np.einsum("in,nm,im->i", along_y, weight, along_z)


def slopes(field, place: np.ndarray) -> np.ndarray:
    """Derivatives (n, …, 2) of a field at places, by central differences."""
    steps = STEP * np.eye(2)
    return np.stack([(field(place + step) - field(place - step)) / (2.0 * STEP) for step in steps], axis=-1)


def test_the_pressure_of_a_square_is_its_series_and_that_of_a_drop_a_parabola():
    known = series(places(), 2.0)
    np.testing.assert_allclose(torsion(SQUARE, places()), known, atol=1e-4 * known.max())
    turns = 2.0 * np.pi * np.arange(160) / 160
    circle = np.array([3.0, 1.0]) + 0.5 * np.stack([np.cos(turns), np.sin(turns)], axis=1)
    arm = 0.4 * (places() - 1.0)
    np.testing.assert_allclose(
        torsion(circle, arm + np.array([3.0, 1.0])), 0.5 * (0.25 - (arm**2).sum(axis=1)), atol=1e-4
    )


@pytest.mark.parametrize("sides", [(2.0, 2.0), (2.0, 3.0)])
def test_vortices_are_steady_but_for_viscosity(sides):
    """They have no divergence, and their pressure balances what carries them along: u·∇u = −∇p/ρ."""
    place = places()
    flow, slope = vortices(place, sides), slopes(lambda r: vortices(r, sides), place)
    np.testing.assert_allclose(np.trace(slope, axis1=1, axis2=2), 0.0, atol=1e-6)
    carried = np.einsum("nj,nij->ni", flow, slope)
    np.testing.assert_allclose(carried, -slopes(lambda r: vortex_pressure(r, sides), place), atol=1e-5)


def test_free_flow_has_the_divergence_that_its_pressure_is_made_for():
    """∂_i u_j ∂_j u_i = 2 (σ² − ω²), so that the water stays as dense as it is."""
    slope = slopes(lambda r: stirred(r, 3.0, 2.0), places())
    np.testing.assert_allclose(np.einsum("nij,nji->n", slope, slope), 2.0 * (9.0 - 4.0), rtol=1e-6)


@pytest.mark.parametrize("state", sorted(STATES))
def test_the_compression_bears_the_pressure(state):
    water = Water(0.1, 10.0, state=state)
    share = np.array([-0.01, 0.0, 0.02])
    np.testing.assert_allclose(STATES[state].pressure(compressed(100.0 * share, water)), share, atol=1e-12)
