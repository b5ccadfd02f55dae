"""The bounds on the step against quadrature, published numbers and hand calculation, and what they scale with."""

from math import pi, sqrt

import numpy as np
import pytest
from scipy.integrate import quad

from solvers.grains.laws import NORMAL, ROLLING, TANGENTIAL
from solvers.grains.laws.hertz import ELASTIC_STEPS, hertz_duration
from solvers.grains.laws.hertz_viscoelastic import BORNE, damping
from solvers.grains.materials import Material, effective_young
from solvers.grains.timestep import FURTHEST, closing_speed, rayleigh_time
from solvers.machine.limit import furthest
from solvers.motion import Heave, Roll, Sway, Tilt
from solvers.scene import Scene
from tests.oracles.given import scene_of
from tests.oracles.scenes import box, material

TANK = box(0.2, 0.1)
FALL = sqrt(2.0 * 9.81 * 0.1)  # m/s, from the lid to the floor


def scene(diameter: float = 3e-3, outline=TANK, **given) -> Scene:
    """A scene of equal grains."""
    changes = {key: given.pop(key) for key in ("young", "restitution", "dissipative_time") if key in given}
    grain = material(**changes)
    return scene_of(np.full((1, 4), diameter / 2), outline, grain, grain, **given)


@pytest.mark.parametrize(
    ("mass", "radius", "young", "speed"),
    [(1e-5, 7.5e-4, 1.7e9, 1.0), (3e-3, 5e-3, 2.5e10, 20.0), (2e-7, 1e-3, 1e6, 0.01)],
)
def test_hertz_duration_is_that_of_the_collision(mass, radius, young, speed):
    """m ξ̈ = −k ξ^(3/2): twice the time to the deepest overlap, ∫ dξ/√(v² − (4/5)(k/m) ξ^(5/2)), ξ = ξ_max sin²θ."""
    k = 4.0 / 3.0 * young * sqrt(radius)
    deepest = (1.25 * mass * speed**2 / k) ** 0.4

    def slowness(theta):
        s = np.sin(theta) ** 2
        return 2.0 * np.sin(theta) * np.cos(theta) / np.sqrt(-np.expm1(2.5 * np.log(s)))

    duration = 2.0 * deepest / speed * quad(slowness, 0.0, pi / 2.0)[0]
    assert hertz_duration(mass, radius, young, speed) == pytest.approx(duration, rel=2e-3)


@pytest.mark.parametrize(
    ("young", "poisson", "density", "radius", "speed", "published"),
    [
        (48e9, 0.20, 2800.0, 0.01, 20.0, 40.34e-6),
        (20e9, 0.25, 2500.0, 0.01, 20.0, 54.20e-6),
        (70e9, 0.30, 2699.0, 0.10, 0.2, 731.6e-6),
        (40e9, 0.35, 1800.0, 0.10, 0.2, 767.0e-6),
    ],
    ids=["glass", "limestone", "aluminium", "magnesium"],
)
def test_hertz_duration_of_chung_and_ooi(young, poisson, density, radius, speed, published):
    """Chung and Ooi (2011): test 1, two spheres at ±10 m/s; test 2, a sphere on a rigid plane at 0.2 m/s."""
    sphere = Material(density, young, poisson, 0.35, restitution=1.0)
    two = speed > 1.0
    share, partner = (0.5, sphere) if two else (1.0, Material(density, 1e25, poisson, 0.35, restitution=1.0))
    mass = share * 4.0 / 3.0 * pi * radius**3 * density
    duration = hertz_duration(mass, share * radius, effective_young(sphere, partner), speed)
    assert duration == pytest.approx(published, rel=2e-3)


def test_rayleigh_time_of_glass():
    """By hand: G = 48/2.4 = 20 GPa, √(2800/2e10) = 3.7417e-4 s/m, π · 0.01 m · 3.7417e-4 / (0.03262 + 0.8766)."""
    assert rayleigh_time(0.01, 2800.0, 20e9, 0.2) == pytest.approx(1.2928e-5, rel=1e-4)


