"""A part of the tank, larger, beside it: what floats, the surface where it flows most, or the gauge hit hardest."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lab.paint.colours import spread
from lab.paint.footage import Bed
from lab.paint.page.layout import Box, Layout
from lab.paint.page.theme import Theme
from lab.paint.painter import Camera, paint_strokes
from lab.paint.scene.view import SceneView

SHARE = 0.3  # of the tank's width that is shown
OUTSIDE = 0.08  # of the part's size that may lie outside the tank
TALL = 0.75  # of the inset's height: a long low tank is shown as large
LARGER = 1.6  # times the view's scale at least
HALF = 0.08  # half thickness in u of the frames around the part and its picture


@dataclass(frozen=True)
class Inset:
    """A part of the first bed: its middle (2,) m in the tank's axes, the box of its picture, pixels a metre, a unit."""

    view: SceneView
    middle: np.ndarray
    box: Box
    scale: float
    unit: float

    @classmethod
    def of(cls, view: SceneView, bed: Bed, what: str, layout: Layout) -> Inset | None:
        """The inset of this kind, None if there is none to show."""
        if what == "none" or "inset" not in layout.boxes:
            return None
        middle = _hardest_hit(bed) if what == "impact" else _afloat(bed)
        middle = _liveliest(bed) if middle is None else middle
        if middle is None:
            return None
        box = layout["inset"]
        wide, high = np.ptp(bed.footage.outline, axis=0)
        width = float(min(SHARE * wide, high / TALL * (box[2] - box[0]) / (box[3] - box[1])))
        scale = max((box[2] - box[0]) / width, LARGER * view.cameras[0].scale)
        size = np.array([box[2] - box[0], box[3] - box[1]]) / scale
        return cls(view, _moved_inside(middle, size, bed.footage.outline), box, scale, layout.unit)

    def paint(self, picture: np.ndarray, frame: int, theme: Theme) -> None:
        """Paint the part into its box, and its frame onto the tank, in place."""
        left, top, right, bottom = self.box
        size = np.array([right - left, bottom - top])
        moved = self.view.tank_camera(0, frame)
        turned = Camera(self.scale, (0.0, 0.0), moved.turn)
        offset = 0.5 * size - turned.pixels(self.middle[None])[0]
        part = np.empty((size[1], size[0], 3), dtype=np.uint8)
        part[:] = theme.paper
        self.view.paint_part(part, 0, frame, Camera(self.scale, tuple(offset), moved.turn))
        picture[top:bottom, left:right] = part
        half, at = HALF * self.unit, moved.pixels(self.middle[None])[0]
        reach = 0.5 * size * moved.scale / self.scale
        _paint_frame(picture, np.array([left, top]) + half, np.array([right, bottom]) - half, half, theme.accent)
        _paint_frame(picture, at - reach, at + reach, half, theme.accent)


def _paint_frame(picture: np.ndarray, low: np.ndarray, high: np.ndarray, half: float, colour: tuple) -> None:
    corners = np.array([low, (high[0], low[1]), high, (low[0], high[1]), low])
    thick = np.full((4, 1), half)
    paint_strokes(picture, np.hstack([corners[:-1], thick, corners[1:], thick]), colour)


def _moved_inside(middle: np.ndarray, size: np.ndarray, outline: np.ndarray) -> np.ndarray:
    """The middle (2,) of a part of this size (m), moved so that little of the part lies outside the tank."""
    edge = OUTSIDE * size
    low, high = outline.min(axis=0) - edge + 0.5 * size, outline.max(axis=0) + edge - 0.5 * size
    return np.where(low <= high, np.clip(middle, low, high), 0.5 * (low + high))


def _afloat(bed: Bed) -> np.ndarray | None:
    """Where the first floating body is in the middle of its way, in the tank's axes; None if there is none."""
    if not bed.footage.floating:
        return None
    name = bed.footage.floating[0]
    line, number = bed.footage.parts[name], list(bed.footage.parts).index(name)
    return np.median([bed.moved(line, number, frame).mean(axis=0) for _, frame in spread([bed], 25)], axis=0)


def _liveliest(bed: Bed) -> np.ndarray | None:
    """Where grains, or the water, move most over the whole film, in the tank's axes; None if it is empty."""
    if bed.empty and bed.footage.water is None:
        return None
    frames = [frame for _, frame in spread([bed], 25)]
    speeds = [_speed(bed, frame) for frame in frames]
    row = int(np.nanargmax([np.nanpercentile(speed, 95.0) for speed in speeds]))
    place = bed.water_position(frames[row]) if bed.empty else bed.position(frames[row])
    fast = speeds[row] >= np.nanpercentile(speeds[row], 90.0)
    return np.nanmedian(place[fast], axis=0)


def _speed(bed: Bed, frame: int) -> np.ndarray:
    return np.hypot(*bed.drops("water_velocity", frame).T) if bed.empty else bed.speed(frame)


def _hardest_hit(bed: Bed) -> np.ndarray | None:
    """The place of the gauge with the highest pressure; None without gauges."""
    pool = bed.footage.water
    if pool is None or not pool.gauges:
        return None
    highest = np.nanmax(bed.footage.measured("gauge_pressure")[:, bed.world], axis=0)
    return np.array(list(pool.gauges.values())[int(np.argmax(highest))].place)
