"""The tank's motions: pose, velocity and acceleration are consistent, and the frame's inertial forces are right."""

from math import hypot, pi

import numpy as np
import pytest
import taichi as ti
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from scipy.interpolate import CubicSpline

from solvers.machine import runtime
from solvers.machine.state import State
from solvers.motion import Heave, Roll, Sway, Tilt
from solvers.motion.harmonic import soft_start
from solvers.motion.history import History, Recorded
from solvers.motion.prescribed import Prescribed
from solvers.motion.tilt import KNOTS

DEG = pi / 180
GRAVITY = 9.81
SOFT_START = 0.8


@ti.data_oriented
class Probe:
    """Reads `Prescribed.kinematics` and `Prescribed.frame` of each of W worlds at many times."""

    def __init__(self, motions, soft_start=0.0):
        runtime.initialise(1)
        self.worlds, self.arrays = len(motions), State()
        self.frame = Prescribed(self.arrays, motions, soft_start, GRAVITY)
        self.arrays.finish()

    @ti.kernel
    def read(self, times: ti.types.ndarray(ti.f64, ndim=1), rows: ti.types.ndarray(ti.f64, ndim=3)):
        for k in range(times.shape[0]):
            for w in range(rows.shape[0]):
                state = self.frame.kinematics(w, times[k])
                body = self.frame.frame(w, times[k])
                for c in ti.static(range(9)):
                    rows[w, k, c] = state[c]
                for c in ti.static(range(4)):
                    rows[w, k, 9 + c] = body[c]

    def at(self, times) -> tuple[np.ndarray, ...]:
        """Pose, velocity, acceleration (W, T, 3) and body force (W, T, 4) at `times` (T,) s."""
        times = np.ascontiguousarray(times, dtype=float)
        rows = np.zeros((self.worlds, len(times), 13))
        self.read(times, rows)
        return rows[..., 0:3], rows[..., 3:6], rows[..., 6:9], rows[..., 9:13]


@pytest.fixture
def probe():
    """Makes probes and frees their arrays."""
    made = []

    def make(motions, soft_start=0.0):
        made.append(Probe(motions, soft_start))
        return made[-1]

    yield make
    for each in made:
        each.arrays.release()


def slope(function, times, h=2e-4):
    """Derivative by the five-point central difference, in error by h⁴ f⁗′/30."""
    ahead, behind = function(times + h) - function(times - h), function(times + 2 * h) - function(times - 2 * h)
    return (8.0 * ahead - behind) / (12.0 * h)


def assert_derivatives(probe, times, tolerance=1e-8):
    """Velocity is the slope of the pose and acceleration that of the velocity, relative to the largest of each."""
    pose, velocity, acceleration, _ = probe.at(times)
    for claimed, found in (
        (velocity, slope(lambda t: probe.at(t)[0], times)),
        (acceleration, slope(lambda t: probe.at(t)[1], times)),
    ):
        size = np.abs(claimed).max(axis=1, keepdims=True)
        assert np.all((size > 0).any(axis=2)), "a motion that does not move tests nothing"
        assert np.abs(claimed - found).max() < tolerance * size.max()
        moving = np.broadcast_to(size, claimed.shape) > 0
        assert np.all(np.abs(claimed - found)[moving] < tolerance * np.broadcast_to(size, claimed.shape)[moving])
    return pose


def worlds_of(kind, **changes):
    """Three worlds of one harmonic motion with different amplitudes, frequencies and phases."""
    return [[kind(a, f, phase, **changes)] for a, f, phase in ((0.1, 1.0, 0.0), (0.05, 2.3, 0.7), (0.02, 0.4, -2.0))]


def transition(tau):
    """Eq. F.1 of Spandonidis (2016)."""
    tau = np.asarray(tau, dtype=float)
    inner = (tau > 0) & (tau < 1)
    safe = np.where(inner, tau, 0.5)
    return np.where(tau >= 1, 1.0, np.where(inner, np.exp(1.0 - 1.0 / (1.0 - (safe - 1.0) ** 2)), 0.0))


