"""A tank free to roll about an axle: empty against the pendulum's theory, and with cargo that does not move."""

from dataclasses import replace
from math import pi, sin, sqrt

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.special import ellipk

from solvers.motion.axle import Axle
from solvers.motion.harmonic import Sway
from solvers.motion.history import Recorded
from solvers.simulation import Simulation
from tests.oracles.given import scene_of
from tests.oracles.scenes import box, material

G = 9.81
PENDULUM = Axle((0.1, 0.47), 26.9, -29.2, heel=1.0)
SWING = sqrt(G * 29.2 / 26.9)  # rad/s, of small rolls
SLIDING = Axle((0.0, 0.47), 26.9, -29.2, damping=0.326, mass=4.978, slide=Sway(0.1, 0.5128), soft_start=1.0)
RUBBED = Axle((0.0, 0.47), 26.9, -29.2, friction=0.54, heel=0.03)
RADIUS, ACROSS, DEEP = 0.01, 9, 2  # of grains in a triangular lattice from wall to wall


def rolled(axles: list[Axle], dt: float, lasts: float, **scene) -> dict[str, np.ndarray]:
    """Quantities (T, W, …) of empty tanks at every tenth step, with their times."""
    given = scene_of(np.zeros((len(axles), 0)), box(0.9, 0.5), axles=axles, gravity=G, step=dt, **scene)
    run = Simulation(given, threads=1, arch="cpu")
    rows = [run.observe()]
    for _ in range(round(lasts / dt / 10)):
        run.advance(10)
        rows.append(run.observe())
    run.close()
    found = {name: np.array([row[name] for row in rows]) for name in rows[0]}
    return found | {"time": 10 * dt * np.arange(len(rows))}


def roll(found: dict, world: int = 0) -> np.ndarray:
    return found["pose"][:, world, 2]


def crossings(time: np.ndarray, values: np.ndarray) -> np.ndarray:
    """When values cross zero, by a cubic through the four samples about it."""
    at = np.flatnonzero(values[:-1] * values[1:] < 0.0)
    at = at[(at > 0) & (at < len(time) - 2)]
    return np.array([np.polyval(np.polyfit(values[k - 1 : k + 3], time[k - 1 : k + 3], 3), 0.0) for k in at])


@pytest.fixture(scope="module")
def swings():
    """A pendulum let go at 1 rad, with steps of 4 and of 2 ms."""
    return [rolled([PENDULUM], dt, 12.0) for dt in (4e-3, 2e-3)]


def test_the_period_is_that_of_the_elliptic_integral(swings):
    """T = 4 K(sin² φ0/2)/ω; the step's error is of second order."""
    wanted = 4.0 / SWING * ellipk(sin(0.5) ** 2)
    coarse, fine = (2.0 * np.diff(crossings(found["time"], roll(found))).mean() / wanted - 1.0 for found in swings)
    assert abs(fine) < 1e-5
    assert coarse / fine == pytest.approx(4.0, abs=0.3)


def test_energy_swings_about_its_value_and_does_not_drift(swings):
    """As of a symplectic scheme: its error is of second order, bounded, and as large at the end as at the beginning."""
    height = G * 29.2 * (1.0 - np.cos(1.0))
    spread = []
    for found in swings:
        energy = found["axle_energy"][:, 0]
        half = len(energy) // 2
        assert energy[half:].mean() - energy[:half].mean() == pytest.approx(0.0, abs=0.05 * np.ptp(energy))
        spread.append(np.ptp(energy) / height)
    assert spread[1] < 1e-4
    assert spread[0] / spread[1] == pytest.approx(4.0, abs=0.3)


def test_the_tank_hangs_from_its_axle(swings):
    """The point of the tank at the axle stays where it is, and the tank's velocity is that of its pose."""
    pose, rate = swings[1]["pose"][:, 0], swings[1]["pose_rate"][:, 0]
    cos, sin = np.cos(pose[:, 2]), np.sin(pose[:, 2])
    held = pose[:, :2] + np.stack([cos * 0.1 - sin * 0.47, sin * 0.1 + cos * 0.47], axis=1)
    np.testing.assert_allclose(held, np.broadcast_to(PENDULUM.place, held.shape), atol=1e-12)
    by_pose = np.gradient(pose, swings[1]["time"], axis=0)[1:-1]
    np.testing.assert_allclose(rate[1:-1], by_pose, atol=3e-3)


