"""Bodies in water in space: their wall particles, the water round them, and how they float."""

from dataclasses import replace

import numpy as np
import pytest

from solvers.fluid.bodies.solids_in_space import shell
from solvers.fluid.given import Water
from solvers.fluid.kernels.wendland_c2 import WendlandC2
from solvers.fluid.start.round_bodies import packed_round
from solvers.simulation import Simulation
from solvers.tank.parts import Hull, Opening
from solvers.tank.shapes import PrismShape, SphereShape
from tests.oracles.floating_in_space import DENSITY, afloat_in_space, body_of, momentum
from tests.oracles.water import GRAVITY, box

SPACING = 0.02
WATER = Water(spacing=SPACING, sound_speed=20.0, smoothing=1.5)
BALL = SphereShape((0.01, 0.3, -0.02), 0.15)
HOLE = (-0.1, 0.27), (0.1, 0.27)  # ends of the diameter of a hole in a floor, 5 spacings wide
CHAMFERED = PrismShape(((-0.1, 0.25), (-0.05, 0.2), (0.1, 0.2), (0.1, 0.4), (-0.1, 0.4)), 0.3, 0.02)


def turned(heel: float, middle: tuple[float, float], size: tuple[float, float]) -> tuple[tuple[float, float], ...]:
    """Corners of a rectangle of a size (m), heeled (rad) about its middle (m)."""
    c, s = np.cos(heel), np.sin(heel)
    corners = 0.5 * np.array(size) * np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
    return tuple(map(tuple, (corners @ np.array([[c, s], [-s, c]]) + np.array(middle)).tolist()))


@pytest.mark.parametrize("shape", [BALL, CHAMFERED])
def test_moments_of_a_shape_are_those_of_many_points_in_it(shape):
    """Volume, centroid and inertia of points of a fine lattice within, to 1 %: a lattice of 60 has 1/60² at faces."""
    low, high = shape.bounds
    sides = [np.linspace(a, b, 61)[1:] - (b - a) / 120.0 for a, b in zip(low, high, strict=True)]
    points = np.stack(np.meshgrid(*sides, indexing="ij"), axis=-1).reshape(-1, 3)
    inside = points[shape.distance(points) < 0.0]
    share = len(inside) / len(points)
    assert share * np.prod(high - low) == pytest.approx(shape.volume, rel=0.01)
    assert np.abs(inside.mean(axis=0) - shape.centroid).max() < 0.01 * np.ptp([low, high])
    off = inside - shape.centroid
    spread = off.T @ off / len(off)
    assert np.abs(np.trace(spread) * np.eye(3) - spread - shape.gyration).max() < 0.01 * shape.gyration.max()
    level = low[1] + 0.3 * (high - low)[1]
    assert (inside[:, 1] < level).mean() * shape.volume == pytest.approx(shape.below(level), rel=0.03)


@pytest.mark.parametrize("shape", [BALL, CHAMFERED])
def test_wall_particles_cover_half_of_a_kernel_at_a_face(shape):
    """Their volumes make up that of the shell, to 1e-3 of a sphere; away from edges Γ = Σ V W is ½ to 2 % on a plane.

    A sphere covers less by its curvature, what `of_ball` finds by integration.
    """
    points, volumes, _, normal, straight, _ = shell(shape, WATER, 3)
    assert np.abs(np.linalg.norm(normal, axis=1) - 1.0).max() < 1e-12
    random = np.random.default_rng(1)
    if isinstance(shape, SphereShape):
        inner = shape.radius - 3.0 * SPACING
        assert volumes.sum() == pytest.approx(shape.volume - 4.0 / 3.0 * np.pi * inner**3, rel=1e-3)
        ways = random.normal(size=(200, 3))
        faces = shape.centroid + shape.radius * ways / np.linalg.norm(ways, axis=1)[:, None]
        covered = of_ball(shape.radius)
    else:
        assert volumes.sum() < shape.volume
        faces = np.column_stack([np.full(50, 0.1), random.uniform(0.28, 0.32, 50), random.uniform(-0.03, 0.07, 50)])
        covered = 0.5
        assert (np.abs(straight).sum(axis=1) > 0.0).any()
    apart = np.linalg.norm(faces[:, None] - points, axis=2)
    kernel = np.where(apart < WATER.reach, WendlandC2.printed(np.minimum(apart, WATER.reach), WATER.length, 3), 0.0)
    assert np.abs((kernel @ volumes).mean() - covered) < 0.02 * covered


def of_ball(radius: float) -> float:
    """What share of a kernel on its surface a ball covers: ∫ W 2π r² (1 − r/2R) dr, the ball's share of each sphere."""
    r = (np.arange(4000) + 0.5) * WATER.reach / 4000
    shells = 2.0 * np.pi * r**2 * (1.0 - 0.5 * r / radius)
    return float((WendlandC2.printed(r, WATER.length, 3) * shells).sum() * WATER.reach / 4000)


def test_water_round_a_body_has_its_volume_and_is_even():
    """Particles fill what the body leaves, none nearer to it than 0.2 spacings, which is half of what a plane has."""
    part = body_of(BALL, 7.0)
    points, volume = packed_round(box(0.8, 0.7), 0.3, WATER, (part,), 0.8)
    assert volume * len(points) == pytest.approx(0.8 * 0.3 * 0.8 - BALL.below(0.3), rel=1e-12)
    assert volume == pytest.approx(SPACING**3, rel=1e-3)
    assert BALL.distance(points).min() > 0.2 * SPACING
    assert points[:, 1].max() < 0.3


