"""Bulk, loose cargo as a continuum, as a preset gives it."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, Literal

import numpy as np

from lab.preset.outline import Point, simple_polygon
from solvers.bulk.given import Granular
from solvers.bulk.laws import LAWS
from solvers.machine.marks import Cheap, Doc, Interval, Unit, Usual
from solvers.tank.outline import cut_off

FASTER = 0.261  # μ_2 − μ_s of glass beads (Jop, Forterre & Pouliquen 2006)
INERTIAL = 0.279  # I_0 of these
SOFTENING = 0.2  # our choice, of 0.05 and 0.2 the one that came nearer to beds of grains in tilts
ROUGH = 10.0  # friction of a wall along which nothing slides

Length = Annotated[float, Unit("m"), Interval(gt=0)]
Friction = Annotated[float, Interval(gt=0, le=2)]


@dataclass(frozen=True)
class Bulk:
    """Loose cargo as a continuum: how dense it is, how it holds against shear and along walls, and its cells.

    It is level up to its `depth`, or fills a `region`; at rest, under its own weight. A cell starts with four material
    points. The friction is the tangent of the angle at which a slope of it slides and comes to rest.
    """

    density: Annotated[
        float, Unit("kg/m^3"), Interval(gt=0), Usual(500.0, 4000.0, "kg/m^3"), Doc("Of the bed, pores included.")
    ]
    spacing: Annotated[
        Length, Cheap(), Usual(0.1, 2.0, "m"), Doc("Width of a cell; a whole number of them spans the tank.")
    ]
    cargo: Annotated[
        str | None,
        Doc(
            "Cargo of the library, or the path of a cargo file: it fills density, repose and diameter, which other "
            "keys here replace; `cargolab cargoes` lists them."
        ),
    ] = None
    depth: Annotated[
        Length | None,
        Usual(0.1, 15.0, "m"),
        Doc("Depth of the bed over the lowest point of [tank]; or give `region`. A further tank has its own depth."),
    ] = None
    region: Annotated[
        Annotated[tuple[tuple[float, float], ...], Unit("m")] | None,
        Doc("Corners, y and z each, of the part of [tank] that it fills, in place of `depth`."),
    ] = None
    repose: Annotated[
        Annotated[float, Unit("rad"), Interval(gt=0, lt=math.pi / 3)] | None,
        Usual(math.pi / 18, math.pi / 4, "deg"),
        Doc("Angle of repose; or give `friction`, its tangent."),
    ] = None
    friction: Annotated[Friction | None, Usual(0.2, 1.0, "1"), Doc("Friction of the bed, in place of `repose`.")] = None
    start_friction: Annotated[
        Friction | None,
        Doc("Friction of the bed before it has been sheared, more than `friction`; without it the same."),
    ] = None
    softening: Annotated[
        float, Interval(gt=0, le=10), Doc("Plastic shear strain over which the difference of the two fades.")
    ] = SOFTENING
    wall_friction: Annotated[
        Annotated[float, Interval(ge=0, le=2)] | None,
        Usual(0.0, 1.0, "1"),
        Doc("Friction along the tank's walls, at most that of the bed, which it is without it."),
    ] = None
    rough: Annotated[bool, Doc("Whether nothing slides along the walls.")] = False
    law: Annotated[
        Literal[*LAWS], Doc("Whether friction grows with the inertial number of the flow, or is constant.")
    ] = "mu-of-i"
    diameter: Annotated[Length, Usual(1e-3, 5e-2, "mm"), Doc("Diameter of the real grains.")] = 4e-3
    fast_friction: Annotated[
        Friction | None, Doc("Friction of very fast flow; without it 0.261 more than that of slow flow.")
    ] = None
    inertial_number: Annotated[
        float, Interval(gt=0, le=10), Doc("Inertial number at which half of the difference is reached.")
    ] = INERTIAL
    packing: Annotated[float, Interval(gt=0, lt=1), Doc("Share of the bed that is grains and not pores.")] = 0.6
    stiffness: Annotated[
        float,
        Cheap(),
        Interval(ge=10, le=1e5),
        Doc(
            "Young's modulus over the stress at the bottom of the bed; stiffer beds shift less, and need shorter steps."
        ),
    ] = 50.0

    @property
    def slow_friction(self) -> float:
        """μ_s of the bed."""
        return self.friction or math.tan(self.repose)

    @property
    def along_walls(self) -> float:
        """The friction along walls."""
        if self.rough:
            return ROUGH
        return self.slow_friction if self.wall_friction is None else self.wall_friction

    @cached_property
    def place(self) -> tuple[Point, ...] | None:
        """The corners (m) of its region, counter-clockwise. Raises LabError."""
        return simple_polygon(self.region) if self.region is not None else None

    def filled(self, corners: np.ndarray) -> np.ndarray:
        """The polygon (m, 2) m that it fills in a tank of these corners."""
        return cut_off(corners, self.depth) if self.depth else np.array(self.place)

    def material(self, high: float, gravity: float) -> Granular:
        """The material as the solver takes it; the deepest bed is `high` (m), under a `gravity` (m/s²)."""
        return Granular(
            density=self.density,
            friction=self.slow_friction,
            wall_friction=self.along_walls,
            young=self.stiffness * self.density * gravity * high,
            law=self.law,
            fast_friction=self.fast_friction or self.slow_friction + FASTER,
            inertial_number=self.inertial_number,
            diameter=self.diameter,
            packing=self.packing,
            start_friction=self.start_friction or 0.0,
            softening=self.softening,
        )
