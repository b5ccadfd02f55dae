"""Ships and their cargo in one time loop: against the ship alone, frozen cargo, and conservation laws."""

from dataclasses import replace
from math import inf, pi

import numpy as np
import pytest

from solvers.machine.errors import Unavailable
from solvers.machine.units import APART
from solvers.ship.body import Body, bolted
from solvers.ship.hydrostatics import turned
from solvers.ship.loads import Floating
from solvers.ship.motion import Radiation, Rig, RollDamping, Ship, sail, start
from solvers.ship.potential.memory import Memory
from solvers.ship.section import box
from solvers.ship.vessel import Vessel
from solvers.ship.water import Water
from solvers.ship.waves import jonswap, random_sea, regular, soft_start
from solvers.simulation import Simulation
from tests.oracles.given import scene_of
from tests.oracles.losses import CountedLaws
from tests.oracles.scenes import box as tank
from tests.oracles.scenes import material
from tests.oracles.voyages import cargo_energy, earth, hull_energy

WATER, G = Water(), 9.81
BARGE = box(0.34, 0.30)
AXIS, HOLD = (0.0, 0.11), (0.0, 0.02)  # m above the keel
RADIUS, ACROSS, DEEP = 0.015, 10, 3
SITES = RADIUS * np.array(
    [(2 * k - ACROSS + 1 + row % 2, 1.0 + np.sqrt(3.0) * row) for row in range(DEEP) for k in range(ACROSS - row % 2)]
)  # in a triangular lattice from wall to wall, which does not shift at small angles
COUNT = len(SITES)
SHEET = 2.0 * RADIUS
NO_CARGO = 1e15  # m, length of a ship on whose every metre the cargo counts for nothing
GRAIN = material(young=5e7, friction=0.6, restitution=0.3)
ELASTIC = material(young=5e7, friction=0.0, dissipative_time=0.0)
LOOSE = material(young=5e7, friction=0.2, restitution=0.5)
CARGO = COUNT * 4.0 / 3.0 * pi * RADIUS**3 * GRAIN.density / SHEET  # kg/m
ADDED = Radiation(np.diag([40.0, 52.0, 0.2]), np.diag([20.0, 100.0, 0.05]))
NONE = Radiation(np.zeros((3, 3)), np.zeros((3, 3)))
ALONE, TINY, LIVELY, VACUUM, OVER, RESONANT, ROLLING, LOSSY, HATCH = range(9)
LASTS, CLOSE = 4.0, 1.6  # s, of the voyage and of those that it is compared with
LOOKS = 10  # a second
HEEL, RELEASE = 0.006, 0.5  # rad, s
ROUNDING = 1e-10  # of sums over many steps
EDGES = ((0.15, 0.17), (-0.15, 0.17))  # m, of a hatch


def memory() -> Memory:
    """An arbitrary memory with two states per mode that couples sway and roll."""
    block = np.array([[-3.0, 4.0], [-4.0, -3.0]])
    matrix, entry = np.kron(np.eye(3), block), np.kron(np.eye(3), [[2.0], [0.0]])
    leave = np.array([[60.0, 20.0, 0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 90.0, 30.0, 0.0, 0.0], [1.0, 0, 0, 0, 0.4, 0.1]])
    return Memory(matrix, entry, leave, np.full(3, 2), np.zeros((3, 3)), 0.0)


def floating(amplitude: float, frequency: float, water: Water = WATER) -> Floating:
    waves = regular(amplitude, frequency, water, soft_start=1.0)
    excess = np.array([[-30.0j, -400.0 + 100.0j, 2.0 + 1.0j]]) * (water.density > 0.0)
    return Floating(BARGE, water, AXIS, waves, excess)


