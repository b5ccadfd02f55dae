"""Open tanks: grains that leave are counted once, fall along the outside, and are removed without side effects."""

import numpy as np
import pytest

from solvers import simulation
from solvers.simulation import Simulation
from solvers.space import order as renumber
from tests.oracles.given import scene_of
from tests.oracles.scenes import box, material
from tests.solvers.grains.test_neighbours import segment_distance

G, R = 9.81, 2e-3
HALF, HIGH = 0.02, 0.03
TANK = box(2 * HALF, HIGH)
LID = 2
SOFT = material(young=5e6, friction=0.3)
SMOOTH = material(young=2e7, friction=0.0, dissipative_time=0.0)
FAR_IN = np.array([-HALF + R, R])  # a place in the tank where a grain disturbs nobody

# Worlds of three grains: where they are at the start, and their velocities.
WORLDS = {
    "over the rim": ([[HALF + 0.4 * R, HIGH + 0.95 * R], FAR_IN, [0.0, R]], None),
    "above the mouth": ([[0.0, HIGH + 6.0 * R], [HALF - R, HIGH + 3.0 * R], FAR_IN], None),
    "thrown back": ([[HALF + 5.0 * R, 0.02], FAR_IN, [0.0, R]], [[-0.25, 0.65], [0.0, 0.0], [0.0, 0.0]]),
    "against the outside": ([[HALF + 2.0 * R, 0.025], FAR_IN, [0.0, R]], [[-0.5, 0.0], [0.0, 0.0], [0.0, 0.0]]),
    "from below": ([[0.0, -2.5 * R], FAR_IN, [0.01, R]], [[0.0, 0.6], [0.0, 0.0], [0.0, 0.0]]),
    "two gone": (
        [[HALF + 4.0 * R, 0.01], [HALF + 5.9 * R, 0.01], [0.0, 8.0 * R]],
        [[0.0, 0.0], [0.0, 0.0], [0.2, 0.0]],
    ),
    "none gone": ([FAR_IN, np.add(FAR_IN, [0.0, 2.1 * R]), [0.0, 8.0 * R]], [[0.0, 0.0], [0.0, 0.0], [0.2, 0.0]]),
}
NAMES = list(WORLDS)
LOOKS, EVERY = 100, 2.5e-3  # s


@pytest.fixture(scope="module", params=["per-world", pytest.param("per-grain", marks=pytest.mark.slow)])
def watched(request):
    """The worlds over a quarter of a second: rows and snapshots (T, W, …), their times, and the mass of a grain."""
    place = np.array([places for places, _ in WORLDS.values()])
    velocity = np.array([np.zeros((3, 2)) if v is None else v for _, v in WORLDS.values()])
    scene = scene_of(
        np.full((len(WORLDS), 3), R),
        TANK,
        SOFT,
        SOFT,
        open_edges=(LID,),
        velocity=velocity,
        spin=np.zeros(place.shape[:2]),
        start_speed=1.0,
        schedule=request.param,
    )
    run = Simulation(scene, place, 1, arch="cpu")
    looks = [run.snapshot() | run.observe() | {"time": 0.0}]
    for _ in range(LOOKS):
        run.advance(round(EVERY / run.dt))
        looks.append(run.snapshot() | run.observe() | {"time": run.time})
    mass = run.grains.mass[0, 0]
    run.close()
    return {name: np.array([look[name] for look in looks]) for name in looks[0]}, mass


def inside(points: np.ndarray) -> np.ndarray:
    """Whether points (…, 2) are between the side walls and above the floor."""
    return (np.abs(points[..., 0]) < HALF) & (points[..., 1] > 0.0)


def test_a_grain_over_the_rim_falls_along_the_outer_side(watched):
    looks, _ = watched
    place = looks["position"][:, NAMES.index("over the rim"), 0]
    place = place[np.isfinite(place[:, 0])]
    below = place[:, 1] < HIGH
    assert below.any()
    assert place[below, 0].min() > HALF
    assert place[place[:, 1] < HIGH - R, 0].min() > HALF + 0.95 * R
    rim = np.linalg.norm(place - [HALF, HIGH], axis=1)
    assert rim.min() > 0.95 * R
    assert place[:, 1].min() < 0.0


