"""What is not made of particles: tank, parts, hull and waterline, as lines in the plane and as faces in space."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from lab.paint.space.stance import carried

if TYPE_CHECKING:
    from lab.paint.footage import Bed
    from lab.paint.space.walls import Walls
    from lab.preset.schema import Preset

WIDE, PIECES = 1.5, 128  # of a waterline: how far it goes on either side, in breadths of the hull, and its pieces


@dataclass(frozen=True)
class Shape:
    """Corners (m, 3) m, and which of them each cell joins; `filled`: whether cells are faces, else they are lines.

    number (c,): of what each cell is a piece of, an index into `names`.
    """

    points: np.ndarray
    cells: tuple[np.ndarray, ...]
    filled: bool
    number: np.ndarray
    names: tuple[str, ...]

    def at(self, points: np.ndarray) -> Shape:
        """The same with its corners elsewhere."""
        return replace(self, points=points)


@dataclass(frozen=True)
class Things:
    """Functions of a picture's number: `inside` by name, in the tank's axes; the waterline in the earth's."""

    inside: Mapping[str, Callable[[int], Shape]]
    waterline: Callable[[int, np.ndarray], Shape] | None


def things_of(preset: Preset, bed: Bed) -> Things:
    """The things of a bed."""
    footage = bed.footage
    inside: dict[str, Callable[[int], Shape]] = {}
    if footage.space is None:
        tank = lines_shape("tank", _edges(footage.basins))
        inside["tank"] = lambda row: tank
        if names := _part_names(bed):
            inside["parts"] = partial(_parts, bed, names)
        if footage.sea:
            hull = lines_shape("hull", [_closed(footage.sea.hull)])
            inside["hull"] = lambda row: hull
    else:
        tank = faces_shape(["tank"], [footage.space.walls])
        inside["tank"] = lambda row: tank
        if footage.space.plates:
            inside["parts"] = partial(_plates, bed)
        if footage.space.hull is not None:
            hull = faces_shape(["hull"], [footage.space.hull])
            inside["hull"] = lambda row: hull
    return Things(inside, partial(_waterline, bed, _along(preset)) if footage.sea else None)


def lines_shape(names: str | Sequence[str], lines: Sequence[np.ndarray]) -> Shape:
    """Lines (m, 2) m in the plane; each has a name, or all one."""
    named = (names,) if isinstance(names, str) else tuple(dict.fromkeys(names))
    number = [0] * len(lines) if isinstance(names, str) else [named.index(name) for name in names]
    starts = np.cumsum([0, *map(len, lines)])
    cells = tuple(np.arange(a, b) for a, b in pairwise(starts))
    flat = np.concatenate([np.zeros((0, 2)), *lines])
    return Shape(np.column_stack([flat, np.zeros(len(flat))]), cells, False, np.array(number, dtype=int), named)


def faces_shape(names: Sequence[str], walls: Sequence[Walls]) -> Shape:
    """The faces of walls, each of which has a name."""
    starts = np.cumsum([0, *(len(one.points) for one in walls)])
    cells = [
        np.arange(start + a, start + b)
        for start, one in zip(starts, walls, strict=False)
        for a, b in pairwise(one.first)
    ]
    number = np.repeat(np.arange(len(walls)), [len(one.pane) for one in walls])
    points = np.concatenate([np.zeros((0, 3)), *(one.points for one in walls)])
    return Shape(points, tuple(cells), True, number, tuple(names))


def _closed(corners: np.ndarray) -> np.ndarray:
    return np.concatenate([corners, corners[:1]])


def _edges(basins: Sequence) -> list[np.ndarray]:
    """The walls (2, 2) m of tanks, without their open edges."""
    return [
        np.array([basin.outline[k], np.roll(basin.outline, -1, axis=0)[k]])
        for basin in basins
        for k in range(len(basin.outline))
        if k not in basin.open_edges
    ]


def _part_names(bed: Bed) -> list[str]:
    return [name for name, _ in _part_lines(bed, 0)]


def _part_lines(bed: Bed, row: int) -> Iterator[tuple[str, np.ndarray]]:
    """The lines (m, 2) m of parts, of rooms in them, and of a sliding mass on its rail, each with its name."""
    footage = bed.footage
    solid = {body.number: body for body in footage.bodies}
    for number, (name, line) in enumerate(footage.parts.items()):
        body = solid.get(number)
        for one in (line,) if body is None else (_closed(body.outline), *map(_closed, body.rooms)):
            yield name, bed.moved(one, number, row)
    if footage.rail:
        yield from (("rail", line) for line in footage.rail.lines(bed.world, float(footage.time[row])))


def _parts(bed: Bed, names: Sequence[str], row: int) -> Shape:
    return lines_shape(names, [line for _, line in _part_lines(bed, row)])


def _plates(bed: Bed, row: int) -> Shape:
    """The parts in space where they are in the tank."""
    space = bed.footage.space
    rest = faces_shape(tuple(bed.footage.parts), space.plates)
    stances = [space.part_at(number, bed.world, row) for number in range(len(space.plates))]
    moved = [carried(plate.points, stance) for plate, stance in zip(space.plates, stances, strict=True)]
    return rest.at(np.concatenate([np.zeros((0, 3)), *moved]))


def _along(preset: Preset) -> float:
    """How long (m) a ship's section is in space; 0 in the plane."""
    return float(getattr(preset.tank.solid, "along", 0.0))


def _waterline(bed: Bed, along: float, row: int, stance: np.ndarray) -> Shape:
    """The free surface about a ship in the earth's axes: a line in the plane, in space a band as long as she is."""
    sea = bed.footage.sea_of(row)
    reach = WIDE * float(np.ptp(sea.hull[:, 0]))
    across = stance[0] + reach * np.linspace(-1.0, 1.0, PIECES + 1)
    line = np.column_stack([across, sea.elevation(across, float(bed.footage.time[row]))])
    if not along:
        return lines_shape("waterline", [line])
    ends = [np.column_stack([line, np.full(len(line), end)]) for end in (-0.5 * along, 0.5 * along)]
    count = len(line)
    cells = tuple(np.array([k, k + 1, count + k + 1, count + k]) for k in range(PIECES))
    return Shape(np.concatenate(ends), cells, True, np.zeros(PIECES, dtype=int), ("waterline",))
