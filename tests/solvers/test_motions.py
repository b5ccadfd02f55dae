"""The tank's motions: pose, velocity and acceleration belong together, and the frame makes the right forces of them."""

from math import hypot, pi

import numpy as np
import pytest
import taichi as ti

from solvers import runtime
from solvers.frame import Frame
from solvers.motions import Heave, Roll, Sway, Tilt
from solvers.motions.harmonic import soft_start
from solvers.motions.tilt import KNOTS
from solvers.runtime import Arrays

DEG = pi / 180
GRAVITY = 9.81
SOFT_START = 0.8


@ti.data_oriented
class Probe:
    """Reads `Frame.kinematics` and `Frame.body_force` of each of W worlds at many times."""

    def __init__(self, motions, soft_start=0.0):
        runtime.initialise(1)
        self.worlds, self.arrays = len(motions), Arrays()
        self.frame = Frame(self.arrays, motions, soft_start, GRAVITY)
        self.arrays.finish()

    @ti.kernel
    def read(self, times: ti.types.ndarray(ti.f64, ndim=1), rows: ti.types.ndarray(ti.f64, ndim=3)):
        for k in range(times.shape[0]):
            for w in range(rows.shape[0]):
                state = self.frame.kinematics(w, times[k])
                body = self.frame.body_force(w, times[k])
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
    for given, found in (
        (velocity, slope(lambda t: probe.at(t)[0], times)),
        (acceleration, slope(lambda t: probe.at(t)[1], times)),
    ):
        size = np.abs(given).max(axis=1, keepdims=True)
        assert np.all((size > 0).any(axis=2)), "a motion that does not move tests nothing"
        assert np.abs(given - found).max() < tolerance * size.max()
        moving = np.broadcast_to(size, given.shape) > 0
        assert np.all(np.abs(given - found)[moving] < tolerance * np.broadcast_to(size, given.shape)[moving])
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
    assert TILTS["long"].duration() == pytest.approx(ends, rel=1e-14)
    assert TILTS["held"].duration() == pytest.approx(ends + 0.7, rel=1e-14)
    for name in ("long", "held"):
        angle, rate, acceleration = tilting(name, [ends + 1e-9, ends + 0.5, 1e6])
        assert np.allclose(angle, 0.5, rtol=1e-14)
        assert np.all(rate == 0.0) and np.all(acceleration == 0.0)


def test_tilt_eases_into_its_rate(tilting):
    times = np.array([0.1, 0.2, 0.6, 0.5 / 0.4, 0.5 / 0.4 + 0.1])
    angle, rate, acceleration = tilting("long", times)
    # The ramp turns by ½ (0.4/0.2) t², then the tank lags a steady turn by half the ease.
    assert np.allclose(angle, [0.01, 0.04, 0.4 * 0.5, 0.5 - 0.04, 0.5 - 0.01], rtol=1e-13)
    assert np.allclose(rate, [0.2, 0.4, 0.4, 0.4, 0.2], rtol=1e-13)
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
    assert TILTS["short"].duration() == pytest.approx(2 * 2 * half + 0.1, rel=1e-13)
    angle, rate, acceleration = tilting("short", [0.5 * half, half, 1.5 * half])
    assert np.allclose(angle, [0.03 / 8, 0.03 / 2, 0.03 * 7 / 8], rtol=1e-12)
    assert np.allclose(rate, [half, 2 * half, half], rtol=1e-12)
    assert np.allclose(acceleration[[0, 2]], [2.0, -2.0], rtol=1e-12)


def test_tilt_by_nothing_stays_upright(tilting):
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
            assert np.allclose(total_force(force, point), weight + rate**2 * (np.array(point) - centre), rtol=1e-12)
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
        assert np.allclose(total_force(body, point), weight + rate**2 * arm + slope * np.array([z, -y]), rtol=1e-12)


def test_body_force_of_shaking_is_inertia(probe):
    heave, sway = Heave(0.02, 3.0, 0.3), Sway(0.05, 2.0, 0.1)
    times = np.array([0.0, 0.13, 0.5])
    body = probe([[heave, sway]]).at(times)[3][0]
    for column, motion, weight in ((0, sway, 0.0), (1, heave, -GRAVITY)):
        omega = 2 * pi * motion.frequency
        inertia = motion.amplitude * omega**2 * np.sin(omega * times + motion.phase)
        assert np.allclose(body[:, column], weight + inertia, rtol=1e-12)
    assert np.all(body[:, 2:] == 0.0)


def test_tank_at_rest_feels_weight_alone(probe):
    resting = probe([[], []])
    assert np.all(resting.at([0.0, 1.0])[3] == [0.0, -GRAVITY, 0.0, 0.0])
    assert not resting.frame.rotating and not resting.frame.moving


@pytest.mark.parametrize("angle, to_starboard", [(10 * DEG, -1), (-10 * DEG, 1)])
def test_a_negative_angle_tilts_to_starboard(probe, angle, to_starboard):
    body = probe([[Tilt(1.0, angle)]]).at([5.0])[3][0, 0]
    assert np.sign(body[0]) == to_starboard
    assert np.allclose(body[:2], GRAVITY * np.array([-np.sin(angle), -np.cos(angle)]), rtol=1e-12)