def test_walls_push_from_outside(watched):
    looks, _ = watched
    for name, axis, limit in (("against the outside", 0, HALF + R), ("from below", 1, -R)):
        place = looks["position"][:, NAMES.index(name), 0, axis]
        velocity = looks["velocity"][:, NAMES.index(name), 0, axis]
        place, velocity = place[np.isfinite(place)], velocity[np.isfinite(place)]
        out = np.sign(limit)
        assert (out * place).min() > out * limit - 0.1 * R
        assert (out * velocity).max() > 0.2, "it is to rebound"


def test_spilled_grains_are_counted_once(watched):
    """Grains outside at the start count at once, one thrown back in stays counted, those above the mouth do not."""
    looks, _ = watched
    spilled = dict(zip(NAMES, looks["spilled"].T, strict=True))
    for name, (places, _) in WORLDS.items():
        outside = ~inside(np.array(places)) & ~(np.abs(np.array(places))[:, 0] < HALF)
        outside |= np.array(places)[:, 1] < 0.0
        assert spilled[name][0] == outside.sum(), name
        assert np.all(np.diff(spilled[name]) >= 0), name
    back = looks["position"][:, NAMES.index("thrown back"), 0]
    assert inside(back).any()
    assert inside(back[-1])
    ends = {name: counts[-1] for name, counts in spilled.items()}
    assert ends == {
        "over the rim": 1,
        "above the mouth": 0,
        "thrown back": 1,
        "against the outside": 1,
        "from below": 1,
        "two gone": 2,
        "none gone": 0,
    }


def test_distant_grains_are_removed_for_good(watched):
    looks, _ = watched
    gone = np.isnan(looks["position"]).any(axis=-1)
    assert gone[-1].sum(axis=1).tolist() == [1, 0, 0, 1, 1, 2, 0]
    assert np.all(np.diff(gone.astype(int), axis=0) >= 0)
    # Half the tank's size beyond it, and not before.
    lower, upper = TANK.min(axis=0), TANK.max(axis=0)
    margin = 0.5 * (upper - lower)
    place = looks["position"][~gone]
    assert np.all((place > lower - margin - 5e-3) & (place < upper + margin + 5e-3))
    for w, i in np.argwhere(gone[-1]):
        last = np.flatnonzero(~gone[:, w, i]).max()
        later = looks["position"][last, w, i] + looks["velocity"][last, w, i] * EVERY
        assert np.any((later < lower - margin) | (later > upper + margin))


def test_removed_grains_do_not_affect_those_inside(watched):
    """The same bouncing grain, with two others that leave and with two that stay."""
    looks, _ = watched
    one, other = (looks["position"][:, NAMES.index(name), 2] for name in ("two gone", "none gone"))
    # As long as it has not met those that stay.
    alone = np.linalg.norm(looks["position"][:, NAMES.index("none gone"), :2] - other[:, None], axis=2).min(axis=1)
    free = np.cumsum(alone < 2.05 * R) == 0
    assert free[-1]
    assert one == pytest.approx(other, abs=1e-12)
    assert np.isfinite(looks["velocity"]).all()


def test_centre_and_energy_count_grains_inside_only(watched):
    looks, mass = watched
    place, velocity, spin = looks["position"], looks["velocity"], looks["spin"]
    never_out = np.cumsum(~(np.abs(place[..., 0]) < HALF) | ~(place[..., 1] > 0.0), axis=0) == 0
    expected = {
        "centre_of_mass": np.where(never_out[..., None], place, 0.0).sum(axis=2) / never_out.sum(axis=2)[..., None],
        "kinetic": 0.5 * mass * np.where(never_out, (velocity**2).sum(axis=-1), 0.0).sum(axis=2),
        "rotational": 0.2 * mass * R**2 * np.where(never_out, spin**2, 0.0).sum(axis=2),
        "potential": mass * G * np.where(never_out, place[..., 1], 0.0).sum(axis=2),
        "spilled": 3.0 - never_out.sum(axis=2),
    }
    for name, values in expected.items():
        np.testing.assert_allclose(looks[name], values, rtol=1e-9, atol=1e-15, err_msg=name)
    assert np.all(looks["escaped"] == -1)


