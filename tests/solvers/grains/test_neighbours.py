"""Neighbour lists against brute force, contact history across rebuilds, and lists that outgrow their arrays."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.spatial import cKDTree

from solvers.grains.lists import candidates
from solvers.grains.lists.candidates import BESIDE
from solvers.grains.lists.skin import ASTRAY, LISTS
from solvers.motion import Sway
from solvers.simulation import Simulation
from tests.oracles.given import scene_of
from tests.oracles.scenes import box, material, simulation

RADIUS = 3e-3
# A hopper with a ledge: slanted walls, a reflex corner, corners of many angles.
TANK = np.array([[-0.03, 0.0], [0.02, 0.0], [0.1, 0.06], [0.1, 0.16], [0.03, 0.16], [0.03, 0.1], [-0.1, 0.1]])
REFLEX = 5
COUNT, WIDTH, LOOKS = 36, 0.04, 140
SKIN, WIDE_SKIN = 1.2e-3, 2.4 * RADIUS


def clouds(rng: np.random.Generator, count: int, cell: float):
    """Radii and positions of awkward clouds: plain, of unequal grains, in clusters, on cell borders, partly outside."""
    lower, upper = TANK.min(axis=0), TANK.max(axis=0)
    plain = rng.uniform(lower, upper, (count, 2))
    unequal = rng.uniform(RADIUS / 5.0, RADIUS, count)
    middles = np.repeat(rng.uniform(lower, upper, (count // 10, 2)), 10, axis=0)
    clusters = middles + rng.normal(0.0, 1.5 * RADIUS, (count, 2))
    columns, rows = (int(n) + 1 for n in (upper - lower) / cell)
    sites = rng.choice(columns * rows, count, replace=False)
    borders = lower + cell * np.stack([sites % columns, sites // columns], axis=1)
    for axis in range(2):  # a third along borders of columns, a third along borders of rows, a third on corners
        borders[axis::3, axis] += rng.uniform(0.0, 0.7 * cell, len(borders[axis::3]))
    outside = rng.uniform(lower - 2.0 * RADIUS, upper + 2.0 * RADIUS, (count, 2))
    outside[::2, 1] = rng.choice([lower[1], upper[1]], len(outside[::2])) + rng.uniform(-2e-3, 2e-3, len(outside[::2]))
    radius = np.stack([np.full(count, RADIUS), unequal, unequal, np.full(count, 0.99 * RADIUS), unequal])
    return radius, np.stack([plain, plain, clusters, borders, outside])


def brute_pairs(position: np.ndarray, radius: np.ndarray, skin: float) -> set[tuple[int, int]]:
    """All i < j whose surfaces are nearer than `skin`."""
    first, second = np.triu_indices(len(radius), 1)
    square = ((position[first] - position[second]) ** 2).sum(axis=1)
    close = square < (radius[first] + radius[second] + skin) ** 2
    return set(zip(first[close].tolist(), second[close].tolist(), strict=True))


def segment_distance(points: np.ndarray, start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Distance of points (N, 2) from a segment."""
    edge = end - start
    share = np.clip((points - start) @ edge / (edge @ edge), 0.0, 1.0)
    return np.linalg.norm(points - start - share[:, None] * edge, axis=1)


def brute_walls(position: np.ndarray, radius: np.ndarray, skin: float) -> set[tuple[int, int]]:
    """All (grain, feature) nearer than `skin`: the segments in their order, then the reflex corner."""
    distance = [segment_distance(position, a, b) for a, b in zip(TANK, np.roll(TANK, -1, axis=0), strict=True)]
    distance.append(np.linalg.norm(position - TANK[REFLEX], axis=1))
    near = np.stack(distance, axis=1) < (radius + skin)[:, None]
    return {(int(i), int(feature)) for i, feature in np.argwhere(near)}