def wave(motion, times):
    """Displacement (T,) of a harmonic motion with the soft start."""
    steady = motion.amplitude * np.sin(2 * pi * motion.frequency * times + motion.phase)
    return transition(times / SOFT_START) * steady


@pytest.mark.parametrize("kind, column", [(Sway, 0), (Heave, 1), (Roll, 2)])
def test_harmonic_motion_and_its_derivatives(probe, kind, column):
    motions = worlds_of(kind)
    moving = probe(motions, SOFT_START)
    # Away from t = 0.8 s, where the soft start ends with a jump of D''.
    times = np.concatenate([np.linspace(0.05, 0.79, 60), np.linspace(0.81, 3.0, 60)])
    pose = assert_derivatives(moving, times)
    for w, (motion,) in enumerate(motions):
        assert np.allclose(pose[w, :, column], wave(motion, times), rtol=0, atol=1e-14)
        assert np.all(np.delete(pose[w], column, axis=1) == 0.0)
        assert motion.duration() == 0.0


def test_harmonic_motion_is_at_rest_before_it_starts(probe):
    for state in probe(worlds_of(Sway)).at([-1e9, -1.0, -1e-9])[:3]:
        assert np.all(state == 0.0)


def test_fastest_speed_of_a_harmonic_motion(probe):
    motions = worlds_of(Heave)
    _, velocity, _, _ = probe(motions).at(np.linspace(0, 3, 5001))
    for w, (motion,) in enumerate(motions):
        assert np.abs(velocity[w, :, 1]).max() == pytest.approx(motion.fastest(0.0), rel=1e-4)


@pytest.fixture(scope="module")
def transition_rows():
    """D and its derivatives as the kernel has them, at τ = 0 … 1.2 for T = 2 s."""
    runtime.initialise(1)

    @ti.kernel
    def fill(times: ti.types.ndarray(ti.f64, ndim=1), length: ti.f64, rows: ti.types.ndarray(ti.f64, ndim=2)):
        for k in range(times.shape[0]):
            d = soft_start(times[k], length)
            for c in ti.static(range(3)):
                rows[k, c] = d[c]

    def at(times, length=2.0):
        times = np.ascontiguousarray(np.atleast_1d(times), dtype=float)
        rows = np.zeros((len(times), 3))
        fill(times, length, rows)
        return rows

    return at


def test_soft_start_goes_from_zero_to_one(transition_rows):
    assert transition_rows(0.0).tolist() == [[0.0, 0.0, 0.0]]
    assert transition_rows([2.0, 2.4]).tolist() == [[1.0, 0.0, 0.0]] * 2
    assert transition_rows(0.0, length=0.0).tolist() == [[1.0, 0.0, 0.0]]
    times = np.linspace(1e-3, 1.999, 500)
    value = transition_rows(times)[:, 0]
    assert np.allclose(value, transition(times / 2.0), rtol=0, atol=1e-14)
    assert np.all(np.diff(value) >= 0.0)
    assert value[-1] == pytest.approx(1.0, abs=1e-6)


def test_derivatives_of_the_soft_start(transition_rows):
    times = np.linspace(0.02, 1.99, 400)
    rows = transition_rows(times)
    assert np.allclose(rows[:, 1], slope(lambda t: transition_rows(t)[:, 0], times), rtol=0, atol=1e-9)
    assert np.allclose(rows[:, 2], slope(lambda t: transition_rows(t)[:, 1], times), rtol=0, atol=1e-8)


TILTS = {
    "long": Tilt(0.4, 0.5, ease=0.2),
    "back": Tilt(0.4, 0.5, hold=0.3, reverse=True, ease=0.2),
    "starboard": Tilt(0.4, -0.5, hold=0.3, reverse=True, ease=0.2),
    "held": Tilt(0.4, 0.5, hold=0.7, ease=0.2),
    "short": Tilt(0.4, 0.03, hold=0.1, reverse=True, ease=0.2),
    "none": Tilt(0.4, 0.0),
}