def fleet() -> list[Vessel]:
    """One ship per world."""
    hull = Body(0.5 * CARGO, (0.004, 0.10), 0.35)
    rig = Rig(np.full(3, 0.5), np.array([3.0, 0.0, 0.1]), np.array([30.0, 0.0, 0.0]))
    tiny = Ship(replace(hull, centre=(0.0, 0.10)), floating(0.0, 4.0), ADDED, AXIS)
    rolling = replace(
        tiny, body=Body(0.8 * CARGO, (0.0, 0.3), 0.3), radiation=Radiation(ADDED.added_mass, 0.1 * ADDED.damping)
    )
    laden = Body(37.0, (0.0, 0.092), 0.65)
    lively = Ship(hull, floating(0.03, 5.0), ADDED, AXIS, RollDamping(0.1, 0.1), rig)
    return [
        Vessel(
            Ship(
                Body(37.0, (0.01, 0.09), 0.6),
                floating(0.02, 4.4),
                Radiation(ADDED.added_mass, 0.1 * ADDED.damping, memory()),
                AXIS,
                RollDamping(0.2, 0.3),
                rig,
            ),
            HOLD,
            NO_CARGO,
        ),
        Vessel(tiny, HOLD, heel=HEEL, release=RELEASE),
        Vessel(lively, HOLD),
        Vessel(Ship(hull, floating(0.0, 4.0, Water(density=0.0)), NONE, AXIS), HOLD, height=0.0),
        Vessel(
            Ship(laden, floating(0.03, 5.5), Radiation(ADDED.added_mass, 0.0 * ADDED.damping), AXIS),
            HOLD,
            laden=True,
            limits=(-0.3, 0.3),
        ),
        Vessel(
            Ship(Body(37.0, (0.0, 0.09), 0.6), floating(0.03, 5.4), NONE, AXIS, free=(False, False, True)),
            HOLD,
            NO_CARGO,
            limits=(-0.5, 0.5),
        ),
        Vessel(rolling, HOLD, heel=2.0, release=RELEASE),
        Vessel(lively, HOLD),
        Vessel(
            Ship(Body(37.0, (0.0, 0.09), 0.6), floating(0.03, 5.4), NONE, AXIS, free=(False, False, True)),
            HOLD,
            NO_CARGO,
            heel=0.1,
            release=RELEASE,
            openings=EDGES,
        ),
    ]


class Run:
    """A simulation of the fleet, its beds settled, that can start again and again."""

    def __init__(self):
        vessels = fleet()
        grains = {LIVELY: ELASTIC, VACUUM: ELASTIC, LOSSY: LOOSE}
        materials = [grains.get(w, GRAIN) for w in range(len(vessels))]
        radius = np.full((len(vessels), COUNT), RADIUS)
        radius[LOSSY] *= np.random.default_rng(3).uniform(0.75, 0.95, COUNT)  # room to flow
        scene = scene_of(
            radius,
            tank(2.0 * ACROSS * RADIUS * 0.9999, 0.25),
            materials,
            materials,
            tangential="mindlin",
            vessels=vessels,
            thickness=SHEET,
            length=1.0,
            step=2.5e-5,
        )
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr("solvers.grains.making.ChosenLaws", CountedLaws)
            self.simulation = Simulation(scene, np.tile(np.add(SITES, [0.0, 0.1 * RADIUS]), (len(vessels), 1, 1)), 1)
        self.simulation.settle(1e-7, 0.8)
        self.height = self.simulation.snapshot()["position"][TINY, :, 1].mean()
        self.settled = self.simulation.state()
        self.every = int(self.simulation.carrier.every[0])
        self.cargo = self.simulation.cargo()

    def sail(self, every: int, lasts: float, looks: int, nudged: bool = False):
        """Times, rows of observations, and what is asked of the frame and the grains, at even looks.

        Grains that are nudged begin one last digit beside their places, some to this side and some to that.
        """
        run = self.simulation
        run.restore(self.settled)
        if nudged:
            place = run.grains.grains.place[0].to_numpy()
            side = np.random.default_rng(4).choice([-np.inf, np.inf], place.shape)
            run.grains.grains.place[0].from_numpy(np.nextafter(place, side))
        velocity = np.zeros((*run.scene.grains.radius.shape, 2))
        velocity[VACUUM] = np.random.default_rng(2).normal(0.0, 0.5, velocity.shape[1:])
        run.launch(velocity)
        run.carrier.every.fill(every)
        steps = every * max(1, round(lasts / (run.dt * every * looks)))
        found = [self.look()]
        for _ in range(looks):
            run.advance(steps)
            found.append(self.look())
        return {name: np.array([look[name] for look in found]) for name in found[0]}

    def look(self):
        run = self.simulation
        snapshot, rows = run.snapshot(), run.observe()
        frame = {
            name: getattr(run.carrier, name).to_numpy()
            for name in ("state", "given", "capsized", "flooded", "pose", "body")
        }
        frame |= {name: getattr(run.carrier.tank_frame, name).to_numpy() for name in ("tank", "felt")}
        frame |= {"pose": frame["pose"][:, :3], "tank": frame["tank"][:, :9], "given": frame["given"][:, 0]}
        motion = frame["tank"]
        energy = cargo_energy(run, snapshot, rows, motion)
        speed, _ = earth(snapshot, motion)
        momentum = (run.grains.mass[..., None] * speed).sum(axis=1)
        lost = run.grains.contacts.laws.lost.to_numpy()[::APART]
        return {
            "time": run.time,
            "place": snapshot["position"],
            "roll": motion[:, 2],
            "cargo": energy,
            "momentum": momentum,
            "lost": lost,
        } | frame

    def hull(self, voyage, world: int) -> Ship:
        """A ship with her hull's body alone."""
        mass, y, z, inertia = voyage["body"][0, world]
        ship = self.simulation.scene.vessels[world].ship
        return replace(ship, body=Body(mass, (y + AXIS[0], z + AXIS[1]), inertia))


