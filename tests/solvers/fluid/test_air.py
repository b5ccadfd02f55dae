"""Water and air as one fluid of two phases: a step against double sums, what is kept, rest, and closed air."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest

from solvers.fluid.given import Air, Fluid, Gauge, Level, Water
from solvers.fluid.phases.adiabatic import background
from solvers.fluid.phases.cohesion import Cohesion
from solvers.fluid.timestep import kinematic
from solvers.fluid.viscosity import VISCOSITY
from solvers.motion.harmonic import Sway
from solvers.scene import Scene
from solvers.simulation import Simulation
from tests.oracles.air import again, both, filled, follows_double_sums, held
from tests.oracles.given import scene_of
from tests.oracles.water import GRAVITY, box

WIDTH, HEIGHT, DEPTH, ROWS = 0.32, 0.32, 0.16, 8
# The same in all, and in a run of a preset (`tests/lab/runs/test_air_runs.py`): one kernel.
TOLD = {
    "gauges": (Gauge((0.16, 0.0), 0.02), Gauge((-0.16, 0.28), 0.02), Gauge((-0.16, 0.16), 0.02)),
    "levels": (Level(0.0),),
    "motions": [[Sway(0.0, 1.0)]],
}


def scene(**changes):
    return both(WIDTH, HEIGHT, DEPTH, ROWS, **TOLD | changes)


@pytest.fixture(scope="module")
def pool() -> Iterator[Simulation]:
    """A simulation in which the tests place their water and air."""
    made = Simulation(scene(background=40.0), threads=1, arch="cpu")
    yield made
    made.close()


@pytest.mark.slow
def test_water_rests_under_air(pool):
    """From hydrostatic rest in both: pressures stay, the surface keeps its place to a quarter of a spacing."""
    again(pool, scene(background=40.0)).observe()
    pool.advance(1500)
    rows, state, spacing = pool.observe(), pool.snapshot(), pool.scene.fluid.water.spacing
    gas, mass = pool.scene.fluid.particles["gas"][0] > 0.5, held(pool)[3]
    np.testing.assert_allclose(rows["wall_force"][0, 1], -GRAVITY * mass.sum(), rtol=3e-3)
    np.testing.assert_allclose(rows["gauge_pressure"][0, 0], 1000.0 * GRAVITY * DEPTH, rtol=0.03)
    # The surface settles by a part of a spacing, which squeezes the air of eight layers by some per cent.
    over, stiff = rows["gauge_pressure"][0, 1] + 1.2 * GRAVITY * 0.12, 1.2 * pool.scene.fluid.water.air.sound_speed**2
    assert abs(over) < 0.03 * stiff
    np.testing.assert_allclose(rows["level_depth"][0], DEPTH, atol=0.25 * spacing)
    assert rows["air_volume"][0] == pytest.approx(WIDTH * (HEIGHT - DEPTH), rel=0.02)
    middle = 0.5 * (state["water_position"][0, :, 1].max() + state["air_position"][0, :, 1].min())
    assert abs(middle - DEPTH) < 0.5 * spacing
    assert state["air_position"].shape[1] == gas.sum()


@pytest.mark.slow
def test_a_gauge_that_sees_more_air_than_water_shows_the_air(pool):
    """Squeezed water ends two fifths of a spacing below the middle of a gauge, which shows nothing of it."""
    made = scene(background=40.0)
    wet, spacing = made.fluid.particles["gas"][0] < 0.5, made.fluid.water.spacing
    made.fluid.particles["position"][0, :, 1] -= 0.4 * spacing
    made.fluid.particles["deviation"][0, wet] = 0.01
    run = again(pool, made)
    run.advance(2)
    shown, squeezed = run.observe()["gauge_pressure"][0], 0.01 * 1000.0 * made.fluid.water.sound_speed**2
    assert shown[0] > 0.5 * squeezed and shown[2] < 0.05 * squeezed


@pytest.mark.slow
def test_closed_air_follows_water_and_walls(pool):
    """Water flies at closed air and takes a fifth of it: the pressures of both sides follow p V^1.4 to 1 %."""
    made, long = scene(background=40.0), 0.5 * (HEIGHT - 0.08)
    spacing, sound = made.fluid.water.spacing, made.fluid.water.air.sound_speed
    places = (np.indices((round(WIDTH / spacing), round(HEIGHT / spacing))).reshape(2, -1).T + 0.5) * spacing
    places[:, 0] -= 0.5 * WIDTH
    gas = (np.abs(places[:, 1] - 0.5 * HEIGHT) > 0.04).astype(float)
    made.matters = made.holding(replace(made.fluid, particles=filled(places, gas, spacing**2))).matters
    high, at_rest = made.fluid.particles["position"][0, :, 1], 1.2 * sound**2 / 1.4
    made.fluid.particles["velocity"][0, :, 1] = 0.18 * np.minimum(1.0, np.minimum(high, HEIGHT - high) / long)
    made.gravity = 0.0
    run = again(pool, made)
    upper = high[made.fluid.particles["gas"][0] > 0.5] > 0.5 * HEIGHT
    run.advance(200)
    rows, pressure = run.observe(), run.snapshot()["air_pressure"][0]
    way = rows["water_centre"][0, 1] - 0.5 * HEIGHT
    assert 0.1 * long < way < 0.3 * long
    for part, side in ((upper, 1.0), (~upper, -1.0)):
        assert 1.0 + pressure[part].mean() / at_rest == pytest.approx((1.0 - side * way / long) ** -1.4, rel=0.01)


def test_drops_fall_together_with_the_pool_below(pool):
    """Three particles of water that fall through air are part of the pool soon after, and do not hover over it."""
    made = scene(background=40.0)
    drops, spacing = made.fluid.particles[0], made.fluid.water.spacing
    high = (np.abs(drops["position"][:, 0]) < 2.0 * spacing) & (np.abs(drops["position"][:, 1] - 0.25) < 0.5 * spacing)
    drops["gas"][high], drops["deviation"][high] = 0.0, 0.0
    made.matters = made.holding(
        replace(made.fluid, particles=drops[np.argsort(drops["gas"], kind="stable")][None])
    ).matters
    run = again(pool, made)
    run.advance(round(0.5 / run.dt))
    place = run.snapshot()["water_position"][0]
    near = np.hypot(*(place[:, None] - place[None]).transpose(2, 0, 1)) < 1.5 * spacing
    assert near.sum(axis=1).min() > 1
    assert place[:, 1].max() < DEPTH + spacing


def test_air_that_has_lost_volume_takes_it_again(pool):
    """Air of nine tenths of its mass at the density of rest: its volume comes back at the rate of 1/τ of what lacks."""
    made = scene(background=40.0)
    made.fluid.particles["volume"] *= 1.0 - 0.1 * made.fluid.particles["gas"]
    run = again(pool, made)
    rate = run.water.constants.numbers["air_keeping"]
    before = run.observe()["air_volume"][0]
    run.advance(300)
    gained = run.observe()["air_volume"][0] / before - 1.0
    assert 0.5 < gained / (0.1 * rate * 300 * run.dt) < 1.3


def test_a_gauge_at_the_surface_does_not_show_the_background(pool):
    """Water sloshes under real air, its sound faster than it needs: a gauge at the still level shows no suction."""
    air, speed = Air(sound_speed=343.0, alpha=0.1), np.sqrt(GRAVITY * DEPTH)
    water = Water(DEPTH / ROWS, 46.5, air=air, speed=speed)
    more = {"sound_speed": 46.5, "speed": speed, "background": background(air, water)}
    made = scene(air={"sound_speed": 343.0, "alpha": 0.1}, **more)
    k, (y, z) = np.pi / WIDTH, made.fluid.particles["position"][0].T
    wet = made.fluid.particles["gas"][0] < 0.5
    made.fluid.particles["velocity"][0, wet, 0] = 0.2 * (np.cos(k * y) * np.cosh(k * z) / np.sinh(k * DEPTH))[wet]
    made.fluid.particles["velocity"][0, wet, 1] = 0.2 * (np.sin(k * y) * np.sinh(k * z) / np.sinh(k * DEPTH))[wet]
    run, shown = again(pool, made), []
    run.observe()
    for step in range(1, 7):
        run.advance(round(0.02 * step / run.dt) - run.steps)
        shown.append(run.observe()["gauge_pressure"][0])
    assert np.min(shown, axis=0)[2] > -0.15 * 1000.0 * GRAVITY * DEPTH


def bubble(made: Scene, near: np.ndarray, deviation: float) -> None:
    """Let the particle nearest to a place (m) be one of air, of this density deviation."""
    at, particles = np.linalg.norm(made.fluid.particles["position"][0] - near, axis=1).argmin(), made.fluid.particles
    particles["gas"][0, at], particles["deviation"][0, at] = True, deviation
    made.matters = made.holding(
        replace(made.fluid, particles=particles[:, np.argsort(particles["gas"][0], kind="stable")])
    ).matters


def test_a_bubble_of_one_particle_does_not_stay_stretched(pool):
    """Drawn out to twice its volume in the middle of the water it bears no more than the background within 5 h/c0."""
    made, middle = scene(background=40.0), np.array([0.0, 0.5 * DEPTH])
    bubble(made, middle, -0.5)
    run, z, gas = again(pool, made), made.fluid.particles["position"][0, :, 1], made.fluid.particles["gas"][0]
    before = run.observe()["water_diffusive"][0]
    run.advance(round(5.0 / run.water.constants.numbers["relief"] / run.dt))
    p = run.water.particles
    (deviation,) = (values[0] for values in p.read(p.deviation))
    (alone,) = np.flatnonzero(gas & (z < DEPTH))
    least = 40.0 / (1.2 * run.scene.fluid.water.air.sound_speed**2)
    assert deviation[alone] == pytest.approx((1.0 - 1.4 * least) ** (1.0 / 1.4) - 1.0, abs=0.02)
    assert run.observe()["water_diffusive"][0] > before


def test_a_gauge_with_a_bubble_before_it_shows_the_waters_pressure(pool):
    """A particle of air on the floor keeps its density of outside: it bears nothing of what the water about it has."""
    made = scene(background=40.0)
    corner = np.array([0.5 * WIDTH, 0.0])
    bubble(made, corner, 0.0)
    run, shown, about = again(pool, made), [], []
    for _ in range(10):
        run.advance(20)
        shown.append(run.observe()["gauge_pressure"][0, 0])
        state = run.snapshot()
        place, pressure = state["water_position"][0], state["water_pressure"][0]
        near = np.linalg.norm(place - corner, axis=1) < 2.0 * run.scene.fluid.water.spacing
        about.append((pressure + 1000.0 * GRAVITY * place[:, 1])[near].mean())
    assert np.mean(shown) == pytest.approx(np.mean(about), rel=0.1)


def stirred(step: float | None = None, **of_air) -> Scene:
    """Both phases displaced and set in motion at random, the air slower than the water's sound, with drops in it."""
    made = scene(air={"sound_speed": 9.0, "alpha": 0.03} | of_air, background=60.0, step=step)
    random, drops = np.random.default_rng(1), made.fluid.particles
    off_walls = (np.abs(drops["position"][0, :, 0]) < 0.08) & (drops["position"][0, :, 1] < 0.24)
    lone = np.flatnonzero(off_walls & (drops["gas"][0] > 0.5))[::7]
    drops["gas"][0, lone], drops["deviation"][0, lone] = 0.0, 0.0
    drops = drops[:, np.argsort(drops["gas"][0], kind="stable")]
    made.matters = made.holding(replace(made.fluid, particles=drops)).matters
    drops["position"] += 0.1 * made.fluid.water.spacing * random.uniform(-1.0, 1.0, drops["position"].shape)
    drops["velocity"] = 0.2 * random.uniform(-1.0, 1.0, drops["position"].shape)
    return made


