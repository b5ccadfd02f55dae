"""A camera in space: perspective, framing what it is to show, from any side.

Points are (y, z, x) as everywhere. From azimuth 0 and elevation 0 the picture is that of the plane: y to the right, z
upwards, x towards the viewer. A growing azimuth takes the camera to the right around the vertical.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from lab.paint.painter import Camera

AWAY = 5.0  # distance of the camera over the radius of the sphere around what it shows: a field of view of 23°


@dataclass(frozen=True)
class Gaze:
    """From where a camera looks where: at target (3,) m, from a distance (m), azimuth and elevation (rad).

    turned (3, 3): of the axes in which points are given, in those in which azimuth and elevation are; None: the same.
    """

    target: np.ndarray
    distance: float
    azimuth: float = 0.0
    elevation: float = 0.0
    turned: np.ndarray | None = None

    @cached_property
    def axes(self) -> np.ndarray:
        """Rows (3, 3): the picture's right and up, and the direction of the gaze, in the axes (y, z, x)."""
        round_, tilt = self.azimuth, self.elevation
        out = np.array([np.cos(tilt) * np.sin(round_), np.sin(tilt), np.cos(tilt) * np.cos(round_)])
        right = np.array([np.cos(round_), 0.0, -np.sin(round_)])
        rows = np.array([right, np.cross(out, right), -out])
        return rows if self.turned is None else rows @ self.turned

    @property
    def eye(self) -> np.ndarray:
        """Place (3,) of the camera, m."""
        return self.target - self.distance * self.axes[2]

    def seen(self, points: np.ndarray) -> np.ndarray:
        """Points (n, 3) m as (right, up, depth) from the camera, m."""
        return (np.asarray(points, dtype=float) - self.target) @ self.axes.T + [0.0, 0.0, self.distance]

    def flat(self, points: np.ndarray) -> np.ndarray:
        """Where points (n, 3) are seen in the picture's plane through the target: right, up (n, 2), m."""
        seen = self.seen(points)
        return self.distance * seen[:, :2] / seen[:, 2:]


@dataclass(frozen=True)
class SpaceCamera:
    """From metres in space to pixels: a gaze, and where the plane through its target lies in the picture.

    screen: camera for the points of that plane, right and up, m.
    """

    gaze: Gaze
    screen: Camera

    @property
    def focal(self) -> float:
        """Pixels for a unit of right over depth."""
        return self.screen.scale * self.gaze.distance

    def pixels(self, points: np.ndarray) -> np.ndarray:
        """Pixels (n, 2) of points (n, 3) in m."""
        return self.screen.pixels(self.gaze.flat(points))

    def shifted(self, left: float, top: float) -> "SpaceCamera":
        """This camera for a part of the picture whose first pixel is in this column and row."""
        return replace(self, screen=self.screen.shifted(left, top))

    def carried(self, place: np.ndarray, turned: np.ndarray) -> "SpaceCamera":
        """This earth camera for points of a tank at a place (3,) m, turned by a matrix (3, 3)."""
        return replace(self, gaze=replace(self.gaze, target=turned.T @ (self.gaze.target - place), turned=turned))

    def from_azimuth(self, azimuth: float) -> "SpaceCamera":
        """This camera, gone around its target to another azimuth (rad)."""
        return replace(self, gaze=replace(self.gaze, azimuth=azimuth))


def gaze_at(points: np.ndarray, azimuth: float, elevation: float, distance: float | None = None) -> Gaze:
    """A gaze at the middle of points (n, 3), m, from this distance (m), or far enough for a mild perspective."""
    low, high = np.min(points, axis=0), np.max(points, axis=0)
    middle = 0.5 * (low + high)
    around = float(np.linalg.norm(np.asarray(points) - middle, axis=1).max())
    return Gaze(middle, distance or AWAY * around, azimuth, elevation)


def ground(gaze: Gaze, shown: Iterable[tuple[float, np.ndarray]]) -> tuple[np.ndarray, np.ndarray]:
    """Lower and upper corner (2,) m of all that is seen in the picture's plane.

    shown: pairs of an azimuth (rad) and of points (n, 3) m that are seen from there.
    """
    low, high = np.full(2, np.inf), np.full(2, -np.inf)
    for azimuth, points in shown:
        seen = replace(gaze, azimuth=float(azimuth)).flat(points)
        low, high = np.minimum(low, seen.min(axis=0)), np.maximum(high, seen.max(axis=0))
    return low, high


def framing(
    gaze: Gaze, points: np.ndarray, azimuths: Sequence[float], box: tuple[float, float, float, float]
) -> SpaceCamera:
    """The camera that shows points (n, 3) as large as they fit into a box of pixels from all these azimuths.

    box: left, top, right, bottom. The scale is the same at all of them, so nothing grows or shrinks in an orbit.
    """
    low, high = ground(gaze, ((azimuth, points) for azimuth in azimuths))
    left, top, right, bottom = box
    scale = float((np.array([right - left, bottom - top]) / np.maximum(high - low, 1e-30)).min())
    middle = 0.5 * np.array([left + right, top + bottom]) - scale * 0.5 * (low + high) * [1.0, -1.0]
    return SpaceCamera(gaze, Camera(scale, (float(middle[0]), float(middle[1]))))


def orbit(azimuth: float, turns: float, time: np.ndarray) -> np.ndarray:
    """Azimuths (F,) rad at times (F,) s of a camera that goes round so many times during a film."""
    span = float(time[-1] - time[0])
    return azimuth + 2.0 * np.pi * turns * (time - time[0]) / span if span > 0.0 else np.full(len(time), azimuth)