def listed(contacts, w: int) -> np.ndarray:
    """The (grain, mate) rows of one world's list, with the index of first contacts checked against them."""
    grain, mate = (field.to_numpy()[w].reshape(-1) for field in (contacts.grain, contacts.mate))
    rows = np.stack([grain, mate], axis=1)[: contacts.length[w]] - w * contacts.stride
    first = contacts.first.to_numpy()[w]
    np.testing.assert_array_equal(first, np.searchsorted(rows[:, 0], np.arange(len(first))))
    return rows


@pytest.fixture(scope="module")
def clouded():
    """A simulation of the clouds with a step so short that nobody moves, and where they are."""
    radius, position = clouds(np.random.default_rng(7), 150, 2.0 * RADIUS + SKIN)
    scene = scene_of(radius, TANK, material(), material(), step=1e-15, schedule="per-world")
    run = Simulation(scene, position, threads=1, skin=SKIN)
    return run, position


def test_lists_equal_brute_force(clouded):
    """The lists of the first step."""
    (run, position), rng, skin, radius = clouded, np.random.default_rng(8), SKIN, clouded[0].scene.grains.radius
    for shift in (0.0, 2e-3):
        moved = position + shift * rng.normal(size=position.shape)
        run.place(moved)
        run.advance(1)
        for w in range(len(radius)):
            pairs, walls = listed(run.grains.lists.pairs, w), listed(run.grains.lists.contacts, w)
            assert np.all(pairs[:, 0] < pairs[:, 1])
            for name, rows, expected in (
                ("pairs", pairs, brute_pairs(moved[w], radius[w], skin)),
                ("walls", walls, brute_walls(moved[w], radius[w], ASTRAY[0] * skin)),
            ):
                assert expected, (name, w)
                assert len(rows) == len(expected), (name, w)
                assert set(map(tuple, rows.tolist())) == expected, (name, w)
            check_stiffness(run, w, pairs, walls)


def check_stiffness(run: Simulation, w: int, pairs: np.ndarray, walls: np.ndarray) -> None:
    """k = (4/3) E* √R_eff of all that is listed."""
    curvature = 1.0 / run.scene.grains.radius[w]
    for contacts, between, bend in (
        (run.grains.lists.pairs, run.scene.grains.interfaces[0], curvature[pairs].sum(axis=1)),
        (run.grains.lists.contacts, run.scene.grains.interfaces[1], curvature[walls[:, 0]]),
    ):
        found = contacts.stiffness.to_numpy()[w].reshape(-1)[: len(bend)]
        np.testing.assert_allclose(found, 4.0 / 3.0 * between.young_modulus / np.sqrt(bend), rtol=1e-12)


def shaken(skin: float | None, room: int = 1) -> Simulation:
    """Soft unequal grains with Mindlin friction, which remembers: in world 0 a loose stack that falls into a heap under
    a strong sway, in world 1 a gas of fast grains."""
    rng = np.random.default_rng(5)
    sites = np.stack(np.meshgrid(np.arange(5) - 2.0, np.arange(8) + 0.4), axis=-1).reshape(-1, 2)[:COUNT]
    stack = RADIUS * (2.5 * sites + rng.uniform(-0.2, 0.2, sites.shape))
    gas = RADIUS * (2.4 * sites + rng.uniform(-0.1, 0.1, sites.shape))
    velocity = np.stack([np.zeros((COUNT, 2)), rng.normal(0.0, 1.0, (COUNT, 2))])
    soft = material(young=3.2e6)
    scene = scene_of(
        RADIUS * rng.uniform(0.7, 1.0, (2, COUNT)),
        box(WIDTH, 0.2),
        soft,
        soft,
        tangential="mindlin",
        motions=[(Sway(amplitude=0.01, frequency=8.0),), (Sway(amplitude=0.002, frequency=3.0),)],
        start_speed=4.0,
    )
    run = Simulation(scene, np.stack([stack, gas]), threads=1, skin=skin)
    if room > 1:
        run.arrays.release()
        run.room = room
        run._build()
        run.grains.grains.put(np.stack([stack, gas]))
    run.launch(velocity)
    return run