@pytest.fixture(scope="module")
def tilting():
    """Angle, rate and acceleration (T,) of one of the tilts at given times."""
    reading = Probe([[tilt] for tilt in TILTS.values()])

    def at(name, times):
        w = list(TILTS).index(name)
        return [state[w, :, 2] for state in reading.at(np.atleast_1d(times))[:3]]

    yield at
    reading.arrays.release()


def test_tilt_reaches_its_angle_and_stays(tilting):
    # Eases up over 0.2 s, turns at 0.4 rad/s, eases down: 0.5 rad take 0.5/0.4 + 0.2 s.
    ends = 0.5 / 0.4 + 0.2
    assert TILTS["long"].duration() == pytest.approx(ends, rel=1e-14, abs=0.0)
    assert TILTS["held"].duration() == pytest.approx(ends + 0.7, rel=1e-14, abs=0.0)
    for name in ("long", "held"):
        angle, rate, acceleration = tilting(name, [ends + 1e-9, ends + 0.5, 1e6])
        assert np.allclose(angle, 0.5, rtol=1e-14, atol=0.0)
        assert np.all(rate == 0.0) and np.all(acceleration == 0.0)


def test_tilt_eases_into_its_rate(tilting):
    times = np.array([0.1, 0.2, 0.6, 0.5 / 0.4, 0.5 / 0.4 + 0.1])
    angle, rate, acceleration = tilting("long", times)
    # The ramp turns by ½ (0.4/0.2) t², then the tank lags a steady turn by half the ease.
    assert np.allclose(angle, [0.01, 0.04, 0.4 * 0.5, 0.5 - 0.04, 0.5 - 0.01], rtol=1e-13, atol=0.0)
    assert np.allclose(rate, [0.2, 0.4, 0.4, 0.4, 0.2], rtol=1e-13, atol=0.0)
    assert np.allclose(acceleration, [2.0, 2.0, 0.0, 0.0, -2.0], atol=1e-12)
    assert TILTS["long"].fastest(0.0) == 0.4


@pytest.mark.parametrize("name, top", [("back", 0.5), ("starboard", -0.5), ("short", 0.03)])
def test_tilt_goes_and_comes_back(tilting, name, top):
    tilt = TILTS[name]
    outward = (tilt.duration() - tilt.hold) / 2.0
    angle, rate, _ = tilting(name, [outward + 1e-9, outward + tilt.hold, tilt.duration() + 1e-9, 1e6])
    assert np.allclose(angle, [top, top, 0.0, 0.0], rtol=1e-13, atol=1e-14)
    assert np.allclose(rate, 0.0, atol=1e-14)
    elapsed = np.linspace(0.0, outward, 40)
    there, back = tilting(name, elapsed)[0], tilting(name, outward + tilt.hold + elapsed)[0]
    assert np.allclose(there + back, top, rtol=0, atol=1e-14)


def test_short_tilt_keeps_the_acceleration_and_never_reaches_its_rate(tilting):
    # A triangle of rates: up at 2 rad/s² for T s and down again, 2 T² = 0.03 rad.
    half = np.sqrt(0.03 / 2.0)
    assert TILTS["short"].duration() == pytest.approx(2 * 2 * half + 0.1, rel=1e-13, abs=0.0)
    angle, rate, acceleration = tilting("short", [0.5 * half, half, 1.5 * half])
    assert np.allclose(angle, [0.03 / 8, 0.03 / 2, 0.03 * 7 / 8], rtol=1e-12, atol=0.0)
    assert np.allclose(rate, [half, 2 * half, half], rtol=1e-12, atol=0.0)
    assert np.allclose(acceleration[[0, 2]], [2.0, -2.0], rtol=1e-12, atol=0.0)


def test_a_zero_tilt_stays_upright(tilting):
    assert TILTS["none"].duration() == 0.0
    assert all(np.all(state == 0.0) for state in tilting("none", np.linspace(-1, 3, 20)))


def test_tilt_is_at_rest_before_it_starts(tilting):
    assert all(np.all(state == 0.0) for state in tilting("back", [-1e9, -1e-9]))


