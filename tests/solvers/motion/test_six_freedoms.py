"""A tank that moves with all six freedoms: its pose and rates, and what flies and spins in it."""

import numpy as np
import pytest
import taichi as ti
from scipy.spatial.transform import Rotation

from solvers.machine.state import State
from solvers.motion import Heave, Pitch, Roll, Surge, Sway, Yaw
from solvers.motion.history import History
from solvers.motion.prescribed_in_space import GAIN, NUMBERS, PLACE, RATE, RISE, TURN, VELOCITY, PrescribedInSpace
from solvers.tank.solids.solid import Prism
from tests.oracles.scenes import box, simulation

G, SIDE, RADIUS, TIME = 9.81, 1.0, 3e-3, 0.4
SEA = (
    Sway(0.04, 0.9, 0.3),
    Heave(0.03, 1.1, 1.0),
    Surge(0.05, 0.8, 2.0),
    Roll(0.4, 0.7, 0.1, (0.02, 0.1)),
    Pitch(0.3, 0.6, 0.8, (0.1, -0.2)),
    Yaw(0.25, 0.5, 1.5, (-0.1, 0.3)),
)
ALONG, ABOUT = {"y": 0, "z": 1, "x": 2}, {"turn": 2, "pitch": 0, "yaw": 1}  # axes in the order y, z, x


def carried(motions, time, point):
    """Where a point (3,) of the tank is over the earth: turned and moved by one motion after the other."""
    for motion in motions:
        way = motion.amplitude * np.sin(2.0 * np.pi * motion.frequency * time + motion.phase)
        if motion.coordinate in ALONG:
            point = point + way * np.eye(3)[ALONG[motion.coordinate]]
            continue
        axis = ABOUT[motion.coordinate]
        centre = np.insert(np.array(motion.centre, dtype=float), axis, 0.0)
        point = centre + Rotation.from_rotvec(way * np.eye(3)[axis]).apply(point - centre)
    return point


@ti.data_oriented
class Probe:
    """What the carrier says at a time."""

    def __init__(self, motions):
        self.arrays = State("f64")
        self.carrier = PrescribedInSpace(self.arrays, [motions], 0.0, G)
        self.found = ti.field(ti.f64, NUMBERS + 21)

    @ti.kernel
    def fill(self, time: ti.f64):
        for _ in range(1):
            m, stands, frame = self.carrier.motion(0, time), self.carrier.stands(0, time), self.carrier.frame(0, time)
            for k in ti.static(range(NUMBERS)):
                self.found[k] = m[k]
            for k in ti.static(range(12)):
                self.found[NUMBERS + k] = stands[k]
            for k in ti.static(range(9)):
                self.found[NUMBERS + 12 + k] = frame[k]

    def at(self, time):
        """The motion, the pose with its rates, and the frame."""
        self.fill(time)
        return np.split(self.found.to_numpy(), [NUMBERS, NUMBERS + 12])


@pytest.fixture(scope="module")
def probe():
    from solvers.machine.runtime import initialise

    initialise()
    made = Probe(SEA)
    made.arrays.finish()
    yield made
    made.arrays.release()


def test_motions_are_composed_as_rotations_and_their_rates_follow(probe):
    """Against scipy's rotations, and central differences of the tank's points: to 1e-7 of a step of 1e-4 s."""
    time, h = 0.37, 1e-4
    points = np.vstack([np.zeros(3), np.eye(3)])
    path = np.array([[carried(SEA, t, point) for point in points] for t in (time - h, time, time + h)])
    turn = np.array([one[1:] - one[0] for one in path]).transpose(0, 2, 1)  # columns are the tank's axes
    m, stands, frame = probe.at(time)
    np.testing.assert_allclose(m[PLACE : PLACE + 3], path[1, 0], atol=1e-14)
    np.testing.assert_allclose(m[TURN : TURN + 9].reshape(3, 3), turn[1], atol=1e-14)
    np.testing.assert_allclose(m[VELOCITY : VELOCITY + 3], (path[2, 0] - path[0, 0]) / (2.0 * h), atol=1e-6)
    np.testing.assert_allclose(m[GAIN : GAIN + 3], (path[2, 0] - 2.0 * path[1, 0] + path[0, 0]) / h**2, atol=1e-5)
    rate = Rotation.from_matrix(turn[2] @ turn[0].T).as_rotvec() / (2.0 * h)
    np.testing.assert_allclose(m[RATE : RATE + 3], rate, atol=1e-6)
    later, before = (probe.at(time + step)[0][RATE : RATE + 3] for step in (h, -h))
    np.testing.assert_allclose(m[RISE : RISE + 3], (later - before) / (2.0 * h), atol=1e-6)
    np.testing.assert_allclose(stands[:3], path[1, 0], atol=1e-14)
    np.testing.assert_allclose(stands[6:12], m[VELOCITY : RATE + 3], atol=1e-14)
    down = -m[GAIN : GAIN + 3] - [0.0, G, 0.0]
    vectors = np.concatenate([turn[1].T @ vector for vector in (down, m[RATE : RATE + 3], m[RISE : RISE + 3])])
    np.testing.assert_allclose(frame, vectors, atol=1e-12)


