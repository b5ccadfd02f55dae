"""The force of the cargo on the tank: weight, impulse and moment against closed forms and the momentum it changes."""

import numpy as np
import pytest
import taichi as ti

from solvers.motion import Sway, Tilt
from solvers.simulation import Simulation
from solvers.tank.parts import Part
from tests.oracles.given import scene_of
from tests.oracles.scenes import box, material

G, RADIUS, COUNT = 9.81, 1.5e-3, 12
FIXED = np.array([[-0.027, 0.0, 5e-3], [-0.04, 0.0, 2e-3]])  # a pocket beside the left wall
SHELF = Part(((-0.05, 0.012), (-0.044, 0.012)))
PADDLE = Part(((0.045, 0.0), (0.045, 0.02)), move=(-0.01, 0.0), speed=0.2, acceleration=20.0)
HEAP, BOUNCING, STIRRED = range(3)
HEIGHTS = np.linspace(5e-3, 14e-3, COUNT)  # m, of the bouncing grains above the floor


@pytest.fixture(scope="module")
def box_run():
    """A box with fixed grains, a shelf and a paddle that moves; its worlds are a heap, grains that bounce, a melee."""
    rng = np.random.default_rng(4)
    column, row = (axis.ravel() for axis in np.meshgrid(np.arange(4), np.arange(3), indexing="ij"))
    sites = RADIUS * np.stack([2.2 * column, 2.2 * row], axis=1)
    place = np.empty((3, COUNT, 2))
    place[HEAP] = [-0.048, 0.0135] + sites + RADIUS * rng.uniform(-0.05, 0.05, sites.shape)
    place[BOUNCING] = np.stack([-0.012 + 3.6e-3 * np.arange(COUNT), RADIUS + HEIGHTS], axis=1)
    place[STIRRED] = [0.02, 0.005] + 1.3 * sites
    velocity = np.zeros(place.shape)
    velocity[STIRRED] = rng.normal(0.0, 0.6, sites.shape)
    lossy, elastic = (
        material(young=2e7, friction=0.6, restitution=0.3),
        material(young=2e7, friction=0.0, dissipative_time=0.0),
    )
    kinds = [lossy, elastic, lossy]
    scene = scene_of(
        np.full((3, COUNT), RADIUS),
        box(0.1, 0.1),
        kinds,
        kinds,
        tangential="mindlin",
        fixed=FIXED,
        parts=(SHELF, PADDLE),
        start_speed=1.5,
        velocity=velocity,
        spin=np.zeros(place.shape[:2]),
    )
    run = Simulation(scene, place, 1, arch="cpu")
    run.start = place, velocity
    yield run
    run.close()


def momenta(run: Simulation) -> np.ndarray:
    """Linear (N s) and angular (N m s) momentum of each world about the tank's origin, (W, 3).

    Of the velocities that Verlet's kicks have changed: what they gain is the impulse, to rounding.
    """
    r, mass, g = run.snapshot()["position"], run.grains.mass, run.grains.grains
    y, z, spin = (field.to_numpy()[:, :COUNT] for field in (*g.velocity, *g.spin))
    v = np.stack([y, z], axis=2)
    angular = mass * (r[..., 0] * v[..., 1] - r[..., 1] * v[..., 0]) + 0.4 * mass * RADIUS**2 * spin
    return np.concatenate([(mass[..., None] * v).sum(axis=1), angular.sum(axis=1)[:, None]], axis=1)


def load(rows: dict[str, np.ndarray]) -> np.ndarray:
    """The load (W, 3) of one observation."""
    return rows["wall_force"]


@pytest.fixture(scope="module")
def looks(box_run):
    """For each observation: the time (s) since the last, the load, and the momentum change without weight, (W, 3)."""
    run, found = box_run, []
    run.advance(1)  # the first kick is half a step
    run.observe()
    mass, before = run.grains.mass, momenta(run)
    for milliseconds in (65, 1, 7, 20, 150, 600, 20):
        steps, weight = round(milliseconds * 1e-3 / run.dt), np.zeros((3, 3))
        for part in np.diff(np.linspace(0, steps, milliseconds + 1).astype(int)):
            arm = run.snapshot()["position"][..., 0]
            run.advance(int(part))
            arm = 0.5 * (arm + run.snapshot()["position"][..., 0])
            weight -= part * run.dt * G * np.stack([0 * mass, mass, mass * arm], axis=2).sum(axis=1)
        now = momenta(run)
        found.append((steps * run.dt, load(run.observe()), now - before - weight))
        before = now
    return found


