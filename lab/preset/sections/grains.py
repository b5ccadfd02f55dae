"""The grains of a preset: as given, as resolved, and the check that they fit into the tank."""

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Annotated, Literal

from lab.base.errors import LabError
from lab.preset.bed_file import read_bed
from lab.preset.outline import Point, area, simple_polygon
from lab.preset.sections.shapes import Shape, by_number
from lab.preset.sections.tank import Tank
from lab.preset.units import needed, show
from solvers.grains.bed.sizes import Sizes
from solvers.machine.marks import Interval, Unit

DENSEST = math.pi / math.sqrt(12)  # largest share of a plane that equal discs cover (Thue)
MOST_PLACES = 4e6  # lattice sites, one per largest grain, in a tank to be filled: they are held in memory

Length = Annotated[float, Unit("m"), Interval(gt=0)]


@dataclass(frozen=True)
class GrainsGiven:
    """Spheres in a plane as a preset gives them: a count, a depth of the bed, or a file that lists them.

    Diameters are uniform in diameter·(1 ± spread), or normal with the relative standard deviation `spread`, cut at ± 3
    of these and at a tenth of the diameter, or by a table of [diameter, share], each class uniform within ± spread.
    `shares` of a table or of shapes are by number or by mass. `orientation`: by how much irregular grains are turned
    at the start (rad). `surface`, after Spandonidis (2016), section 5.3.1: `solvers/grains/bed/filling.py` says what is
    done for it. `region`: corners (m) of the part of the tank, such as a funnel in it, in which the grains start.
    `settled_as`: round outlines may settle as discs, into the very bed that these would have.
    """

    diameter: Length | None = None
    spread: Annotated[float, Interval(ge=0, le=0.5)] = 0.0
    distribution: Literal["uniform", "normal", "table"] = "uniform"
    table: tuple[tuple[Length, Annotated[float, Interval(gt=0)]], ...] | None = None
    shares: Literal["number", "mass"] = "number"
    orientation: Annotated[float, Unit("rad")] | Literal["random"] = "random"
    count: Annotated[int, Interval(ge=1, le=1_000_000)] | None = None
    depth: Length | None = None
    surface: Literal["undisturbed", "slightly-disturbed", "disturbed"] = "slightly-disturbed"
    region: Annotated[tuple[tuple[float, float], ...], Unit("m")] | None = None
    bed: str | None = None
    reuse_bed: bool = True
    settled_as: Literal["outlines", "discs"] = "outlines"


@dataclass(frozen=True)
class Grains(GrainsGiven):
    """The resolved grains: `diameter` (m) is the mean; `listed` holds y, z, radius, v_y, v_z, ω (SI) from `bed`.

    The shares in `table` are by number. For irregular grains it has the diameters and shares of all shapes.
    """

    listed: tuple[tuple[float, float, float, float, float, float], ...] = ()

    @property
    def sizes(self) -> Sizes:
        """The distribution that the diameters are drawn from."""
        classes = self.table or ((self.diameter, 1.0),)
        return Sizes(classes, self.spread, self.distribution == "normal")

    @property
    def range(self) -> tuple[float, float]:
        """Smallest and largest possible diameter (m)."""
        if self.listed:
            radius = [grain[2] for grain in self.listed]
            return 2.0 * min(radius), 2.0 * max(radius)
        return self.sizes.range