def test_the_angles_are_those_of_the_motions(probe):
    """With roll innermost, then pitch, then yaw, the recorded angles are the prescribed ones, in the order θ, ψ, φ."""
    for time in (0.0, 0.3, 0.8):
        angles = {m.coordinate: m.amplitude * np.sin(2 * np.pi * m.frequency * time + m.phase) for m in SEA}
        given = [angles[name] for name in ("pitch", "yaw", "turn")]
        np.testing.assert_allclose(probe.at(time)[1][3:6], given, atol=1e-14)


def test_signs_are_those_of_ships(probe):
    """A positive pitch lifts the bow, x < 0; a positive yaw takes it to port, y < 0; a roll takes starboard up."""
    turn = probe.at(0.1)[0][TURN : TURN + 9].reshape(3, 3)
    _, stands, _ = probe.at(0.1)
    pitch, yaw, roll = stands[3:6]
    bow, starboard = turn @ [0.0, 0.0, -1.0], turn @ [1.0, 0.0, 0.0]
    assert min(pitch, yaw, roll) > 0.05
    assert bow[1] > 0.0 > bow[0]
    assert starboard[1] > 0.0


def flown(step, schedule="auto"):
    """Velocity, spin and place over the earth (6, 3) of a sphere that flies in the tank without gravity."""
    place, velocity, spin = (
        np.array([[0.05, 0.45, -0.1]]),
        np.array([[0.1, -0.05, 0.2]]),
        np.array([[20.0, -30.0, 10.0]]),
    )
    run = simulation(
        place[None], RADIUS, box(SIDE, SIDE), velocity=velocity[None], spin=spin[None], gravity=0.0, step=step,
        motions=[SEA], soft_start=0.0, solid=Prism(SIDE), tangential="mindlin", schedule=schedule,
    )  # fmt: skip
    seen = []
    for _ in range(6):
        rows, state = run.observe(), run.snapshot()
        pose, rates = rows["pose"][0], rows["pose_rate"][0]
        pitch, yaw, roll = pose[3:]
        turn = Rotation.from_rotvec([0.0, yaw, 0.0]) * Rotation.from_rotvec([pitch, 0.0, 0.0])
        turn = turn * Rotation.from_rotvec([0.0, 0.0, roll])
        at, relative, own = (turn.apply(state[name][0, 0]) for name in ("position", "velocity", "spin"))
        seen.append([rates[:3] + relative + np.cross(rates[3:], at), own + rates[3:], pose[:3] + at])
        run.advance(round(TIME / step / 5))
    run.arrays.release()
    return np.array(seen).swapaxes(0, 1)


@pytest.mark.slow
def test_neither_velocity_nor_spin_change_over_the_earth():
    """A force-free sphere flies straight on and spins on, to second order in the step: half the step, a quarter."""
    errors = []
    for step in (2e-4, 1e-4):
        velocity, spin, place = flown(step)
        straight = place[0] + velocity[0] * np.linspace(0.0, TIME, 6)[:, None]
        apart = velocity - velocity[0], spin - spin[0], place - straight
        errors.append([np.abs(values).max() for values in apart])
    coarse, fine = np.array(errors)
    assert (fine < [1e-4, 1e-2, 1e-4]).all()
    np.testing.assert_allclose(coarse / fine, 4.0, rtol=0.2)


@pytest.mark.slow
def test_grain_by_grain_a_sphere_flies_as_world_by_world():
    """The frame's nine numbers go by way of arrays; the same but for rounding."""
    for found, usual in zip(flown(2e-4, "per-grain"), flown(2e-4), strict=True):
        np.testing.assert_allclose(found, usual, rtol=1e-12, atol=1e-12)


@pytest.mark.slow
def test_a_record_turns_a_tank_about_a_skew_axis(probe):
    """Angles of a turn at a constant rate about (2, 3, 1): the rate of turning stays, and a point is pulled inwards.

    Splines through 400 samples of a quarter of a turn are within 1e-6 of it.
    """
    axis, rate, count = np.array([2.0, 3.0, 1.0]) / np.sqrt(14.0), 0.8, 400
    time = np.linspace(0.0, 2.0, count)
    yaw, pitch, roll = Rotation.from_rotvec(rate * time[:, None] * axis).as_euler("YXZ").T  # of axes y, z, x
    surge = 0.1 * time**2
    columns = {"roll": roll, "pitch": pitch, "yaw": yaw, "surge": surge}
    record = History(tuple(time), **{name: tuple(values) for name, values in columns.items()})
    made = Probe(tuple(record.motions.values()))
    made.arrays.finish()
    m, _, frame = made.at(1.1)
    made.arrays.release()
    np.testing.assert_allclose(m[RATE : RATE + 3], rate * axis, atol=1e-6)
    np.testing.assert_allclose(m[RISE : RISE + 3], 0.0, atol=1e-4)
    np.testing.assert_allclose(m[GAIN : GAIN + 3], [0.0, 0.0, 0.2], atol=1e-4)
    felt = Rotation.from_rotvec(-rate * 1.1 * axis).apply([0.0, -G, -0.2])
    np.testing.assert_allclose(frame[:3], felt, atol=1e-4)
