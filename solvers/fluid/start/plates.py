"""Water packed beside plates without thickness, which hide what is behind them, and round bodies."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from solvers.fluid.bodies.solids import TOUCHES, counter_clockwise, is_solid, line_of, prolonging, sheet
from solvers.fluid.given import Water
from solvers.fluid.start.lattice import from_edges
from solvers.fluid.start.packing import KEPT, PUSH, Crowd, Packing, area_of, below, relax, scattered
from solvers.fluid.start.parts import free_share
from solvers.fluid.walls.layers import layers
from solvers.tank.parts import Body, Part
from solvers.tank.tank import Tank

UPRIGHT = 1e-6  # sine of the angle to an axis below which a plate counts as parallel to it


@dataclass(frozen=True, eq=False)
class Line:
    """A plate from `start` (2,) m along the unit vector `way` (2,), that hides from `low` to `high` (m) on it."""

    start: np.ndarray
    way: np.ndarray
    low: float
    high: float

    def of(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """How far (m) the points (n, 2) m are along the plate and to its left."""
        y, z = (points - self.start).T
        return self.way[0] * y + self.way[1] * z, self.way[0] * z - self.way[1] * y

    def hides(self, a: np.ndarray, b: np.ndarray, blur: float) -> np.ndarray:
        """The share (n,) of points `b` (n, 2) m that is hidden from `a`, as of `Visibility`; `blur` (m) is its h."""
        (along, across), (along_b, across_b) = self.of(a), self.of(b)
        crossed = across * across_b < 0.0
        through = along - (along_b - along) * across / np.where(crossed, across_b - across, 1.0)
        deep = np.clip(np.minimum(through - self.low, self.high - through) / blur, 0.0, 1.0)
        return np.where(crossed, deep * deep * (3.0 - 2.0 * deep), 0.0)


class Parted(Crowd):
    """A crowd parted by the plates `lines`; `owner` (k,) is the one that a wall particle belongs to, −1 for none."""

    def __init__(self, crowd: tuple, lines: Sequence[Line], owner: np.ndarray):
        self.lines, self.owner = lines, owner
        super().__init__(*crowd)

    def look(self, skin: float) -> None:
        """As of `Crowd`; of all pairs notes those that each plate may part, and those with its own wall particles."""
        super().look(skin)
        reach, self.near = 2.0 * self.length + 2.0 * skin, []
        for q, line in enumerate(self.lines):
            near, dry = (self._near(line, points, reach) for points in (self.points, self.walls))
            own = self.owner[self.dry] == q
            inner = np.flatnonzero(near[self.first] & near[self.second])
            self.near.append((inner, np.flatnonzero(own | near[self.wet] & dry[self.dry])))

    @staticmethod
    def _near(line: Line, points: np.ndarray, reach: float) -> np.ndarray:
        along, across = line.of(points)
        return (np.abs(across) < reach) & (along > line.low - reach) & (along < line.high + reach)

    def parted(self, inner: np.ndarray, outer: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The weights of pairs of particles, and of particles and walls, of which plates hide what is behind them."""
        for q, (line, (here, there)) in enumerate(zip(self.lines, self.near, strict=True)):
            first, second = self.points[self.first[here]], self.points[self.second[here]]
            inner[here] *= 1.0 - line.hides(first, second, self.length)
            dry = self.dry[there]
            hidden = line.hides(self.points[self.wet[there]], self.walls[dry], self.length)
            outer[there] *= np.where(self.owner[dry] == q, hidden, 1.0 - hidden)
        return inner, outer


def is_slanted(part: Part) -> bool:
    """Whether a part is a plate that is parallel to no axis, beside which a lattice would end in steps."""
    way = np.subtract(part.points[1], part.points[0])
    return not is_solid(part) and bool(np.abs(way).min() > UPRIGHT * np.hypot(*way))


def packed_beside(
    polygon: np.ndarray, level: float, water: Water, parts: Sequence[Part], outline: np.ndarray
) -> Packing:
    """Particles that fill a polygon (m, 2) m up to a `level` (m) beside plates and round bodies, as of `packed`.

    The wall particles of plates and bodies are those of the run, and so is who sees whom past a plate (`Visibility`);
    ends that touch the tank's `outline` (m, 2) m reach on into it. Raises ValueError if no particle fits in.

    Limits: where a plate parts the water, the particles on either side are as many as the sequence has there, one more
    or less than their part of the area.
    """
    shapes = tuple((shape.tobytes(), shape.shape) for shape in (np.array(one, float) for one in (polygon, outline)))
    drawn = tuple((tuple(map(tuple, part.points)), is_solid(part)) for part in parts)
    return _packed(shapes, float(level), water.spacing, water.smoothing, drawn)


@lru_cache(maxsize=KEPT)
def _packed(shapes: tuple, level: float, spacing: float, smoothing: float, drawn: tuple) -> Packing:
    polygon, outline = (np.frombuffer(data).reshape(shape) for data, shape in shapes)
    parts = [Body(points, closed=closed) for points, closed in drawn]
    area = area_of(below(polygon, level)) * free_share(polygon, level, parts, spacing)
    polygon, count, rows = below(polygon, level), round(area / spacing**2), int(np.ceil(2.0 * smoothing - 1e-9))
    if count < 1:
        raise ValueError("no particle of this spacing fits in")
    alike = prolonging(parts, spacing)
    plates = [np.flatnonzero(row) for k, row in enumerate(alike) if row.any() and not row[:k].any()]
    drawn_as = [line_of(parts, members) for members in plates]
    solid = [counter_clockwise(part.points) for part in parts if is_solid(part)]
    holes = [below(one, level) for one in solid if one[:, 1].min() < level]
    found = [layers(polygon, spacing, rows), *(layers(hole[::-1], spacing, rows) for hole in holes)]
    owner = np.full(sum(len(points) for points, *_ in found), -1)
    found += [sheet(ends, spacing, rows) for ends in drawn_as]
    walls, volumes, _ = (np.concatenate(each) for each in zip(*found, strict=True))
    own = [np.full(len(points), q) for q, (points, *_) in enumerate(found[len(found) - len(plates) :])]
    lines = [_line(ends, outline, spacing, 2.0 * smoothing * spacing) for ends in drawn_as]
    points = scattered(polygon, holes, count)
    made = points, area / count, walls, volumes, smoothing * spacing
    crowd = Parted(made, lines, np.concatenate([owner, *own]))
    steps = relax(crowd, spacing, PUSH * min(1.0, smoothing / 2.0) ** 2)
    return Packing(crowd.points, area / count, spacing * crowd.pushes(), crowd.covers(), steps)


def _line(ends: np.ndarray, outline: np.ndarray, spacing: float, reach: float) -> Line:
    """A plate between two ends (2, 2) m in a tank, on into whose wall an end reaches that touches it."""
    length = float(np.hypot(*(ends[1] - ends[0])))
    touches = (from_edges(ends, outline) < TOUCHES * spacing) | ~Tank(outline, 1.0).holds(ends)
    low, high = np.where(touches, reach, 0.0)
    return Line(ends[0], (ends[1] - ends[0]) / length, -float(low), length + float(high))
