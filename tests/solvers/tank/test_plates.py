"""Plates that move in the tank: collisions with them, a gate that holds a bed, a floor that drops away."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import pytest

from solvers.simulation import Simulation
from solvers.tank.parts import Part
from tests.oracles.given import scene_of
from tests.oracles.scenes import box, material
from tests.solvers.grains.test_neighbours import segment_distance

G, RADIUS = 9.81, 2e-3
ROOF = np.array([[-0.02, 0.0], [0.0, 0.01], [0.02, 0.0]])
UP = np.array([-0.01, 0.02]) / np.hypot(0.01, 0.02)  # square to the roof's left side
STILL, MOVING = np.array([-0.1, 0.06]), np.array([0.05, 0.06])  # where the two roofs are at the start
V = np.array([0.8, 1.6])  # m/s, of the one that moves
DURATION = 0.03
ASIDE = np.array([[-0.17, 0.02], [-0.17, 0.18]])  # where grains lie that meet nothing
LEFT = 0.5 * (ROOF[0] + ROOF[1])
# Where a grain would meet a roof, and from where: (a point of the roof's frame, away from it, aside of it in radii).
AIMS = {
    "above a side": (LEFT, UP, 0.0),
    "below a side": (LEFT, -UP, 0.0),
    "aslant": (LEFT, np.add(UP, [0.9, 0.3]), 0.0),
    "grazing a side": (LEFT, UP + 8.0 * np.array([-UP[1], UP[0]]), 0.0),
    "the ridge": (ROOF[1], np.array([0.0, 1.0]), 0.3),
    "grazing the ridge": (ROOF[1], np.array([1.0, 0.1]), 0.4),
    "under the ridge": (ROOF[1], np.array([0.1, -1.0]), 0.0),
    "the end, on the roof": (ROOF[0], np.array([0.0, 1.0]), 0.2),
    "the end, off the roof": (ROOF[0], np.array([0.0, 1.0]), -0.6),
    "grazing the end": (ROOF[0], np.array([0.0, 1.0]), -0.98),
    "the end from the side": (ROOF[0], np.array([-1.0, 0.0]), 0.3),
    "the way of the roof": (LEFT, V, 0.0),  # a grain that stands in it
}
KINDS = {"elastic": (0.0, 0.0), "lossy": (2e-5, 0.4)}  # dissipative time (s), friction
STAND = np.linalg.norm(V)


@dataclass
class Flight:
    """What came of grains aimed at the still roof and, as seen from it, at the moving one, (T, 2 kinds, aims, …).

    The last axis but the coordinates is (still, moving); `nearest` is the distance from the roofs, `contacts` the
    number per world that the lists know.
    """

    position: np.ndarray
    velocity: np.ndarray
    spin: np.ndarray
    nearest: np.ndarray
    contacts: np.ndarray
    time: np.ndarray
    fastest: float


def distance(points: np.ndarray, place: np.ndarray) -> np.ndarray:
    """Distance (N,) of points (N, 2) from a roof."""
    sides = [segment_distance(points, a + place, b + place) for a, b in pairwise(ROOF)]
    return np.min(sides, axis=0)


def shot(point: np.ndarray, away: np.ndarray, aside: float) -> tuple[np.ndarray, np.ndarray]:
    """Where a grain starts, a little off the roof, and its velocity, in the roof's frame."""
    away = away / np.hypot(*away)
    path = point + RADIUS * np.linspace(0.0, 20.0, 401)[:, None] * away + aside * RADIUS * np.array([away[1], -away[0]])
    start = np.flatnonzero(distance(path, np.zeros(2)) < 1.2 * RADIUS).max(initial=0)
    return path[start], -STAND * away


SLOW = [pytest.param(schedule, marks=pytest.mark.slow) for schedule in ("per-band", "per-grain")]


