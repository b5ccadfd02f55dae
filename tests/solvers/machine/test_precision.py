"""Precisions: errors of f32, mixed and f64 for overlaps of 1e-7 m far from the tank's origin; and other devices."""

from dataclasses import dataclass

import numpy as np
import pytest
import taichi as ti

from solvers.machine import runtime
from solvers.machine.errors import Unavailable
from solvers.motion import Sway
from solvers.scene import Scene
from solvers.simulation import Simulation
from solvers.tank.parts import Part
from tests.oracles.given import scene_of
from tests.oracles.scenes import material
from tests.oracles.water import still
from tests.solvers.grains.test_collisions import rebound

G, R, DENSITY = 9.81, 1.5e-3, 1319.0
MASS = DENSITY * 4.0 / 3.0 * np.pi * R**3
AWAY = 0.3  # m, of the column and the collisions from the origin
TANK = np.array([[-0.01, AWAY], [AWAY + 0.01, AWAY], [AWAY + 0.01, AWAY + 0.04], [-0.01, AWAY + 0.04]])
LIFT = Part(((0.05, AWAY + 0.005), (0.08, AWAY + 0.005)), move=(0.0, 0.02), speed=1.0, acceleration=1e300)
TIME, LOOKS = 0.018, 18  # s; the lift is under way all the time
SOFT, FULL = range(2)  # worlds: a thousandth of the stiffness of cellulose acetate, and all of it
YOUNG = (3.2e6, 3.2e9)
COLUMN, SPEEDS, SLOW = 5, (0.01, 0.3, 1.0), 4e-3
CARRIED, CRAWLER = COLUMN + 2 * len(SPEEDS), COLUMN + 2 * len(SPEEDS) + 1
PRECISIONS = ("f64", "mixed", "f32")


@dataclass
class Told:
    """Results of the scene in one precision: Δt (s), displacements of the lift (T,) m, states (T, 2, …)."""

    dt: float
    lifted: np.ndarray
    position: np.ndarray
    velocity: np.ndarray


def scene(precision: str) -> Scene:
    """Two worlds that differ in stiffness."""
    grain = [material(young=young) for young in YOUNG]
    count = CRAWLER + 2
    return scene_of(np.full((2, count), R), TANK, grain, grain, start_speed=1.0, parts=(LIFT,), precision=precision)


def stiffness(world: int) -> tuple[float, float]:
    """k (N/m^1.5) of two grains, and of a grain and a wall."""
    young = YOUNG[world] / (2.0 * (1.0 - 0.28**2))
    return 4.0 / 3.0 * young * np.sqrt(0.5 * R), 4.0 / 3.0 * young * np.sqrt(R)


def resting(world: int) -> np.ndarray:
    """Overlaps (m) in the column: of the lowest grain with the floor, then of each with the next."""
    pair, wall = stiffness(world)
    load = MASS * G * np.arange(COLUMN, 0, -1)
    return (load / np.array([wall, *[pair] * (COLUMN - 1)])) ** (2 / 3)


def start() -> tuple[np.ndarray, np.ndarray]:
    """Places (2, n, 2) and velocities of a column that rests, pairs that meet, a grain on the lift, and a crawler.

    The crawler goes to meet another near y = 0, where 32 bits resolve its steps.
    """
    place, velocity = [], []
    for world in (SOFT, FULL):
        overlap = resting(world)
        heights = AWAY + R - overlap[0] + np.cumsum([0.0, *(2.0 * R - overlap[1:])])
        places, speeds = [[AWAY, z] for z in heights], [[0.0, 0.0]] * COLUMN
        for k, speed in enumerate(SPEEDS):
            z, gap = AWAY + 0.034 - 0.006 * k, 2e-6
            places += [[AWAY - 0.02 - 2.0 * R - gap, z], [AWAY - 0.02, z]]
            speeds += [[speed, 0.0], [0.0, 0.0]]
        places += [[0.065, LIFT.points[0][1] + R - (MASS * G / stiffness(world)[1]) ** (2 / 3)]]
        places += [[0.002 - 2.0 * R - 1.5e-5, AWAY + 0.03], [0.002, AWAY + 0.03]]
        speeds += [[0.0, LIFT.speed], [SLOW, 0.0], [0.0, 0.0]]
        place.append(places)
        velocity.append(speeds)
    return np.array(place), np.array(velocity)


