"""Gauges where they are: a dot on the wall for one of pressure, a dashed line with the level on it for one of depth."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from PIL import Image, ImageDraw

from lab.paint import decorations as deco
from lab.paint import palette
from lab.paint.painter import Camera, paint_strokes
from lab.paint.water.pool import Pool
from solvers.fluid.given import Gauge

DOT, RING, BAR = 0.36, 0.12, 0.2  # radius of a dot, width of its white ring, half thickness of a sensor, in u
DASH, SPACE, THIN = 0.45, 0.4, 0.055  # of the line of a depth gauge: lengths and half thickness, in u
AWAY, LETTERS = 0.75, 0.95  # distance of a name from the wall's inner face and its height, in u
LONG = 0.9  # u, half the length of a name that is too long to stand beside the tank
TRIES = (0.0, 1.0, -1.0, 2.0, -2.0, 3.0, 4.0)  # how far along the wall a name is moved off others, over its size
SMALL = 0.4  # least size of a dot, over the usual one
SMALLEST = 7.0  # pixels; smaller letters are left out
OF_TANK = 0.04  # largest u, over the larger side of the tank in the picture


@dataclass(frozen=True)
class Marks:
    """The gauges of one tank in a picture; unit: a page's unit, pixels; hues: of the gauges by name, 0..255.

    paper: the colour around them.
    """

    outline: np.ndarray
    pool: Pool
    hues: Mapping[str, tuple]
    unit: float
    paper: tuple = palette.PAPER

    def paint(self, picture: np.ndarray, camera: Camera, depths: Mapping[str, float]) -> None:
        """Paint the gauges over a picture, in place; camera: of the tank's points; depths (m) of those of depth."""
        u = self._u(camera)
        small = self._apart(camera, u)
        for name, gauge in self.pool.gauges.items():
            self._paint_sensor(picture, camera, gauge, self.hues[name], small)
        for name, level in self.pool.levels.items():
            low, high = ends_at(self.outline, level.y)
            ends = camera.pixels(np.array([(level.y, low), (level.y, high)]))
            paint_strokes(picture, dashes(*ends, u), self.hues[name])
            if np.isfinite(depths.get(name, np.nan)):
                surface = camera.pixels(np.array([(level.y, low + depths[name])]))[0]
                paint_dot(picture, surface, self.hues[name], 0.8 * u)

    def name(self, image: Image.Image, camera: Camera) -> None:
        """Write the gauges' names beside them, outside the tank."""
        u, draw = self._u(camera), ImageDraw.Draw(image)
        if LETTERS * u < SMALLEST:
            return
        places = [(name, np.array(gauge.place), self._wall(gauge)[1]) for name, gauge in self.pool.gauges.items()]
        for name, level in self.pool.levels.items():
            places.append((name, np.array([level.y, ends_at(self.outline, level.y)[1]]), np.array([0.0, 1.0])))
        written: list[tuple[np.ndarray, np.ndarray]] = []
        for name, place, outwards in places:
            self._write(draw, camera, name, (place, outwards), written)

    def _apart(self, camera: Camera, u: float) -> float:
        """The unit of the dots, so small that those of gauges beside each other can be told apart."""
        places = camera.pixels(np.array([gauge.place for gauge in self.pool.gauges.values()]).reshape(-1, 2))
        away = np.linalg.norm(places[:, None] - places, axis=2)
        nearest = away[away > 0.0].min(initial=np.inf)
        return min(u, max(SMALL * u, 0.5 * nearest / DOT))

    def _u(self, camera: Camera) -> float:
        return min(self.unit, OF_TANK * camera.scale * float(np.ptp(self.outline, axis=0).max()))

    def _write(self, draw: ImageDraw.ImageDraw, camera: Camera, name: str, spot: tuple, written: list) -> None:
        """Write a name outwards of a place in the tank, beside those that are `written`."""
        u, (place, outwards) = self._u(camera), spot
        at, out = camera.pixels(place[None])[0], camera.pixels(np.array([place, place + outwards]))
        towards = (out[1] - out[0]) / camera.scale
        half = 0.5 * deco.font(LETTERS * u, bold=True).getlength(name)
        if abs(towards[0]) > abs(towards[1]) and half > LONG * u:
            towards = -towards  # beside the tank there is no room for it
        write_beside(draw, name, (at, towards), u, self.hues[name], self.paper, written)

    def _paint_sensor(self, picture: np.ndarray, camera: Camera, gauge: Gauge, hue: tuple, u: float) -> None:
        along, outwards = self._wall(gauge)
        middle, half = np.array(gauge.place), 0.5 * gauge.length
        ends = camera.pixels(np.array([middle - half * along, middle + half * along]))
        ends += BAR * u * (camera.pixels(outwards[None]) - camera.pixels(np.zeros((1, 2)))) / camera.scale
        paint_strokes(picture, np.array([[*ends[0], BAR * u, *ends[1], BAR * u]]), hue)
        paint_dot(picture, ends.mean(axis=0), hue, u)

    def _wall(self, gauge: Gauge) -> tuple[np.ndarray, np.ndarray]:
        """Directions along the wall that a gauge is in, and out of the tank."""
        first, place = self.outline, np.array(gauge.place)
        edge = np.roll(first, -1, axis=0) - first
        on = np.clip(((place - first) * edge).sum(axis=1) / (edge**2).sum(axis=1), 0.0, 1.0)
        away = np.linalg.norm(first + on[:, None] * edge - place, axis=1)
        along = edge[np.argmin(away)] / np.linalg.norm(edge[np.argmin(away)])
        return along, np.array([along[1], -along[0]])  # an outline runs counter-clockwise


