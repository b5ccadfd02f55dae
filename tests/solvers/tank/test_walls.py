"""Distances and normals of the walls against independent geometry, and the forces of corners on grains."""

import numpy as np
import pytest
import taichi as ti
from matplotlib.path import Path

from solvers.machine import runtime
from solvers.machine.state import State
from solvers.tank.pieces import Pieces
from solvers.tank.tank import Tank
from solvers.tank.walls import Walls
from tests.oracles.scenes import box, material, simulation

RADIUS = 5e-3
# An L with a plate on its floor, thinner than the skin of the contact lists.
PLATE = [[0.0499, 0.0], [0.0499, 0.02], [0.0501, 0.02], [0.0501, 0.0]]
L_ROOM = np.array([[0.0, 0.0], *PLATE, [0.1, 0.0], [0.1, 0.16], [-0.1, 0.16], [-0.1, 0.06], [0.0, 0.06]])
CORNER = L_ROOM[9]
HOPPER_SIDE = [[0.02, 0.0], [0.02, 0.03], [0.1, 0.11], [0.1, 0.2]]
HOPPER = np.array(HOPPER_SIDE + [[-y, z] for y, z in reversed(HOPPER_SIDE)])
OUTLINES = {"rectangle": (box(0.2, 0.1), []), "L": (L_ROOM, [2, 3, 9]), "hopper": (HOPPER, [1, 6])}


@ti.kernel
def probe(
    walls: ti.template(),
    points: ti.types.ndarray(),
    reach: ti.f64,
    gaps: ti.types.ndarray(),
    near: ti.types.ndarray(),
    holds: ti.types.ndarray(),
):
    """Ask the walls about points (N, 2): gaps (N, features, 3), near (N, features), holds (N,)."""
    for i in range(points.shape[0]):
        shift = walls.shift(0, 0.0)
        y, z = points[i, 0], points[i, 1]
        holds[i] = ti.cast(walls.holds(y, z), ti.i32)
        for feature in range(walls.features):
            near[i, feature] = ti.cast(walls.near(feature, shift, reach, y, z), ti.i32)
            gap = walls.gap(feature, shift, y, z)
            for k in ti.static(range(3)):
                gaps[i, feature, k] = gap[k]


def ask(outline: np.ndarray, points: np.ndarray, reach: float):
    """Signed distances (N, features), normals (N, features, 2), near (N, features) and holds (N,) of an outline."""
    runtime.initialise(1)
    arrays = State()
    walls = Walls(arrays, [Tank(outline, 1.0)], Pieces(arrays, (), (), 1))
    arrays.finish()
    gaps = np.zeros((len(points), walls.features, 3))
    near, holds = np.zeros(gaps.shape[:2], dtype=np.int32), np.zeros(len(points), dtype=np.int32)
    probe(walls, points, reach, gaps, near, holds)
    arrays.release()
    return gaps[..., 0], gaps[..., 1:], near.astype(bool), holds.astype(bool)


def feet(points: np.ndarray, outline: np.ndarray, reflex: list[int]) -> tuple[np.ndarray, np.ndarray]:
    """Nearest point (N, features, 2) of every segment, then of every reflex corner, and the place along the segment."""
    edge = np.roll(outline, -1, axis=0) - outline
    away = points[:, None] - outline
    share = (away * edge).sum(axis=-1) / (edge**2).sum(axis=-1)
    on_segment = outline + np.clip(share, 0.0, 1.0)[..., None] * edge
    corners = np.broadcast_to(outline[reflex], (len(points), len(reflex), 2))
    return np.concatenate([on_segment, corners], axis=1), share


@pytest.mark.parametrize("name", OUTLINES)
def test_walls_have_correct_distances_and_normals(name):
    """Random points in and around an outline: inside or outside, nearest feature, distance and normal."""
    outline, reflex = OUTLINES[name]
    rng, reach, segments = np.random.default_rng(1), 0.02, len(outline)
    points = rng.uniform(outline.min(axis=0) - 0.02, outline.max(axis=0) + 0.02, (2000, 2))
    points = np.concatenate([points, np.repeat(outline, 400, axis=0) + rng.normal(0.0, 3e-3, (400 * segments, 2))])
    distance, normal, near, holds = ask(outline, points, reach)
    foot, share = feet(points, outline, reflex)
    apart = np.linalg.norm(points[:, None] - foot, axis=-1)

    np.testing.assert_array_equal(holds, Path(outline).contains_points(points))
    np.testing.assert_array_equal(near, apart < reach)

    faces = np.zeros_like(near)
    faces[:, :segments] = (share >= 0.0) & (share <= 1.0)
    for k, corner in enumerate(reflex):  # the corner is the nearest point of both its segments
        faces[:, segments + k] = (share[:, corner - 1] > 1.0) & (share[:, corner] < 0.0)
    np.testing.assert_array_equal(distance < 1e20, faces)
    assert faces.sum(axis=0).min() > 5
    np.testing.assert_allclose(np.abs(distance[faces]), apart[faces], rtol=1e-9, atol=1e-15)

    # A step along the normal leads away from the foot where the distance is positive, and towards it where negative.
    arrow = (points[:, None] - foot)[faces] / distance[faces][:, None]
    np.testing.assert_allclose(normal[faces], arrow, atol=1e-9)

    # From inside, the nearest feature faced is the nearest point of the whole outline, and it counts once.
    inside = np.where(faces & (distance > 0.0), distance, np.inf)[holds]
    nearest = apart[holds, :segments].min(axis=1)
    np.testing.assert_allclose(inside.min(axis=1), nearest, rtol=1e-9)
    assert np.all((inside < nearest[:, None] * (1.0 + 1e-9)).sum(axis=1) == 1)