def test_grains_that_go_together_keep_their_lists_for_long(clouded):
    """All of a world fly one way: lists are good for ASTRAY skins, candidates until walls are met that were far off.

    Walls up to BESIDE LISTS skins away are among these, and lists ask for all up to 2 ASTRAY skins.
    """
    (run, position), skin = clouded, SKIN
    run.place(position)
    run.advance(1)
    validity, sought, went = run.grains.lists.validity, {}, np.zeros(2)
    for flight in range(1, 101):
        went += np.array([0.06, 0.08]) * skin
        for a, field in enumerate(run.grains.grains.place):
            whole = field.to_numpy()
            whole[0, : position.shape[1]] = position[0, :, a] + went[a]
            field.from_numpy(whole)
        travel = validity.displacement.to_numpy()
        travel[0] += 0.1 * skin
        validity.displacement.from_numpy(travel)
        run.advance(1)
        if validity.displacement.to_numpy()[0] < 0.01 * skin:
            sought[flight] = bool(run.grains.lists.candidates.renewed.to_numpy()[0])
    lasted = np.diff([0, *sought])
    assert len(lasted) > 3 and np.all(lasted >= 0.85 * ASTRAY[0] / 0.1) and np.all(lasted <= ASTRAY[0] / 0.1 + 1)
    first = next(flight for flight, anew in sought.items() if anew)
    before = max(flight for flight in sought if flight < first)
    assert 0.1 * before < BESIDE * LISTS - 2.0 * ASTRAY[0] < 0.1 * first


def test_lists_equal_brute_force_while_grains_fly(clouded):
    """New lists after each of many flights of a third of the skin; cells are searched for a few of them.

    Each world by itself: in the second nobody moves and its first candidates stay.
    """
    (run, position), skin, radius = clouded, SKIN, clouded[0].scene.grains.radius
    run.place(position)
    position, rng = position.copy(), np.random.default_rng(9)
    flight, sought = rng.normal(size=position[0].shape), []
    flight *= 0.33 * skin / np.linalg.norm(flight, axis=1).max()
    for _ in range(24):
        position[0] += flight
        for a, field in enumerate(run.grains.grains.place):
            whole = field.to_numpy()
            whole[:, : position.shape[1]] = position[:, :, a]
            field.from_numpy(whole)
        run.grains.lists.validity.expire(range(2))
        run.advance(1)
        sought.append(run.grains.lists.candidates.renewed.to_numpy())
        for w in range(2):
            pairs, walls = listed(run.grains.lists.pairs, w), listed(run.grains.lists.contacts, w)
            assert set(map(tuple, pairs.tolist())) == brute_pairs(position[w], radius[w], skin)
            assert set(map(tuple, walls.tolist())) == brute_walls(position[w], radius[w], ASTRAY[0] * skin)
    run.close()  # those that follow find their kernels
    # Two may have neared each other by LISTS − 2 ASTRAY = 3 skins, and no two do by more than 0.66 skins a flight
    between = np.diff(np.flatnonzero(np.array(sought)[:, 0]))
    assert len(between) > 1 and np.all(between >= 4)
    assert np.flatnonzero(np.array(sought)[:, 1]).tolist() == [0]