@pytest.fixture(scope="module")
def told() -> dict[str, Told]:
    """The scene in every precision."""
    found = {}
    for precision in PRECISIONS:
        place, velocity = start()
        run = Simulation(scene(precision), place, 1, skin=1e-5, arch="cpu")
        run.launch(velocity)
        looks = []
        for _ in range(LOOKS):
            run.advance(round(TIME / LOOKS / run.dt))
            run.observe()
            looks.append((run.placed()["part"][0, 0, 1], *(run.snapshot()[name] for name in ("position", "velocity"))))
        run.close()
        columns = (np.array(column, dtype=float) for column in zip(*looks, strict=True))
        found[precision] = Told(run.dt, *columns)
    return found


def restitution_errors(told: Told, world: int) -> np.ndarray:
    """Relative error of the restitution at each speed, compared with an integration of the law."""
    pair = scene("f64").grains.interfaces_of[world][0]
    found = []
    for k, speed in enumerate(SPEEDS):
        damping = 1.5 * pair.dissipative_time * (stiffness(world)[0] / (0.5 * MASS)) ** 0.4
        away = np.diff(told.velocity[-1, world, COLUMN + 2 * k : COLUMN + 2 * k + 2, 0])[0]
        found.append(away / speed / rebound(0.5, damping * speed**0.2)[0] - 1.0)
    return np.abs(found)


def column_errors(told: Told, world: int) -> np.ndarray:
    """Largest relative errors over time of the column's overlaps."""
    z = told.position[:, world, :COLUMN, 1]
    found = np.column_stack([AWAY + R - z[:, 0], 2.0 * R - np.diff(z, axis=1)])
    return np.abs(found / resting(world) - 1.0).max(axis=0)


@pytest.mark.slow
def test_restitution(told):
    """Mixed is as good as f64 at any speed and stiffness; f32 is for fast grains."""
    for world in (SOFT, FULL):
        errors = {name: restitution_errors(told[name], world) for name in PRECISIONS}
        assert errors["f64"].max() < 1e-3
        assert np.abs(errors["mixed"] - errors["f64"]).max() < 1e-5
        assert errors["f32"][-1] < 5e-3
        assert errors["f32"][-2] < 0.1


@pytest.mark.slow
def test_grains_stand_still_in_32_bits_where_a_step_is_less_than_a_digit(told):
    """Places at 0.3 m come in steps of 3e-8 m, so that 1 cm/s at a step of 1 µs is lost: why there is mixed."""
    digit = float(np.spacing(np.float32(AWAY - 0.02)))
    assert SPEEDS[0] * told["f32"].dt < 0.5 * digit
    first = start()[0][FULL, COLUMN, 0]
    assert abs(told["f32"].position[-1, FULL, COLUMN, 0] - first) < digit
    assert told["mixed"].position[-1, FULL, COLUMN + 1, 0] - first > 0.1 * SPEEDS[0] * TIME


@pytest.mark.slow
def test_a_column_rests_on_its_overlaps(told):
    """Overlaps of 2e-6 to 5e-6 m, and of 2e-8 to 5e-8 m at full stiffness."""
    for world, (f64, mixed, f32) in ((SOFT, (1e-9, 1e-4, 0.05)), (FULL, (1e-7, 5e-3, 3.0))):
        errors = {name: column_errors(told[name], world).max() for name in PRECISIONS}
        assert errors["f64"] < f64
        assert errors["mixed"] < mixed
        assert errors["f32"] < f32
        assert 30.0 * errors["mixed"] < errors["f32"]


@pytest.mark.slow
def test_a_moving_plate_carries_a_grain_on_its_overlap(told):
    """The position of a moving plate is exact to rounding, so its force is smooth.

    The launch leaves half a step of weight in the velocity, which rings off before the second look.
    """
    for world, allowed in ((SOFT, 0.01), (FULL, 0.03)):
        overlap = (MASS * G / stiffness(world)[1]) ** (2 / 3)
        for name, limit in (("f64", 2e-3), ("mixed", allowed)):
            lifted = LIFT.speed * told[name].dt * np.round(TIME / LOOKS / told[name].dt) * np.arange(1, LOOKS + 1)
            found = LIFT.points[0][1] + R + lifted - told[name].position[:, world, CARRIED, 1]
            assert np.abs(found[1:] / overlap - 1.0).max() < limit, (name, world)


