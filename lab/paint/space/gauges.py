"""Gauges in space: a ring on the wall for one of pressure, a dashed line with the level for one of depth."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from PIL import Image, ImageDraw

from lab.paint import palette
from lab.paint.footage import Bed
from lab.paint.painter import paint_strokes
from lab.paint.space.camera import SpaceCamera
from lab.paint.water.gauges import LETTERS, SMALLEST, dashes, ends_at, hues_of, paint_dot, write_beside
from lab.paint.water.pool import Pool
from solvers.fluid.given import Gauge
from solvers.fluid.walls.faces import Spot, spot_on

AROUND = 24  # lines of a ring
LEAST, LINE = 0.3, 0.1  # smallest radius of a ring and half its line's thickness, in u
OUT = 0.02  # of the tank's longest side, by which the far end of a name's direction is out of the wall


@dataclass(frozen=True)
class SpaceMarks:
    """The gauges of one tank; half: how far (m) it reaches along x; unit: a page's unit, pixels; hues by name."""

    outline: np.ndarray
    half: float
    periodic: bool
    pool: Pool
    hues: Mapping[str, tuple]
    unit: float
    paper: tuple = palette.PAPER

    @classmethod
    def of(cls, bed: Bed, hues: Sequence[tuple], unit: float, theme, first: tuple | None) -> "SpaceMarks | None":
        """The gauges of a bed, all in the hue `first` unless it is None; None where there are none."""
        footage = bed.footage
        pool = footage.water
        if not pool or not (pool.gauges or pool.levels):
            return None
        own = hues_of(pool, hues) if first is None else dict.fromkeys((*pool.gauges, *pool.levels), first)
        x = footage.space.walls.points[:, 2]
        return cls(footage.outline, 0.5 * float(np.ptp(x)), footage.space.periodic, pool, own, unit, theme.paper)

    def spot(self, gauge: Gauge) -> Spot:
        """Where a gauge of pressure is."""
        return spot_on(np.array([*gauge.place, gauge.x]), self.outline, self.half, not self.periodic)

    def paint(self, picture: np.ndarray, camera: SpaceCamera, depths: Mapping[str, float]) -> None:
        """Paint the gauges over a picture, in place, over all that is before them; depths (m) of those of depth."""
        u, turn = self.unit, 2.0 * np.pi * np.arange(AROUND + 1) / AROUND
        for name, gauge in self.pool.gauges.items():
            spot, scale = self.spot(gauge), camera.screen.scale
            radius = max(gauge.radius, LEAST * u / scale)
            ring = spot.foot + radius * np.column_stack([np.cos(turn), np.sin(turn)]) @ spot.along
            at, half = camera.pixels(ring), np.full(AROUND, LINE * u)
            paint_strokes(picture, np.column_stack([at[:-1], half, at[1:], half]), self.hues[name])
        for name, level in self.pool.levels.items():
            low, high = ends_at(self.outline, level.y)
            line = np.array([(level.y, low, level.x), (level.y, high, level.x)])
            paint_strokes(picture, dashes(*camera.pixels(line), u), self.hues[name])
            if np.isfinite(depth := depths.get(name, np.nan)):
                surface = np.array([(level.y, low + depth, level.x)])
                paint_dot(picture, camera.pixels(surface)[0], self.hues[name], 0.8 * u)

    def name(self, image: Image.Image, camera: SpaceCamera) -> None:
        """Write the gauges' names beside them."""
        u, draw, written = self.unit, ImageDraw.Draw(image), []
        if LETTERS * u < SMALLEST:
            return
        spots = [(name, self.spot(gauge)) for name, gauge in self.pool.gauges.items()]
        places = [(name, spot.foot, spot.normal) for name, spot in spots]
        for name, level in self.pool.levels.items():
            top = np.array([level.y, ends_at(self.outline, level.y)[1], level.x])
            places.append((name, top, np.array([0.0, 1.0, 0.0])))
        far = OUT * max(2.0 * self.half, float(np.ptp(self.outline, axis=0).max()))
        for name, place, outwards in places:
            at, out = camera.pixels(np.array([place, place + far * outwards]))
            away = float(np.linalg.norm(out - at))
            towards = (out - at) / away if away > 1e-9 else np.array([0.0, -1.0])
            write_beside(draw, name, (at, towards), u, self.hues[name], self.paper, written)