@pytest.mark.slow
def test_candidates_that_fill_their_room_are_all_kept(monkeypatch):
    """Nothing that is looked at after the last pair is found is written over it."""
    places = RADIUS * np.array([[[2.1 * (k % 6) - 5.25, 1.05 + 2.1 * (k // 6)] for k in reversed(range(12))]])
    found = []
    for _ in range(2):
        run = simulation(places, RADIUS, box(0.05, 0.05), schedule="per-world")
        run.advance(1)
        seen = run.grains.lists.candidates
        first, mate = seen.first.to_numpy()[0], seen.mate.to_numpy()[0]
        found.append([set(mate[a:b].tolist()) for a, b in pairwise(first)])
        monkeypatch.setattr(candidates, "ROOM", (0, candidates.ROOM[1]))
        monkeypatch.setattr(candidates, "MORE", (int(first[-1]), candidates.MORE[1]))
        run.close()
    assert found[1] == found[0] and sum(map(len, found[0])) > 20


def brute_census(position: np.ndarray, radius: np.ndarray) -> int:
    """Touching grains and touched walls, the lid apart, which nobody reaches."""
    pairs = cKDTree(position).query_pairs(2.0 * radius.max(), output_type="ndarray")
    gap = np.linalg.norm(position[pairs[:, 0]] - position[pairs[:, 1]], axis=1) - radius[pairs].sum(axis=1)
    walls = np.stack([position[:, 1], WIDTH / 2 - position[:, 0], WIDTH / 2 + position[:, 0]])
    return int((gap < 0.0).sum() + (walls < radius).sum())


def watched(run: Simulation) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """A run every 0.5 ms: positions (T, 2, n, 2), contacts by the lists and by brute force, and skins, (T, 2)."""
    positions, counted, expected, skins = [], [], [], []
    for _ in range(LOOKS):
        run.advance(round(5e-4 / run.dt))
        position = run.snapshot()["position"]
        positions.append(position)
        counted.append(run.observe()["contacts"])
        expected.append([brute_census(position[w], run.scene.grains.radius[w]) for w in range(2)])
        skins.append(run.grains.lists.skin.width.to_numpy())
    return np.array(positions), np.array(counted), np.array(expected), np.array(skins)


@pytest.fixture(scope="module")
def usual():
    """The shaken grains with a wide skin and room for all: what is `watched`, and the end."""
    run = shaken(WIDE_SKIN, room=2)
    positions, counted, expected, _ = watched(run)
    assert run.room == 2
    end = run.snapshot() | run.observe()
    run.close()
    return positions, counted, expected, end


def test_no_contact_is_missed(usual):
    """Grains must travel less than the skin allows between two rebuilds, at whatever speed."""
    _, counted, expected, _ = usual
    assert np.all(expected.max(axis=0) > [30, 8])  # many enough to miss one
    np.testing.assert_array_equal(counted, expected)


@pytest.mark.slow
def test_the_skin_follows_the_speed_and_no_contact_is_missed(usual):
    """Lists of the gas have wide skins and seldom expire, those of the stack thin ones; both move as with any skin."""
    run = shaken(None, room=2)
    positions, counted, expected, skins = watched(run)
    run.close()
    diameter = 2.0 * run.scene.grains.mean_radius
    np.testing.assert_array_equal(counted, expected)
    assert np.all(skins[:15, 1] > 1.5 * skins[:15, 0])  # then the gas has lost its speed
    assert np.all((skins >= 0.05 * diameter) & (skins <= 0.25 * diameter))
    assert np.abs(positions[:60] - usual[0][:60]).max() < 1e-6 * RADIUS


@pytest.mark.slow
def test_history_survives_rebuilds(usual):
    """A skin so thin that the lists are made anew at nearly every step leads to the same motion."""
    looks = 60
    run = shaken(1e-6, room=2)
    apart = []
    for k in range(looks):
        run.advance(round(5e-4 / run.dt))
        apart.append(np.abs(run.snapshot()["position"] - usual[0][k]).max() / RADIUS)
    run.close()
    assert max(apart) < 1e-6


@pytest.mark.slow
def test_lists_grow_during_a_run_without_changing_it(usual):
    """The heap outgrows its list of pairs while grains already press and rub. The run that had the room from the start
    must agree to the last bit, in that world and in the one beside it, and no step may be lost or doubled."""
    run = shaken(WIDE_SKIN)
    run.advance(1)
    assert run.room == 1
    steps = LOOKS * round(5e-4 / run.dt)
    run.advance(steps // 3)
    run.advance(steps - 1 - steps // 3)
    assert run.room == 2
    assert run.steps == steps
    assert np.all(run.clock.step.to_numpy() == steps)
    assert np.any(run.grains.lists.pairs.length.to_numpy() > 4 * COUNT + 16)
    end = run.snapshot() | run.observe()
    run.close()
    for name in usual[3].keys() - {"wall_force"}:  # this is a mean over another time
        values = usual[3][name]
        np.testing.assert_array_equal(end[name], values, err_msg=name)
