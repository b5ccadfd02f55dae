"""The tank of a preset: as given, as resolved, and its checks."""

from dataclasses import dataclass
from typing import Annotated

import numpy as np

from lab.base.errors import LabError
from lab.preset.outline import Point, rectangle, simple_polygon
from lab.preset.units import show
from solvers.machine.marks import Interval, Unit
from solvers.tank.outline import top_edges

MOST_LINING = 20_000  # grains that line a tank

Length = Annotated[float, Unit("m"), Interval(gt=0)]
Thickness = Annotated[float, Unit("m"), Interval(gt=0, le=1e3)]


@dataclass(frozen=True)
class TankGiven:
    """A tank as a preset gives it: width and height, or an outline; whether it has a lid and a lining of grains.

    The plane stands for a slab of this `thickness`, by default the grains' mean diameter: forces are those on the slab,
    and a ship carries as many slabs as fit into a metre.
    """

    width: Length | None = None
    height: Length | None = None
    outline: Annotated[tuple[tuple[float, float], ...], Unit("m")] | None = None
    lid: bool = True
    roughness: Length | None = None
    thickness: Thickness | None = None


@dataclass(frozen=True)
class Tank:
    """The tank's outline (m) in its own frame, a simple polygon, counter-clockwise.

    `open_edges` have no wall; edge k runs from corner k to corner k + 1. `roughness` is the diameter (m) of the fixed
    grains that line floor and sides, None if these are smooth; `thickness` (m) is the slab's, None for the grains'
    mean diameter.
    """

    outline: tuple[tuple[float, float], ...]
    open_edges: tuple[int, ...] = ()
    roughness: float | None = None
    thickness: float | None = None

    @property
    def width(self) -> float:
        """Largest extent sideways (m)."""
        across = [y for y, _ in self.outline]
        return max(across) - min(across)

    @property
    def height(self) -> float:
        """Largest extent upwards (m)."""
        upwards = [z for _, z in self.outline]
        return max(upwards) - min(upwards)


def full_tank(given: TankGiven) -> Tank:
    """The resolved tank. Raises LabError for an invalid outline, and for a lining that does not fit."""
    outline = np.array(_outline(given))
    open_edges = () if given.lid else top_edges(outline)
    if not given.lid and not open_edges:
        raise LabError("tank.lid: this outline has no edge along its top to leave open; leave lid out.")
    tank = Tank(tuple(map(tuple, outline.tolist())), open_edges, given.roughness, given.thickness)
    check_lining(tank)
    return tank


def check_lining(tank: Tank) -> None:
    """Raise LabError for grains that are too large or too many to line a tank."""
    if tank.roughness is None:
        return
    outline, size = np.array(tank.outline), show(tank.roughness, "m")
    around = float(np.hypot(*(outline - np.roll(outline, 1, axis=0)).T).sum())
    if tank.roughness > 0.25 * min(tank.height, tank.width):
        raise LabError(f"tank.roughness: grains of {size} are too large to line the tank.")
    if around > MOST_LINING * tank.roughness:
        raise LabError(f"tank.roughness: more than {MOST_LINING} grains of {size} go around.")


def _outline(given: TankGiven) -> tuple[Point, ...]:
    sides = {"width": given.width, "height": given.height}
    if given.outline is not None:
        if any(sides.values()):
            raise LabError("tank.outline: give either an outline or a width and a height, not both.")
        try:
            return simple_polygon(given.outline)
        except LabError as error:
            raise LabError(f"tank.outline: {error}") from None
    for name, side in sides.items():
        if side is None:
            raise LabError(f"tank.{name}: missing; give width and height, or an outline.")
    return rectangle(given.width, given.height)