@pytest.fixture(scope="module", params=["per-world", *SLOW])
def flight(request) -> Flight:
    """Worlds of two grains without weight, each aim once elastic and once with friction and loss.

    After each of them a grain lies aside: a band is of two grains at least.
    """
    shots = [shot(*aim) for aim in AIMS.values()] * len(KINDS)
    start, velocity = (np.array(values) for values in zip(*shots, strict=True))
    materials = [material(young=4e7, dissipative_time=a, friction=mu) for a, mu in KINDS.values() for _ in AIMS]
    roofs = [tuple(map(tuple, ROOF + place)) for place in (STILL, MOVING)]
    way = 0.05
    scene = scene_of(
        np.full((len(start), 4), RADIUS),
        box(0.4, 0.2),
        materials,
        materials,
        tangential="mindlin",
        gravity=0.0,
        start_speed=STAND,
        parts=(Part(roofs[0]), Part(roofs[1], tuple(way * V / STAND), 0.0, STAND, 1e300)),
        schedule=request.param,
    )
    flies = slice(None, None, 2)
    place, speed, spin = (np.zeros((len(start), 4, *size)) for size in ((2,), (2,), ()))
    place[:, flies] = np.stack([start + STILL, start + MOVING], axis=1)
    place[:, 1::2] = ASIDE
    speed[:, flies], spin[:, flies] = np.stack([velocity, velocity + V], axis=1), 150.0
    run = Simulation(scene, place, 1, arch="cpu", units=2 if request.param == "per-band" else None)
    run.launch(speed, spin)
    looks = []
    while run.time < DURATION:
        run.advance(12)
        state, rows = run.snapshot(), run.observe()
        roofs = run.placed()["part"][0] + [STILL, MOVING]
        state = {name: state[name][:, flies] for name in ("position", "velocity", "spin")}
        near = np.stack([distance(state["position"][:, k], roof) for k, roof in enumerate(roofs)], axis=1)
        looks.append([*state.values(), near, rows["contacts"], run.time])
    run.close()
    shape = len(looks), len(KINDS), len(AIMS)
    columns = [np.array(column) for column in zip(*looks, strict=True)]
    return Flight(*(c.reshape(*shape, *c.shape[2:]) for c in columns[:5]), columns[5], scene.credible_speed())


@pytest.mark.slow
def test_a_moving_plate_is_a_still_one_seen_from_a_moving_frame(flight):
    """Galileo: positions, velocities and spins agree, whatever the impact, with friction and without."""
    shift = MOVING - STILL + V * flight.time[:, None, None, None]
    apart = flight.position[..., 1, :] - flight.position[..., 0, :] - shift
    assert np.abs(apart).max() < 1e-9
    assert np.abs(flight.velocity[..., 1, :] - flight.velocity[..., 0, :] - V).max() < 1e-6
    assert np.abs(flight.spin[..., 1] - flight.spin[..., 0]).max() < 1e-3
    turned = np.linalg.norm(flight.velocity[-1] - flight.velocity[0], axis=-1)
    assert turned.min() > 0.02 * STAND, "all are to meet their roof"


def test_no_grain_passes_a_plate(flight):
    """The speeds are the highest credible ones of the scene."""
    assert flight.fastest == pytest.approx(STAND)
    assert flight.nearest.min() > 0.8 * RADIUS
    assert flight.nearest[-1].min() > RADIUS


def test_lists_contain_all_contacts_with_plates(flight):
    """No contact is missed because the plate moves and the grain does not."""
    touching = flight.nearest < RADIUS
    assert touching.sum() > 100
    np.testing.assert_array_equal(touching.any(axis=-1), flight.contacts > 0)


def test_impacts_on_plates_create_no_energy(flight):
    """In the frame of the roof: conserved by elastic smooth impacts, head-on and grazing, and reduced by all others."""
    frame = np.stack([np.zeros(2), V])
    energy = 0.5 * ((flight.velocity - frame) ** 2).sum(axis=-1) + 0.2 * RADIUS**2 * flight.spin**2
    kept = energy[-1] / energy[0]
    assert kept[0] == pytest.approx(np.ones(kept[0].shape), abs=1e-3)
    assert np.all(energy[:, 1].max(axis=0) <= energy[0, 1] * (1.0 + 1e-3))
    assert kept[1].max() < 0.99


GATE = Part(((0.0, 0.0), (0.0, 0.05)), move=(0.0, 0.08), start=0.2, speed=1.5, acceleration=50.0)
FLOOR = Part(((0.03, 0.1), (0.06, 0.1)), move=(0.0, -0.08), start=0.2, speed=10.0, acceleration=3.0 * G)
BEHIND = 21


@pytest.fixture(scope="module")
def machine():
    """A bed behind a gate, and three grains on a floor; the gate opens and the floor drops after 0.2 s.

    Returns (time, position (n, 2), displacements (2, 2), rows) every 10 ms, the overlap (m) of a grain at rest on the
    floor, and the mass of a grain.
    """
    rng = np.random.default_rng(1)
    column, row = (axis.ravel() for axis in np.meshgrid(np.arange(3), np.arange(7), indexing="ij"))
    bed = RADIUS * (np.stack([2.1 * column - 5.4, 2.1 * row + 1.1], axis=1) + rng.uniform(-0.05, 0.05, (BEHIND, 2)))
    on_floor = np.array([[0.035, 0.1 + RADIUS], [0.045, 0.1 + RADIUS], [0.055, 0.1 + RADIUS]])
    scene = scene_of(
        np.full((1, BEHIND + 3), RADIUS),
        np.array([[-0.013, 0.0], [0.08, 0.0], [0.08, 0.2], [-0.013, 0.2]]),
        material(young=4e7),
        material(young=4e7),
        tangential="mindlin",
        parts=(GATE, FLOOR),
    )
    run = Simulation(scene, np.concatenate([bed, on_floor])[None], 1, arch="cpu")
    looks = []
    while run.time < 0.35:
        run.advance(round(0.01 / run.dt))
        rows = run.observe()
        looks.append((run.time, run.snapshot()["position"][0], run.placed()["part"][0], rows))
    stiffness = 4.0 / 3.0 * scene.grains.interfaces[1].young_modulus * np.sqrt(RADIUS)
    mass = run.grains.mass[0, 0]
    run.close()
    return looks, (mass * G / stiffness) ** (2 / 3), mass


