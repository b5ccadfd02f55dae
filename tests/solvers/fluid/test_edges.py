"""Forces on single edges: what wall particles near a corner give to the other edge."""

import numpy as np
import pytest

from solvers.fluid.given import Water
from solvers.fluid.kernels.wendland_c2 import WendlandC2
from solvers.fluid.start.packing import packed
from solvers.fluid.start.rest import at_rest
from solvers.fluid.walls.edges import parting
from solvers.fluid.walls.layers import edge_of, layers
from solvers.fluid.walls.wall_layers import OF_NONE
from solvers.simulation import Simulation
from solvers.tank.tank import Tank
from tests.oracles.water import GRAVITY, box, still

BOX = box(0.3, 0.4)
CHAMFERS = np.array([(-0.2, 0.0), (0.2, 0.0), (0.3, 0.1), (0.3, 0.5), (-0.3, 0.5), (-0.3, 0.1)])
HOPPER = np.array([(-0.1, 0.0), (0.1, 0.0), (0.3, 0.4), (-0.3, 0.4)])
WEDGE = np.array([(0.0, 0.0), (0.4, 0.0), (0.2, 0.35)])
STEP = np.array([(-0.3, 0.0), (0.0, 0.0), (0.0, 0.15), (0.3, 0.15), (0.3, 0.5), (-0.3, 0.5)])
RIDGE = np.array([(-0.3, 0.0), (-0.1, 0.0), (0.0, 0.1), (0.1, 0.0), (0.3, 0.0), (0.3, 0.5), (-0.3, 0.5)])
OCTAGON = 1e-3 * np.array(
    [(-150, 0), (150, 0), (250, 100), (250, 250), (150, 350), (-150, 350), (-250, 250), (-250, 100)]
)
QUADRATURE = 160  # points of a face
DEPTH, ROWS = 0.16, 16
UPRIGHT = 2  # the octagon's edge from 100 mm on: a corner of 135 deg is 6 spacings below the surface
UNEVEN = 0.008  # of ρ g H: r.m.s. error of the pressure at rest, some 20 layers (docs/physics/sph/accuracy.md)