def test_step_falls_with_stiffness_and_grows_with_size():
    """Δt ∝ Y^(−2/5) at one restitution, since its damping x stays, whether Y or its scale changes; and Δt ∝ d."""
    step = scene().time_step()
    assert "Hertz" in scene().step_limits()[0].reason
    for factor in (1e-3, 0.1, 3.0):  # beyond, waves in the grains bound it
        assert scene(young=3.2e9 * factor).time_step() == pytest.approx(step * factor**-0.4, rel=1e-9, abs=0.0)
    assert scene(stiffness_scale=1e-3).time_step() == pytest.approx(step * 1e-3**-0.4, rel=1e-9, abs=0.0)
    for factor in (0.1, 5.0):
        assert scene(diameter=3e-3 * factor).time_step() == pytest.approx(step * factor, rel=1e-9, abs=0.0)


def test_step_resolves_the_fastest_collision_of_the_smallest_grains():
    radius = np.array([[2e-3, 1e-3], [1.5e-3, 1.2e-3]])
    elastic = material(restitution=1.0)
    made = scene_of(radius, TANK, elastic, elastic)
    mass = 4.0 / 3.0 * pi * 1e-9 * elastic.density
    young = elastic.young / (2.0 * (1.0 - elastic.poisson**2))
    collision = hertz_duration(mass / 2.0, 5e-4, young, FALL)
    assert made.time_step() == pytest.approx(collision / ELASTIC_STEPS, rel=1e-12, abs=0.0)
    lossy = scene_of(radius, TANK, elastic, elastic, start_speed=3.0 * FALL)
    assert lossy.time_step() == pytest.approx(made.time_step() * 3.0**-0.2, rel=1e-12, abs=0.0)


@pytest.mark.parametrize("restitution", [1.0, 0.9, 0.8, 0.6])
def test_a_collision_of_usual_grains_takes_at_most_thirty_steps(restitution):
    """What the mean of the forces over a kick buys; that the restitution is right is tested on collisions."""
    made = scene(restitution=restitution)
    grain, radius = made.grains.grain[0], made.grains.sizes[0]
    mass = 0.5 * grain.density * 4.0 / 3.0 * pi * radius**3
    duration = hertz_duration(mass, 0.5 * radius, made.grains.interfaces[0].young_modulus, made.credible_speed())
    assert 15.0 < duration / made.time_step() < 30.0


def test_damping_and_slow_waves_shorten_the_step():
    steps = [scene(restitution=e).time_step() for e in (1.0, 0.9, 0.6, 0.3, 0.1)]
    assert np.all(np.diff(steps) <= 0.0)
    assert steps[-1] < 0.6 * steps[0]
    # Where nothing moves, collisions last long and the Rayleigh time is what is left.
    still = scene(gravity=0.0, restitution=1.0)
    shear = 3.2e9 / (2.0 * 1.28)
    assert still.time_step() == pytest.approx(0.2 * rayleigh_time(1.5e-3, 1319.0, shear, 0.28))
    assert "Rayleigh" in still.step_limits()[0].reason
    order = [limit.step for limit in scene().step_limits()]
    assert order == sorted(order)
    assert len(order) == 6


def test_the_harder_of_grain_and_wall_bounds_the_step():
    """The step follows the harder of grain–grain and grain–wall contacts."""
    radius = np.full((1, 4), 1.5e-3)
    grain = material()
    both = [scene_of(radius, TANK, grain, material(young=3.2e9 * f)).time_step() for f in (1e-3, 1e3)]
    assert both[0] == pytest.approx(scene().time_step(), rel=0.05)
    assert both[1] < 0.9 * both[0]


def test_damping_gives_the_x_of_the_law():
    """x = β v^(1/5) gives back the restitution's own x at its own speed, and grows as v^(1/5) elsewhere."""
    from solvers.grains.restitution import restitution

    made = scene(restitution=0.7)
    mass = 4.0 / 3.0 * pi * 1.5e-3**3 * 1319.0 / 2.0
    x = damping(made.grains.interfaces[0], mass, 7.5e-4, 1.0)
    assert restitution(x) == pytest.approx(0.7, abs=1e-6)
    assert damping(made.grains.interfaces[0], mass, 7.5e-4, 32.0) == pytest.approx(2.0 * x, rel=1e-12)


