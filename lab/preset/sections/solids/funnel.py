"""A funnel in the tank: two walls at an angle over an outlet, and the gate that opens it; in a turned tank a cone."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import pi, tan
from typing import Annotated

import numpy as np

from lab.base.errors import LabError
from lab.preset.outline import Point, stands_out
from lab.preset.units import show
from solvers.machine.marks import Doc, Interval, Unit, Usual

EXACT = 12  # decimals of a metre: corners that a person types in whole micrometres have the same numbers
NAMES = "funnel-port", "funnel-starboard", "funnel-gate"  # of its parts
ARCHES = 5.0  # grains: in the plane narrower outlets may arch close (To, Lai & Pak 2001, Phys. Rev. Lett. 86, 71)

Length = Annotated[float, Unit("m"), Interval(gt=0)]
Height = Annotated[float, Unit("m")]


@dataclass(frozen=True)
class Funnel:
    """Walls at an `angle` from the vertical over an outlet, up to a `width` and from there upright, or to the `top`.

    They stand symmetrically about y = 0, in space along the whole tank, or turned with it about its axis. Grains start
    in the funnel unless `grains.region` says where. Its gate drops from `opens` on, by default through the floor.
    """

    angle: Annotated[
        float,
        Unit("rad"),
        Interval(gt=0, lt=0.5 * pi),
        Usual(pi / 18, pi / 3, "deg"),
        Doc("Of its walls from the vertical."),
    ]
    outlet: Annotated[Length, Usual(0.0, 0.1, "mm"), Doc("Width of its outlet; of one that is turned, the diameter.")]
    tip: Annotated[Height, Doc("Height of its outlet, in the tank's axes.")]
    width: Annotated[
        Length | None,
        Doc("Its largest width, from which on its walls are upright; they lean up to the top without it."),
    ] = None
    top: Annotated[Height | None, Doc("Height of its upper end, in the tank's axes; that of the tank without it.")] = (
        None
    )
    opens: Annotated[float, Unit("s"), Interval(ge=0), Doc("When its gate begins to drop, after the settling.")] = 0.0
    drop: Annotated[
        Length | None, Doc("How far its gate drops; through the floor, by the outlet's width, without it.")
    ] = None
    gate_speed: Annotated[float, Unit("m/s"), Interval(gt=0), Doc("Top speed of its gate.")] = 10.0
    gate_acceleration: Annotated[
        float, Unit("m/s^2"), Interval(gt=0), Doc("How fast its gate speeds up; grains must not fall faster.")
    ] = 50.0

    def shoulder(self, top: float) -> float:
        """Height (m) up to which its walls lean; `top`: that of its upper end."""
        return self.tip + 0.5 * (self.width - self.outlet) / tan(self.angle) if self.width else top

    def wall(self, corners: Sequence[Point]) -> tuple[Point, ...]:
        """The corners (m) of the starboard wall from the outlet up, in a tank with these corners."""
        top = self.upper(corners)
        shoulder = _exact(self.shoulder(top))
        half = 0.5 * (self.width or self.outlet + 2.0 * (top - self.tip) * tan(self.angle))
        upright = ((_exact(half), top),) if shoulder < top else ()
        return ((_exact(0.5 * self.outlet), self.tip), (_exact(half), shoulder), *upright)

    def upper(self, corners: Sequence[Point]) -> float:
        """Height (m) of its upper end."""
        return max(z for _, z in corners) if self.top is None else self.top

    def inside(self, corners: Sequence[Point]) -> tuple[Point, ...]:
        """The corners (m) of the room in it, counter-clockwise from the port lip."""
        starboard = self.wall(corners)
        port = tuple((-y, z) for y, z in reversed(starboard))
        return (port[-1], *starboard, *port[:-1])

    def plates(self, corners: Sequence[Point]) -> tuple[tuple[Point, ...], ...]:
        """The corners (m) of its parts: port wall and starboard wall from above, and the gate."""
        starboard = tuple(reversed(self.wall(corners)))
        lip = starboard[-1]
        return tuple((-y, z) for y, z in starboard), starboard, ((-lip[0], lip[1]), lip)

    def way(self, corners: Sequence[Point]) -> float:
        """How far (m) its gate drops."""
        return self.drop or self.tip - min(z for _, z in corners) + self.outlet


def check_funnel(tank) -> None:
    """Raise LabError for a funnel that is none, or that is not within its `lab.preset.sections.tank.Tank`."""
    for key, fault in _faults(tank):
        raise LabError(f"tank.funnel{key}: {fault}.")


def _faults(tank) -> Iterator[tuple[str, str]]:
    """The keys at fault, and why."""
    funnel = tank.funnel
    if tank.mesh or tank.lies:
        yield "", "no funnel stands in a tank that is a mesh, or turned about x; leave it out"
        return
    corners = tank.corners
    top, floor = funnel.upper(corners), min(z for _, z in corners)
    if funnel.tip <= floor:
        yield ".tip", f"must be higher than the tank's floor, {show(floor, 'm')} (got {show(funnel.tip, 'm')})"
    if top <= funnel.tip:
        yield ".tip", f"must be lower than its upper end, {show(top, 'm')} (got {show(funnel.tip, 'm')})"
    if funnel.width and funnel.outlet >= funnel.width:
        yield ".outlet", f"must be less than its width, {show(funnel.width, 'm')} (got {show(funnel.outlet, 'm')})"
    elif funnel.shoulder(top) > top + 10.0**-EXACT:
        high = show(funnel.shoulder(top), "m")
        yield ".width", f"its walls reach it {high} high, over its upper end, {show(top, 'm')}; take a larger angle"
    out = stands_out(np.array(funnel.inside(corners)), np.array(corners))
    if out is not None:
        place = ", ".join(show(x, "m") for x in out)
        yield "", f"stands out of the tank at {place}; take a smaller angle, outlet or width, or a lower top"


def caution(funnel: Funnel, largest: float) -> str | None:
    """What a reader must know of an outlet that is narrow beside the largest grains (m); None of a wide one."""
    wide = funnel.outlet / largest
    if wide <= 1.0:
        return f"The funnel's outlet is {wide:.2g} of the largest grains wide: these cannot pass."
    if wide < ARCHES:
        return (
            f"The funnel's outlet is {wide:.2g} of the largest grains wide: narrower than {ARCHES:g} it may arch close."
        )
    return None


def in_words(funnel: Funnel, corners: Sequence[Point]) -> str:
    """The funnel in a clause: its angle, outlet and height."""
    angle, outlet = show(funnel.angle, "rad"), show(funnel.outlet, "m")
    upright = f", {show(funnel.width, 'm')} wide" if funnel.width else ""
    return (
        f"walls {angle} from the vertical over an outlet of {outlet}, {show(funnel.tip, 'm')} to "
        f"{show(funnel.upper(corners), 'm')} high{upright}, opened at {show(funnel.opens, 's')}"
    )


def _exact(value: float) -> float:
    return round(value, EXACT)