def test_impulse_is_the_change_of_momentum(looks, box_run):
    """Newton: what the walls, fixed grains and parts give the grains, in every interval; of the moment, too."""
    mass = box_run.grains.mass[0].sum()
    for time, load, given in looks:
        wrong = np.abs(load * time + given)
        assert wrong[:, :2].max() < 1e-10 * mass
        # The weight's own moment is known to the mean of places at both ends of each millisecond.
        assert wrong[:, 2].max() < 1e-3 * mass * G * time * RADIUS
    assert max(np.abs(load[STIRRED, 0]) for _, load, _ in looks) > 5e-4


def test_an_elastic_bounce_transfers_twice_the_momentum(looks, box_run):
    """Elastic grains that fall h meet the floor at v = √(2 g h), each once in 65 ms, for a Hertz collision's time.

    The impulse is 2 m v and the weight's in that time, 2.87 (m²/(R E*² v))^(1/5) (Johnson 1985, eq. 11.24).
    """
    time, load, _ = looks[0]
    mass, speed = box_run.grains.mass[BOUNCING], np.sqrt(2.0 * G * HEIGHTS)
    young = box_run.scene.grains.interfaces_of[BOUNCING][1].young_modulus
    impulse = mass * (2.0 * speed + G * 2.87 * (mass**2 / (RADIUS * young**2 * speed)) ** 0.2)
    y = box_run.start[0][BOUNCING, :, 0]
    assert load[BOUNCING, 0] == pytest.approx(0.0, abs=1e-12)
    assert load[BOUNCING, 1:] * time == pytest.approx([-impulse.sum(), -(impulse * y).sum()], rel=2e-4)


def test_the_load_of_a_heap_at_rest_is_its_weight_at_its_centre(looks, box_run):
    """On floor, wall, shelf and fixed grains together; the moment is that of the weight at the centre of mass.

    (One or two that roll on slowly matter little.)
    """
    _, load, _ = looks[-1]
    rows = box_run.observe()
    weight = box_run.grains.mass[HEAP].sum() * G
    assert rows["centre_of_mass"][HEAP, 0] < -0.02
    assert load[HEAP] == pytest.approx([0.0, -weight, -weight * rows["centre_of_mass"][HEAP, 0]], abs=2e-4 * weight)
    place = box_run.snapshot()["position"][HEAP]
    near = np.linalg.norm(place[:, None] - FIXED[:, :2], axis=2) < RADIUS + FIXED[:, 2]
    assert near.any(), "some grains are to lie on the fixed ones"


def test_a_second_observation_at_the_same_time_is_equal(box_run):
    assert np.array_equal(load(box_run.observe()), load(box_run.observe()))


def test_a_launch_starts_a_new_average(looks, box_run):
    """The average includes neither the forces nor the time before the launch; the heap rests."""
    weight = box_run.grains.mass[HEAP].sum() * G
    box_run.advance(300)
    box_run.launch()
    box_run.advance(100)
    assert load(box_run.observe())[HEAP, 1] == pytest.approx(-weight, rel=1e-2)


@ti.data_oriented
class Pushing:
    """Computes the forces of the present instant once, without moving anything."""

    def __init__(self, run: Simulation):
        self.matter = run.grains

    @ti.kernel
    def push(self, t: ti.f64, dt: ti.f64):
        for u in range(self.matter.units.count):
            self.matter.push(u, t, dt, dt)