@pytest.mark.parametrize(
    ("motion", "speed"),
    [
        (Sway(0.1, 5.0), 0.1 * 10.0 * pi),
        (Heave(0.1, 5.0), 0.1 * 10.0 * pi),
        (Roll(0.3, 8.0), 0.3 * 16.0 * pi * sqrt(0.1**2 + 0.1**2)),
        (Roll(0.3, 4.0, centre=(0.3, -0.2)), 0.3 * 8.0 * pi * sqrt(0.4**2 + 0.3**2)),
        (Tilt(20.0, 1.0, centre=(-0.3, 0.4)), 20.0 * sqrt(0.4**2 + 0.4**2)),
        (Sway(0.001, 1.0), FALL),
    ],
    ids=["sway", "heave", "roll", "roll far off", "tilt", "gentle sway"],
)
def test_credible_speed_includes_the_motion_and_its_lever_arm(motion, speed):
    made = scene_of(np.full((2, 4), 1.5e-3), TANK, material(), material(), motions=[(), (motion,)])
    assert made.credible_speed() == pytest.approx(speed, rel=1e-12)
    assert scene_of(made.grains.radius, TANK, material(), material(), start_speed=50.0).credible_speed() == 50.0


def test_a_given_step_is_used():
    assert scene(step=1.5e-7).time_step() == 1.5e-7


@pytest.mark.parametrize("phase", [0.0, 0.5 * pi, 2.0])
def test_credible_speed_covers_the_soft_start(phase):
    """The speed of D(t/T) A sin(ωt + phase), D(τ) = exp(1 − 1/(1 − (τ − 1)²)), by differences, never exceeds it."""
    amplitude, frequency, length = 0.2, 3.0, 0.05
    t = np.linspace(0.0, 3.0 * length, 30001)
    tau = np.clip(t / length, 1e-9, 1.0)
    start = np.exp(1.0 - 1.0 / (1.0 - (tau - 1.0) ** 2))
    place = amplitude * start * np.sin(2.0 * pi * frequency * t + phase)
    fastest = np.abs(np.gradient(place, t)).max()
    radius, grain = np.full((1, 4), 1.5e-3), material()
    made = scene_of(radius, TANK, grain, grain, motions=[(Sway(amplitude, frequency, phase),)], soft_start=length)
    assert fastest <= made.credible_speed() <= 4.0 * fastest


@pytest.mark.parametrize("law", NORMAL)
def test_every_normal_law_bounds_the_step_and_scales_with_stiffness(law):
    """Softening stretches every collision by scale^(−2/5); damping and size shorten or stretch the step."""
    step = scene(normal=law).time_step()
    assert scene(normal=law, stiffness_scale=1e-3).time_step() == pytest.approx(step * 1e-3**-0.4, rel=1e-9, abs=0.0)
    assert scene(normal=law, diameter=6e-3).time_step() == pytest.approx(2.0 * step, rel=1e-9, abs=0.0)
    steps = [scene(normal=law, restitution=e).time_step() for e in (1.0, 0.6, 0.1)]
    assert np.all(np.diff(steps) <= 0.0)
    assert len([limit for limit in scene(normal=law).step_limits() if limit.forced > 1.0]) == 4


@pytest.mark.parametrize("restitution", [0.9, 0.5, 0.05])
def test_a_step_is_not_forced_past_what_a_strong_damper_bears(restitution):
    """FURTHEST derived steps where damping is weak, BORNE of the damper's own where it is strong; draft's at least."""
    made = scene(restitution=restitution, stiffness_scale=1e-3)
    most = furthest(made.step_limits()) / made.time_step()
    least, largest = {0.9: (FURTHEST, FURTHEST), 0.5: (BORNE, FURTHEST), 0.05: (BORNE, BORNE)}[restitution]
    assert least - 1e-9 < most < largest + 1e-9
    assert made.longest_step(1.6) == pytest.approx(1.6 * made.time_step())