def test_derivatives_of_a_tilt(probe):
    tilts = [tilt for name, tilt in TILTS.items() if name != "none"]
    reading = probe([[tilt] for tilt in tilts])
    knots = np.concatenate([[time for time, _ in tilt.knots()] for tilt in tilts])
    times = np.linspace(0.01, 3.4, 300)
    times = times[np.abs(times[:, None] - knots).min(axis=1) > 1e-3]
    assert_derivatives(reading, times)


def test_programmes_fit_the_table():
    assert max(len(tilt.knots()) for tilt in TILTS.values()) == KNOTS
    assert {len(tilt.parameters(0.0)) for tilt in TILTS.values()} == {2 * KNOTS}


def chain(frequency, tilt_centre, roll_centre):
    """A tilting table on a rolling, swaying and heaving deck, about different centres."""
    return [
        Tilt(0.3, 0.35, tilt_centre, hold=0.4, reverse=True, ease=0.15),
        Roll(0.25, frequency, 0.4, roll_centre),
        Sway(0.04, 0.7 * frequency, 1.0),
        Heave(0.03, 1.6 * frequency, -0.5),
    ]


def chain_pose(motions, tilt, times):
    """Pose (T, 3) of the chain, its points written as y + iz; `tilt` (T,) is the first motion's angle."""
    roll, sway, heave = (wave(motion, times) for motion in motions[1:])
    point = np.zeros(len(times), dtype=complex)
    for angle, (y, z) in ((tilt, motions[0].centre), (roll, motions[1].centre)):
        point = complex(y, z) + np.exp(1j * angle) * (point - complex(y, z))
    point += sway + 1j * heave
    return np.column_stack([point.real, point.imag, tilt + roll])


def test_chain_of_motions(probe):
    worlds = [chain(1.1, (0.02, 0.07), (-0.3, 0.5)), chain(1.9, (-0.05, 0.1), (0.4, -0.2))]
    reading, tilting = probe(worlds, SOFT_START), probe([[worlds[0][0]]])
    knots = [time for time, _ in worlds[0][0].knots()] + [SOFT_START]
    times = np.linspace(0.05, 3.5, 300)
    times = times[np.abs(times[:, None] - np.array(knots)).min(axis=1) > 1e-3]
    pose = assert_derivatives(reading, times)
    tilt = tilting.at(times)[0][0, :, 2]
    for w, motions in enumerate(worlds):
        assert np.allclose(pose[w], chain_pose(motions, tilt, times), rtol=0, atol=1e-14)


def test_order_of_a_chain_matters(probe):
    sway, roll = Sway(0.1, 1.0, pi / 2), Roll(0.5, 1.0, pi / 2, (0.0, 0.3))
    rolled_first, swayed_first = (probe([motions]).at([0.0])[0][0, 0] for motions in ([roll, sway], [sway, roll]))
    turn = np.array([[np.cos(0.5), -np.sin(0.5)], [np.sin(0.5), np.cos(0.5)]])
    centre, swayed = np.array([0.0, 0.3]), np.array([0.1, 0.0])
    assert np.allclose(rolled_first[:2], centre - turn @ centre + swayed, atol=1e-15)
    assert np.allclose(swayed_first[:2], centre + turn @ (swayed - centre), atol=1e-15)


def total_force(body, position):
    """What a grain at rest in the tank feels per unit mass (m/s²): b − φ̈ × r + φ̇² r."""
    y, z = position
    return body[:2] + body[3] * np.array([z, -y]) + body[2] ** 2 * np.array([y, z])


def test_body_force_of_steady_turning_is_weight_and_centrifugal_force(probe):
    rate, centre = 3.0, np.array([0.2, -0.4])
    reading = probe([[Tilt(rate, 10.0, tuple(centre), ease=0.1)]])
    times = np.array([0.3, 1.0, 2.7])
    pose, velocity, _, body = (state[0] for state in reading.at(times))
    for phi, (speed_y, speed_z), force in zip(pose[:, 2], velocity[:, :2], body, strict=True):
        # In the tank's frame the centre of a turn is where it was at rest: the centrifugal force points away from it.
        weight = -GRAVITY * np.array([np.sin(phi), np.cos(phi)])
        for point in ([0.0, 0.0], [0.1, 0.05], [-0.3, 0.2]):
            expected = weight + rate**2 * (np.array(point) - centre)
            assert np.allclose(total_force(force, point), expected, rtol=1e-12, atol=0.0)
        assert force[2] == pytest.approx(rate) and force[3] == pytest.approx(0.0, abs=1e-12)
        assert hypot(speed_y, speed_z) == pytest.approx(rate * hypot(*centre), rel=1e-12)


