"""The tank of a preset."""

from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, Literal

import numpy as np

from lab.base.errors import LabError
from lab.preset.fields import Columns, Of, Table
from lab.preset.outline import Point, rectangle, simple_polygon
from lab.preset.sections.solids.funnel import Funnel, check_funnel
from lab.preset.sections.solids.mesh import COLUMNS, MOST, UNITS, mesh_of
from lab.preset.units import show
from solvers.machine.marks import Doc, Interval, Unit, Usual
from solvers.machine.quantity import PLANE
from solvers.tank.outline import top_edges
from solvers.tank.solids.mesh import Mesh
from solvers.tank.solids.solid import Lying, Prism, Solid, Turned

MOST_LINING = 20_000  # grains that line a tank

Length = Annotated[float, Unit("m"), Interval(gt=0)]
Thickness = Annotated[float, Unit("m"), Interval(gt=0, le=1e3)]
Outline = Annotated[tuple[tuple[float, float], ...], Unit("m")]


@dataclass(frozen=True)
class Shell:
    """The walls of a tank: a width and a height, or an outline; whether it has a lid; its length along a ship."""

    width: Annotated[Length | None, Doc("Width of a rectangular tank, its origin in the middle of its floor.")] = None
    height: Annotated[Length | None, Doc("Height of a rectangular tank.")] = None
    outline: Annotated[Outline | None, Doc("Corners of the tank, y and z each, in place of width and height.")] = None
    lid: Annotated[bool, Doc("Whether the tank is closed at the top.")] = True
    length: Annotated[
        Length | None, Doc("Length of a hold along its ship, which carries no more of it; the ship's own without it.")
    ] = None

    @cached_property
    def corners(self) -> tuple[Point, ...]:
        """The outline (m) in the tank's own frame, a simple polygon, counter-clockwise. Raises LabError."""
        return self._polygon("width", "height")

    def _polygon(self, *names: str) -> tuple[Point, ...]:
        """The polygon of the outline, or of two sides by their names, its origin in the middle of its floor."""
        sides = {name: getattr(self, name) for name in names}
        words = " and ".join(names)
        if self.outline is not None:
            if any(sides.values()):
                raise LabError(
                    f"tank.outline: give either an outline or a {words.replace('and ', 'and a ')}, not both."
                )
            try:
                return tuple(map(tuple, np.array(simple_polygon(self.outline)).tolist()))
            except LabError as error:
                raise LabError(f"tank.outline: {error}") from None
        for name, side in sides.items():
            if side is None:
                raise LabError(f"tank.{name}: missing; give {words}, or an outline.")
        return rectangle(*sides.values())

    @property
    def open_edges(self) -> tuple[int, ...]:
        """The edges without a wall; edge k runs from corner k to corner k + 1."""
        return () if self.lid else top_edges(np.array(self.corners))

    @property
    def extent(self) -> tuple[float, float]:
        """Largest extents (m) sideways and upwards."""
        y, z = zip(*self.corners, strict=True)
        return max(y) - min(y), max(z) - min(z)