@pytest.fixture(scope="module")
def run(pool) -> Simulation:
    return again(pool, stirred())


def test_a_step_equals_double_sums(run):
    follows_double_sums(run)


def test_the_load_is_what_both_phases_lose(run):
    """The momentum of water and air changes by their weight and by minus the load on the tank, to rounding."""
    run.advance(1)  # the first kick is half a step long
    run.observe()
    _, before, _, mass, *_ = held(run)
    steps = 50
    run.advance(steps)
    load = run.observe()["wall_force"][0, :2]
    change = mass @ (held(run)[1] - before)
    weight = np.array([0.0, -GRAVITY * mass.sum()])
    scale = steps * run.dt * np.abs(load).max()
    np.testing.assert_allclose(change, steps * run.dt * (weight - load), atol=1e-12 * scale)


def test_energy_is_accounted_for(run):
    """What both phases lose goes to viscosity, diffusion and walls: pairs of water and air make and take none."""
    start = run.observe()
    run.advance(400)
    end = run.observe()
    lost = start["water_total"] - end["water_total"]
    taken = sum(end[name] - start[name] for name in ("water_viscous", "water_diffusive", "water_wall_energy"))
    assert lost > 0.0
    np.testing.assert_allclose(taken, lost, rtol=0.03)
    run.close()  # the slow ones that follow find its kernels