def test_a_sliding_mass_drives_the_roll_as_its_equation_says():
    """Against an eighth-order integration of (I0 + m x²) φ̈ + … = −B φ̇; with steps half as long a quarter off."""
    a, omega = 0.1, 2.0 * pi * 0.5128

    def x(t: float) -> tuple[float, float]:
        if t >= 1.0:
            return a * np.sin(omega * t), a * omega * np.cos(omega * t)
        q = t * (2.0 - t)
        d = np.exp(1.0 - 1.0 / q) if q > 2e-3 else 0.0
        return a * d * np.sin(omega * t), a * d * (
            omega * np.cos(omega * t) + (2.0 * (1.0 - t) / q**2 * np.sin(omega * t) if d else 0.0)
        )

    def rate(t: float, state: np.ndarray) -> list[float]:
        at, speed = x(t)
        m, phi, turn = SLIDING.mass, *state
        force = G * SLIDING.moment * np.sin(phi) - m * G * at * np.cos(phi) - SLIDING.damping * turn
        return [turn, (force - 2.0 * m * at * speed * turn) / (SLIDING.inertia + m * at**2)]

    errors = []
    for dt in (4e-3, 2e-3):
        found = rolled([SLIDING], dt, 12.0)
        exact = solve_ivp(rate, (0.0, 13.0), [0.0, 0.0], "DOP853", found["time"], rtol=1e-10, atol=1e-12)
        errors.append(np.abs(roll(found) - exact.y[0]).max() / np.abs(exact.y[0]).max())
        gain = found["axle_energy"][:, 0] - found["axle_energy"][0, 0]
        load, slide, friction, damping = found["axle_works"][:, 0].T
        assert not load.any() and not friction.any() and damping[-1] > 0.04 * np.ptp(gain)
        np.testing.assert_allclose(gain, slide - damping, atol=1e-3 * np.ptp(gain))
    assert np.abs(exact.y[0]).max() > 0.2  # else nothing was tried
    assert errors[1] < 1e-4
    assert errors[0] / errors[1] == pytest.approx(4.0, abs=0.3)


def test_a_recorded_slide_moves_the_mass_as_its_formula():
    time = np.arange(0.0, 8.0, 0.02)
    sine = replace(SLIDING, soft_start=0.0, slide=Sway(0.1, 0.5128, phase=0.5 * pi))
    samples = 0.1 * np.cos(2.0 * pi * 0.5128 * time)
    record = replace(sine, slide=Recorded("y", tuple(time), tuple(samples)))
    by_formula, by_record = (rolled([axle], 4e-3, 6.0) for axle in (sine, record))
    np.testing.assert_allclose(roll(by_record), roll(by_formula), atol=1e-5 * np.abs(roll(by_formula)).max())


def test_dry_friction_takes_as_much_of_each_swing_and_then_holds():
    """|φ| falls by 2 K/(g |S|) from turn to turn, and rests where the friction can hold it (den Hartog 1931)."""
    found = rolled([RUBBED], 2e-3, 12.0)
    lost = 2.0 * RUBBED.friction / (G * 29.2)  # rad a half swing
    angle, rate = roll(found), found["pose_rate"][:, 0, 2]
    half = pi / SWING / 0.02  # samples
    turns = [abs(angle[round(k * half)]) for k in range(7)]
    np.testing.assert_allclose(np.diff(turns), -lost, rtol=0.02)
    stopped = np.flatnonzero(rate == 0.0)[1]  # it begins at rest
    assert abs(angle[stopped]) < 0.5 * lost
    assert not rate[stopped:].any() and np.ptp(angle[stopped:]) == 0.0
    taken = found["axle_works"][-1, 0, 2]
    np.testing.assert_allclose(taken, found["axle_energy"][0, 0] - found["axle_energy"][-1, 0], rtol=1e-3)


def test_tanks_of_one_launch_have_axles_of_their_own():
    both = rolled([SLIDING, replace(SLIDING, inertia=20.0, damping=1.0)], 4e-3, 4.0)
    alone = rolled([SLIDING], 4e-3, 4.0)
    np.testing.assert_array_equal(roll(both), roll(alone))
    assert np.abs(roll(both, 1) - roll(both)).max() > 0.01