@pytest.fixture(scope="module")
def dropped():
    """A heeled prism of half the water's density that falls into the water off the middle: run, and its start."""
    middle, size, spacing = (0.02, 0.6), (0.3, 0.3), 0.05
    shape = PrismShape(turned(0.3, middle, size), 0.3, -0.03)
    body = body_of(shape, 0.5 * DENSITY * shape.volume, centre=(0.03, 0.58, -0.01))
    run = Simulation(afloat_in_space((body,), (0.7, 1.0, 0.7), 0.5, spacing), threads=1)
    yield run, run.state()
    run.close()


def on_both(run: Simulation) -> np.ndarray:
    """The present load (6, 2) N, N m of the water on the tank, all faces together, and on the body."""
    loads = np.stack([field.to_numpy().sum(axis=0) for field in run.water.load.instant])
    faces = run.scene.faces
    return np.stack([loads[:, :faces].sum(axis=1), loads[:, faces]], axis=1)


@pytest.mark.slow
def test_what_water_loses_bodies_and_tank_gain(dropped):
    """Momentum and its moment are kept to 1e-12 of Σ|F|Δt; and the load on the body is the one that was solved for."""
    run, start = dropped
    run.restore(start)
    run.advance(1)
    coupling, bodies, p = run.water.extrapolation.coupling, run.parts.bodies, run.water.particles
    (first, turning), given, pushed, off, down = momentum(run), np.zeros(6), 0.0, 0.0, np.array([0.0, -GRAVITY, 0.0])
    for _ in range(60):
        mass, *place = (values[0] for values in p.read(p.mass, *p.place))
        centre = np.array([field.to_numpy()[0, 0] for field in bodies.place[:3]])
        weighs = mass @ np.stack(place, axis=1) + bodies.rows[0, 0] * centre  # kg m
        run.advance(1)
        loads = on_both(run)
        weight = (mass.sum() + bodies.rows[0, 0]) * down
        given += run.dt * (np.concatenate([weight, np.cross(weighs, down)]) - loads[:, 0])
        pushed += run.dt * np.abs(loads[:3]).sum()
        off = max(off, np.abs(loads[:3, 1] - coupling.foreseen.to_numpy()[0, 0, :3]).max() / np.abs(loads[:3]).sum())
    now, twisted = momentum(run)
    assert np.abs(now - first - given[:3]).max() < 1e-12 * pushed
    assert np.abs(twisted - turning - given[3:]).max() < 1e-12 * pushed  # the tank is a metre large
    assert off < 1e-12
    assert np.abs(run.observe()["body_place"][0, 0, 3:]).min() > 1e-3  # rad, else nothing was tried


def holed(opens: float) -> Simulation:
    """A cabin of 0.4 m with walls of a spacing, that floats over a round hole in its floor, open from a time (s) on."""
    outer, room = turned(0.0, (0.0, 0.4), (0.4, 0.3)), turned(0.0, (0.0, 0.4), (0.32, 0.22))
    shape, hull = PrismShape(outer, 0.4), Hull(0.04, (PrismShape(room, 0.32),), (Opening(HOLE, opens),))
    body = replace(body_of(shape, 0.4 * DENSITY * shape.volume), hull=hull)
    depth = 0.25 + 0.4 * 0.3
    return Simulation(afloat_in_space((body,), (0.8, 0.8, 0.8), depth, 0.04), threads=1)


@pytest.mark.slow
def test_water_enters_a_hull_through_its_hole_alone():
    """Until the hole opens, no water is in the room, to 1e-9 of what it holds; then what flows in is there.

    Momentum is kept to 1e-12 of Σ|F|Δt as the hole opens. The flow, of samples 4 steps apart, adds up to what is in the
    room, to half a layer of particles in the hole: it is that of a slab one of them thick.
    """
    run = holed(0.02)
    try:
        whole = DENSITY * 0.32 * 0.22 * 0.32
        run.advance(int(0.015 / run.dt))
        assert run.observe()["room_water"][0, 0] < 1e-9 * whole
        first, given, pushed, entered, p = momentum(run)[0], np.zeros(3), 0.0, 0.0, run.water.particles
        mass = p.read(p.mass)[0][0].sum() + run.parts.bodies.rows[0, 0]
        for step in range(200):
            run.advance(1)
            loads = on_both(run)[:3]
            given += run.dt * (np.array([0.0, -mass * GRAVITY, 0.0]) - loads[:, 0])
            pushed += run.dt * np.abs(loads).sum()
            if step % 4 == 3:
                rows = run.observe()
                entered += 4.0 * run.dt * rows["opening_flow"][0, 0]
        assert np.abs(momentum(run)[0] - first - given).max() < 1e-12 * pushed
        assert rows["room_water"][0, 0] > 0.02 * whole  # else nothing was tried
        layer = DENSITY * 0.04 * np.pi * 0.1**2
        assert entered == pytest.approx(rows["room_water"][0, 0], abs=0.5 * layer)
    finally:
        run.close()
