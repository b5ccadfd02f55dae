"""Pressures over those of the upper fluid at rest: a step against double sums, what is kept, and what is shown."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest

from solvers.fluid.checks import refuse_reduced
from solvers.fluid.given import Gauge
from solvers.fluid.phases.reduced_pressure import ReducedPressure
from solvers.machine.errors import Unavailable
from solvers.motion.harmonic import Sway
from solvers.scene import Scene
from solvers.simulation import Simulation
from tests.oracles.air import again, both, follows_double_sums, held
from tests.oracles.water import GRAVITY

WIDTH, HEIGHT, DEPTH, ROWS, DENSITY = 0.32, 0.32, 0.16, 8, 500.0
GAUGES = Gauge((0.16, 0.0), 0.02), Gauge((-0.16, 0.28), 0.02)


def scene(amplitude: float = 0.0, **of_air) -> Scene:
    """Water below a fluid of half its density, in a tank that may sway."""
    air = {"density": DENSITY, "alpha": 0.03, "reduced": DEPTH} | of_air
    motions = [[Sway(amplitude, 2.0)]]
    return both(WIDTH, HEIGHT, DEPTH, ROWS, air=air, background=200.0, gauges=GAUGES, motions=motions)


def stirred(amplitude: float = 0.0) -> Scene:
    """Both set in motion at random."""
    made = scene(amplitude)
    random, drops = np.random.default_rng(1), made.fluid.particles
    drops["position"] += 0.1 * made.fluid.water.spacing * random.uniform(-1.0, 1.0, drops["position"].shape)
    drops["velocity"] = 0.2 * random.uniform(-1.0, 1.0, drops["position"].shape)
    return made


@pytest.fixture(scope="module")
def pool() -> Iterator[Simulation]:
    """A simulation in which the tests place their fluids."""
    made = Simulation(scene(), threads=1, arch="cpu")
    yield made
    made.close()


@pytest.mark.slow
def test_gauges_show_the_whole_pressure(pool):
    """At rest: ρ g d of the water at the floor, less than outside in the upper fluid, which hangs; the load is all."""
    run, found = again(pool, scene()), []
    run.advance(600)
    for _ in range(12):  # sound goes to and fro between floor and lid
        run.advance(25)
        found.append(run.observe())
    names = "gauge_pressure", "air_mean_pressure", "wall_force"
    (floor, above), mean_pressure, load = (np.mean([rows[name][0] for rows in found], axis=0) for name in names)
    # The surface settles by a part of a spacing, which lifts all pressures alike: what lies between them is certain.
    np.testing.assert_allclose(floor - above, GRAVITY * (1000.0 * DEPTH + DENSITY * (0.28 - DEPTH)), rtol=0.02)
    over = DENSITY * GRAVITY * (0.28 - 0.5 * (DEPTH + HEIGHT))
    np.testing.assert_allclose(mean_pressure - above, over, rtol=0.1)
    np.testing.assert_allclose(run.snapshot()["air_pressure"][0].mean() - above, over, rtol=0.2)
    np.testing.assert_allclose(load[1], -GRAVITY * held(run)[3].sum(), rtol=2e-3)


@pytest.mark.slow
def test_velocities_are_those_of_now(pool):
    """At rest nothing moves after a step, though velocities are kept half a kick behind; nor does energy come of it."""
    run = again(pool, scene())
    start = run.observe()
    run.advance(1)
    rows, state = run.observe(), run.snapshot()
    kick = 0.5 * run.dt * GRAVITY * DENSITY / 1000.0
    assert max(np.sqrt((state[f"{name}_velocity"] ** 2).mean()) for name in ("water", "air")) < 0.5 * kick
    moving = 0.5 * held(run)[3].sum() * kick**2
    assert rows["water_kinetic"][0] < 0.25 * moving
    assert abs(rows["water_total"][0] - start["water_total"][0]) < 0.25 * moving


@pytest.mark.slow
def test_a_step_equals_double_sums(pool):
    follows_double_sums(again(pool, stirred()))


@pytest.mark.slow
def test_momentum_and_energy_in_a_tank_that_sways(pool):
    """Momentum changes by the whole weight less the load, to rounding; energy by what is taken, and the walls' work."""
    pool.close()
    run = Simulation(stirred(0.01), threads=1, arch="cpu")
    run.advance(1)  # the first kick is half a step long
    start = run.observe()
    _, before, _, mass, *_ = held(run)
    steps = 100
    run.advance(steps)
    end = run.observe()
    change, load = mass @ (held(run)[1] - before), end["wall_force"][0, :2]
    weight = np.array([0.0, -GRAVITY * mass.sum()])
    scale = steps * run.dt * np.abs(load).max()
    np.testing.assert_allclose(change, steps * run.dt * (weight - load), atol=1e-12 * scale)
    run.advance(400)
    end = run.observe()
    lost = start["water_total"] - end["water_total"] + end["water_work"] - start["water_work"]
    taken = sum(end[name] - start[name] for name in ("water_viscous", "water_diffusive", "water_wall_energy"))
    run.close()
    np.testing.assert_allclose(taken, lost, rtol=0.03)


def test_the_background_bears_less():
    """The difference of both weights over one smoothing length, not the whole weight of the upper fluid."""
    made = scene().fluid.water
    assert ReducedPressure.hanging(made, GRAVITY, 1.0) == pytest.approx(500.0 * GRAVITY * made.length)
    whole = replace(made, air=replace(made.air, reduced=None))
    assert ReducedPressure.hanging(whole, GRAVITY, 1.0) == pytest.approx(500.0 * GRAVITY)
    assert ReducedPressure.weight(made, GRAVITY) == pytest.approx(0.5 * GRAVITY)


def test_starts_at_rest_without_weight_above():
    """Under the reduced pressure the upper fluid has none at rest, the water that of half its weight."""
    made = scene()
    drops, wet = made.fluid.particles[0], made.fluid.particles["gas"][0] < 0.5
    assert (drops["deviation"][~wet] == 0.0).all()
    share = 0.5 * GRAVITY * (DEPTH - drops["position"][wet, 1]) / made.fluid.water.sound_speed**2
    np.testing.assert_allclose(drops["deviation"][wet], share, rtol=1e-2)


def test_what_does_not_go_with_it():
    with pytest.raises(Unavailable, match=r"^air\.reduced: does not go with air\.stiff_from; leave out"):
        refuse_reduced(scene(stiff_from=1.0))
    refuse_reduced(scene())