@pytest.fixture(scope="module")
def run():
    made = Run()
    yield made
    made.simulation.close()


@pytest.fixture(scope="module")
def voyage(run):
    return run.sail(run.every, LASTS, round(LOOKS * LASTS))


@pytest.fixture(scope="module")
def finer(run):
    return run.sail(run.every // 2, CLOSE, round(LOOKS * CLOSE))


@pytest.fixture(scope="module")
def twin(run):
    return run.sail(run.every, CLOSE, round(LOOKS * CLOSE), nudged=True)


@pytest.mark.slow
def test_a_ship_without_cargo_moves_as_the_ship_alone(run, voyage):
    """Waves, memory, springs, viscous damping: the method of Runge and Kutta to rounding."""
    vessel = run.simulation.scene.vessels[ALONE]
    interval = run.every * run.simulation.dt
    state = start(vessel.ship, vessel.heave(Body(0.0, (0.0, 0.0), 0.0), 0.0))
    early = voyage["time"] < 3.0
    alone = sail(vessel.ship, state, interval, voyage["time"][early][-1])
    at = np.round(voyage["time"][early] / interval).astype(int)
    assert np.abs(alone.roll).max() > 0.1
    assert voyage["pose"][early, ALONE][1:] == pytest.approx(alone.state[at[1:], :3], abs=1e-10)


@pytest.mark.slow
def test_cargo_that_does_not_move_is_part_of_the_rigid_body(run, voyage):
    """Twice as heavy as the hull, at a roll of a third of a degree: as one rigid body, within the bed's compliance."""
    vessel = run.simulation.scene.vessels[TINY]
    cargo = run.cargo[TINY]
    aboard = Body(cargo.mass, tuple(np.add(cargo.centre, HOLD)), cargo.inertia)
    assert aboard.mass == pytest.approx(2.0 * vessel.ship.body.mass)
    ship = replace(vessel.ship, body=bolted(vessel.ship.body, aboard))
    frozen = sail(ship, start(ship, vessel.heave(aboard, HEEL), HEEL), 0.005, LASTS - RELEASE)
    later = voyage["time"] > RELEASE + 0.01
    wanted = np.interp(voyage["time"][later] - RELEASE, frozen.time, frozen.roll)
    assert np.ptp(wanted) > 1.5 * HEEL
    assert voyage["roll"][later, TINY] == pytest.approx(wanted, abs=0.003 * np.ptp(wanted))


@pytest.mark.slow
@pytest.mark.slow  # the method itself is to rounding, above
@pytest.mark.parametrize(("world", "until"), [(ALONE, CLOSE), (TINY, CLOSE), (LOSSY, 1.55)])
def test_half_the_interval_gives_the_same_motion(voyage, finer, twin, world, until):
    """To 1e-5 of the roll: without cargo, with cargo that lies and with cargo that has shifted.

    Only while cargo that is nudged by a last digit takes the same way to far less than that, as on another processor.
    """
    largest = np.abs(voyage["roll"][:, world]).max()
    for other, closeness in ((finer, 1e-5), (twin, 1e-8)):
        early = other["time"] < until
        rough = np.interp(other["time"][early], voyage["time"], np.arange(len(voyage["time"])))
        assert np.abs(rough - np.round(rough)).max() < 1e-6
        known = voyage["roll"][np.round(rough).astype(int), world]
        assert other["roll"][early, world] == pytest.approx(known, abs=closeness * largest)
    moved = voyage["place"][voyage["time"] < until, world] - voyage["place"][0, world]
    assert world != LOSSY or np.abs(moved).max() > RADIUS


@pytest.mark.slow
def test_momentum_of_ship_and_cargo_without_water(run, voyage):
    """With weight alone m (v_G + g t) is constant, whatever the impacts of the grains on the hull."""
    ship = run.hull(voyage, VACUUM)
    motion = voyage["tank"][:, VACUUM]
    arm = np.array([ship.lever(roll) for roll in motion[:, 2]])
    hold = np.subtract(HOLD, AXIS)
    c, s = np.cos(motion[:, 2]), np.sin(motion[:, 2])
    arm -= np.stack([c * hold[0] - s * hold[1], s * hold[0] + c * hold[1]], axis=1)
    centre = motion[:, 3:5] + motion[:, 5:6] * np.stack([-arm[:, 1], arm[:, 0]], axis=1)
    total = ship.body.mass * SHEET * centre + voyage["momentum"][:, VACUUM]
    mass = (ship.body.mass + CARGO) * SHEET
    total[:, 1] += mass * G * voyage["time"]
    assert np.ptp(motion[:, 2]) > 0.05
    assert total == pytest.approx(np.tile(total[0], (len(total), 1)), abs=1e-4 * mass)


@pytest.mark.slow
@pytest.mark.parametrize("world", [LIVELY, LOSSY])
def test_energy(run, voyage, world):
    """Light hull, waves, elastic and smooth or lossy and rough grains: no joule of the waves' work is unaccounted for.

    It is what hull and cargo gain, what goes into waves and viscosity, and what the contacts lose by their own count.
    """
    ship = run.hull(voyage, world)
    gained = hull_energy(ship, HOLD, voyage["tank"][:, world]) + voyage["cargo"][:, world] / SHEET
    waves, radiated, viscous = voyage["state"][:, world, -3:].T
    lost = counted(voyage, world)
    assert np.ptp(voyage["roll"][:, world]) > 0.1
    assert radiated[-1] > 0.1 * np.abs(waves).max()
    near = 1e-4 * np.abs(waves).max()
    assert np.abs(lost).max() < ROUNDING * near if world == LIVELY else lost[-1] > 100.0 * near
    assert gained - gained[0] == pytest.approx(waves - radiated - viscous - lost, abs=near)


def counted(voyage, world):
    """The energy lost in the contacts since the start (J/m)."""
    return (voyage["lost"][:, world] - voyage["lost"][0, world]) / SHEET


@pytest.mark.slow
@pytest.mark.parametrize("world", [LIVELY, LOSSY, ROLLING])
def test_losses_of_grains_are_counted(voyage, world):
    """Less of their own energy and the work they do on the hull is ever more heat, contact by contact; or nothing."""
    later = voyage["time"] > RELEASE + 0.05  # before it the hull is held, or turned by hand
    missing = -voyage["cargo"][later, world] / SHEET - voyage["given"][later, world]
    lost = counted(voyage, world)[later]
    assert missing - missing[0] == pytest.approx(lost - lost[0], abs=1e-3 * np.ptp(voyage["given"][:, world]))
    assert np.diff(lost).min() >= -ROUNDING * np.ptp(voyage["given"][:, world])
    if world == ROLLING:
        assert np.ptp(lost) > 0.2 * np.ptp(voyage["given"][:, world])


@pytest.mark.slow
def test_a_hull_lighter_than_her_cargo_rolls_over(run, voyage):
    """Top-heavy, let go at a heel of 115°: through 180° and back, all finite."""
    roll = voyage["roll"][:, ROLLING]
    assert np.isfinite(voyage["tank"][:, ROLLING]).all()
    turned_over = np.abs(roll).argmax()
    assert np.abs(roll[turned_over]) > pi > np.abs(roll[turned_over:]).min()
    assert voyage["capsized"][-1, ROLLING] < 0.0


@pytest.mark.slow
def test_a_capsize_ends_only_its_world(run, voyage):
    """Resonance without damping: the world ends at the step at which roll leaves its limits; the others continue."""
    for world, limit in ((RESONANT, 0.5), (OVER, 0.3)):
        when = voyage["capsized"][-1, world]
        assert 0.0 < when < LASTS
        after = voyage["time"] > when
        assert np.ptp(voyage["roll"][after, world]) == 0.0
        assert abs(voyage["roll"][-1, world]) == pytest.approx(limit, abs=0.01)
    assert voyage["capsized"][-1, LIVELY] == -1.0


@pytest.mark.slow
def test_a_ship_held_by_her_axis_is_heeled_about_it(voyage):
    """From upright to the heel and on as she rolls: the axis stays in the waterline, over y = 0."""
    tank = voyage["tank"][:, HATCH]
    arm = turned(tuple(np.subtract(HOLD, AXIS)), tank[:, 2])
    assert np.ptp(tank[:, 2]) > 0.2
    height = AXIS[1] - 37.0 / (1000.0 * 0.34)  # m, by her draught
    assert tank[:, :2] - arm == pytest.approx(np.tile([0.0, height], (len(tank), 1)), abs=1e-9)


@pytest.mark.slow
def test_flooding_through_a_hatch_ends_only_its_world(run, voyage):
    """At the interval at which the edge is under the waves' surface, as of the ship by herself; the rest sail on."""
    when, interval = voyage["flooded"][-1, HATCH], run.every * run.simulation.dt
    vessel = run.simulation.scene.vessels[HATCH]
    state = start(vessel.ship, vessel.heave(Body(0.0, (0.0, 0.0), 0.0), vessel.heel), vessel.heel)
    alone = sail(vessel.ship, state, interval, LASTS - RELEASE, begin=RELEASE, openings=EDGES)
    assert RELEASE < when < LASTS
    assert when == pytest.approx(alone.flooded, abs=2.0 * interval)
    still = voyage["time"] > when
    assert np.ptp(voyage["roll"][still, HATCH]) == 0.0
    roll = voyage["roll"][-1, HATCH]
    edges = turned(tuple(np.transpose(EDGES)), roll) - turned(AXIS, roll)  # from the axis
    k, height = 5.4**2 / G, AXIS[1] - 37.0 / (1000.0 * 0.34)
    rises = [0.03 * np.cos(k * y - 5.4 * when) - z - height for y, z in edges]
    assert max(rises) == pytest.approx(0.0, abs=1e-3)
    assert (voyage["flooded"][-1, :HATCH] == -1.0).all() and voyage["capsized"][-1, HATCH] == -1.0


@pytest.mark.slow
def test_a_ship_is_heeled_smoothly(run, voyage):
    """Until she is let go her tank's speed and acceleration are those of its path (eq. F.1); the grains feel them."""
    frame, held = run.simulation.carrier, slice(1, 5)
    upright, heeled = (field.to_numpy()[ROLLING] for field in (frame.upright, frame.heeled))
    hold = np.subtract(HOLD, AXIS)

    def path(time):
        pose = upright + soft_start(time, RELEASE)[:, None] * (heeled - upright)
        return pose + np.pad(turned(hold, pose[:, 2]), ((0, 0), (0, 1)))

    t, h = voyage["time"][held] - run.simulation.dt, 1e-4
    tank, felt = voyage["tank"][held, ROLLING], voyage["felt"][held, ROLLING]
    speed, gain = (path(t + h) - path(t - h)) / (2.0 * h), (path(t + h) - 2.0 * path(t) + path(t - h)) / h**2
    assert t[-1] < RELEASE and np.abs(gain).max() > 10.0
    assert tank[:, :3] == pytest.approx(path(t), abs=1e-9)
    assert tank[:, 3:6] == pytest.approx(speed, abs=1e-4)
    assert tank[:, 6:9] == pytest.approx(gain, abs=1e-3)
    pull = np.array([turned((-y, -G - z), -roll) for y, z, roll in zip(*gain[:, :2].T, path(t)[:, 2], strict=True)])
    assert felt[:, :4] == pytest.approx(np.column_stack([pull, speed[:, 2], gain[:, 2]]), abs=1e-3)


@pytest.mark.slow
def test_grains_settle_before_the_ship_is_released(run):
    """They have fallen by the tenth of a radius by which they were placed too high."""
    assert run.height == pytest.approx(SITES[:, 1].mean(), abs=0.02 * RADIUS)


@pytest.mark.slow
def test_a_laden_ship_has_the_given_mass_and_inertia(run, voyage):
    """Hull and cargo together have the mass and inertia given for both."""
    cargo = run.cargo[OVER]
    aboard = Body(cargo.mass, tuple(np.add(cargo.centre, HOLD)), cargo.inertia)
    vessel = run.simulation.scene.vessels[OVER]
    whole, wanted = bolted(vessel.hull(aboard), aboard), vessel.ship.body
    assert (whole.mass, whole.inertia) == (pytest.approx(wanted.mass), pytest.approx(wanted.inertia))
    assert whole.centre == pytest.approx(wanted.centre)
    with pytest.raises(Unavailable, match="heavier"):
        vessel.hull(replace(aboard, mass=40.0))
    with pytest.raises(Unavailable, match="inertia"):
        vessel.hull(replace(aboard, inertia=1.0))


def later(run, steps=1500):
    """The complete state of a simulation some steps later."""
    run.advance(steps)
    run.observe()
    return run.state()


@pytest.mark.slow
def test_a_state_continues_bit_for_bit(run):
    """From the middle of an interval, as after an interruption."""
    simulation = run.simulation
    simulation.restore(run.settled)
    simulation.advance(40_017)
    kept = simulation.state()
    first = later(simulation)
    simulation.restore(kept)
    second = later(simulation)
    assert first.keys() == second.keys()
    assert all(np.array_equal(first[name], second[name]) for name in first)
    assert not all(np.array_equal(first[name], kept[name]) for name in first)


@pytest.mark.slow
def test_growing_contact_arrays_changes_nothing(monkeypatch):
    """The arrays are enlarged during a run without any effect on the ship."""
    monkeypatch.setattr("solvers.grains.making.ChosenLaws", CountedLaws)  # as `Run` has them, for those that are larger
    found = []
    for grow in (False, True):
        run = Run().simulation
        run.advance(40_017)
        if grow:
            run._make_room()
        run.advance(1000)
        found.append((run.snapshot()["position"], run.carrier.pose.to_numpy(), run.carrier.given.to_numpy()))
        run.close()
    for one, other in zip(*found, strict=True):
        assert np.array_equal(one, other)


@pytest.mark.slow
@pytest.mark.parametrize("height", [0.0005, 0.05])
def test_half_an_hour_in_an_irregular_sea(height):
    """One soft grain for a cargo: roll stays finite and steady, in small waves as large as they are."""
    sea = random_sea(jonswap(height, 4.5), 4.5, WATER, 1, 20.0)
    load = Floating(BARGE, WATER, AXIS, sea, np.tile([[30.0j, 300.0, 4.0]], (len(sea.amplitude), 1)))
    rig = Rig(damping=np.array([5.0, 0.0, 0.0]), spring=np.array([30.0, 0.0, 0.0]))
    ship = Ship(Body(37.0, (0.0, 0.09), 0.6), load, Radiation(ADDED.added_mass, ADDED.damping, memory()), AXIS, rig=rig)
    vessel = Vessel(replace(ship, damping=RollDamping(0.2, 0.2)), HOLD)
    scene = scene_of([[RADIUS]], tank(0.3, 0.25), material(young=1e5), material(young=1e5), vessels=[vessel], step=1e-4)
    run = Simulation(scene, np.array([[[0.0, RADIUS]]]), 1)
    rolls = []
    for _ in range(36):
        run.advance(round(50.0 / run.dt))
        rolls.append(run.observe()["pose"][0, 2])
    run.close()
    assert np.isfinite(rolls).all() and np.ptp(rolls) > 0.1 * height
    assert np.abs(rolls).max() < 12.0 * height + 0.05


def test_ships_do_not_run_per_grain():
    place = np.zeros((1, 1, 2)) + RADIUS
    scene = scene_of([[RADIUS]], tank(0.3, 0.25), GRAIN, GRAIN, vessels=fleet()[:1], schedule="per-grain")
    with pytest.raises(Unavailable, match="per-world"):
        Simulation(scene, place, 1)


@pytest.mark.slow
@pytest.mark.parametrize("together", [True, False])
def test_bands_move_the_ship_as_one_unit_does(together):
    """Two bands in step, or one after the other, against the whole: to rounding, until grains make the most of it."""
    found = []
    for schedule in ("per-world", "per-band"):
        vessel = replace(fleet()[TINY], heel=0.1, release=0.1)
        scene = scene_of(
            np.full((1, COUNT), RADIUS),
            tank(2.0 * ACROSS * RADIUS * 0.9999, 0.25),
            GRAIN,
            GRAIN,
            tangential="mindlin",
            vessels=[vessel],
            step=2.5e-5,
            schedule=schedule,
        )
        run = Simulation(scene, SITES[None] + [0.0, 1e-4], 2, arch="cpu")
        if schedule == "per-band":
            assert run.units_a_world == 2
            run.schedule.together = together
        run.settle(1e-7, 0.1)
        run.advance(25_000)
        found.append((run.carrier.pose.to_numpy(), run.snapshot()["position"]))
        run.close()
    assert abs(found[0][0][0, 2]) > 0.01
    for one, other in zip(*found, strict=True):
        assert other == pytest.approx(one, abs=1e-9)


def test_intervals():
    """A millisecond, less where the memory is faster."""
    vessel = fleet()[ALONE]
    assert vessel.interval == 1e-3
    quick = replace(memory(), matrix=20.0 * memory().matrix)
    ship = replace(vessel.ship, radiation=Radiation(ADDED.added_mass, ADDED.damping, quick))
    assert replace(vessel, ship=ship).interval == pytest.approx(0.02 / 100.0)
    assert vessel.limits == (-inf, inf)


@pytest.mark.slow
def test_changed_waves_act_from_then_on(run):
    """Twice as high and shorter, after half a second: as by the method of Runge and Kutta, waves changed then."""
    simulation, every = run.simulation, run.every
    simulation.restore(run.settled)
    simulation.carrier.every.fill(every)
    before = list(simulation.scene.vessels)
    ship = before[ALONE].ship
    interval = every * simulation.dt
    steps = every * round(0.5 / interval)
    simulation.advance(steps)
    other = replace(ship, load=floating(0.04, 5.2))
    simulation.meet([replace(v, ship=other) if w == ALONE else v for w, v in enumerate(before)])
    simulation.advance(steps)
    roll = simulation.carrier.pose.to_numpy()[ALONE, 2]
    simulation.meet(before)
    half = steps * simulation.dt
    first = sail(ship, start(ship, before[ALONE].heave(Body(0.0, (0.0, 0.0), 0.0), 0.0)), interval, half)
    then = sail(other, first.state[-1], interval, half, begin=half)
    assert abs(then.roll[-1] - first.roll[-1]) > 1e-3
    assert roll == pytest.approx(then.roll[-1], abs=1e-9)