def test_body_force_of_spinning_up_is_euler_force(probe):
    centre, slope = np.array([0.2, -0.4]), 3.0 / 0.5
    reading = probe([[Tilt(3.0, 10.0, tuple(centre), ease=0.5)]])
    pose, _, _, body = (state[0, 0] for state in reading.at([0.2]))
    rate, phi = slope * 0.2, 0.5 * slope * 0.04
    assert pose[2] == pytest.approx(phi)
    weight = -GRAVITY * np.array([np.sin(phi), np.cos(phi)])
    for point in ([0.0, 0.0], [0.1, 0.05]):
        y, z = arm = np.array(point) - centre
        expected = weight + rate**2 * arm + slope * np.array([z, -y])
        assert np.allclose(total_force(body, point), expected, rtol=1e-12, atol=0.0)


def test_body_force_of_shaking_is_inertia(probe):
    heave, sway = Heave(0.02, 3.0, 0.3), Sway(0.05, 2.0, 0.1)
    times = np.array([0.0, 0.13, 0.5])
    body = probe([[heave, sway]]).at(times)[3][0]
    for column, motion, weight in ((0, sway, 0.0), (1, heave, -GRAVITY)):
        omega = 2 * pi * motion.frequency
        inertia = motion.amplitude * omega**2 * np.sin(omega * times + motion.phase)
        assert np.allclose(body[:, column], weight + inertia, rtol=1e-12, atol=0.0)
    assert np.all(body[:, 2:] == 0.0)


def test_tank_at_rest_feels_weight_alone(probe):
    resting = probe([[], []])
    assert np.all(resting.at([0.0, 1.0])[3] == [0.0, -GRAVITY, 0.0, 0.0])
    assert not resting.frame.rotating and not resting.frame.moving


@pytest.mark.parametrize("angle, to_starboard", [(10 * DEG, -1), (-10 * DEG, 1)])
def test_a_negative_angle_tilts_to_starboard(probe, angle, to_starboard):
    body = probe([[Tilt(1.0, angle)]]).at([5.0])[3][0, 0]
    assert np.sign(body[0]) == to_starboard
    assert np.allclose(body[:2], GRAVITY * np.array([-np.sin(angle), -np.cos(angle)]), rtol=1e-12, atol=0.0)


def pulse(time, begin=0.5, end=3.5):
    """Displacement (T,) that swings up and down at 1.1 Hz between two instants and rests outside them."""
    within = np.clip((time - begin) / (end - begin), 0.0, 1.0)
    return 0.1 * np.sin(pi * within) ** 4 * np.sin(2 * pi * 1.1 * (time - begin))


def uneven(count, length, seed):
    """`count` rising times (s) from 0 to `length`, up to ten times as far apart here as there."""
    gaps = np.random.default_rng(seed).uniform(0.1, 1.0, count - 1)
    return length * np.concatenate([[0.0], np.cumsum(gaps)]) / gaps.sum()


def record(coordinate, time, values, centre=(0.0, 0.0)):
    return Recorded(coordinate, tuple(np.asarray(time).tolist()), tuple(np.asarray(values).tolist()), centre)


