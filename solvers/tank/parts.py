"""Parts that move in the tank's frame, such as gates, funnels and dropping floors, or stand still, such as baffles."""

from dataclasses import dataclass
from math import hypot, sqrt
from typing import Annotated, ClassVar

import numpy as np
import taichi as ti

from solvers.machine.marks import Doc, Interval, Unit
from solvers.tank.outline import moments
from solvers.tank.shapes import PrismShape, SphereShape

SHORTEST = 1e-12  # s, the least time in which a part speeds up; far below any step


@ti.func
def travel(table: ti.template(), row, first, t):
    """Fraction of its move that a part has made at time t, from 0 to exactly 1, and its rate (1/s).

    The rate rises linearly to its top v in the time T, and falls likewise at the end. At τ after the start (or before
    the end) v τ²/2T is done (or left) for τ < T, and v (τ − T/2) from then on. Reads `Part.parameters` from column
    `first` on.
    """
    ramp, total, rate = table[row, first + 1], table[row, first + 2], table[row, first + 3]
    passed = ti.min(ti.max(t - table[row, first], 0.0), total)
    near = ti.min(passed, total - passed)
    way, pace = rate * (near - 0.5 * ramp), rate
    if near < ramp:
        way, pace = 0.5 * rate * near * near / ramp, rate * near / ramp
    if 2.0 * passed > total:
        way = 1.0 - way
    return ti.Vector([way, pace])


@dataclass(frozen=True)
class Part:
    """Thin plates along a polyline (m), with contact on both sides, that move together.

    From `start` (s after the tank's motion begins) they are displaced by `move` (y, z; m) in the tank's frame: they
    accelerate with `acceleration` up to `speed`, and brake likewise at the end. If the way is too short to reach
    `speed`, the top speed is lower. A part whose `move` is zero stands still.
    """

    points: Annotated[tuple[tuple[float, float], ...], Unit("m"), Doc("Corners of the thin plates, y and z each.")]
    move: Annotated[tuple[float, float], Unit("m"), Doc("How far the part moves, in y and z.")] = (0.0, 0.0)
    start: Annotated[float, Unit("s"), Interval(ge=0), Doc("When it begins to move.")] = 0.0
    speed: Annotated[float, Unit("m/s"), Interval(ge=0), Doc("Its top speed.")] = 0.0
    acceleration: Annotated[float, Unit("m/s^2"), Interval(ge=0), Doc("How fast it speeds up, and brakes.")] = 0.0
    closed: ClassVar = False
    motions: ClassVar = ()
    tank: ClassVar = 0
    free: ClassVar = None
    hull: ClassVar = None
    sieve: ClassVar = False
    shape: ClassVar = None

    @property
    def way(self) -> float:
        """Length of the move (m)."""
        return hypot(*self.move)

    def fastest(self) -> float:
        """Largest speed (m/s) that the part reaches."""
        return min(self.speed, sqrt(self.way) * sqrt(self.acceleration))

    def duration(self) -> float:
        """Time from the start of the tank's motion until the part stands still for good (s); 0 if it never moves."""
        start, _, total, *_ = self.parameters()
        return start + total

    def parameters(self) -> list[float]:
        """The kernel's table: start, time to speed up, time under way (s), top rate (1/s), move (y, z; m)."""
        if not self.way:
            return [0.0] * 6
        fastest = Part.fastest(self)
        ramp, cruise = max(fastest / self.acceleration, SHORTEST), self.way / fastest
        return [self.start, ramp, ramp + cruise, 1.0 / cruise, *self.move]


@dataclass(frozen=True)
class Free:
    """What a part that moves freely is: its `mass` (kg) and `inertia` (kg m²) about the `centre` of mass (m), as drawn.

    Mass and inertia are those of the slab that the tank is thick. It is held until `release` (s). `friction` and
    `restitution` are those of its surface and a wall. In space the centre has three coordinates, and the inertia is
    the tensor (3, 3) in the axes y, z, x.
    """

    mass: float
    inertia: float | tuple[tuple[float, ...], ...]
    centre: tuple[float, ...]
    release: float = 0.0
    friction: float = 0.3
    restitution: float = 0.3

    @property
    def least_inertia(self) -> float:
        """The least of the moments of inertia (kg m²) about axes through the centre."""
        return float(np.linalg.eigvalsh(np.atleast_2d(self.inertia)).min())


@dataclass(frozen=True)
class Opening:
    """A hole through the wall of a hull, between two points (m) in it as drawn; it is covered until `opens` (s).

    In space it is round: the points are the ends of its diameter in the section, and `x` (m) is where its middle is.
    """

    ends: tuple[tuple[float, float], tuple[float, float]]
    opens: float = 0.0
    x: float = 0.0

    def place(self, axes: int) -> tuple[np.ndarray, np.ndarray, float]:
        """Its middle (axes,) m, the unit normal of the wall there, to the left of its line, and half its width (m)."""
        start, end = np.array(self.ends)
        length = float(np.hypot(*(end - start)))
        along = (end - start) / length
        middle, normal = np.zeros(axes), np.zeros(axes)
        middle[:2], normal[:2] = 0.5 * (start + end), (-along[1], along[0])
        middle[2:] = self.x
        return middle, normal, 0.5 * length


@dataclass(frozen=True)
class Hull:
    """A body that is hollow: its `rooms` are simple polygons (m) as drawn, `wall` (m) what is between them and without.

    A wall between two rooms is as thick. `openings` lead through the walls. In space rooms are prisms.
    """

    wall: float
    rooms: tuple[tuple[tuple[float, float], ...] | PrismShape, ...]
    openings: tuple[Opening, ...] = ()


@dataclass(frozen=True)
class Body(Part):
    """A part with motions of its own; in water a thin plate between two points or, if it is `closed`, a solid polygon.

    Its `motions` are those that a tank may have (`solvers.motion`), in the tank's frame, from the drawn place on; they
    follow its `move`. They begin with the tank's own motion. `tank` is the number of the tank in which it stands. One
    that is `free` moves as what pushes it says; it has no motions. A solid one with a `hull` is hollow. A `sieve` holds
    grains back and lets water pass. In space a solid one has a `shape`, of which the points are the section.
    """

    closed: bool = False
    motions: tuple = ()
    tank: int = 0
    free: Free | None = None
    hull: Hull | None = None
    sieve: bool = False
    shape: SphereShape | PrismShape | None = None

    @property
    def lowest(self) -> float:
        """The height (m) of its lowest point as drawn."""
        return float(self.shape.bounds[0][1]) if self.shape else min(z for _, z in self.points)

    def volume(self, thickness: float) -> float:
        """Volume (m³) of a solid body, in the plane that of a slab of a `thickness` (m)."""
        return self.shape.volume if self.shape else abs(moments(np.asarray(self.points, float))[0]) * thickness

    def fastest(self) -> float:
        """Bound on the speed (m/s) of its corners."""
        fastest = super().fastest()
        for motion in self.motions:
            lever = 1.0
            if motion.coordinate == "turn":
                lever = max(hypot(y - motion.centre[0], z - motion.centre[1]) for y, z in self.points)
            fastest += lever * motion.fastest(0.0)
        return fastest