@pytest.mark.slow
def test_slow_grains_meet_in_all_precisions(told):
    """Below 5 mm/s the speeds' 16th powers vanish in 32 bits; the neighbour lists must still find the contacts."""
    usual = told["f64"].velocity[-1, :, CRAWLER:, 0]
    assert np.all(usual[:, 0] < 0.2 * SLOW)
    for name in ("mixed", "f32"):
        assert told[name].velocity[-1, :, CRAWLER:, 0] == pytest.approx(usual, abs=0.01 * SLOW), name


def shaken(arch: str) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Positions and observed rows of a small swayed bed in 32 bits on a device."""
    rng = np.random.default_rng(2)
    column, row = (axis.ravel() for axis in np.meshgrid(np.arange(5), np.arange(6), indexing="ij"))
    place = R * (2.02 * np.stack([column - 2.0, row + 0.5], axis=1) + rng.uniform(-0.01, 0.01, (30, 2)))
    outline = R * np.array([[-6.0, 0.0], [6.0, 0.0], [6.0, 20.0], [-6.0, 20.0]])
    soft = material(young=8e5)
    bed = scene_of(
        R * rng.uniform(0.9, 1.0, (1, 30)),
        outline,
        soft,
        soft,
        tangential="mindlin",
        motions=[(Sway(0.005, 5.0),)],
        fixed=np.array([[0.0, -0.5 * R, R]]),
        precision="f32",
        schedule="per-grain",
        step=2e-5,
    )
    run = Simulation(bed, place[None], 1, arch=arch)
    run.advance(1500)
    found = run.snapshot()["position"][0].astype(float), run.observe()
    run.close()
    return found


@pytest.mark.slow
def test_a_software_vulkan_agrees_with_the_processor():
    runtime.initialise(1)
    if not ti._lib.core.with_vulkan():
        pytest.skip("there is no Vulkan driver here")
    (place, rows), (expected, usual) = shaken("vulkan"), shaken("cpu")
    assert usual["contacts"][0] > 8
    assert np.abs(place - expected).max() < 1e-3 * R
    assert np.abs(expected - place.mean(axis=0)).max() > R
    for name in ("centre_of_mass", "kinetic", "potential"):
        assert rows[name] == pytest.approx(usual[name], rel=2e-2), name
    assert rows["wall_force"][:, 1] == pytest.approx(usual["wall_force"][:, 1], rel=2e-2)


@pytest.mark.parametrize(("arch", "precision"), [("cuda", "f64"), ("vulkan", "f64"), ("vulkan", "mixed")])
def test_missing_devices_are_reported_in_one_sentence(monkeypatch, arch, precision):
    monkeypatch.setattr(runtime, "has_cuda", lambda: False)
    with pytest.raises(Unavailable, match=rf"^run\.arch: [^.]*{'CUDA' if arch == 'cuda' else '32 bits'}.*\.$") as error:
        Simulation(scene(precision), start()[0], 1, arch=arch)
    assert "\n" not in str(error.value)


def test_water_has_no_vulkan(monkeypatch):
    """A real device is passed over by auto; asked for, it is refused before anything is compiled."""
    monkeypatch.setattr(runtime, "has_cuda", lambda: False)
    monkeypatch.setattr(runtime, "has_vulkan", lambda: True)
    many = runtime.WORTH_OF_GRAINS * runtime.cores_of_machine()
    assert runtime.choose_arch("auto", "f32", water=True, particles=many) == "cpu"
    assert runtime.choose_arch("auto", "f32", particles=many) == "vulkan"
    with pytest.raises(Unavailable, match=r"^run\.arch: Taichi cannot compile water for vulkan; use cuda or cpu\.$"):
        Simulation(still(0.2, 0.2, 0.1, 5, precision="f32"), threads=1, arch="vulkan")


def test_a_device_is_taken_for_many_particles_only(monkeypatch):
    """Or if it is asked for: a small run waits for it longer than for the processor."""
    monkeypatch.setattr(runtime, "has_cuda", lambda: True)
    monkeypatch.setattr(runtime, "cores_of_machine", lambda: 4)
    monkeypatch.setattr(runtime, "_most_cores", 2**31)
    for water, least in ((False, runtime.WORTH_OF_GRAINS), (True, runtime.WORTH_OF_WATER)):
        few = 4 * least - 1
        chosen = [runtime.choose_arch("auto", "mixed", water, count) for count in (0, few, few + 1)]
        assert chosen == ["cpu", "cpu", "cuda"]
    runtime.use_cores(1)  # as in one of several processes
    assert runtime.choose_arch("auto", "mixed", particles=few) == "cpu"
    assert runtime.choose_arch("cuda", "mixed") == "cuda"