@pytest.mark.parametrize("restitution", [0.9, 0.05])
def test_gears_scheme_bears_fewer_derived_steps(restitution):
    """Four fifths of what Verlet's bears, as the map of limits has it."""
    verlet, gear = (
        scene(restitution=restitution, stiffness_scale=1e-3, integrator=name) for name in ("verlet", "gear")
    )
    most = [furthest(made.step_limits()) / made.time_step() for made in (verlet, gear)]
    assert most[1] == pytest.approx(0.8 * most[0])


@pytest.mark.parametrize("tangential", TANGENTIAL)
@pytest.mark.parametrize("rolling", ROLLING)
def test_springs_bound_the_step_only_where_they_are_stiff(tangential, rolling):
    """Δt² k/m ≤ 0.1 of every spring, which the collision's own step keeps in ordinary scenes.

    Mindlin's is resolved by it, too, and its dashpot where the restitution is 0.5 or less.
    """
    laws = {"tangential": tangential, "rolling": rolling}
    assert scene(restitution=0.8, **laws).time_step() == scene(restitution=0.8).time_step()
    lossy = scene(restitution=0.5, **laws).time_step() < scene(restitution=0.5).time_step()
    assert lossy == (tangential == "mindlin")
    rough = material(rolling_friction=30.0)
    stiff = scene_of(np.full((1, 4), 1.5e-3), TANK, rough, rough, **laws)
    assert (stiff.time_step() < scene(**laws).time_step()) == (rolling == "elastic-plastic")


@pytest.mark.parametrize("count", [1, 2, 3, 50])
@pytest.mark.parametrize("flat", [False, True])
def test_closing_speed_is_the_largest_difference_of_velocities(count, flat):
    """Against all pairs: in the plane, and where all move along one line or two alike."""
    velocity = np.random.default_rng(count).normal(0.3, 1.0, (count, 2)) * ([1.0, 0.0] if flat else [1.0, 2.0])
    velocity = np.concatenate([velocity, velocity[:1]])
    pairs = np.linalg.norm(velocity[:, None] - velocity, axis=2).max()
    assert closing_speed(velocity) == pytest.approx(max(pairs, np.linalg.norm(velocity, axis=1).max()), rel=1e-12)
    assert closing_speed(np.zeros((count, 2))) == 0.0


def test_the_speed_limit_of_the_watch_is_never_exceeded():
    """So soft that a collision lasts long: a tenth of the radius a step, at 1.5 times the speed, of all 16 grains."""
    made = scene_of(np.full((1, 16), 1.5e-3), TANK, material(young=1e4), material(young=1e4), start_speed=20.0)
    longest = 0.1 * 1.5e-3 / (1.5 * 16 ** (1 / 16) * 20.0)
    assert made.longest_step(2.75) == pytest.approx(longest, rel=1e-12, abs=0.0)
    gear = scene_of(
        made.grains.radius, TANK, made.grains.grain[0], made.grains.wall[0], start_speed=20.0, integrator="gear"
    )
    firm = [limit for limit in gear.step_limits() if limit.firm and limit.forced > 1.0]
    assert [limit.step for limit in firm] == pytest.approx([longest], rel=1e-12, abs=0.0)
    assert "watch" in firm[0].reason
    ordinary = scene()
    assert ordinary.longest_step(2.75) == pytest.approx(2.75 * ordinary.time_step(), rel=1e-12, abs=0.0)


@pytest.mark.parametrize("law", NORMAL)
def test_deepest_overlap_is_that_of_the_impact(law):
    """At the restitution speed all laws are as deep as Hertz: (5 m v²/(4 k))^(2/5), at a wall, in radii of any size."""
    mass = 4.0 / 3.0 * pi * 1.5e-3**3 * 1319.0
    k = 4.0 / 3.0 * 3.2e9 / (2.0 * (1.0 - 0.28**2)) * sqrt(1.5e-3)
    deepest = (1.25 * mass / k) ** 0.4 / 1.5e-3
    assert scene(normal=law).grains.deepest_overlap(1.0) == pytest.approx(deepest, rel=1e-9)
    assert scene(normal=law, diameter=6e-3).grains.deepest_overlap(1.0) == pytest.approx(deepest, rel=1e-9)
    assert scene(normal=law, stiffness_scale=1e-2).grains.deepest_overlap(1.0) == pytest.approx(
        deepest * 10**0.8, rel=1e-9
    )