@pytest.mark.parametrize("coordinate, column", [("y", 0), ("z", 1), ("turn", 2)])
def test_record_is_the_cubic_spline_through_its_samples(probe, coordinate, column):
    times = [7.0 + uneven(4000, 4.0, seed) for seed in (1, 2)]
    reading = probe([[record(coordinate, time, pulse(time - 7.0))] for time in times])
    for w, time in enumerate(times):
        knots = time - 7.0
        spline = CubicSpline(knots, pulse(knots), bc_type="clamped")
        where = np.sort(np.concatenate([knots, np.random.default_rng(w).uniform(0, 4.0, 3000)]))
        for order, state in enumerate(reading.at(where)[:3]):
            exact = spline(where, order)
            assert np.abs(state[w, :, column] - exact).max() < 4e-15 * np.abs(exact).max()
            assert np.all(np.delete(state[w], column, axis=1) == 0.0)
        assert np.array_equal(reading.at(knots)[0][w, :, column], pulse(knots))


def test_record_of_a_harmonic_motion_moves_the_tank_like_it(probe):
    harmonic = Sway(0.04, 1.5, 0.3)
    where = np.linspace(0.0, 3.8, 4000)  # not up to the end, where the spline knows its neighbours on one side alone
    exact = [state[0, :, 0] for state in probe([[harmonic]], SOFT_START).at(where)[:3]]
    errors = []
    for spacing in (0.02, 0.01):
        time = np.arange(0.0, 4.0 + spacing / 2, spacing)
        samples = harmonic.amplitude * np.sin(2 * pi * harmonic.frequency * time + harmonic.phase)
        states = probe([[record("y", time, samples)]], SOFT_START).at(where)[:3]
        errors.append(
            [np.abs(state[0, :, 0] - e).max() / np.abs(e).max() for state, e in zip(states, exact, strict=True)]
        )
    # A cubic spline is in error by h⁴ in displacement and by h² in acceleration (de Boor 1978).
    assert errors[1][0] < 1e-6 and errors[1][2] < 2e-3
    assert errors[0][0] / errors[1][0] > 12 and errors[0][2] / errors[1][2] > 3.5


def test_derivatives_of_records_in_a_chain(probe):
    time = uneven(60, 4.0, 3)
    drift = 0.05 + 0.03 * np.cos(2 * time)  # neither starts nor ends at rest or at zero
    worlds = [
        [Tilt(0.3, 0.35, (0.02, 0.07), ease=0.15), *History(tuple(time), sway, heave, roll, centre).motions.values()]
        for sway, heave, roll, centre in (
            (tuple(pulse(time)), tuple(drift), tuple(2 * drift), (-0.3, 0.5)),
            (tuple(drift), tuple(pulse(time)), tuple(pulse(time)), (0.4, -0.2)),
        )
    ]
    knots = np.concatenate([time, [0.15, SOFT_START], [knot for knot, _ in worlds[0][0].knots()]])
    where = np.linspace(0.05, 3.95, 300)
    where = where[np.abs(where[:, None] - knots).min(axis=1) > 1e-3]
    assert_derivatives(probe(worlds, SOFT_START), where, tolerance=1e-7)


def test_acceleration_of_a_record_is_continuous(probe):
    time = uneven(50, 4.0, 4)
    reading = probe([[record("y", time, 0.1 * np.sin(3 * time))]])
    inner = time[1:-1]
    before, after = (reading.at(inner + side)[2][0, :, 0] for side in (-1e-9, 1e-9))
    assert np.abs(after - before).max() < 1e-6 * np.abs(after).max()


def test_record_is_at_rest_before_its_first_sample_and_stays_where_it_ends(probe):
    time = np.linspace(0.0, 4.0, 100)
    rising = 0.1 * np.sin(pi * time / 8.0) ** 2  # from rest at zero to rest at 0.1 m
    motion = record("z", time, rising)
    assert motion.rests == (True, True) and motion.duration() == 4.0
    reading = probe([[motion]])
    assert all(np.all(state == 0.0) for state in reading.at([-1e9, -1e-9])[:3])
    pose, velocity, acceleration, _ = reading.at([0.0, 4.0 + 1e-12, 5.0, 1e6])
    assert np.allclose(pose[0, :, 1], [0.0, 0.1, 0.1, 0.1], rtol=0, atol=1e-12)
    assert np.abs(velocity).max() < 1e-13 and np.all(acceleration[0, 1:] == 0.0)


