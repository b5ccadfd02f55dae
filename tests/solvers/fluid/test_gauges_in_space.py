"""Gauges of water in space: discs in the faces of a prism, depths at places of its floor, forces on its faces."""

from collections.abc import Iterator

import numpy as np
import pytest

from solvers.fluid.given import Gauge, Level
from solvers.fluid.walls.faces import spot_on
from solvers.simulation import Simulation
from tests.oracles.water import GRAVITY, again, box
from tests.oracles.water_in_space import pool

SIDES, ROWS, SPACING = (10, 11, 12), 8, 0.05
WIDTH, ALONG, DEPTH = SIDES[0] * SPACING, SIDES[2] * SPACING, ROWS * SPACING
HEAD = 1000.0 * GRAVITY * DEPTH
HALVES = 0.5 * WIDTH, 0.5 * ALONG
RADIUS = 0.06
GAUGES = (
    Gauge((-HALVES[0], 0.5 * DEPTH), x=0.1, radius=RADIUS),  # a side
    Gauge((0.05, 0.0), x=-0.1, radius=RADIUS),  # the floor
    Gauge((0.1, 0.3 * DEPTH), x=HALVES[1], radius=RADIUS),  # an end
    Gauge((-HALVES[0] + RADIUS, 0.15 * DEPTH), x=-HALVES[1], radius=RADIUS),  # an end, beside three faces
    Gauge((HALVES[0], 0.5 * DEPTH), x=0.0),  # a point
    Gauge((HALVES[0], DEPTH + 0.1), x=0.0, radius=RADIUS),  # above the water
)
BELOW = np.array([0.5, 1.0, 0.7, 0.85, 0.5, 0.0]) * DEPTH

LEVELS = Level(0.0, 0.0), Level(0.05, 0.1), Level(-0.02, -0.13)


@pytest.fixture(scope="module")
def run() -> Iterator[Simulation]:
    made = Simulation(pool(SIDES, ROWS, SPACING, gauges=GAUGES, levels=LEVELS), threads=1, arch="cpu")
    yield made
    made.close()


def test_water_at_rest_has_the_pressure_of_its_depth_at_discs_in_all_faces(run):
    """To 2 % of ρ g H, as in the plane: what ten layers are asked; of a disc the mean is that of its middle."""
    run.observe()
    run.advance(300)
    shown = run.observe()["gauge_pressure"][0]
    np.testing.assert_allclose(shown, 1000.0 * GRAVITY * BELOW, atol=0.02 * HEAD)
    assert shown[-1] == 0.0


@pytest.mark.parametrize("radius", [0.03, 0.1, 0.33])
@pytest.mark.parametrize("middle", [(0.5, 0.5, 0.1), (0.1, 0.0, 0.2), (0.0, 0.4, -2.0)])
def test_the_mean_over_a_disc_is_that_of_quadratic_functions(middle, radius):
    """∫ x² dA = π r⁴/4 and ∫ x y dA = 0 about the middle, to rounding; points lie in the face and within the disc."""
    spot = spot_on(np.array(middle), box(1.0, 1.0), 2.0)
    off = spot.disc(radius, 0.05) - spot.foot
    flat = off @ spot.along.T
    np.testing.assert_allclose(off @ spot.normal, 0.0, atol=1e-15)
    assert np.linalg.norm(off, axis=1).max() < radius
    np.testing.assert_allclose(flat.mean(axis=0), 0.0, atol=1e-15)
    np.testing.assert_allclose(flat.T @ flat / len(flat), np.eye(2) * radius**2 / 4.0, atol=1e-14)


@pytest.mark.parametrize(
    ("point", "face", "room"),
    [
        ((0.1, 0.0, 0.3), 0, 0.4),
        ((0.5, 0.25, 1.9), 1, 0.1),
        ((-0.5, 0.5, 0.0), 3, 0.5),
        ((0.2, 0.9, -2.0), 4, 0.1),
        ((0.4, 0.3, 2.0), 5, 0.1),
    ],
)
def test_a_point_lies_in_the_face_that_is_nearest(point, face, room):
    spot = spot_on(np.array(point), box(1.0, 1.0), 2.0)
    assert spot.face == face
    assert (spot.away, spot.room) == pytest.approx((0.0, room))
    outside = spot_on(np.array(point) + 0.01 * spot.normal, box(1.0, 1.0), 2.0)
    assert (outside.face, outside.away) == (face, pytest.approx(0.01))


def test_a_level_gauge_shows_a_tilted_surface(run):
    """z = H + b y + c x at the gauge, more than a kernel's reach R off the sides, where its kernel is even.

    Columns of particles stand for the water at their middles. Summed at points R/n apart the kernel is 1 everywhere,
    and its first moment within 2 R max|B₃|/n³, with Bernoulli's third polynomial, √3/36 at most (its multiplication
    theorem): here n = 3, 0.4 % of R.
    """
    scene = pool(SIDES, ROWS, SPACING, gauges=GAUGES, levels=LEVELS)
    drops, slopes = scene.fluid.particles, np.array([0.3, -0.2])
    share = (DEPTH + drops["position"][..., [0, 2]] @ slopes) / DEPTH
    drops["position"][..., 1] *= share
    drops["volume"] *= share
    again(run, scene)
    found, reach = run.observe()["level_depth"][0], scene.fluid.water.reach
    wanted = [DEPTH + slopes @ (level.y, level.x) for level in LEVELS]
    assert reach == pytest.approx(3.0 * SPACING)
    np.testing.assert_allclose(found, wanted, atol=np.abs(slopes).sum() * 2.0 * reach * 3.0**0.5 / 36.0 / 27.0 + 1e-12)