HARD = material(young=3.2e7, restitution=1.0, friction=0.0)
DEEP = 0.01 * RADIUS
H = RADIUS - DEEP
# Places of grains at rest, the directions they are pushed in, each as hard as one wall pushes, and how many walls do.
TOUCHING = {
    "a convex corner": ([0.1 - H, H], [-1.0, 1.0], 2),
    "a wall": ([0.1 - H, 0.03], [-1.0, 0.0], 1),
    "the ledge beside the reflex corner": (CORNER + np.array([-1e-6, H]), [0.0, 1.0], 1),
    "right above the corner": (CORNER + np.array([0.0, H]), [0.0, 1.0], 1),
    "right beside the corner": (CORNER + np.array([H, 0.0]), [1.0, 0.0], 1),
    "beyond both segments": (CORNER + H * np.array([0.6, 0.8]), [0.6, 0.8], 1),
    "a thin plate": ([0.0499 - H, 0.01], [-1.0, 0.0], 1),
    "nothing": ([0.05, 0.1], [0.0, 0.0], 0),
}


def throws(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Places and velocities (24, 2): 12 grains aimed at the reflex corner off its middle, 6 slid over the ledge's end
    at several speeds, 6 thrown anywhere."""
    angle = rng.uniform(-0.3 * np.pi, 0.8 * np.pi, 12)
    ray = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    aside = np.stack([-ray[:, 1], ray[:, 0]], axis=1) * RADIUS * rng.uniform(-0.9, 0.9, (12, 1))
    place = [CORNER + 4.0 * RADIUS * ray + aside, np.tile(CORNER + RADIUS * np.array([-2.0, 1.0]), (6, 1))]
    velocity = [-rng.uniform(0.3, 1.5, (12, 1)) * ray, np.linspace([0.05, 0.0], [0.6, 0.0], 6)]
    place.append(rng.uniform([0.01, 0.03], [0.09, 0.15], (6, 2)))
    velocity.append(rng.normal(0.0, 1.0, (6, 2)))
    return np.concatenate(place), np.concatenate(velocity)


@pytest.fixture(scope="module")
def room():
    """Lone grains in the L, one a world: those of TOUCHING, then the thrown ones, whose flight is followed.

    Returns the acceleration (W, 2) and the contacts (W,) of the first step, place and velocity (W, 2) at the start, the
    mass (W,), and the state every 2 ms.
    """
    place, velocity = throws(np.random.default_rng(4))
    touching = np.array([at for at, _, _ in TOUCHING.values()])
    place, velocity = np.concatenate([touching, place]), np.concatenate([np.zeros_like(touching), velocity])
    run = simulation(place[:, None], RADIUS, L_ROOM, grain=HARD, velocity=velocity[:, None], start_speed=2.0)
    run.advance(1)
    felt, counted = run.snapshot()["velocity"][:, 0] - velocity, run.observe()["contacts"]
    looks = []
    for _ in range(250):
        run.advance(round(2e-3 / run.dt))
        looks.append({"time": run.time} | run.snapshot() | run.observe())
    run.close()
    return felt / run.dt, counted, place, velocity, run.grains.mass[:, 0], looks


def test_each_touching_corner_pushes_once(room):
    """Before it moves, a grain feels its force for one step: half of it in the kick, half in the predicted velocity.

    A wall pushes with the force of Hertz, (4/3) E* √R ξ^(3/2).
    """
    felt, counted, _, _, mass, _ = room
    young = HARD.young / (2.0 * (1.0 - HARD.poisson**2))
    push = 4.0 / 3.0 * young * np.sqrt(RADIUS) * DEEP**1.5 / mass[0]
    for k, (name, (_, ways, contacts)) in enumerate(TOUCHING.items()):
        np.testing.assert_allclose(felt[k] + [0.0, 9.81], push * np.array(ways), atol=1e-9 * push, err_msg=name)
        assert counted[k] == contacts, name


def test_energy_is_conserved_in_an_elastic_tank_with_a_reflex_corner(room):
    """Frictionless elastic grains under gravity hit walls and the corner many times."""
    _, _, place, velocity, mass, looks = room
    thrown = slice(len(TOUCHING), None)
    given = 0.5 * mass * (velocity**2).sum(axis=1) + 9.81 * mass * place[:, 1]
    drift, bounces, at_corner = np.zeros(len(mass)), np.zeros(len(mass)), np.zeros(len(mass), dtype=bool)
    before, then = velocity, 0.0
    for look in looks:
        kept = look["kinetic"] + look["rotational"] + look["potential"]
        drift = np.maximum(drift, np.where(look["contacts"] > 0, 0.0, np.abs(kept / given - 1.0)))
        now = look["velocity"][:, 0]
        struck = np.linalg.norm(now - before - [0.0, -9.81 * (look["time"] - then)], axis=1) > 1e-3
        bounces += struck
        at_corner |= struck & (np.linalg.norm(look["position"][:, 0] - CORNER, axis=1) < 1.5 * RADIUS)
        before, then = now, look["time"]
    assert bounces[thrown].min() >= 1
    assert at_corner[thrown][:18].sum() >= 14
    assert drift[thrown].max() < 1e-3
