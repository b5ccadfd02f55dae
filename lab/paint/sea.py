"""What carries a tank, in a picture.

A ship and the sea: the hull around the tank, and the water up to the free surface. An axle, and the mass that slides on
a rail through it, as lines.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from lab.assembly.ship import make_water, make_waves
from lab.paint import palette
from lab.paint.painter import Camera, paint_tank
from lab.preset.schema import Preset
from lab.preset.sections.axle import Axle
from solvers.ship.waves import Waves, soft_start

WATER, SURFACE = (214, 230, 243), (70, 130, 180)
LINE = 0.12  # thickness of the surface's line, in the units of a page
HATCH = 4  # the edge of a box's outline that its hatch leaves open: see `Ship.corners`
AROUND = np.array([0.45, 0.2])  # width of the sea shown beside, and above and below the hull, relative to her size
BEYOND = 1.3  # of the farthest place of the mass: half the rail's length
BLOCK = 0.18  # of half the rail: half the mass's side
PIVOT = 0.012  # of the tank's width: half the axle's size
SQUARE = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, 1.0]])
CROSS = np.array([[-1.0, -1.0], [1.0, 1.0], [0.0, 0.0], [-1.0, 1.0], [1.0, -1.0]])


class Sea:
    """The hull and the waves of a ship's recording; preset: of the ship.

    `waves`: the waves of a frame (`recording.WAVES`) if a user has changed those of the preset, or None.
    """

    waves: np.ndarray | None = None

    def __init__(self, preset: Preset) -> None:
        self.ship, self._sea = preset.ship, preset.waves
        self._water = make_water(preset.sea, preset.run.gravity)

    @property
    def hull(self) -> np.ndarray:
        """The hull's outline (m, 2) in the tank's frame, m."""
        return self.ship.corners - np.array(self.ship.hold)

    def paint_hull(self, picture: np.ndarray, camera: Camera, thick: float) -> None:
        """Paint the hull with walls `thick` pixels thick and an open hatch; the camera is that of the tank's points."""
        paint_tank(picture, camera, self.hull, thick, palette.WALL, palette.LINE, (HATCH,) if self.ship.hatch else ())
        if self.ship.hatch:
            inside = self.hull[[HATCH + 2, HATCH - 1, HATCH, HATCH + 1]]
            paint_tank(picture, camera, inside, thick, palette.WALL, palette.HOLD, (0, 2))

    @property
    def soft_start(self) -> float:
        """Time (s) in which the waves reach their full height."""
        return self._sea.soft_start if self._sea else 0.0

    @cached_property
    def _waves(self):
        return make_waves(self._sea, self._water)

    @cached_property
    def _of_height_one(self) -> Waves:
        return make_waves(replace(self._sea, height=1.0), self._water)

    def elevation(self, y: np.ndarray, time: float) -> np.ndarray:
        """Elevation (k,) m of the free surface at positions y (k,) m, in the earth frame."""
        if self.waves is None or np.isnan(self.waves[0]):
            return np.zeros(len(y)) if self._waves is None else self._waves.elevation(y, time)
        height, frequency, number = self.waves
        if np.isnan(frequency):
            return height * self._of_height_one.elevation(y, time)
        return height * soft_start(time, self.soft_start) * np.cos(number * y - frequency * time)

    def ground(self, hulls: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper corner (m) of the part that is shown, from all positions (k, 2) m of the hull's corners."""
        room = AROUND * np.ptp(self.hull, axis=0).max()
        return hulls.min(axis=0) - room, hulls.max(axis=0) + room * (1.0, 0.5)

    def paint(self, picture: np.ndarray, camera: Camera, ground: tuple, time: float, thick: float) -> None:
        """Paint the water into the ground's box of a picture, in place."""
        height, width, _ = picture.shape
        (left, bottom), (right, top) = camera.pixels(np.array(ground))
        columns = np.arange(max(0, round(left)), min(width, round(right)))
        rows = np.arange(max(0, round(top)), min(height, round(bottom)))
        y = (columns + 0.5 - camera.offset[0]) / camera.scale
        surface = camera.offset[1] - camera.scale * self.elevation(y, time)
        if not len(rows) or not len(columns):
            return
        # Above the highest and below the lowest point of the surface all pixels of a row are equal.
        first = int(np.clip(np.floor(surface.min() - thick - 2.0), rows[0], rows[-1] + 1))
        last = int(np.clip(np.ceil(surface.max() + thick + 2.0), first, rows[-1] + 1))
        picture[last : rows[-1] + 1, columns[0] : columns[-1] + 1] = WATER
        box = picture[first:last, columns[0] : columns[-1] + 1].astype(float)
        row = np.arange(first, last)[:, None]
        below = np.clip(row + 1.0 - surface, 0.0, 1.0)[..., None]
        box += below * (np.array(WATER) - box)
        line = np.clip(0.5 * thick + 0.5 - np.abs(row + 0.5 - surface), 0.0, 1.0)[..., None]
        box += line * (np.array(SURFACE) - box)
        picture[first:last, columns[0] : columns[-1] + 1] = np.round(box).astype(np.uint8)


@dataclass(frozen=True, eq=False)
class Rail:
    """The rail of a tank `width` m wide; `time` (T,) s and `slide` (T, W) m of the mass along it."""

    axle: Axle
    width: float
    time: np.ndarray
    slide: np.ndarray

    def lines(self, world: int, time: float) -> list[np.ndarray]:
        """Polylines (k, 2) m in the tank's axes at a time (s): the axle, the rail, and the mass as a crossed square."""
        pivot = np.array(self.axle.place)
        found = [pivot + PIVOT * self.width * CROSS]
        if self.axle.slide is not None:
            half = BEYOND * max(float(np.abs(self.slide).max(initial=0.0)), 0.02 * self.width)
            mass = np.add(pivot, [float(np.interp(time, self.time, self.slide[:, world])), 0.0])
            found += [pivot + np.array([[-half, 0.0], [half, 0.0]]), mass + BLOCK * half * SQUARE]
        return found
