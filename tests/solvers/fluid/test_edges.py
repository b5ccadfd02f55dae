"""Forces on single edges: what dummies near a corner give to the other edge."""

import numpy as np
import pytest

from solvers.fluid.given import Water
from solvers.fluid.kernels.wendland_c2 import WendlandC2
from solvers.fluid.start.rest import at_rest
from solvers.fluid.walls.behind import OF_NONE
from solvers.fluid.walls.edges import corner
from solvers.fluid.walls.layers import edge_of, layers
from solvers.simulation import Simulation
from solvers.tank.tank import Tank
from tests.oracles.water import GRAVITY, box, still

BOX = box(0.3, 0.4)
CHAMFERS = np.array([(-0.2, 0.0), (0.2, 0.0), (0.3, 0.1), (0.3, 0.5), (-0.3, 0.5), (-0.3, 0.1)])
HOPPER = np.array([(-0.1, 0.0), (0.1, 0.0), (0.3, 0.4), (-0.3, 0.4)])
WEDGE = np.array([(0.0, 0.0), (0.4, 0.0), (0.2, 0.35)])
STEP = np.array([(-0.3, 0.0), (0.0, 0.0), (0.0, 0.15), (0.3, 0.15), (0.3, 0.5), (-0.3, 0.5)])
QUADRATURE = 160  # points of a face
DEPTH, ROWS = 0.3, 15


def frame(outline: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Lengths (m,) m of the edges of a polygon, and outward normals (m, 2)."""
    ways = np.roll(outline, -1, axis=0) - outline
    lengths = np.linalg.norm(ways, axis=1)
    return lengths, np.stack([ways[:, 1], -ways[:, 0]], axis=1) / lengths[:, None]


def faces_of(outline: np.ndarray) -> np.ndarray:
    """Points (m, k, 2) m along each edge of a polygon."""
    ways = np.roll(outline, -1, axis=0) - outline
    return outline[:, None] + ways[:, None] * ((np.arange(QUADRATURE) + 0.5) / QUADRATURE)[:, None]


def shared(points: np.ndarray, force: np.ndarray, outline: np.ndarray, reach: float) -> np.ndarray:
    """The forces (m, 2) on the edges from those on dummies (n, 2)."""
    own, total = edge_of(points, outline), np.zeros_like(outline)
    other, shares = corner(points, Tank(outline, 1.0), reach)
    given = np.einsum("nab,nb->na", shares, force)
    np.add.at(total, own, force - given)
    np.add.at(total, other[other != OF_NONE], given[other != OF_NONE])
    return total


@pytest.mark.parametrize(
    ("outline", "lacking"),
    [(BOX, 0.0), (CHAMFERS, 0.0), (HOPPER, 0.0), (WEDGE, 0.0), (STEP, [0.0, 0.42, 0.42, 0.0, 0.0, 0.0])],
)
def test_under_an_even_pressure_each_edge_bears_it_on_its_length(outline, lacking):
    """A dummy bears 2 p V Σ n ∫ W dS over all faces; beside a corner that points inwards 0.42 Δx p are lacking.

    That is 2 ∫ (½ − γ) ds there, γ what the solid quarter covers, for a kernel with h = 2 Δx. The rule that counts all
    to the nearest edge misses 0.1 to 0.6 Δx p everywhere.
    """
    spacing, fine = 0.02, 2  # dummies are finer, so that only geometry is asked
    length, reach = 2.0 * spacing, 4.0 * spacing
    points, volumes, _ = layers(outline, spacing / fine, 4 * fine)
    lengths, normals = frame(outline)
    force = np.zeros_like(points)
    for face, long, normal in zip(faces_of(outline), lengths, normals, strict=True):
        away = np.minimum(np.linalg.norm(points[:, None] - face, axis=2), reach)
        seen = WendlandC2.printed(away, length).sum(axis=1) * long / QUADRATURE
        force += 2.0 * (volumes * seen)[:, None] * normal
    found = shared(points, force, outline, reach)
    np.testing.assert_allclose(found.sum(axis=0), force.sum(axis=0), atol=1e-12)
    np.testing.assert_allclose(
        (found * normals).sum(axis=1), lengths - spacing * np.array(lacking), atol=0.05 * spacing
    )


@pytest.mark.slow
def test_water_at_rest_weighs_on_each_edge_between_chamfers():
    """By its hydrostatic force, to ρ g h² of a metre: what is left is of second order in the spacing.

    Mass is that of compressed water, half a per cent more. Together the edges bear the load on the tank.
    """
    water = Water(spacing=DEPTH / ROWS, sound_speed=10.0 * np.sqrt(GRAVITY * DEPTH))
    drops = at_rest(CHAMFERS, DEPTH, water, GRAVITY)[None]
    run = Simulation(still(0.6, 0.5, DEPTH, ROWS, outline=CHAMFERS, edges=tuple(range(6)), drops=drops, alpha=0.02))
    run.advance(round(2.0 / run.dt))
    run.observe()
    run.advance(round(1.0 / run.dt))
    rows = run.observe()
    run.close()
    lengths, normals = frame(CHAMFERS)
    wanted = [GRAVITY * 1000.0 * np.maximum(DEPTH - face[:, 1], 0.0).mean() for face in faces_of(CHAMFERS)] * lengths
    force = rows["edge_force"][0]
    second_order = 1000.0 * GRAVITY * water.length**2
    np.testing.assert_allclose((force * normals).sum(axis=1), wanted, atol=second_order)
    np.testing.assert_allclose(force.sum(axis=0), rows["wall_force"][0, :2], atol=1e-12 * np.abs(force).max())
