"""A step of water in a tank at rest: against double sums in plain numpy, and what it must conserve."""

from dataclasses import replace

import numpy as np
import pytest
import taichi as ti

from solvers.fluid.checks import residual
from solvers.fluid.given import Gauge, Level
from solvers.fluid.surface.void_indicator import PACKING, RAMP
from solvers.machine.errors import BadState
from solvers.machine.state import without_worlds
from solvers.motion.harmonic import Sway
from solvers.scene import Scene
from solvers.simulation import Simulation
from tests.oracles.water import GRAVITY, PlainWater, again, still

WIDTH, HEIGHT, DEPTH, ROWS = 0.6, 0.6, 0.3, 15
GAUGES = Gauge((-0.3, 0.06), 0.02), Gauge((0.1, 0.0), 0.02), Gauge((0.3, 0.5), 0.02)
# The same in all, and in a run of a preset (`tests/lab/runs/test_water_runs.py`): one kernel.
TOLD = {"gauges": GAUGES, "levels": (Level(0.0), Level(-0.3)), "edges": (0, 1, 2, 3), "motions": [[Sway(0.0, 1.0)]]}
UNTOLD = {name: () for name in TOLD}  # of which the course of the water does not depend, and kernels compile faster


def disturbed(seed: int = 1, **changes):
    """A still tank whose particles were displaced and set in motion at random."""
    scene = still(WIDTH, HEIGHT, DEPTH, ROWS, **TOLD | changes)
    random, drops = np.random.default_rng(seed), scene.fluid.particles
    drops["position"] += 0.1 * scene.fluid.water.spacing * random.uniform(-1.0, 1.0, drops["position"].shape)
    drops["velocity"] = 0.2 * random.uniform(-1.0, 1.0, drops["position"].shape)
    return scene


def held(run: Simulation) -> list[np.ndarray]:
    """Places, velocities, s, masses, accelerations and slopes of the first world's particles, by their numbers."""
    p = run.water.particles
    y, z, v, w, s, m, *rest = p.read(*p.place, *p.velocity, p.deviation, p.mass, *p.acceleration, *p.gradient)
    pairs = [np.stack(pair, axis=-1)[0] for pair in ((y, z), (v, w), rest[0:2], rest[2:4])]
    return [*pairs[:2], s[0], m[0], *pairs[2:]]


NEIGHBOURS = 50  # π (2 h)²/Δx² with h = 2 Δx
# By how much a sum over neighbours of 32-bit numbers x is off at random, of Σ|x|: √n u (Higham & Mary 2019)
ROUNDING = NEIGHBOURS**0.5 * 2.0**-24
# Σ|x| of the accelerations by single neighbours, of g: 2 p/ρ ∫ |∇W| = 14 p/(3 ρ h) of Wendland's C2, at half the depth
CANCELLED = 7.0 / 3.0 * ROWS / 2.0


def to_digits(run: Simulation, double: float, single: float) -> float:
    """The tolerance for numbers of 64 bits, or that for those of 32."""
    return single if run.water.particles.real == ti.f32 else double


def upset(run: Simulation, number: int, fields, values) -> None:
    """Give a particle of a running simulation other values of some fields."""
    p = run.water.particles
    block, lane = np.argwhere(p.number.to_numpy()[: p.fluid_blocks] == number)[0]
    for field, value in zip(fields, values, strict=True):
        field[block, lane] = value


@pytest.fixture(scope="module")
def run() -> Simulation:
    return Simulation(disturbed(), threads=1, arch="cpu")


@pytest.fixture(scope="module")
def course(run) -> np.ndarray:
    """The places that others must find. The shared simulation ends here, so that those after it find their kernels."""
    again(run, disturbed(3)).advance(60)
    place = run.snapshot()["water_position"][0]
    run.close()
    return place


def check_a_step(run: Simulation) -> np.ndarray:
    """Compare the next step with double sums; returns how full the water around each particle was."""
    plain, dt = PlainWater(run.scene), run.dt
    r, u, before, m, *_ = held(run)
    run.advance(1)
    push, slope, _ = plain.push(r, u, before, m)
    pressed = plain.wall_pressure(r, m, before) > 0.0
    u = u + dt * (push + plain.gravity)
    middle = r + 0.5 * dt * u
    found, numbers, told = held(run), run.water.constants.numbers, run.water.forces.voids
    full, lacking = plain.void_indicator(r, m, before, numbers["plane"])
    s = before + dt * (plain.rate(middle, u, before, m, slope, pressed) + plain.keeping(full, lacking, before))
    s = s / (1.0 + dt * numbers["relief"] * np.clip((PACKING - full) / RAMP, 0.0, 1.0))
    np.testing.assert_allclose(run.water.particles.read(told.indicator)[0][0], full, atol=1e-9)
    np.testing.assert_allclose(found[4], push, atol=1e-9 * np.abs(push).max())
    np.testing.assert_allclose(found[5], slope, atol=1e-8 * np.abs(slope).max())
    np.testing.assert_allclose(found[2], s, atol=1e-9 * np.abs(s).max())
    np.testing.assert_allclose(found[0], middle + 0.5 * dt * u, atol=1e-12)
    return full


