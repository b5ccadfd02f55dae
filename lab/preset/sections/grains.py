"""The grains of a preset, and the check that they fit into the tank."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, Literal

import numpy as np

from lab.base.errors import LabError
from lab.preset.bed_file import MOST, NEEDED, OPTIONAL, ListedGrains, check_listed, check_radii, listed
from lab.preset.fields import Columns, Table
from lab.preset.outline import Point, area, simple_polygon
from lab.preset.sections.materials import Kind
from lab.preset.sections.tank import Tank
from lab.preset.units import needed, show
from solvers.grains.bed.sizes import Sizes
from solvers.machine.marks import Cheap, Doc, Interval, Unit, Usual

DENSEST = math.pi / math.sqrt(12)  # largest share of a plane that equal discs cover (Thue)
DENSEST_SPHERES = math.pi / math.sqrt(18)  # largest share of space that equal spheres fill (Hales 2005)
MOST_PLACES = 4e6  # lattice sites, one per largest grain, in a tank to be filled: they are held in memory

Length = Annotated[float, Unit("m"), Interval(gt=0)]


@dataclass(frozen=True)
class Grains:
    """Spheres in a plane: a count, a depth of the bed, or a file that lists them, which replaces how a bed is made.

    Diameters are uniform in diameter·(1 ± spread), or normal with the relative standard deviation `spread`, cut at ± 3
    of these and at a tenth of the diameter, or by a table of [diameter, share], each class uniform within ± spread.
    `surface`, after Spandonidis (2016), section 5.3.1: `solvers/grains/bed/filling.py` says what is done for it.
    """

    diameter: Annotated[
        Length | None,
        Cheap(),
        Usual(1e-3, 1e-2, "mm"),
        Doc("Mean diameter; of shapes, that of the disc of equal area."),
    ] = None
    cargo: Annotated[
        str | None,
        Doc(
            "Cargo of the library, or the path of a cargo file: it fills density, friction and size, which other keys "
            "here replace; `cargolab cargoes` lists them."
        ),
    ] = None
    stands_for: Annotated[
        Length | None,
        Doc("Diameter of the real grains that each grain of a coarse model stands for; it changes only texts."),
    ] = None
    true_size: Annotated[
        Length | None,
        Doc("Diameter of the grains that each one stands for in water: the bed has the permeability of these."),
    ] = None
    spread: Annotated[float, Interval(ge=0, le=0.5), Doc("Relative spread of the diameters.")] = 0.0
    distribution: Annotated[Literal["uniform", "normal", "table"], Doc("How the diameters are distributed.")] = (
        "uniform"
    )
    table: Annotated[
        tuple[tuple[Length, Annotated[float, Interval(gt=0)]], ...] | None,
        Cheap(),
        Doc('Classes of sizes, [diameter, share] each, for distribution = "table".'),
    ] = None
    shares: Annotated[
        Literal["number", "mass"], Doc("Whether shares of a table or of shapes are by number or by mass.")
    ] = "number"
    orientation: Annotated[
        Annotated[float, Unit("rad")] | Literal["random"],
        Doc("By how much irregular grains are turned at the start."),
    ] = "random"
    count: Annotated[
        Annotated[int, Interval(ge=1, le=1_000_000)] | None, Cheap(), Doc("Number of grains; give it or `depth`.")
    ] = None
    depth: Annotated[Length | None, Doc("Depth of the settled bed, in place of `count`.")] = None
    surface: Annotated[
        Literal["undisturbed", "slightly-disturbed", "disturbed"], Doc("How the bed's surface is made.")
    ] = "slightly-disturbed"
    layered: Annotated[
        bool,
        Doc("Whether the kinds of grains start in layers, the rest lowest and each kind above the one before it."),
    ] = False
    region: Annotated[
        Annotated[tuple[tuple[float, float], ...], Unit("m")] | None,
        Doc("Corners, y and z each, of the part of the tank in which the grains start, such as a funnel."),
    ] = None
    room: Annotated[
        str | None,
        Doc('The room of a hull that floats in which the grains are, as "HULL.ROOM"; by default they are in [tank].'),
    ] = None
    bed: Annotated[
        Table | None,
        Columns(NEEDED, OPTIONAL, MOST),
        Doc(
            "CSV file that lists the grains: y, z, radius and any of vy, vz, omega, in SI, in space x, vx, omega_y and "
            "omega_z, too; kind: 0 for [material], then the numbers of [kinds]."
        ),
    ] = None
    poured_friction: Annotated[
        Annotated[float, Interval(ge=0, le=10)] | None,
        Doc("Friction of all surfaces while the grains are poured: 0 packs them densely, 1 loosely; else their own."),
    ] = None
    reuse_bed: Annotated[bool, Doc("Keep settled beds, and reuse them.")] = True
    settled_as: Annotated[
        Literal["outlines", "discs"], Doc("Whether round outlines settle as discs, into the bed that these would have.")
    ] = "outlines"

    @cached_property
    def listed(self) -> ListedGrains | None:
        """The grains of the file; None without one."""
        return listed(self.bed) if self.bed is not None else None

    @property
    def normal(self) -> bool:
        """Whether the diameters are normally distributed."""
        return self.distribution == "normal"

    @property
    def place(self) -> tuple[Point, ...] | None:
        """The corners (m) of the region that the grains start in, counter-clockwise. Raises LabError."""
        return simple_polygon(self.region) if self.region is not None and not self.listed else None


def check_grains(grains: Grains, shaped: bool, settle: bool) -> None:
    """Raise LabError for keys that contradict each other; `shaped`: the grains have shapes, `settle`: they settle."""
    if grains.surface != "slightly-disturbed" and not settle:
        raise LabError(
            f"grains.surface: a bed is {grains.surface} by how it settles; leave run.settle true, with gravity."
        )
    if grains.poured_friction is not None and (not settle or grains.bed is not None or grains.surface == "undisturbed"):
        raise LabError(
            'grains.poured_friction: goes with grains that are poured, and an "undisturbed" surface has none; leave it '
            "out, or grains.surface and grains.bed."
        )
    if grains.bed is not None:
        if grains.surface != "slightly-disturbed":
            raise LabError("grains.surface: says how a bed is poured, but grains.bed lists its grains; leave one out.")
        check_radii(grains.listed)
        return
    if (grains.distribution == "table") != (grains.table is not None):
        got = "no table" if grains.table is None else f'distribution = "{grains.distribution}"'
        raise LabError(f'grains.table: goes with distribution = "table" (got {got}).')
    if grains.table is None and grains.diameter is None and not shaped:
        raise LabError(f"grains.diameter: missing; {needed('m')}.")
    if grains.table == ():
        raise LabError('grains.table: at least one class is needed, e.g. [["6 mm", 0.352], ["8 mm", 0.648]].')
    if grains.shares == "mass" and grains.table is None and not shaped:
        raise LabError("grains.shares: goes with shapes, or with a table of sizes.")
    if grains.region is not None:
        _check_region(grains)


def _check_region(grains: Grains) -> None:
    if grains.depth is not None:
        raise LabError("grains.region: goes with a count of grains; a depth would fill the whole tank.")
    if grains.surface != "slightly-disturbed":
        raise LabError("grains.region: grains in a region settle as they lie; leave grains.surface out.")
    try:
        simple_polygon(grains.region)
    except LabError as error:
        raise LabError(f"grains.region: {error}") from None


def check_layers(grains: Grains, kinds: Mapping[str, Kind]) -> None:
    """Raise LabError for layers or sizes of kinds of grains that do not go with how the bed is made."""
    listed = "grains.bed" if grains.bed is not None else "grains.table" if grains.table is not None else None
    sized = [name for name, kind in kinds.items() if kind.diameter]
    if sized and listed:
        raise LabError(f"kinds.{sized[0]}.diameter: {listed} says how large grains are; leave one of them out.")
    if not grains.layered:
        return
    if not kinds or grains.bed is not None:
        remedy = "add a table [kinds.NAME]" if not kinds else "leave out grains.bed"
        raise LabError(f"grains.layered: kinds of grains that are poured start in layers; {remedy}, or leave this out.")
    if grains.surface != "slightly-disturbed":
        raise LabError("grains.layered: layers settle as they lie; leave grains.surface out, or this.")


def check_room(
    grains: Grains, sizes: Sizes, mean: float, tank: Tank, size_key: str, settle: bool, scale: float
) -> None:
    """Raise LabError for grains that do not fit or would be too many; `size_key` is the key of their size.

    `tank` is the one that they are in, `mean` is the grains' mean diameter (m); `settle`: whether they settle before
    the tank moves; `scale`: the factor on their moduli.
    """
    if grains.listed:
        check_listed(grains.listed, tank, moving=not settle, scale=scale)
        return
    if (grains.count is None) == (grains.depth is None):
        got = "neither" if grains.count is None else "both"
        raise LabError(f"grains.depth: give exactly one of depth and count (got {got}).")
    largest, (width, height) = sizes.range[1], tank.extent
    if largest >= min(width, height):
        raise LabError(f"{size_key}: grains of up to {show(largest, 'm')} do not fit into the tank.")
    deep = 2.0 * tank.solid.half(np.array(tank.corners)) / largest if tank.solid else 1.0
    if width * height * deep > MOST_PLACES * largest**2:
        raise LabError(f"{size_key}: grains of up to {show(largest, 'm')} are too small for so large a tank.")
    high, deep = show(height, "m"), show(grains.depth or 0.0, "m")
    if grains.depth is None:
        _check_count(grains, sizes, tank)
    elif grains.depth > height and tank.open_edges:
        raise LabError(f"grains.depth: {deep} is more than the tank's height, {high}.")
    elif grains.depth >= height and not tank.open_edges:
        raise LabError(f"grains.depth: {deep} must be less than the tank's height, {high}.")
    elif grains.depth < mean:
        raise LabError(f"grains.depth: {deep} is less than one grain, {show(mean, 'm')}.")


def _check_count(grains: Grains, sizes: Sizes, tank: Tank) -> None:
    """Raise LabError for more grains than the tank has room for in the densest lattice."""
    place, solid = np.array(grains.place or tank.corners), tank.solid
    if solid is None:
        taken, room = grains.count * math.pi / 4 * sizes.mean_square, DENSEST * area(place)
    else:
        volume = solid.within(place) if grains.place else solid.volume(place, float(np.ptp(place[:, 1])))
        taken, room = grains.count * math.pi / 6 * sizes.mean_cube, DENSEST_SPHERES * volume
    if taken > room:
        where = "region" if grains.region else "tank"
        raise LabError(f"grains.count: {grains.count} grains do not fit into the {where}.")
