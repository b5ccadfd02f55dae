"""Gauges of water in space: discs in the faces of a prism, depths at places of its floor, forces on its faces."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest

from solvers.fluid.given import Gauge, Level
from solvers.fluid.walls.faces import spot_on
from solvers.scene import Scene
from solvers.simulation import Simulation
from tests.oracles.water import GRAVITY, again, box
from tests.oracles.water_in_space import PlainWaterInSpace, pool

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


@pytest.mark.slow
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


@pytest.mark.slow
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


def stirred() -> Scene:
    """A pool whose particles are off their lattice and move at random."""
    scene, random = pool(SIDES, ROWS, SPACING, gauges=GAUGES, levels=LEVELS), np.random.default_rng(1)
    drops = scene.fluid.particles
    drops["position"] += 0.1 * SPACING * random.uniform(-1.0, 1.0, drops["position"].shape)
    drops["velocity"] = 0.2 * random.uniform(-1.0, 1.0, drops["position"].shape)
    return scene


def by_hand(scene: Scene, r: np.ndarray, mass: np.ndarray, s: np.ndarray) -> np.ndarray:
    """Forces (N) and moments (N m) on the faces of a box (6, 6): floor, right, lid, left, ends at −x and x.

    By double sums over water and walls; the part of each along y, z or x goes to the face with that normal which the
    wall particle is behind, other parts to the first of the faces that it is behind.
    """
    water = scene.fluid.water
    plain = PlainWaterInSpace(replace(scene, matters=(replace(scene.fluid, water=replace(water, gauges=())),)))
    volume, on_wall = plain.volume(mass, s), plain.wall_pressure(r, mass, s)
    _, _, value, gradient = plain.between(r, plain.wall)
    push = np.maximum(1000.0 * water.sound_speed**2 * s, 0.0)[:, None] + on_wall
    force = (push * volume[:, None] * plain.wall_volume)[..., None] * gradient
    steep = np.einsum("i,iwa->wa", volume, gradient)
    along = plain.is_straight * (steep - (steep * plain.normal).sum(axis=1, keepdims=True) * plain.normal)
    strength = (plain.wall_volume * on_wall)[:, None] * along / np.maximum(volume @ value, 1e-30)[:, None]
    force -= (volume[:, None] * value)[..., None] * strength
    faces = np.array([[3, 1], [0, 2], [4, 5]])
    off = plain.wall - np.clip(plain.wall, plain.lower, plain.upper)
    of_axis = np.where(off == 0.0, 9, faces[np.arange(3), (off > 0.0).astype(int)])
    found = np.zeros((6, 6))
    for a in range(3):
        bears, part = np.where(of_axis[:, a] < 9, of_axis[:, a], of_axis.min(axis=1)), np.zeros_like(force)
        part[..., a] = force[..., a]
        moment = np.cross(r[:, None], part)
        for face in range(6):
            found[face, :3] += part[:, bears == face].sum(axis=(0, 1))
            found[face, 3:] += moment[:, bears == face].sum(axis=(0, 1))
    return found


@pytest.mark.slow
def test_each_face_bears_what_double_sums_say(run):
    """Forces and moments of a disturbed pool, to rounding."""
    scene = stirred()
    again(run, scene).advance(5)
    run.observe()
    p = run.water.particles
    r, (s, mass) = np.stack(p.read(*p.place), axis=-1)[0], [one[0] for one in p.read(p.deviation, p.mass)]
    run.advance(1)
    found, wanted = run.observe()["face_force"][0], by_hand(scene, r, mass, s)
    np.testing.assert_allclose(found, wanted, atol=1e-9 * np.abs(wanted).max())
    assert (np.abs(wanted[[0, 1, 3, 4, 5], [1, 0, 0, 2, 2]]) > 10.0).all()


@pytest.mark.slow
def test_the_loads_on_all_faces_are_what_the_water_loses(run):
    """Momentum changes by the weight and minus the sum over the faces, to rounding; the lid bears nothing."""
    again(run, stirred()).advance(1)
    run.observe()
    p, steps = run.water.particles, 20
    mass = p.read(p.mass)[0][0]
    before = np.stack(p.read(*p.velocity), axis=-1)[0]
    run.advance(steps)
    rows, gained = run.observe(), np.stack(p.read(*p.velocity), axis=-1)[0] - before
    faces = rows["face_force"][0]
    pulled = mass.sum() * np.array([0.0, -GRAVITY, 0.0])
    scale = np.abs(faces).max()
    np.testing.assert_allclose(mass @ gained / (steps * run.dt), pulled - faces[:, :3].sum(axis=0), atol=1e-11 * scale)
    np.testing.assert_allclose(faces.sum(axis=0), rows["wall_force"][0], atol=1e-12 * scale)
    np.testing.assert_array_equal(faces[2], 0.0)


@pytest.mark.slow
def test_each_face_bears_the_pressure_on_it_at_rest(run):
    """Floor and sides: ρ g H A and ρ g H² L/2, square to them, to what pressures at rest are off and what edges take.

    Pressures are 2 % of ρ g H off at most; a face may miss a tenth of a spacing of the pressure at its edges, as in the
    plane; water draws an upright wall by ρ g h² a metre where the push along it is not taken off, here everywhere,
    since no wall particle is more than 1.5 reaches off all edges.
    """
    again(run, pool(SIDES, ROWS, SPACING, gauges=GAUGES, levels=LEVELS))
    run.observe()
    run.advance(300)
    faces = run.observe()["face_force"][0]
    floor, sides = HEAD * WIDTH * ALONG, 0.5 * HEAD * DEPTH * np.array([ALONG, ALONG, WIDTH, WIDTH])
    drawn = 1000.0 * GRAVITY * (1.5 * SPACING) ** 2 * 2.0 * (WIDTH + ALONG)
    edges = 0.1 * SPACING * HEAD * np.array([ALONG + DEPTH, ALONG + DEPTH, WIDTH + DEPTH, WIDTH + DEPTH])
    found = np.array([faces[1, 0], -faces[3, 0], -faces[4, 2], faces[5, 2]])
    np.testing.assert_array_less(np.abs(found - sides), edges + 0.02 * 2.0 * sides)
    assert -faces[0, 1] == pytest.approx(floor, abs=drawn + 0.02 * floor)
    np.testing.assert_allclose(found[::2], found[1::2], rtol=0.01)