@pytest.mark.slow
@pytest.mark.parametrize("changes", [{"precision": "mixed"}, {"schedule": "per-grain", "precision": "f32"}])
def test_other_ways_of_running_give_the_same(changes):
    """Numbers of 32 bits, and particles one by one: the same course, to the rounding of each."""
    place = []
    for more in ({}, changes):
        made = scene(**more)
        made.fluid.particles["velocity"][..., 0] = 0.1
        other = Simulation(made, threads=1, arch="cpu")
        other.advance(60)
        state = other.snapshot()
        place.append(np.concatenate([state["water_position"][0], state["air_position"][0]]))
        other.close()
    tight = {"mixed": 5e-4, "f32": 3e-3}[changes["precision"]]
    np.testing.assert_allclose(place[1], place[0], atol=tight * made.fluid.water.spacing)


@pytest.mark.slow
def test_a_step_with_cohesion_equals_double_sums():
    made = stirred(step=1e-5, interface="cohesion", cohesion=20.0)
    follows_double_sums(Simulation(made, threads=1, arch="cpu"), 1)  # water throws air off


@pytest.mark.slow
def test_water_rests_under_air_with_cohesion():
    """The surface keeps its place to half a spacing, water its pressure to a tenth of X; the lid bears X besides."""
    sound, pull = 60.0, Cohesion.pull(1000.0, 1.2, GRAVITY, DEPTH)
    air = {"interface": "cohesion", "cohesion": pull, "sound_speed": 4.0 * sound, "alpha": 0.07}
    run = Simulation(scene(sound_speed=sound, smoothing=1.34, alpha=0.07, air=air), threads=1, arch="cpu")
    run.advance(round(1.0 / run.dt))
    rows, state, spacing = run.observe(), run.snapshot(), run.scene.fluid.water.spacing
    middle = 0.5 * (state["water_position"][0, :, 1].max() + state["air_position"][0, :, 1].min())
    assert abs(middle - DEPTH) < 0.5 * spacing
    assert rows["gauge_pressure"][0, 0] == pytest.approx(1000.0 * GRAVITY * DEPTH, abs=0.1 * pull)