@pytest.mark.slow
def test_a_gate_holds_a_bed_and_releases_it(machine):
    looks, *_ = machine
    for time, position, moved, _ in looks:
        if time < GATE.start:
            assert position[:BEHIND, 0].max() < -0.9 * RADIUS
            assert not moved.any()
    assert looks[-1][2][0] == pytest.approx([0.0, 0.08])
    out = looks[-1][1][:BEHIND, 0] > RADIUS
    assert 3 <= out.sum() < BEHIND
    assert looks[-1][1][:BEHIND, 1].max() < looks[15][1][:BEHIND, 1].max() - RADIUS


@pytest.mark.slow
def test_grains_on_a_floor_that_drops_at_three_g_fall_freely(machine):
    """They leave it once it has moved by their overlap; until then it carries them with less than their weight."""
    looks, overlap, _ = machine
    compared = 0
    for time, position, moved, _ in looks:
        fallen = 0.1 + RADIUS - overlap - position[BEHIND:, 1]
        since = time - FLOOR.start
        if since < 0.0:
            assert np.all(np.abs(fallen) < 0.1 * overlap) or time < 0.1
        elif since < 0.09:
            compared += 1
            carried = G * np.sqrt(overlap / G) * since
            assert np.all(fallen < 0.5 * G * since**2 + 1e-9)
            assert np.all(fallen > 0.5 * G * since**2 - carried)
            if since < 0.05:
                assert moved[1, 1] == pytest.approx(-1.5 * G * since**2, abs=1e-12)
    assert compared >= 8


@pytest.mark.slow
@pytest.mark.parametrize("schedule", ["per-world", *SLOW])
def test_a_plate_finds_grains_that_lie_still(schedule):
    """Nobody moves when the plate sets off, so that only its own way can tell that lists are old. A plate of 1 m/s that
    meets an elastic grain at rest throws it ahead at 2 m/s, which it hands on to the next; then it meets it again.
    """
    plate = Part(((-0.05, 0.0), (-0.05, 0.1)), move=(0.06, 0.0), speed=1.0, acceleration=1e300)
    elastic = material(dissipative_time=0.0, friction=0.0)
    place = RADIUS * np.array([[[0.0, 20.0], [4.0, 20.0], [8.0, 20.0], [12.0, 20.0]]])
    scene = scene_of(
        np.full((1, 4), RADIUS),
        box(0.2, 0.12),
        elastic,
        elastic,
        gravity=0.0,
        start_speed=2.0,
        parts=(plate,),
        schedule=schedule,
    )
    run = Simulation(scene, place, 1, arch="cpu", units=2 if schedule == "per-band" else None)
    run.advance(round(0.062 / run.dt))
    state = run.snapshot()
    run.close()
    assert state["velocity"][0, -1] == pytest.approx([2.0, 0.0], abs=1e-2)
    assert np.all(state["position"][0, :, 0] > -0.05 + 0.06 + 0.99 * RADIUS)


@pytest.mark.slow
@pytest.mark.parametrize("schedule", ["per-world", *SLOW])
def test_grains_from_afar_meet(schedule):
    """Two lone grains come at each other across cells with nothing in them, a third at a wall: none is missed."""
    elastic = material(dissipative_time=0.0, friction=0.0)
    place = np.array([[[-0.06, 0.05], [0.06, 0.05], [0.03, 0.09], [0.0, 0.02]]])
    velocity = np.array([[[3.0, 0.0], [-2.0, 0.0], [0.0, 1.0], [0.0, 0.0]]])
    scene = scene_of(
        np.full((1, 4), RADIUS), box(0.2, 0.12), elastic, elastic, gravity=0.0, start_speed=3.0, schedule=schedule
    )
    run = Simulation(scene, place, 1, arch="cpu", units=2 if schedule == "per-band" else None)
    run.launch(velocity)
    run.advance(round(0.035 / run.dt))
    state = run.snapshot()
    run.close()
    expected = [[-2.0, 0.0], [3.0, 0.0], [0.0, -1.0], [0.0, 0.0]]
    np.testing.assert_allclose(state["velocity"][0], expected, atol=1e-2)
