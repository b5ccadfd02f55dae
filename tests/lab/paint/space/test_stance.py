"""Stances of tanks: recorded angles of pitch, yaw and roll as one turn."""

from types import SimpleNamespace

import numpy as np
from scipy.spatial.transform import Rotation

from lab.paint.space.scene import scene_in_space
from lab.paint.space.stance import carried, stances
from solvers.tank.solids.solid import Prism


def test_recorded_angles_turn_a_point_by_roll_then_pitch_then_yaw():
    """About the axes x, y and z of the earth, in the order y, z, x of all arrays."""
    pose, point = np.array([[0.1, 0.2, 0.3, 0.4, -0.5, 0.6]]), np.array([0.3, -0.2, 0.7])
    pitch, yaw, roll = pose[0, 3:]
    for axis, angle in ((2, roll), (0, pitch), (1, yaw)):
        point = Rotation.from_rotvec(angle * np.eye(3)[axis]).apply(point)
    found = carried(np.array([[0.3, -0.2, 0.7]]), stances(pose)[0])
    np.testing.assert_allclose(found[0], pose[0, :3] + point, atol=1e-14)


def test_a_recorded_pose_is_turned_into_a_stance_once():
    """In the scene of a footage: its turn is that of pitch, yaw and roll, not that of a vector of these."""
    pose = np.array([[[0.1, 0.2, 0.3, 0.4, -0.5, 0.6]]])
    still = np.zeros((1, 1, 0, 3))
    footage = SimpleNamespace(
        pose=pose, series_pose=pose, outline=np.array([[-1.0, 0.0], [1.0, 0.0], [1.0, 1.0], [-1.0, 1.0]]),
        open_edges=(), parts={}, part=still, part_turn=still, part_pitch_yaw=None,
    )  # fmt: skip
    preset = SimpleNamespace(tank=SimpleNamespace(solid=Prism(1.0)), ship=None)
    found = scene_in_space(preset, footage).stance[0, 0]
    expected = Rotation.from_euler("YXZ", [-0.5, 0.4, 0.6]).as_rotvec()
    np.testing.assert_allclose(found, [0.1, 0.2, 0.3, *expected], atol=1e-14)


def test_a_tank_that_rolls_alone_keeps_its_numbers_even_past_half_a_turn():
    pose = np.array([[0.1, 0.2, 0.0, 0.0, 0.0, 4.0]])
    np.testing.assert_array_equal(stances(pose), pose)
    np.testing.assert_array_equal(stances(pose[:, [0, 1, 5]]), pose)