def test_a_record_that_ends_in_motion_continues_without_a_jump(probe):
    time = np.linspace(0.0, 4.0, 200)
    motion = record("y", time, 0.1 * np.sin(3.0 * time))
    assert motion.rests == (False, False)
    pose, velocity, acceleration, _ = probe([[motion]]).at([4.0 - 1e-12, 4.0 + 1e-12, 4.5])
    speed = 0.3 * np.cos(12.0)
    assert velocity[0, :, 0] == pytest.approx([speed] * 3, rel=1e-4)
    assert pose[0, 1, 0] == pytest.approx(pose[0, 0, 0], abs=1e-11)
    assert pose[0, 2, 0] == pytest.approx(0.1 * np.sin(12.0) + 0.5 * velocity[0, 2, 0])
    assert np.all(acceleration[0, 1:] == 0.0)


def test_soft_start_eases_into_a_record_that_starts_anywhere(probe):
    time = np.linspace(0.0, 4.0, 200)
    values = 0.1 * np.cos(3.0 * time)
    early, after = np.linspace(0.0, SOFT_START, 200), np.linspace(SOFT_START, 4.0, 200)
    pose, velocity, acceleration, _ = probe([[record("y", time, values)]], SOFT_START).at(early)
    assert pose[0, 0, 0] == velocity[0, 0, 0] == acceleration[0, 0, 0] == 0.0
    spline = CubicSpline(time, values, bc_type=((1, 0.0), "not-a-knot"))  # it starts at rest and ends in motion
    assert np.allclose(pose[0, :, 0], transition(early / SOFT_START) * spline(early), rtol=0, atol=1e-15)
    pose = probe([[record("y", time[:100], values[:100])]], SOFT_START).at(after[after < time[99]])[0]
    assert np.allclose(pose[0, :, 0], 0.1 * np.cos(3.0 * after[after < time[99]]), rtol=0, atol=1e-6)


SAMPLES = st.lists(st.floats(-1.0, 1.0, allow_subnormal=False), min_size=4, max_size=12)


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(SAMPLES, st.integers(0, 100), st.sampled_from([0.0, 0.5, 3.0]))
def test_fastest_bounds_the_speed_of_a_record(values, seed, start):
    motion = record("y", uneven(len(values), 2.0, seed), values)
    time = np.linspace(0.0, 2.0, 5001)
    value, speed = motion.curve(time), motion.curve(time, 1)
    slope = np.gradient(transition(time / start), time) if start else 0.0
    reached = np.abs((transition(time / start) if start else 1.0) * speed + slope * value).max()
    assert reached <= motion.fastest(start) * (1 + 1e-3) + 1e-12
    if not start:
        assert reached >= 0.999 * motion.fastest(0.0)


def test_tank_rolls_about_a_centre_that_sways_and_heaves(probe):
    time = np.linspace(0.0, 4.0, 500)
    sway, heave, roll = 0.1 * np.sin(time) ** 2, 0.05 * np.sin(2 * time) ** 2, 0.4 * np.sin(1.5 * time) ** 2
    centre = np.array([0.2, -0.3])
    history = History(tuple(time), tuple(sway), tuple(heave), tuple(roll), tuple(centre))
    assert list(history.motions) == ["roll", "sway", "heave"]
    pose = probe([list(history.motions.values())]).at(time)[0][0]
    assert np.allclose(pose[:, 2], roll, rtol=0, atol=1e-15)
    # The tank's point that lies on the centre at rest follows sway and heave.
    c, s = np.cos(pose[:, 2]), np.sin(pose[:, 2])
    carried = pose[:, :2] + np.column_stack([c * 0.2 + s * 0.3, s * 0.2 - c * 0.3])
    assert np.allclose(carried, centre + np.column_stack([sway, heave]), rtol=0, atol=1e-14)


def test_unrecorded_coordinates_do_not_move():
    history = History((0.0, 1.0, 2.0, 3.0), heave=(0.0, 0.1, 0.1, 0.0))
    assert [motion.coordinate for motion in history.motions.values()] == ["z"]