def write_beside(
    draw: ImageDraw.ImageDraw, name: str, spot: tuple, u: float, hue: tuple, paper: tuple, written: list
) -> None:
    """Write a name beside a spot, a place and a direction in pixels, where it covers none of those that are `written`.

    u: pixels a unit; paper: the colour around the letters. `written` are the middles and halves (pixels) of names.
    """
    at, towards = spot
    face = deco.font(LETTERS * u, bold=True)
    half = 0.5 * np.array([face.getlength(name), LETTERS * u])  # of the text, so that it clears the dot
    at = at + towards * (AWAY * u + np.abs(towards) @ half)
    along = np.array([0.0, -2.0 * half[1]] if abs(towards[0]) > abs(towards[1]) else [2.0 * half[0], 0.0])
    tries = (at + step * along for step in TRIES)
    at = next((one for one in tries if not any((abs(one - m) < 0.95 * (half + h)).all() for m, h in written)), at)
    written.append((at, half))
    draw.text(tuple(at), name, hue, face, "mm", stroke_width=2, stroke_fill=paper)


def hues_of(pool: Pool, series: Sequence[tuple] = palette.SERIES) -> dict[str, tuple]:
    """A colour of a series for each gauge, by name."""
    names = (*pool.gauges, *pool.levels)
    return {name: series[k % len(series)] for k, name in enumerate(names)}


def ends_at(outline: np.ndarray, y: float) -> tuple[float, float]:
    """Lowest and highest point (m) of a tank with this outline (m, 2) m at a place y (m)."""
    after = np.roll(outline, -1, axis=0)
    crossed = (outline[:, 0] - y) * (after[:, 0] - y) <= 0.0
    heights = []
    for (y0, z0), (y1, z1) in zip(outline[crossed], after[crossed], strict=True):
        heights += [z0, z1] if y0 == y1 else [z0 + (z1 - z0) * (y - y0) / (y1 - y0)]
    return (min(heights), max(heights)) if heights else tuple(outline[:, 1][[0, 0]])


def paint_dot(picture: np.ndarray, at: np.ndarray, hue: tuple, u: float) -> None:
    """Paint a dot with a white ring at a pixel."""
    for radius, colour in ((DOT + RING, palette.PAPER), (DOT, hue)):
        paint_strokes(picture, np.array([[*at, radius * u, *at, radius * u]]), colour)


def dashes(first: np.ndarray, second: np.ndarray, u: float) -> np.ndarray:
    """Strokes (k, 6) of a dashed line between two pixels."""
    length = max(float(np.linalg.norm(second - first)), 1e-9)
    begin = np.arange(0.0, length, (DASH + SPACE) * u)
    shares = np.column_stack([begin, np.minimum(begin + DASH * u, length)]) / length
    ends = first + shares[..., None] * (second - first)
    half = np.full(len(begin), max(THIN * u, 0.6))
    return np.column_stack([ends[:, 0], half, ends[:, 1], half])