def test_a_step_equals_double_sums(run):
    run.advance(7)
    full = check_a_step(run)
    assert full.min() > PACKING  # at the surface and in corners, too


def test_the_load_is_what_the_water_loses(run):
    """The momentum of the water changes by its weight and by minus the load on the tank, to rounding."""
    run.observe()
    _, before, _, mass, *_ = held(run)
    steps = 50
    run.advance(steps)
    load = run.observe()["wall_force"][0, :2]
    change = mass @ (held(run)[1] - before)
    weight = np.array([0.0, -GRAVITY * mass.sum()])
    chance = 5.0 / (steps * run.scene.particles) ** 0.5  # five deviations of the mean of so many sums
    scale, digits = steps * run.dt * np.abs(load).max(), to_digits(run, 1e-12, chance * ROUNDING * CANCELLED)
    np.testing.assert_allclose(change, steps * run.dt * (weight - load), atol=digits * scale)


def test_the_loads_on_all_edges_are_the_load_on_the_tank(run):
    """Summed over the walls, the forces are those summed over the water; the floor bears most, the lid nothing."""
    run.observe()
    run.advance(20)
    rows = run.observe()
    edges, load = rows["edge_force"][0], rows["wall_force"][0, :2]
    digits = to_digits(run, 1e-10, 2.0 * ROUNDING)  # of two sums
    np.testing.assert_allclose(edges.sum(axis=0), load, atol=digits * np.abs(edges).max())
    assert edges[0, 1] < 0.9 * load[1] < 0.0 < edges[1, 0]
    np.testing.assert_array_equal(edges[2], 0.0)


def test_energy_is_accounted_for(run):
    """What is lost goes to viscosity, to diffusion and to the wall particles; it only falls.

    The account has the errors of the step: on this rough state 1.6 %, with half the step 0.4 %, with a quarter 0.15 %.
    """
    start = run.observe()
    run.advance(400)
    end = run.observe()
    lost = start["water_total"] - end["water_total"]
    taken = sum(end[name] - start[name] for name in ("water_viscous", "water_diffusive", "water_wall_energy"))
    assert 0.5 * start["water_kinetic"] < lost
    np.testing.assert_allclose(taken, lost, rtol=0.03)


