"""What carries a tank, in a picture.

A ship and the sea: the hull around the tank, and the water up to the free surface. An axle, and the mass that slides on
a rail through it, as lines.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from lab.assembly.ship import make_water, make_waves
from lab.paint.page.theme import LIGHT, Theme
from lab.paint.painter import Camera
from lab.paint.scene.backdrop import paint_sea
from lab.paint.scene.ship import paint_hull, paint_superstructure
from lab.preset.schema import Preset
from lab.preset.sections.axle import Axle
from solvers.ship.waves import Waves, soft_start

LINE = 0.12  # thickness of the surface's line, in the units of a page
GRAVITY = 9.81  # m/s², for the wave number
AROUND = np.array([0.06, 0.03])  # room beside, and above and below the hull, relative to her size
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

    def paint_hull(
        self, picture: np.ndarray, camera: Camera, thick: float, theme: Theme = LIGHT, unit: float = 0.0
    ) -> None:
        """Paint the hull with plates `thick` pixels thick and an open hatch; the camera is that of the tank's points.

        unit: pixels of a page's unit; without it, only the plates.
        """
        paint_hull(picture, camera, self.ship, thick, theme, unit)

    def paint_superstructure(self, picture: np.ndarray, camera: Camera, theme: Theme = LIGHT) -> None:
        """Paint the silhouette of her superstructure; the camera is that of the tank's points."""
        paint_superstructure(picture, camera, self.ship, theme)

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

    @property
    def _decay(self) -> float:
        """Wave number (1/m) of the main frequency over deep water, ω²/g; 0 without waves."""
        frequency = self._sea.frequency if self._sea else 0.0
        if self.waves is not None and np.isfinite(self.waves).all():
            frequency = float(self.waves[1])
        return frequency**2 / GRAVITY

    def ground(self, hulls: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper corner (m) of the part that is shown, from all positions (k, 2) m of the hull's corners."""
        room = AROUND * np.ptp(self.hull, axis=0).max()
        return hulls.min(axis=0) - room, hulls.max(axis=0) + room

    def paint(
        self, picture: np.ndarray, camera: Camera, ground: tuple, time: float, thick: float, theme: Theme = LIGHT
    ) -> None:
        """Paint the water into the ground's box (m) of a picture, in place."""
        (left, bottom), (right, top) = camera.pixels(np.array(ground))
        self.paint_box(picture, camera, (round(left), round(top), round(right), round(bottom)), time, thick, theme)

    def paint_box(
        self, picture: np.ndarray, camera: Camera, box: tuple, time: float, thick: float, theme: Theme = LIGHT
    ) -> None:
        """Paint the water into a box (left, top, right, bottom) of pixels, in place; camera: of the earth's points."""
        height, width, _ = picture.shape
        left, right = max(0, box[0]), min(width, box[2])
        top, bottom = max(0, box[1]), min(height, box[3])
        if left >= right or top >= bottom:
            return
        y = (np.arange(left, right) + 0.5 - camera.offset[0]) / camera.scale
        surface = camera.offset[1] - camera.scale * self.elevation(y, time)
        decay = self._decay / camera.scale
        paint_sea(picture, (left, top, right, bottom), camera.offset[1], surface, thick, theme, decay)


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