# An L, open on the top of its tall part (edge 4) and on the step's (edge 2).
STEP = np.array([[-0.03, 0.0], [0.03, 0.0], [0.03, 0.02], [0.0, 0.02], [0.0, 0.04], [-0.03, 0.04]])
OPEN = (2, 4)
RIM, CORNER = STEP[2], STEP[4]  # of the step, and of the tall part towards it
DEEP = 0.02 * R
SIDE = np.array([0.6, 0.8])
PUSHED = {
    "the rim as a point": (RIM + (R - DEEP) * SIDE, SIDE),
    "the rim from within": (RIM + (R - DEEP) * SIDE * [-1, 1], SIDE * [-1, 1]),
    "the top of the rim": (np.add(RIM, [0.0, R - DEEP]), [0.0, 1.0]),
    "the side from outside": (np.add(RIM, [R - DEEP, -0.01]), [1.0, 0.0]),
    "the side from within": (np.add(RIM, [DEEP - R, -0.01]), [-1.0, 0.0]),
    "the tall wall from the step": (np.add(CORNER, [R - DEEP, -0.01]), [1.0, 0.0]),
    "the tall rim": (CORNER + (R - DEEP) * SIDE, SIDE),
    "a floor from below": ([0.0, DEEP - R], [0.0, -1.0]),
    "a bottom corner from outside": (STEP[1] + (R - DEEP) * np.array([0.8, -0.6]), [0.8, -0.6]),
    "no wall where it is open": ([0.015, 0.02], [0.0, 0.0]),
    "the lower end of the tall wall": (STEP[3] - (R - DEEP) * SIDE, -SIDE),
}


@pytest.fixture(scope="module")
def stepped():
    """A world for each push with a smooth elastic grain at rest, then falls over both open edges.

    Returns the acceleration of the first step (W, 2), contacts (W,), and rows later, with the worlds' first places.
    """
    falls = np.array([[0.015, 0.03], [0.005, 0.05], [-0.015, 0.05], [0.033, 0.03], [-0.033, 0.03], [0.015, 0.035]])
    place = np.concatenate([np.array([at for at, _ in PUSHED.values()]), falls])
    velocity = np.zeros_like(place)
    velocity[-1, 0] = 0.6  # leaps over the rim of the step
    velocity[-5, 0] = -0.1  # meets the tall rim from the step's side, or goes into the tall part
    scene = scene_of(np.full((len(place), 1), R), STEP, SMOOTH, SMOOTH, open_edges=OPEN, start_speed=1.0)
    run = Simulation(scene, place[:, None], 1, arch="cpu")
    run.launch(velocity[:, None])
    run.advance(1)
    felt, contacts = (run.snapshot()["velocity"][:, 0] - velocity) / run.dt, run.observe()
    looks = []
    for _ in range(60):
        run.advance(round(2e-3 / run.dt))
        looks.append(run.observe() | run.snapshot())
    mass = run.grains.mass[0, 0]
    run.close()
    return felt, contacts, looks, mass


@pytest.mark.slow
def test_walls_of_an_open_tank_push_along_the_distance(stepped):
    """A rim pushes as a point, a wall square to itself from either side, with the force of Hertz; nothing pushes twice.

    (The first step gives half a kick and a velocity predicted by another half: the whole acceleration.)
    """
    felt, rows, _, mass = stepped
    young = SMOOTH.young / (2.0 * (1.0 - SMOOTH.poisson**2))
    push = 4.0 / 3.0 * young * np.sqrt(R) * DEEP**1.5 / mass
    for k, (name, (_, way)) in enumerate(PUSHED.items()):
        np.testing.assert_allclose(felt[k] + [0.0, G], push * np.array(way), atol=1e-6 * push, err_msg=name)
        assert rows["contacts"][k] == np.any(way), name