def test_a_tank_is_heeled_smoothly_and_let_go_at_rest():
    found = rolled([replace(PENDULUM, heel=0.2, release=1.0)], 2e-3, 3.0)
    time, angle = found["time"], roll(found)
    wanted = 4.0 / SWING * ellipk(sin(0.1) ** 2)
    assert angle[time <= 1.0].max() == pytest.approx(0.2, abs=1e-9)
    assert crossings(time, angle)[0] == pytest.approx(1.0 + 0.25 * wanted, abs=2e-5)


@pytest.fixture(scope="module")
def wedged():
    """Grains wedged from wall to wall in a tank let go at a small heel, in one slab of three that its length takes."""
    sites = RADIUS * np.array(
        [
            (2 * k - ACROSS + 1 + row % 2, 1.0 + np.sqrt(3.0) * row)
            for row in range(DEEP)
            for k in range(ACROSS - row % 2)
        ]
    )
    grain, slab = material(young=5e7, friction=0.6, restitution=0.3), 2.0 * RADIUS
    axle = Axle((0.02, 0.15), 0.004, -0.02, heel=0.01, release=0.5, length=3.0 * slab)
    scene = scene_of(
        np.full((1, len(sites)), RADIUS),
        box(2.0 * ACROSS * RADIUS * 0.9999, 0.2),
        grain,
        grain,
        tangential="mindlin",
        axles=[axle],
        thickness=slab,
        step=2.5e-5,
    )
    run = Simulation(scene, np.add(sites, [0.0, 0.1 * RADIUS])[None], 1)
    run.settle(1e-7, 0.8)
    mass = 4.0 / 3.0 * pi * RADIUS**3 * grain.density
    place = run.snapshot()["position"][0] - axle.place
    own = 3.0 * mass * ((place**2).sum() + len(place) * 0.4 * RADIUS**2)
    moment = 3.0 * mass * place.sum(axis=0)
    rows = []
    for _ in range(120):
        run.advance(800)
        rows.append(run.observe())
    run.close()
    return axle, own, moment, {name: np.array([row[name] for row in rows]) for name in rows[0]}


@pytest.mark.slow
def test_wedged_grains_turn_with_the_tank_as_a_rigid_weight(wedged):
    """The roll of the rigid body with the grains' inertia and weight, to 1 % of the heel: contacts give a little."""
    axle, own, moment, found = wedged
    angle, time = roll(found), 0.02 * (1.0 + np.arange(120))
    inertia = axle.inertia + own

    def rate(t: float, state: np.ndarray) -> list[float]:
        phi, turn = state
        lever = np.sin(phi) * moment[1] - np.cos(phi) * moment[0]
        return [turn, G * (axle.moment * np.sin(phi) + lever) / inertia]

    later = time > 0.5
    exact = solve_ivp(rate, (0.5, 2.5), [0.01, 0.0], "DOP853", time[later], rtol=1e-10, atol=1e-12).y[0]
    np.testing.assert_allclose(angle[later], exact, atol=1e-4)
    alone = replace(axle, heel=0.01).natural_period(G)
    assert abs(2.0 * pi * sqrt(inertia / (-G * (axle.moment + moment[1]))) / alone - 1.0) > 0.05  # else nothing tried


@pytest.mark.slow
def test_a_held_load_is_a_rigid_weights(wedged):
    """As the tank is turned by hand the moment about the axle is that of the grains' weight and inertia, to 1e-3."""
    _, own, moment, found = wedged
    phi = roll(found)
    mean, rise = 0.5 * (phi[1:] + phi[:-1]), np.gradient(np.gradient(phi, 0.02), 0.02)
    wanted = G * (np.sin(mean) * moment[1] - np.cos(mean) * moment[0]) - own * 0.5 * (rise[1:] + rise[:-1])
    held = slice(7, 22)  # 0.16 to 0.46 s: the roll rises too abruptly before for second differences
    np.testing.assert_allclose(found["axle_moment"][1:, 0][held], wanted[held], rtol=1e-3)


def test_without_a_spring_there_is_no_period():
    assert PENDULUM.natural_period(G) == pytest.approx(2.0 * pi / SWING)
    assert replace(PENDULUM, moment=0.5).natural_period(G) is None
