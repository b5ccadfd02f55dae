"""Air that is soft at the start and stiff from a moment on: what goes on over it, rest, restarts, and long steps."""

from dataclasses import replace

import numpy as np
import pytest

from solvers.fluid.given import Air, Fluid, Level, Water
from solvers.fluid.timestep import soft_limit, steps_of_water, stiff_step
from solvers.scene import Scene
from solvers.simulation import Simulation
from solvers.time.changes import up_to_change
from tests.oracles.air import both, filled
from tests.oracles.given import scene_of
from tests.oracles.water import GRAVITY, again, box

WIDTH, HEIGHT, DEPTH, ROWS = 0.32, 0.32, 0.16, 8
SOUND, STIFF, STRIDE, BACKGROUND = 12.5, 100.0, 8, 30.0
FROM = 0.05  # s
KEPT = "water_position", "water_velocity", "air_position", "air_velocity"

pytestmark = pytest.mark.slow  # two compilations of water with air


def scene() -> Scene:
    """A tank at rest, half full, whose air gets eight times the water's speed of sound."""
    air = {"sound_speed": STIFF, "soft_speed": SOUND, "stiff_from": FROM}
    levels = (Level(0.0),)
    made = both(WIDTH, HEIGHT, DEPTH, ROWS, sound_speed=SOUND, levels=levels, air=air, background=BACKGROUND)
    step = min(made.longest_step(1.0), soft_limit(made, 1.0) / STRIDE)
    return made.holding(replace(made.fluid, soft_multiple=STRIDE), step=step)


def stirred() -> Scene:
    """Both phases set in motion at random, with air that is squeezed and drawn out, up to where it resists no more."""
    made, random = scene(), np.random.default_rng(3)
    drops = made.fluid.particles
    drops["velocity"] = 0.1 * random.uniform(-1.0, 1.0, drops["position"].shape)
    drops["deviation"] += np.where(drops["gas"] > 0.5, random.uniform(-0.1, 0.1, drops.shape), 0.0)
    drops["deviation"][0, -3:] = -0.5, 0.9, 3.0
    return made


def mass_of(run: Simulation) -> np.ndarray:
    """Masses (n,) of all particles, kg/m."""
    return run.water.particles.read(run.water.particles.mass)[0][0]


@pytest.fixture(scope="module")
def made():
    run = Simulation(scene(), threads=1, arch="cpu")
    yield run
    run.close()


def test_pressure_mass_momentum_and_energy_go_on(made):
    """At the moment itself: pressures to rounding, places, velocities and masses bit for bit, energy with its account.

    The density becomes that of stiff air under the same pressure.
    """
    run = again(made, stirred())
    run.observe()
    rows, state, mass = run.observe(), run.snapshot(), mass_of(run)
    soft = run.water.particles.read(run.water.particles.deviation)[0]
    run.water.change()
    after, later = run.observe(), run.snapshot()
    stiff = run.water.particles.read(run.water.particles.deviation)[0]
    gas = run.scene.fluid.particles["gas"][0] > 0.5
    scale = np.abs(state["air_pressure"]).max()
    np.testing.assert_allclose(later["air_pressure"], state["air_pressure"], atol=1e-12 * scale)
    np.testing.assert_array_equal(later["water_pressure"], state["water_pressure"])
    for name in KEPT:
        np.testing.assert_array_equal(later[name], state[name])
    np.testing.assert_array_equal(mass_of(run), mass)
    np.testing.assert_allclose(after["water_momentum"], rows["water_momentum"], rtol=1e-12)
    assert np.abs(soft[0, gas]).max() > 0.5 > 0.1 > np.abs(stiff[0, gas]).max() > 0.0
    np.testing.assert_array_equal(soft[0, ~gas], stiff[0, ~gas])
    assert after["water_elastic"] < rows["water_elastic"]
    loss = after["water_diffusive"] - rows["water_diffusive"]
    np.testing.assert_allclose(rows["water_elastic"] - after["water_elastic"], loss, rtol=1e-9)


def test_a_still_tank_stays_still(made):
    """Water and air at rest before and after: the surface keeps its place, the air its pressure and its rest."""
    run = again(made, scene())
    due, spacing = stiff_step(run.scene), run.scene.fluid.water.spacing
    looks = []
    for _ in range(3):  # the last two under stiff air
        run.advance(due)
        looks.append(run.observe() | run.snapshot())
    assert run.water.changes > run.steps == 3 * due
    fastest = [np.hypot(*look["air_velocity"][0].T).max() for look in looks]
    assert max(fastest[1:]) < 1.2 * fastest[0]
    for look in looks:
        assert look["level_depth"][0] == pytest.approx(DEPTH, abs=0.1 * spacing)
        assert abs(look["air_mean_pressure"][0]) < 3e-4 * 1.2 * STIFF**2
        assert np.ptp(look["air_pressure"][0]) < 2.0 * 1.2 * GRAVITY * (HEIGHT - DEPTH)
        assert look["wall_force"][0, 1] == pytest.approx(-GRAVITY * mass_of(run).sum(), rel=2e-2)


