"""Recordings for export, with places and poses that are known."""

from pathlib import Path

import numpy as np

from lab.preset.find import load
from lab.preset.recorded import to_table
from tests.oracles.synthetic import frame, of_a_ship, recorder, sample

SHIP, BOX = "ship/capsize-map", "space/tilting-box"
TIMES = np.array([0.0, 0.4, 1.0])  # s
PLACE = np.array([[-0.02, 0.02], [0.0, 0.02], [0.02, 0.02], [0.0, 0.031]])  # m, in the tank
SPEED = np.array([[0.1, 0.0], [0.0, 0.2], [-0.3, 0.1], [0.0, 0.0]])  # m/s
IN_SPACE = np.column_stack([PLACE, [0.01, -0.01, 0.0, 0.005]])


def pose_at(time: float, start: tuple[float, float]) -> np.ndarray:
    """Sway, heave (m) and roll (rad) of the ship."""
    return np.array([start[0] + 0.05 * time, start[1] - 0.02 * time, 0.6 * time])


def ship(folder: Path, worlds: int = 1, title: str = "A barge", lost: bool = False, close: bool = True) -> Path:
    """A barge that drifts and heels, with four grains; in the last frame the third has left the scene if `lost`."""
    preset = load(SHIP).resolved
    said, hold = to_table(preset) | {"title": title}, np.array(preset.tank.corners)
    writer = recorder(folder, worlds, resolved=said, outline=hold, kind=np.zeros((worlds, 4), dtype=np.uint8))
    for time in TIMES:
        pose = np.tile(pose_at(time, preset.ship.hold_at_rest), (worlds, 1))
        place = np.tile(PLACE, (worlds, 1, 1)) + 0.001 * time
        if lost and time == TIMES[-1]:
            place[:, 2] = np.nan
        writer.sample(sample(time, worlds, pose=pose, kinetic=np.full(worlds, 1.5 * time), **of_a_ship(worlds)))
        angle, velocity = np.full((worlds, 4), 0.25), np.tile(SPEED, (worlds, 1, 1))
        writer.frame(frame(time, worlds, pose=pose, position=place, velocity=velocity, angle=angle))
    if close:
        writer.close()
    else:
        writer.flush()
    return folder


def in_space(folder: Path) -> Path:
    """A box with four spheres that turns about all three axes."""
    preset = load(BOX).resolved
    said, hold = to_table(preset), np.array(preset.tank.corners)
    with recorder(folder, resolved=said, outline=hold, radius=np.full((1, 4), 0.006)) as writer:
        for time in TIMES:
            pose = np.array([[0.1, 0.2, 0.3, 0.4, -0.5, 0.6]]) * time
            writer.sample(sample(time, axes=3, faces=6, pose=pose))
            writer.frame(frame(time, axes=3, pose=pose, position=IN_SPACE[None]))
    return folder


def placed(points: np.ndarray, pose: np.ndarray) -> np.ndarray:
    """Points (n, 2) m of a tank in a pose (3,) in the earth's axes: (Y, Z) + R(φ) r, by sines and cosines."""
    y, z = points.T
    cosine, sine = np.cos(pose[2]), np.sin(pose[2])
    return np.column_stack([pose[0] + cosine * y - sine * z, pose[1] + sine * y + cosine * z])


def turn_of(pitch: float, yaw: float, roll: float) -> np.ndarray:
    """The matrix (3, 3) for vectors y, z, x of a roll, then a pitch, then a yaw about the earth's x, y and z."""
    (cr, sr), (cp, sp), (cy, sy) = ((np.cos(a), np.sin(a)) for a in (roll, pitch, yaw))
    about_x = np.array([(1, 0, 0), (0, cr, -sr), (0, sr, cr)])
    about_y = np.array([(cp, 0, sp), (0, 1, 0), (-sp, 0, cp)])
    about_z = np.array([(cy, -sy, 0), (sy, cy, 0), (0, 0, 1)])
    order = [1, 2, 0]  # y, z, x of x, y, z
    return (about_z @ about_y @ about_x)[np.ix_(order, order)]