def full_grains(given: GrainsGiven, shapes: Mapping[str, Shape], tank: Tank, settle: bool) -> Grains:
    """The resolved grains, with all sizes; a file of grains replaces all keys on how a bed is made."""
    if given.surface != "slightly-disturbed" and not settle:
        raise LabError(f"grains.surface: a bed is {given.surface} by how it settles; leave run.settle true.")
    if given.bed is not None:
        return _listed_grains(given, tank, settle)
    if (given.distribution == "table") != (given.table is not None):
        got = "no table" if given.table is None else f'distribution = "{given.distribution}"'
        raise LabError(f'grains.table: goes with distribution = "table" (got {got}).')
    if given.table is None and given.diameter is None and not shapes:
        raise LabError(f"grains.diameter: missing; {needed('m')}.")
    if given.table == ():
        raise LabError('grains.table: at least one class is needed, e.g. [["6 mm", 0.352], ["8 mm", 0.648]].')
    if given.shares == "mass" and given.table is None and not shapes:
        raise LabError("grains.shares: goes with shapes, or with a table of sizes.")
    grains = Grains(**asdict(given))
    classes = tuple((shape.diameter, shape.share) for shape in shapes.values())
    if grains.table is not None:
        classes = by_number(grains.table, grains.shares)
    if classes:
        grains = replace(grains, table=classes, diameter=Sizes(classes).mean)
    if grains.region is not None:
        grains = replace(grains, region=_region(grains))
    check_grains(grains, tank, _size_key(grains, shapes))
    return grains


def _size_key(grains: Grains, shapes: Mapping[str, Shape]) -> str:
    """The key that sets the size of the largest grains."""
    if shapes:
        return f"shapes.{max(shapes, key=lambda name: shapes[name].diameter)}.diameter"
    return "grains.diameter" if grains.table is None else "grains.table"


def _region(grains: Grains) -> tuple[Point, ...]:
    """The corners of the region that the grains start in."""
    if grains.depth is not None:
        raise LabError("grains.region: goes with a count of grains; a depth would fill the whole tank.")
    if grains.surface != "slightly-disturbed":
        raise LabError("grains.region: grains in a region settle as they lie; leave grains.surface out.")
    try:
        return simple_polygon(grains.region)
    except LabError as error:
        raise LabError(f"grains.region: {error}") from None


def _listed_grains(given: GrainsGiven, tank: Tank, settle: bool) -> Grains:
    if given.surface != "slightly-disturbed":
        raise LabError("grains.surface: says how a bed is poured, but grains.bed lists its grains; leave one out.")
    listed = read_bed(given.bed, tank.outline, moving=not settle)
    mean = 2.0 * sum(grain[2] for grain in listed) / len(listed)
    return Grains(diameter=mean, count=len(listed), bed=Path(given.bed).name, reuse_bed=given.reuse_bed, listed=listed)


def check_grains(grains: Grains, tank: Tank, size_key: str) -> None:
    """Raise LabError for grains that do not fit or would be too many; `size_key` is the key of their size."""
    if (grains.count is None) == (grains.depth is None):
        got = "neither" if grains.count is None else "both"
        raise LabError(f"grains.depth: give exactly one of depth and count (got {got}).")
    largest = grains.range[1]
    if largest >= min(tank.width, tank.height):
        raise LabError(f"{size_key}: grains of up to {show(largest, 'm')} do not fit into the tank.")
    if tank.width * tank.height > MOST_PLACES * largest**2:
        raise LabError(f"{size_key}: grains of up to {show(largest, 'm')} are too small for so large a tank.")
    height = show(tank.height, "m")
    if grains.depth is None:
        _check_room(grains, grains.region or tank.outline)
    elif grains.depth > tank.height and tank.open_edges:
        raise LabError(f"grains.depth: {show(grains.depth, 'm')} is more than the tank's height, {height}.")
    elif grains.depth >= tank.height and not tank.open_edges:
        raise LabError(f"grains.depth: {show(grains.depth, 'm')} must be less than the tank's height, {height}.")
    elif grains.depth < grains.diameter:
        raise LabError(f"grains.depth: {show(grains.depth, 'm')} is less than one grain, {show(grains.diameter, 'm')}.")


def _check_room(grains: Grains, outline: tuple[Point, ...]) -> None:
    """Raise LabError for more grains than the tank has room for in the densest lattice."""
    if grains.count * math.pi / 4 * grains.sizes.mean_square > DENSEST * area(outline):
        room = "region" if grains.region else "tank"
        raise LabError(f"grains.count: {grains.count} grains do not fit into the {room}.")
