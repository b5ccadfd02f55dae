"""The schedules do the same physics: the same motion to rounding, with lists, laws and watch at work in each."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pytest

from solvers.machine.errors import BadState, Unavailable
from solvers.motion import Roll, Sway, Tilt
from solvers.simulation import Simulation
from solvers.tank.parts import Part
from solvers.time.schedules import choose_schedule
from solvers.time.settling import AT_REST
from solvers.time.watch import RUNNING
from tests.oracles.given import scene_of
from tests.oracles.scenes import material
from tests.solvers.grains.test_neighbours import segment_distance

RADIUS = 3e-3
COUNT, WORLDS, THREADS = 36, 2, 2
TANK = np.array([[-0.035, 0.0], [0.01, 0.0], [0.01, 0.012], [0.035, 0.012], [0.035, 0.12], [-0.035, 0.12]])
REFLEX, LID = 2, 4
FIXED = np.array([[-0.02, 0.0, 2.5e-3], [-0.008, 0.001, 3e-3], [0.03, 0.02, 2e-3]])
PADDLE = Part(((-0.03, 0.016), (-0.03, 0.05)), move=(0.025, 0.0), start=0.005, speed=0.4, acceleration=20.0)
STEP = 2e-5
EARLY, LATE = 3000, 12_000  # steps: 0.06 s, the stack has fallen into a heap; 0.24 s
SKIN = 1.5e-3

# Schedules with the units they cut a world into, and the tank that each is tried in: open and with the one law, or
# closed and with the other.
UNITS = {"per-world": 1, "two bands": 2, "three bands": 3, "per-grain": COUNT}
TANKS = {"open": ("mindlin", (LID,)), "closed": ("haff-werner", ())}
TRIED = {"per-world": "open", "two bands": "open", "three bands": "closed", "per-grain": "open"}
COSTLY = pytest.mark.slow  # of schedules that another one stands for in the quick tests
SCHEDULES = [pytest.param(name, marks=() if name == "per-world" else COSTLY) for name in TRIED]


def start() -> tuple[np.ndarray, np.ndarray]:
    """Radii (W, n) and positions (W, n, 2) of a loose stack above the ledge, beside the paddle."""
    rng = np.random.default_rng(11)
    column, row = (axis.ravel() for axis in np.meshgrid(np.arange(6), np.arange(6), indexing="ij"))
    sites = RADIUS * np.stack([2.12 * column - 3.3, 2.12 * row + 6.5], axis=1)
    places = sites + RADIUS * rng.uniform(-0.05, 0.05, (WORLDS, COUNT, 2))
    return RADIUS * rng.uniform(0.75, 1.0, (WORLDS, COUNT)), places


def made(schedule: str, tank: str, threads: int = THREADS) -> Simulation:
    """A tilted, swayed and rolled tank with a ledge, three fixed grains and a paddle."""
    law, open_edges = TANKS[tank]
    radius, place = start()
    motions = [(Tilt(4.0, 0.3, ease=0.01), Sway(0.004, 6.0, phase=w), Roll(0.2, 4.0, 0.5, (0.1, -0.1))) for w in (0, 1)]
    scene = scene_of(
        radius,
        TANK,
        material(young=4e6, dissipative_time=2e-4),
        material(young=8e6, dissipative_time=1e-4, friction=0.4),
        tangential=law,
        motions=motions,
        fixed=FIXED,
        parts=(PADDLE,),
        open_edges=open_edges,
        step=STEP,
        schedule="per-band" if schedule.endswith("bands") else schedule,
        sizes=(0.75 * RADIUS, RADIUS),
    )
    return Simulation(scene, place, threads, SKIN, arch="cpu", units=UNITS[schedule])


@dataclass
class Told:
    """A simulation, and what came of its story early and late."""

    run: Simulation
    early: dict[str, np.ndarray]
    late: dict[str, np.ndarray]


@pytest.fixture(scope="module")
def told():
    """Stories by schedule and tank, each told once."""
    known: dict[tuple[str, str], Told] = {}

    def tell(schedule: str, tank: str) -> Told:
        if (schedule, tank) not in known:
            run = made(schedule, tank)
            if schedule.endswith("bands"):
                run.schedule.together = False  # spinning on shared cores takes its time
            looks = []
            for steps in (EARLY, LATE - EARLY):
                run.advance(steps)
                looks.append(run.observe() | run.snapshot())
            known[schedule, tank] = Told(run, *looks)
        return known[schedule, tank]

    yield tell
    for found in known.values():
        found.run.close()


@pytest.fixture(scope="module", params=SCHEDULES)
def used(request, told: Callable[[str, str], Told]) -> Simulation:
    """A simulation in each schedule."""
    return told(request.param, TRIED[request.param]).run


@pytest.fixture
def run(used) -> Simulation:
    """The same, its clock at zero, of which a test may change what is set here."""
    used.dt = STEP
    used.carrier.gravity.fill(used.scene.gravity)
    used.start_clock()
    used.place(start()[1])
    return used


@pytest.mark.parametrize("schedule", SCHEDULES[1:])
def test_all_schedules_give_the_same_motion(told, schedule):
    """To rounding while it is young, and as a whole later on: what differs grows tenfold in some hundredths of a
    second."""
    usual, found = (told(name, TRIED[schedule]) for name in ("per-world", schedule))
    moved = np.linalg.norm(usual.early["position"] - start()[1], axis=2)
    assert moved.min() > RADIUS
    assert usual.early["contacts"].sum() > 30
    assert np.abs(usual.early["angle"]).max() > 0.5
    for name, scale in (("position", 1.0), ("velocity", 1e3), ("angle", 1e3), ("spin", 1e6)):
        assert np.abs(found.early[name] - usual.early[name]).max() < 1e-12 * scale, name
    for name in set(usual.early) - {"position", "velocity", "angle", "spin"}:
        np.testing.assert_allclose(found.early[name], usual.early[name], rtol=1e-7, atol=1e-9, err_msg=name)
    for name, near in (("centre_of_mass", 0.2 * RADIUS), ("potential", 1e-5)):
        np.testing.assert_allclose(found.late[name], usual.late[name], rtol=0.0, atol=near, err_msg=name)


def travelled(t: float) -> np.ndarray:
    """Displacement (m) of the paddle while it speeds up or runs at its top speed, by kinematics."""
    ramp = PADDLE.speed / PADDLE.acceleration
    passed = max(0.0, t - PADDLE.start)
    way = 0.5 * PADDLE.acceleration * min(passed, ramp) ** 2 + PADDLE.speed * max(0.0, passed - ramp)
    return np.array([way, 0.0])


def brute(run: Simulation, place: np.ndarray, radius: np.ndarray, t: float) -> tuple[set, set]:
    """Pairs (i, j) of one world as its units should list them, and (grain, feature) at walls, nearer than is listed."""
    skin, size, wide = run.skin, run.grains.lists.units.size, run.grains.lists.skin.beside_walls
    others, sizes = np.concatenate([place, FIXED[:, :2]]), np.concatenate([radius, FIXED[:, 2]])
    away = np.linalg.norm(place[:, None] - others, axis=2)
    first, second = np.nonzero(away < radius[:, None] + sizes + skin)
    inside = (first // size == second // size) & (second < COUNT)
    wanted = (first != second) & (~inside | (first < second))
    pairs = set(zip(first[wanted].tolist(), second[wanted].tolist(), strict=True))

    paddle = np.array(PADDLE.points) + travelled(t)
    segments = [*zip(TANK, np.roll(TANK, -1, axis=0), strict=True), paddle]
    corners = TANK if run.scene.open_edges else TANK[[REFLEX]]
    distance = [segment_distance(place, a, b) for a, b in segments]
    distance = [gap for k, gap in enumerate(distance) if k not in run.scene.open_edges]
    distance += [np.linalg.norm(place - corner, axis=1) for corner in (*corners, *paddle)]
    grain, feature = np.nonzero(np.stack(distance, axis=1) < (radius + wide * skin)[:, None])
    return pairs, set(zip(grain.tolist(), feature.tolist(), strict=True))


def listed(contacts, w: int) -> list[tuple[int, int]]:
    """The (grain, mate) rows of all units of one world."""
    rows = []
    grain, mate, length = (field.to_numpy() for field in (contacts.grain, contacts.mate, contacts.length))
    for u in range(w * contacts.units.a_world, (w + 1) * contacts.units.a_world):
        pairs = grain[u].reshape(-1)[: length[u]], mate[u].reshape(-1)[: length[u]]
        assert np.all(np.diff(pairs[0]) >= 0)
        rows += zip(*((numbers - w * contacts.stride).tolist() for numbers in pairs), strict=True)
    return rows


def clouds(cell: float) -> list[np.ndarray]:
    """Awkward positions (W, n, 2): scattered, in clumps, on the cells' borders, partly outside the tank."""
    rng, lower, upper = np.random.default_rng(5), TANK.min(axis=0), TANK.max(axis=0)
    size = (WORLDS, COUNT, 2)
    clumps = np.repeat(rng.uniform(lower, upper, (WORLDS, COUNT // 4, 2)), 4, axis=1)
    sites = [rng.permutation(64)[:COUNT] for _ in range(WORLDS)]
    borders = lower + cell * np.stack([np.stack([n % 8, n // 8], axis=1) for n in sites])
    borders[:, ::2] += rng.uniform(0.0, 0.5 * cell, borders[:, ::2].shape)
    return [
        rng.uniform(lower, [upper[0], 0.05], size),
        clumps + rng.normal(0.0, RADIUS, size),
        borders,
        rng.uniform(lower - 3.0 * RADIUS, [upper[0] + 3.0 * RADIUS, 0.03], size),
    ]


def test_lists_equal_brute_force(run):
    """Taken with a step so short that nobody moves, when the paddle is under way."""
    run.dt, run.origin = 1e-15, 0.04
    counted = np.zeros(2, dtype=int)
    for cloud in clouds(float(run.grains.lists.cells.lengths.to_numpy()[2])):
        run.place(cloud)
        run.advance(1)
        assert run.room == 1
        for w in range(WORLDS):
            pairs, walls = brute(run, cloud[w], run.scene.grains.radius[w], run.origin)
            counted += np.array([len(pairs), len(walls)])
            for found, expected in ((run.grains.lists.pairs, pairs), (run.grains.lists.contacts, walls)):
                rows = listed(found, w)
                assert len(rows) == len(set(rows))
                assert set(rows) == expected
    assert np.all(counted > 50)


@pytest.mark.slow
def test_per_grain_lists_follow_the_tanks_acceleration():
    """A grain that hangs in a tank in free space as that sets off with 20 g: it meets one at the wall just beyond the
    lists' skin. The schedule of single grains looks at speeds now and then, and there are none to begin with.
    """
    push, radius = 200.0, 1.5e-3
    sway = Sway(push / (20.0 * np.pi) ** 2, 10.0, phase=0.5 * np.pi)
    half, grain = 0.02, material()
    outline = np.array([[-half, 0.0], [half, 0.0], [half, 0.03], [-half, 0.03]])
    scene = scene_of(
        np.full((1, 2), radius), outline, grain, grain, gravity=0.0, motions=[(sway,)], schedule="per-grain"
    )
    run = Simulation(scene, np.zeros((1, 2, 2)), THREADS, arch="cpu")
    gap = 1.1 * run.grains.slack()
    run.place(np.array([[[half - radius, 0.01], [half - 3.0 * radius - gap, 0.01]]]))
    run.advance(round(1.5 * np.sqrt(2.0 * gap / push) / run.dt))
    speed = np.abs(run.snapshot()["velocity"]).max()
    run.close()
    assert 0.1 * np.sqrt(2.0 * push * gap) < speed < np.sqrt(2.0 * push * gap)


def momenta(run: Simulation) -> np.ndarray:
    """Linear (N s) and angular (N m s) momentum of each world, (W, 3)."""
    state, mass = run.snapshot(), run.grains.mass
    r, v, spin = state["position"], state["velocity"], state["spin"]
    angular = mass * (r[..., 0] * v[..., 1] - r[..., 1] * v[..., 0]) + 0.4 * mass * run.scene.grains.radius**2 * spin
    return np.concatenate([(mass[..., None] * v).sum(axis=1), angular.sum(axis=1)[:, None]], axis=1)


def test_momentum_is_conserved_without_walls(run):
    """A cloud that collapses in free space; the tank stands still before its motion begins."""
    run.carrier.gravity.fill(0.0)
    run.origin = AT_REST
    middle = np.array([0.0, 0.07])
    place = start()[1] - start()[1].mean(axis=1, keepdims=True) + middle
    velocity = -15.0 * (place - middle) + np.random.default_rng(2).normal(0.0, 0.1, place.shape)
    run.place(place, velocity, np.full(place.shape[:2], 20.0))
    before, energy = momenta(run), run.observe()["kinetic"]
    run.advance(1500)
    rows = run.observe()
    assert np.all(rows["kinetic"] < 0.5 * energy)
    scale = (run.grains.mass[..., None] * np.abs(velocity)).sum(axis=(1, 2))
    # The angular one is read from velocities half a step ahead of the scheme's.
    assert np.all(np.abs(momenta(run) - before) < scale[:, None] * [1e-12, 1e-12, 1e-9])
    assert np.abs(rows["wall_force"][:, :2]).max() < 1e-12


@pytest.mark.slow
@pytest.mark.parametrize("schedule", ["two bands", "per-grain"])
def test_growing_lists_change_nothing(told, schedule):
    """A heap that rubs is asked to list far more than touches: its springs, contacts and steps stay.

    To the last bit where pairs are taken one by one; in a band a pair comes to stand in another lane of its block, and
    the compiler does not round alike in all lanes.
    """
    found, ends = told(schedule, TRIED[schedule]).run, []
    for skin in (SKIN, 20.0 * SKIN):
        found.start_clock()
        found.place(start()[1])
        found.advance(EARLY)
        assert found.room == 1
        usual = found.grains.lists.skin.bounds.to_numpy()
        wider = usual.copy()
        wider[-1] += skin - SKIN  # what all gaps are listed beyond the skin
        found.grains.lists.skin.bounds.from_numpy(wider)
        found.grains.lists.expire()
        found.advance(1)
        found.grains.lists.skin.bounds.from_numpy(usual)
        found.advance(100)
        ends.append(found.snapshot() | found.observe())
        assert np.all(found.clock.step.to_numpy() == EARLY + 101)
    assert found.room > 1
    assert ends[0]["contacts"].sum() > 30
    for name in ends[0]:
        if schedule == "per-grain":
            assert ends[0][name].tobytes() == ends[1][name].tobytes(), name
        else:
            np.testing.assert_allclose(ends[0][name], ends[1][name], rtol=1e-9, atol=1e-12, err_msg=name)


def test_worlds_at_rest_stop_until_the_others_rest(run):
    """A drift too slow to count goes on for the two looks that tell rest, stops, and goes on when the clock starts."""
    run.carrier.gravity.fill(0.0)
    rest, slow = 1e-4, 1e-3
    velocity = np.zeros((WORLDS, COUNT, 2))
    velocity[0, :, 1], velocity[1, ::2, 1] = slow, 0.05
    run.place(start()[1], velocity)
    looks = []
    assert not run.settle(rest, 0.05, tell=lambda _: looks.append(run.snapshot()["position"]))
    assert len(looks) == 5
    drift = [np.ptp(look[0] - start()[1][0], axis=0).max() for look in looks]
    assert max(drift) < 1e-12
    drift = [(look[0] - start()[1][0])[0, 1] for look in looks]
    assert drift == pytest.approx([0.01 * slow, *[0.02 * slow] * 4], rel=1e-9)
    assert np.linalg.norm(looks[-1][1] - looks[1][1], axis=1).max() > 0.02 * 0.05
    assert np.all(run.clock.status.to_numpy() == RUNNING)
    run.origin = AT_REST
    run.advance(500)
    assert run.snapshot()["position"][0, 0, 1] - start()[1][0, 0, 1] == pytest.approx(0.03 * slow, rel=1e-9)


@pytest.mark.parametrize("trouble", ["is not a number", "moves at"])
def test_the_watch_stops_a_bad_world(run, trouble):
    """A speed that is no number, and one that grows too large in a free fall of many steps."""
    place, velocity = start()[1], np.zeros((WORLDS, COUNT, 2))
    place[1, 7] = 0.025, 0.11
    velocity[1, 7, 1] = np.nan if trouble == "is not a number" else 0.02 - 0.1 * run.scene.grains.sizes[0] / STEP
    run.place(place, velocity)
    with pytest.raises(BadState, match=f"world 1: a grain.* {trouble}"):
        run.advance(300)
    found = run.snapshot()
    assert np.isfinite(found["position"][0]).all()
    assert np.isfinite(np.delete(found["position"][1], 7, axis=0)).all()
    assert np.linalg.norm(found["position"][0] - place[0], axis=1).max() < RADIUS


@pytest.mark.parametrize(
    ("wanted", "arch", "says"), [("per-grain", "cpu", "run.schedule"), ("auto", "cuda", "run.arch")]
)
def test_a_carrier_that_answers_needs_a_schedule_by_worlds_and_is_told_how_to_get_it(wanted, arch, says):
    with pytest.raises(Unavailable, match=f"ships and tanks on axles .* set {says} = "):
        choose_schedule(wanted, arch, 1, 100, 2, answering=True)
    assert choose_schedule("auto", "cpu", 1, 100, 2, answering=True) in ("per-world", "per-band")