@dataclass(frozen=True)
class Tank(Shell):
    """A tank: width and height, or an outline; its length in space; whether it has a lid and a lining of fixed grains.

    The plane stands for a slab of this `thickness`, and a tank in space is one as thick as it is `along`: forces are
    those on the slab, and a ship carries as many slabs as fit into a metre of the tank's `length`.
    """

    along: Annotated[
        Length | None,
        Doc(
            "Length of the tank along x, from end wall to end wall: the scene is then in space and its grains are "
            "spheres; without it the scene is plane."
        ),
    ] = None
    periodic: Annotated[
        bool,
        Doc(
            "Whether there are no end walls in space: the tank is a slice of one without an end, and what leaves it on "
            "one side enters on the other."
        ),
    ] = False
    turned: Annotated[
        bool | Literal["x"],
        Doc(
            "Whether the outline is a section through the vertical axis, turned about it, with all parts in it: the "
            'scene is then in space, too; with "x" a section through the axis x, as a drum lies: width is its '
            "diameter and along its length, or the outline has corners y and x."
        ),
    ] = False
    mesh: Annotated[
        Table | None,
        Columns(COLUMNS, (), MOST, surface=True),
        Doc(
            "STL file of the tank's inner surface, in place of width and height, with x along, y across and z up: "
            "closed, or open at the top; the scene is then in space, too."
        ),
    ] = None
    unit: Annotated[
        Literal[*UNITS] | None, Doc("Unit of the numbers in the file of `mesh`, which does not say it.")
    ] = None
    roughness: Annotated[
        Length | None,
        Of("grains"),
        Doc("Diameter of fixed grains that line floor and sides; they are smooth without it."),
    ] = None
    thickness: Annotated[
        Thickness | None,
        Doc("Thickness of the slab that the plane stands for; the grains' mean diameter without it, 1 m if empty."),
    ] = None
    funnel: Annotated[Funnel | None, Doc("A funnel that stands in the tank, with the grains in it.")] = None

    @property
    def lies(self) -> bool:
        """Whether it is turned about the axis x."""
        return self.turned == "x"

    @cached_property
    def corners(self) -> tuple[Point, ...]:
        """The outline (m) in the tank's own frame, a simple polygon, counter-clockwise. Raises LabError."""
        if self.lies or self.mesh:
            return tuple(map(tuple, self.solid.front.tolist()))
        return self._polygon("width", "height")

    @property
    def open_edges(self) -> tuple[int, ...]:
        """The edges without a wall; edge k runs from corner k to corner k + 1."""
        if self.mesh:
            return top_edges(np.array(self.corners)) if self.solid.open else ()
        return super().open_edges

    @property
    def profile(self) -> tuple[Point, ...]:
        """The section (m) of a tank that lies, across its axis and along it, counter-clockwise. Raises LabError."""
        middle = 0.0 if self.outline else 0.5 * (self.along or 0.0)
        return tuple((y, x - middle) for y, x in self._polygon("width", "along"))

    @cached_property
    def solid(self) -> Solid | None:
        """The solid that the outline stands for in space; None in the plane. Raises LabError."""
        if self.mesh:
            return self._mesh()
        if self.lies:
            return Lying(self.profile)
        return Turned() if self.turned else Prism(self.along, self.periodic) if self.along else None

    def _mesh(self) -> Mesh:
        """The mesh of its file. Raises LabError."""
        if self.unit is None:
            raise LabError(f"tank.unit: missing; a file of triangles has no unit, so give one of {', '.join(UNITS)}.")
        try:
            return mesh_of(self.mesh.name, self.mesh.columns, UNITS[self.unit])
        except LabError as error:
            raise LabError(f"tank.mesh: {error}") from None

    @property
    def in_space(self) -> tuple[str, ...]:
        """What of it is in space, in words; nothing of one in the plane."""
        if self.mesh:
            return (f"{self.mesh.name}, {len(self.solid.triangles)} triangles",)
        if self.lies:
            return (f"lying, {show(float(np.ptp(self.solid.corners[:, 1])), 'm')} long",)
        if self.turned:
            return ("turned about its axis",)
        if not self.along:
            return ()
        slice_of_one = ", a slice of one without an end" if self.periodic else ""
        return (f"{show(self.along, 'm')} long{slice_of_one}",)

    @property
    def axes(self) -> int:
        """Number of axes of a scene in it."""
        return self.solid.axes if self.solid else PLANE


@dataclass(frozen=True)
class FurtherTank(Shell):
    """A further tank of a ship, beside [tank]. Tanks may overlap in the plane: they stand one behind the other."""

    place: Annotated[
        tuple[float, float], Unit("m"), Doc("Where its origin is in the hull's axes, y and z, as `ship.hold` is.")
    ] = (0.0, 0.0)
    depth: Annotated[
        Length | None,
        Usual(0.02, 1.0, "mm"),
        Doc("Depth of the water, or of the bulk, in it; it holds no water without it."),
    ] = None


def check_tank(tank: Shell) -> None:
    """Raise LabError for an invalid outline, a lid that cannot be left out, or a funnel or lining that does not fit."""
    if not tank.lid and not tank.open_edges:
        raise LabError("tank.lid: this outline has no edge along its top to leave open; leave lid out.")
    if getattr(tank, "funnel", None):
        check_funnel(tank)
    outline = np.array(tank.corners)
    if getattr(tank, "roughness", None) is None:
        return
    size = show(tank.roughness, "m")
    around = float(np.hypot(*(outline - np.roll(outline, 1, axis=0)).T).sum())
    if tank.roughness > 0.25 * min(tank.extent):
        raise LabError(f"tank.roughness: grains of {size} are too large to line the tank.")
    if around > MOST_LINING * tank.roughness:
        raise LabError(f"tank.roughness: more than {MOST_LINING} grains of {size} go around.")