def frame(outline: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Lengths (m,) m of the edges of a polygon, and outward normals (m, 2)."""
    ways = np.roll(outline, -1, axis=0) - outline
    lengths = np.linalg.norm(ways, axis=1)
    return lengths, np.stack([ways[:, 1], -ways[:, 0]], axis=1) / lengths[:, None]


def faces_of(outline: np.ndarray) -> np.ndarray:
    """Points (m, k, 2) m along each edge of a polygon."""
    ways = np.roll(outline, -1, axis=0) - outline
    return outline[:, None] + ways[:, None] * ((np.arange(QUADRATURE) + 0.5) / QUADRATURE)[:, None]


def shared(
    points: np.ndarray, volumes: np.ndarray, force: np.ndarray, weight: np.ndarray, outline: np.ndarray, water: Water
) -> np.ndarray:
    """The forces (m, 2) on the edges from those on wall particles (n, 2), which see water of a weight (n, 2)."""
    own, total = edge_of(points, outline), np.zeros_like(outline)
    found = parting(points, volumes, Tank(outline, 1.0), water, range(len(outline)))
    given = np.einsum("nab,nb->na", found.of_force, force) + np.einsum("nab,nb->na", found.of_weight, weight)
    np.add.at(total, own, force - given)
    near = found.other != OF_NONE
    np.add.at(total, found.other[near], given[near])
    return total


def hydrostatic(outline: np.ndarray, level: float) -> np.ndarray:
    """Forces (m,) N/m on the edges of a tank with water at rest up to a level (m)."""
    heads = [np.maximum(level - face[:, 1], 0.0).mean() for face in faces_of(outline)]
    return 1000.0 * GRAVITY * np.array(heads) * frame(outline)[0]


@pytest.mark.parametrize("outline", [BOX, CHAMFERS, HOPPER, WEDGE, STEP, RIDGE])
def test_under_an_even_pressure_each_edge_bears_it_on_its_length(outline):
    """A wall particle bears 2 p V Σ n ∫ W dS over all faces. The rule that counts all to the nearest edge misses 0.1 to
    0.6 Δx p everywhere, the one without `_more` 0.42 Δx p where a corner of 90 deg points inwards: 2 ∫ (½ − γ) ds, γ
    what the solid quarter covers.
    """
    spacing, fine = 0.02, 2  # wall particles are finer, so that only geometry is asked
    water = Water(spacing=spacing, sound_speed=10.0)
    points, volumes, _ = layers(outline, spacing / fine, 4 * fine)
    lengths, normals = frame(outline)
    force = np.zeros_like(points)
    for face, long, normal in zip(faces_of(outline), lengths, normals, strict=True):
        away = np.minimum(np.linalg.norm(points[:, None] - face, axis=2), water.reach)
        seen = WendlandC2.printed(away, water.length).sum(axis=1) * long / QUADRATURE
        force += 2.0 * (volumes * seen)[:, None] * normal
    found = shared(points, volumes, force, 0.0 * force, outline, water)
    np.testing.assert_allclose(found.sum(axis=0), force.sum(axis=0), atol=1e-12)
    np.testing.assert_allclose((found * normals).sum(axis=1), lengths, atol=0.05 * spacing)


@pytest.mark.parametrize(
    ("outline", "level"),
    [(OCTAGON, 0.16), (STEP, 0.25), (RIDGE, 0.2), (WEDGE, 0.25)],
)
def test_packed_water_under_hydrostatic_pressure_loads_each_edge_by_its_head(outline, level):
    """At corners of 45 to 270 deg, to ρ g Δx², the weight of a particle, and UNEVEN of the load.

    Without the weight of what wall particles see, an edge beside a corner of 135 deg has 2 ρ g Δx² too much. The
    pressure of a wall particle is the hydrostatic one, so that no run is needed.
    """
    spacing = 0.01
    water = Water(spacing=spacing, sound_speed=100.0)
    packing, (points, volumes, _) = packed(outline, level, water), layers(outline, spacing, 4)
    off = points[:, None] - packing.points
    away = np.minimum(np.linalg.norm(off, axis=2), water.reach)
    t = 1.0 - 0.5 * away / water.length
    share = packing.volume * volumes[:, None] * 1000.0 * GRAVITY
    head = np.maximum(level - points[:, 1], 0.0)[:, None] + level - packing.points[:, 1]
    push = share * WendlandC2.factors(water.length)[1] * t**3 * head
    force = np.einsum("nm,nma->na", push, off)
    seen = (share * WendlandC2.printed(away, water.length)).sum(axis=1)
    found = shared(points, volumes, force, seen[:, None] * np.array([0.0, -1.0]), outline, water)
    wanted = hydrostatic(outline, level)
    error = (found * frame(outline)[1]).sum(axis=1) - wanted
    np.testing.assert_array_less(np.abs(error), 1000.0 * GRAVITY * spacing**2 + UNEVEN * wanted + 1e-9)
    np.testing.assert_allclose(found.sum(axis=0), force.sum(axis=0), atol=1e-9 * wanted.max())


@pytest.mark.slow
def test_water_at_rest_weighs_on_each_edge_of_an_octagon():
    """By its hydrostatic force, as above. Together the edges bear the load on the tank."""
    water = Water(spacing=DEPTH / ROWS, sound_speed=10.0 * np.sqrt(GRAVITY * DEPTH))
    drops = at_rest(OCTAGON, DEPTH, water, GRAVITY)[None]
    run = Simulation(still(0.5, 0.35, DEPTH, ROWS, outline=OCTAGON, edges=tuple(range(8)), drops=drops, alpha=0.02))
    run.advance(round(2.0 / run.dt))
    run.observe()
    run.advance(round(1.0 / run.dt))
    rows = run.observe()
    run.close()
    wanted, force = hydrostatic(OCTAGON, DEPTH), rows["edge_force"][0]
    assert wanted[UPRIGHT] == pytest.approx(17.66, abs=0.01)
    error = (force * frame(OCTAGON)[1]).sum(axis=1) - wanted
    np.testing.assert_array_less(np.abs(error), 1000.0 * GRAVITY * water.spacing**2 + UNEVEN * wanted + 1e-9)
    np.testing.assert_allclose(force.sum(axis=0), rows["wall_force"][0, :2], atol=1e-12 * np.abs(force).max())