def test_the_load_is_minus_the_forces_on_the_grains_of_that_instant(looks, box_run):
    """Piece by piece, to 1e-12 of Σ|F|; the moment to 1e-12 of Σ|F| times the width.

    One grain touches a fixed one, one the shelf, one the paddle; the others touch walls and each other.
    """
    run, pressed, rng = box_run, RADIUS - 2e-6, np.random.default_rng(1)
    on_each = [(-0.027, 5e-3 + pressed), (-0.047, 0.012 + pressed), (0.035 - pressed, 0.01), (0.05 - pressed, 0.03)]
    row = [(2.0 * pressed * k, pressed) for k in range(COUNT - len(on_each))]
    place, spin = np.tile([*on_each, *row], (3, 1, 1)), rng.normal(0.0, 1.0, (3, COUNT))
    run.place(place, rng.normal(0.0, 5e-3, place.shape), spin)
    run.advance(2)
    run.observe()
    assert (np.abs(run.loads()).max(axis=2) > 0.0).all(), "walls, shelf, paddle and fixed grains are loaded"
    Pushing(run).push(run.time, run.dt)
    g, place = run.grains.grains, run.snapshot()["position"]
    y, z, torque = (field.to_numpy()[:, :COUNT] for field in (*g.force, *g.torque))
    moment = place[..., 0] * z - place[..., 1] * y + torque
    acting = np.stack([y, z, moment], axis=2)
    on_pieces = np.stack([acting[:, 3:].sum(axis=1), acting[:, 1], acting[:, 2], acting[:, 0]], axis=1)
    scale = np.hypot(y, z).sum(axis=1)[:, None, None] * [1.0, 1.0, 0.1]
    found = np.stack([field.to_numpy() for field in run.grains.load.impulse], axis=-1) / run.dt
    assert np.all(np.abs(found[:, :4] + on_pieces) <= 1e-12 * scale)
    assert not found[:, 4:].any()


TILT, SWAY = 0.1, Sway(3e-3, 3.0)
ROWS, COLUMNS = 3, 4


@pytest.fixture(scope="module")
def block():
    """Square-packed grains that fill the width of a box: world 0 is tilted and held, world 1 swayed."""
    column, row = (axis.ravel() for axis in np.meshgrid(np.arange(COLUMNS), np.arange(ROWS), indexing="ij"))
    sites = RADIUS * np.stack([2.0 * column - COLUMNS + 1.0, 2.0 * row + 1.0], axis=1)
    rough = material(young=2e8, friction=0.8, restitution=0.3)
    motions = [
        (Tilt(5.0, TILT, ease=0.005), Sway(1e-15, SWAY.frequency)),
        (Tilt(5.0, 1e-12, ease=0.005), SWAY),
    ]
    scene = scene_of(
        np.full((2, len(sites)), RADIUS),
        box(2.0 * COLUMNS * RADIUS * 0.9999, 0.05),
        rough,
        rough,
        tangential="mindlin",
        motions=motions,
        soft_start=0.05,
    )
    run = Simulation(scene, np.tile(sites, (2, 1, 1)), 1, arch="cpu")
    yield run
    run.close()


@pytest.mark.slow
def test_worlds_at_rest_keep_their_load(block):
    """World 0 is at rest from the start; world 1 is thrown up and falls down again."""
    weight = block.grains.mass[0].sum() * G
    velocity = np.zeros((*block.scene.grains.radius.shape, 2))
    velocity[1, :, 1] = 0.3
    block.launch(velocity)
    assert block.settle(1e-7, 1.0)
    assert load(block.observe())[:, 1] == pytest.approx([-weight] * 2, rel=1e-2)


@pytest.mark.slow
def test_a_block_loads_a_moving_tank_as_a_rigid_body(block):
    """−m a in a sway, the weight's components in a tilted tank (the tank's own axes)."""
    mass = block.grains.mass[0].sum()
    block.start_clock()
    block.advance(round(0.3 / block.dt))
    block.observe()
    tilted, swayed, expected = [], [], []
    step, omega = round(0.01 / block.dt), 2.0 * np.pi * SWAY.frequency
    for _ in range(12):
        before = block.time
        block.advance(step)
        found = load(block.observe())
        tilted.append(found[0, :2] / (mass * G))
        swayed.append(found[1, 0])
        speed = SWAY.amplitude * omega * np.cos(omega * np.array([before, block.time]))
        expected.append(-mass * np.diff(speed)[0] / (block.time - before))
    assert np.array(tilted) == pytest.approx(np.tile([-np.sin(TILT), -np.cos(TILT)], (12, 1)), abs=1e-3)
    assert swayed == pytest.approx(expected, abs=0.02 * np.max(np.abs(expected)))
    assert np.ptp(expected) > 1.5 * mass * SWAY.amplitude * omega**2
