"""The angle of a drum's bed, of made courses of its centre of mass, and which measures look at a drum."""

from types import SimpleNamespace

import numpy as np
import pytest

from lab.measures import drum
from lab.measures.motion import is_tilt
from solvers.machine.quantity import ROLL

RATE, AWAY = 2.0, 0.055  # rad/s, m


def made(direction, last=5.0):
    """A drum that turns, whose bed stays 30 deg from straight below from 1 s on, but for a swing of 1 deg."""
    time = np.linspace(0.0, last, 501)
    roll = direction * RATE * time
    angle = np.radians(30.0) * np.minimum(time, 1.0) + np.radians(1.0) * np.sin(4.0 * np.pi * time)
    over = np.column_stack([direction * np.sin(angle), -np.cos(angle)])  # the earth's axes
    turned = np.column_stack(
        [np.cos(roll) * over[:, 0] + np.sin(roll) * over[:, 1], np.cos(roll) * over[:, 1] - np.sin(roll) * over[:, 0]]
    )
    centre = AWAY * np.append(turned, np.zeros((len(time), 1)), axis=1)
    pose = np.zeros((len(time), 1, 6))
    pose[:, 0, ROLL] = roll
    motion = SimpleNamespace(tilt=SimpleNamespace(angle=direction * 20.0))
    series = {"time": time, "pose": pose, "centre_of_mass": centre[:, None]}
    return SimpleNamespace(series=series, preset=SimpleNamespace(tank=SimpleNamespace(lies=True), motion=motion))


@pytest.mark.parametrize("direction", [1.0, -1.0])
def test_the_angle_is_from_straight_below_whichever_way_a_drum_turns(direction):
    """And is its mean after the first half turn, at 1.57 s, whole swings of it within a hundredth."""
    recording = made(direction)
    assert drum.applies(recording) and not is_tilt(recording)
    found = drum.measure(recording)
    assert found["bed_angle"].value == pytest.approx(30.0, abs=0.05)
    assert found["bed_angle_range"].value == pytest.approx(2.0, abs=0.01)
    assert found["bed_radius"].value == pytest.approx(1e3 * AWAY, rel=1e-9)


def test_a_drum_that_has_not_gone_half_round_has_no_angle_yet():
    assert not drum.applies(made(1.0, last=1.5))