@pytest.mark.slow
def test_an_l_with_two_open_edges_keeps_and_spills(stepped):
    """Into the step, from its air into the tall part or back, into the tall part: kept; beside either: spilled."""
    _, _, looks, _ = stepped
    first = len(PUSHED)
    spilled = np.array([look["spilled"] for look in looks])[:, first:]
    assert spilled[-1].tolist() == [0, 0, 0, 1, 1, 1]
    assert spilled[0].tolist() == [0, 0, 0, 1, 1, 0]
    place = np.array([look["position"] for look in looks])[:, first:, 0]
    walls = [(STEP[k], STEP[(k + 1) % len(STEP)]) for k in range(len(STEP)) if k not in OPEN]
    known = place[np.isfinite(place[..., 0])]
    assert np.min([segment_distance(known, a, b) for a, b in walls]) > 0.9 * R


# A bin with an outlet: a closed and an open half of the floor, and no lid.
BIN = np.array([[-HALF, 0.0], [0.0, 0.0], [HALF, 0.0], [HALF, HIGH], [-HALF, HIGH]])


@pytest.mark.slow
def test_grains_that_jump_above_the_mouth_stay_and_those_through_the_outlet_leave(monkeypatch):
    """A grain that leaps higher than others are followed comes back; one that falls through the floor is spilled there.

    Then all are placed anew, with numbers the solver has changed meanwhile.
    """
    monkeypatch.setattr(renumber, "FEWEST", 2)
    monkeypatch.setattr(renumber, "MIXED", -1.0)
    monkeypatch.setattr(simulation, "LOOK_FOR_MIXING", 0.05)
    radius = np.array([[R, 0.8 * R, 0.9 * R]])
    place = np.array([[[0.5 * HALF, 0.01], [-0.5 * HALF, 0.01], [-0.9 * HALF, 0.8 * R]]])
    velocity = np.array([[[0.0, 0.0], [0.0, 0.95], [0.0, 0.0]]])
    scene = scene_of(radius, BIN, SOFT, SOFT, open_edges=(1, 3), start_speed=1.0)
    run = Simulation(scene, place, 1, arch="cpu")
    run.launch(velocity)
    looks = []
    for _ in range(22):
        run.advance(round(0.01 / run.dt))
        looks.append(run.observe() | run.snapshot())
    height = np.array([look["position"][0, 1, 1] for look in looks])
    assert height.max() > 1.6 * HIGH
    assert 0.0 < height[-1] < HIGH
    out = np.array([look["position"][0, 0, 1] for look in looks])
    assert np.isnan(out[-1])
    np.testing.assert_array_equal([look["spilled"][0] for look in looks], ~(out > 0.0))
    mass = run.grains.mass[0]
    for look in looks:
        here = [1, 2] if look["spilled"][0] else [0, 1, 2]
        centre = (mass[here] * look["position"][0, here, 1]).sum() / mass[here].sum()
        assert look["centre_of_mass"][0, 1] == pytest.approx(centre, rel=1e-9)

    assert not np.array_equal(run.grains.numbering.number[0], [0, 1, 2])
    anew = np.array([[[0.0, 0.012], [0.008, 0.012], [-0.008, 0.012]]])
    speeds = np.array([[[0.1, 0.0], [0.2, 0.0], [0.3, 0.0]]])
    run.place(anew, speeds)
    rows, state = run.observe(), run.snapshot()
    np.testing.assert_array_equal(state["position"], anew)
    np.testing.assert_array_equal(state["velocity"], speeds)
    assert rows["spilled"][0] == 0.0
    assert rows["kinetic"][0] == pytest.approx(0.5 * (mass * speeds[0, :, 0] ** 2).sum(), rel=1e-12)
    run.close()