def test_tanks_of_other_sizes_share_compiled_kernels(run):
    """All arrays of a tank twice as fine, wider and half as deep have the same shapes, for which kernels are made."""
    fewer = TOLD | {"gauges": GAUGES[:1], "levels": (), "edges": (0,)}
    scene = still(2.0 * WIDTH, HEIGHT, 0.5 * DEPTH, 2 * ROWS // 3, **fewer)
    other = Simulation(scene, threads=1, arch="cpu")
    shapes = [{name: array.shape for name, array in one.arrays.arrays.items()} for one in (run, other)]
    assert shapes[0] == shapes[1]
    assert other.scene.particles != run.scene.particles
    other.close()


def test_water_with_voids_loses_its_pressure(run):
    """A lattice that is higher by a fifth bears none where it is not packed; its energy is accounted for."""
    scene = disturbed()
    scene.fluid.particles["position"][0, :, 1] *= 1.2
    scene.fluid.particles["deviation"][0] = 0.01
    again(run, scene)
    start = run.observe()
    run.advance(1)
    full = check_a_step(run)
    assert np.median(full) < PACKING - RAMP
    run.advance(10)
    end = run.observe()
    p = run.water.particles
    full, s = (values[0] for values in p.read(run.water.forces.voids.indicator, p.deviation))
    assert np.abs(s[full < PACKING - RAMP]).mean() < 0.2 * 0.01
    assert abs(residual(end, residual(start, 0.0))[0]) < 0.03 * start["water_elastic"][0]


def test_water_that_is_packed_too_close_takes_its_room_again(run):
    """Water at rest whose particles are 3 % too heavy for their room rises by as much, but for what its surface is."""
    scene = still(WIDTH, HEIGHT, DEPTH, ROWS, **TOLD)
    scene.fluid.particles["volume"] *= 1.03
    again(run, scene)
    start = run.observe()
    run.advance(round(2.5 / (run.water.constants.numbers["keeping"] * run.dt)))
    end = run.observe()
    p = run.water.particles
    full, eigenvalue = (values[0] for values in p.read(run.water.forces.voids.indicator, p.eigenvalue))
    assert full[eigenvalue > 0.95].mean() == pytest.approx(1.0, abs=0.01)
    assert 1.015 < end["water_potential"] / start["water_potential"] < 1.035
    assert abs(residual(end, residual(start, 0.0))[0]) < 0.03 * abs(end["water_diffusive"][0])


def test_a_drop_alone_falls_without_pressure(run):
    """A pressed drop high above the water is relieved within a few h/c0 and falls as a stone does."""
    scene = disturbed()
    drop = scene.fluid.particles[0, -1]
    drop["position"], drop["velocity"], drop["deviation"] = (0.0, 0.5), 0.0, 0.02
    again(run, scene)
    run.advance(20)
    places, speeds, s, *_ = held(run)
    time = 20 * run.dt
    assert 0.0 <= s[-1] < 1e-4 * scene.fluid.particles["deviation"][0, -1]
    assert places[-1] == pytest.approx([0.0, 0.5 - 0.5 * GRAVITY * time**2], abs=GRAVITY * time * run.dt)
    assert speeds[-1] == pytest.approx([0.0, -GRAVITY * time], abs=GRAVITY * run.dt)


def test_gravity_may_change_while_water_runs(run):
    """Under half of the gravity the water weighs half as much on its tank, and no energy counts as created."""
    again(run, still(WIDTH, HEIGHT, DEPTH, ROWS, **TOLD))
    run.observe()
    run.alter(replace(run.scene, gravity=0.5 * GRAVITY))
    loads = []
    for _ in range(40):  # over some ten times that sound takes through the depth
        run.advance(20)
        loads.append(run.observe()["wall_force"][0, 1])
    weight = 0.5 * GRAVITY * held(run)[3].sum()
    np.testing.assert_allclose(np.mean(loads[10:]), -weight, rtol=0.03)


def test_water_at_rest_weighs_on_the_floor_and_its_gauges(run):
    """From hydrostatic rest: pressures, levels and the load stay; c0 = 10 √(gH) compresses the water by up to 1 %.

    The floor bears the water's weight, a wall ρ g H²/2 to a tenth of a spacing of the pressure at its foot: it has its
    part of what the wall particles beyond the corner bear, 0.35 spacings.
    """
    again(run, still(WIDTH, HEIGHT, DEPTH, ROWS, **TOLD))
    run.observe()
    run.advance(600)
    rows, mass = run.observe(), held(run)[3].sum()
    np.testing.assert_allclose(rows["wall_force"][0], [0.0, -mass * GRAVITY, 0.0], atol=2e-3 * mass * GRAVITY)
    deep = 1000.0 * GRAVITY * np.array([DEPTH - 0.06, DEPTH, 0.0])
    np.testing.assert_allclose(rows["gauge_pressure"][0], deep, atol=0.02 * 1000.0 * GRAVITY * DEPTH)
    np.testing.assert_allclose(rows["level_depth"][0], DEPTH, rtol=0.01)
    side = 0.5 * 1000.0 * GRAVITY * DEPTH**2
    floor, right, _, left = rows["edge_force"][0]
    np.testing.assert_allclose([right[0], -left[0]], side, atol=0.1 * 1000.0 * GRAVITY * DEPTH * DEPTH / ROWS)
    np.testing.assert_allclose(floor[1], -mass * GRAVITY, rtol=2e-3)
    assert rows["water_kinetic"][0] < 1e-4 * 1000.0 * GRAVITY * DEPTH * WIDTH * DEPTH
    place, pressure = (run.snapshot()[name][0] for name in ("water_position", "water_pressure"))
    wanted = 1000.0 * GRAVITY * (DEPTH - place[:, 1])
    np.testing.assert_allclose(pressure, wanted, atol=0.5 * 1000.0 * GRAVITY * DEPTH / ROWS)  # half a layer


@pytest.mark.parametrize("trouble", ["not a number", "left the tank", "gained energy", "Mach"])
def test_the_watch_stops_water_that_is_not_sound(run, trouble):
    """Within a step, or at the next look: one sentence that has the time."""
    again(run, still(WIDTH, HEIGHT, DEPTH, ROWS, **TOLD))
    p, sound = run.water.particles, run.scene.fluid.water.sound_speed
    run.observe()
    run.advance(10)
    run.observe()
    with pytest.raises(BadState, match=rf"{trouble}[^.]* .*t = \S+ s; [^.]*\S\.\S.*\.$"):
        if trouble == "not a number":
            upset(run, 100, p.velocity, (np.nan, 0.0))
        elif trouble == "left the tank":
            upset(run, 100, p.place, (0.5 * WIDTH + 2.0 * run.scene.fluid.water.spacing, 0.1))
        elif trouble == "Mach":
            upset(run, 100, p.velocity, (0.51 * sound, 0.0))
        else:
            for number in range(0, run.scene.particles, 2):
                upset(run, number, p.velocity, (0.3, 0.0))
        if trouble in ("not a number", "Mach"):
            run.advance(1)
        run.observe()


def come_through(deep: float) -> Scene:
    """Single particles, by so many spacings behind the face of a wall or the floor, between two wall particles, or
    corners.

    The rest is far from walls.
    """
    spacing = DEPTH / ROWS
    out, ways = deep * spacing, (1.0 + 6.25 * np.arange(4)) * spacing  # over six spacings apart: none sees another
    right = np.stack([np.full(4, 0.5 * WIDTH + out), 5.0 * spacing + ways], axis=1)
    floor = np.stack([ways - 0.5 * WIDTH + 5.0 * spacing, np.full(4, -out)], axis=1)[:3]
    corners = np.array([[-0.5 * WIDTH - out, -out], [-0.5 * WIDTH - out, HEIGHT + out]])
    scene = still(WIDTH, HEIGHT, DEPTH, ROWS, gravity=0.0, **TOLD)
    drops = scene.fluid.particles[0]
    drops["deviation"], drops["position"][:, 1] = 0.0, drops["position"][:, 1] + 0.5 * (HEIGHT - DEPTH)
    drops["position"][:, 0] *= 0.6
    drops["position"][:9] = np.concatenate([right, floor, corners])
    return scene


@pytest.mark.parametrize("deep", [0.15, 0.3, 0.45])
def test_a_wall_pushes_back_what_has_come_through_its_face(run, deep):
    """Anywhere behind it, those at the corners towards the middle."""
    again(run, come_through(deep))
    run.advance(1)
    push = held(run)[4]
    inwards = np.append(-push[:4, 0], push[4:7, 1])
    assert (inwards > 0.0).all()
    assert inwards.min() > 0.4 * inwards.max()
    assert (push[7:9, 0] > 0.0).all() and push[7, 1] > 0.0 > push[8, 1]


@pytest.mark.slow
@pytest.mark.parametrize(
    "changes",
    [
        pytest.param({"precision": "mixed"}, marks=pytest.mark.slow),
        pytest.param({"schedule": "per-band"}, marks=pytest.mark.slow),  # see `test_on_axle.py`
        {"schedule": "per-grain", "precision": "f32"},
    ],
)
def test_other_ways_of_running_give_the_same_water(course, changes):
    """Numbers of 32 bits, bands on threads, and particles one by one: the same course, to the rounding of each.

    Those one by one in two worlds, whose first has another course: they do not feel each other.
    """
    units = {"units": 2} if changes == {"schedule": "per-band"} else {}
    scenes = [disturbed(seed, **UNTOLD | changes) for seed in ((4, 3) if "f32" in changes.values() else (3,))]
    other = Simulation(Scene.joined(scenes), threads=1 + len(units), arch="cpu", **units)
    other.advance(60)
    places, spacing = other.snapshot()["water_position"], other.scene.fluid.water.spacing
    precision = other.scene.precision
    place = places[-1]
    assert len(places) == 1 or np.abs(places[0] - place).max() > 0.05 * spacing
    other.close()
    tight = {"f64": 1e-9, "mixed": 2e-5, "f32": 5e-4}[precision]
    np.testing.assert_allclose(place, course, atol=tight * spacing)


@pytest.mark.slow
def test_worlds_go_on_when_one_leaves(course):
    """With the same bits, although they are counted anew and lists of neighbours hold places in all worlds."""
    scenes = [disturbed(seed) for seed in (4, 5, 6)]
    whole = Simulation(Scene.joined(scenes), threads=1, arch="cpu")
    whole.advance(20)
    state, axes = whole.state(), whole.axes()
    whole.advance(15)
    place = whole.snapshot()["water_position"]
    whole.close()
    left = Simulation(Scene.joined(scenes[1:]), threads=1, arch="cpu")
    left.restore({name: without_worlds(values, axes[name], 3, slice(0, 1)) for name, values in state.items()})
    left.advance(15)
    np.testing.assert_array_equal(left.snapshot()["water_position"], place[1:])
    left.close()