def test_steps_are_long_before_the_moment_only(made):
    """Eight base steps in one until then, wherever a run stops to look; single ones from then on."""
    run = again(made, stirred())
    due = stiff_step(run.scene)
    assert due % STRIDE == 0 and abs(due * run.dt - FROM) <= STRIDE * run.dt
    assert run.whole(1000) % STRIDE == 0
    strides = []
    for steps in (STRIDE, due - 2 * STRIDE, STRIDE, 3, 5):
        run.advance(steps)
        strides.append(int(run.clock.before.to_numpy()[0]))
    assert run.steps == due + 8 and strides == [STRIDE] * 3 + [1, 1]
    assert run.water.constants.numbers["air_stiffness"] == pytest.approx(1.2 * STIFF**2)
    assert steps_of_water(run.scene, run.steps) == due // STRIDE + 8
    assert steps_of_water(run.scene, 2 * STRIDE) == 2


def test_a_restart_has_the_same_bits(made):
    """From before the moment, from the moment itself, and from after it, in a simulation that is elsewhere."""
    run = again(made, stirred())
    due, kept = stiff_step(run.scene), []
    for steps in (due - 4 * STRIDE, 4 * STRIDE, 64, 64):
        run.advance(steps)
        kept.append(run.state())
    for number, state in enumerate(kept[:-1]):
        for elsewhere in (kept[0], kept[-1]):  # with soft air, with stiff air
            run.restore(elsewhere)
            run.restore(state)
            run.advance(due + 128 - run.steps)
            end = run.state()
            assert sorted(end) == sorted(kept[-1])
            for name, values in kept[-1].items():
                np.testing.assert_array_equal(end[name], values, err_msg=f"{name} from {number}")


def test_nothing_changes_while_the_clock_has_not_started(made):
    run = again(made, scene())
    run.steps, run.origin = stiff_step(run.scene) + 1, -1e9
    assert up_to_change(run, 10**6) == 10**6
    run.origin = 0.0
    assert up_to_change(run, 10**6) == 10**6  # stiff, and never again
    assert run.water.changes > 10**6
    run.place(np.zeros((1, 0, 2)))
    assert run.water.changes == stiff_step(run.scene)


def test_air_that_stays_as_it_is_has_steps_of_one_length():
    made = both(WIDTH, HEIGHT, DEPTH, ROWS)
    assert made.fluid.water.softened is made.fluid.water
    assert steps_of_water(made, 100) == 100


@pytest.mark.slow
def test_momentum_is_kept_over_the_moment():
    """Both phases in periodic space without gravity: 1e-12 of Σ m |u|, with steps of both lengths."""
    air = Air(1.2, STIFF, soft_speed=SOUND, stiff_from=0.02, alpha=0.05)
    water = Water(1.0 / 24.0, SOUND, alpha=0.05, periodic=("y", "z"), air=air, background=BACKGROUND)
    places = (np.indices((24, 24)).reshape(2, -1).T + 0.5) / 24.0
    places[:, 0] -= 0.5
    drops = filled(places, (places[:, 1] > 0.5).astype(float), 1.0 / 576.0)
    drops["velocity"] = 0.1 * np.random.default_rng(5).uniform(-1.0, 1.0, drops["position"].shape)
    given = {"outline": box(1.0, 1.0), "gravity": 0.0, "fluid": Fluid(water, drops)}
    made = scene_of(np.zeros((1, 0)), **given)
    made.matters = made.holding(replace(made.fluid, soft_multiple=STRIDE)).matters
    made.step = min(made.longest_step(1.0), soft_limit(made, 1.0) / STRIDE)
    run = Simulation(made, threads=1, arch="cpu")
    p = run.water.particles

    def momentum() -> tuple[np.ndarray, float]:
        v, w, mass = p.read(*p.velocity, p.mass)
        return np.array([(mass * v).sum(), (mass * w).sum()]), float((mass * np.hypot(v, w)).sum())

    start, scale = momentum()
    run.advance(stiff_step(made) + 200)
    end, _ = momentum()
    run.close()
    assert run.water.changes > run.steps
    assert np.abs(end - start).max() < 1e-12 * scale