@pytest.mark.slow
def test_tension_keeps_momentum():
    """A drop that is longer than wide, in periodic space: forces of both of a pair are of the same step."""
    air = Air(100.0, 3.0, alpha=0.05, tension=1.0)
    water = Water(1.0 / 24.0, 1.0, alpha=0.05, periodic=("y", "z"), air=air)
    water = replace(water, background=background(air, water))
    places = (np.indices((24, 24)).reshape(2, -1).T + 0.5) / 24.0
    places[:, 0] -= 0.5
    gas = np.hypot(places[:, 0] / 0.31, (places[:, 1] - 0.5) / 0.2) > 1.0
    fluid = Fluid(water, filled(places, gas.astype(float), 1.0 / 576.0))
    run = Simulation(scene_of(np.zeros((1, 0)), box(1.0, 1.0), gravity=0.0, fluid=fluid), threads=1)
    run.advance(300)
    _, velocity, _, mass, *_ = held(run)
    assert np.abs(mass @ velocity).max() < 1e-12 * (mass @ np.hypot(*velocity.T))


def test_a_laminar_stress_has_the_viscosity_that_it_says():
    """As the artificial viscosity of α h c/8 has, of both phases."""
    water = Water(0.01, 20.0, alpha=0.04, kinematic=0.04 * 0.02 * 20.0 / 8.0)
    assert VISCOSITY["laminar-stress"].strength(water) == pytest.approx(VISCOSITY["artificial"].strength(water))
    assert kinematic(water) == pytest.approx(kinematic(replace(water, viscosity="laminar-stress")))
