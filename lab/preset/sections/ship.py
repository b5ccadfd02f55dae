"""The ship of a preset: her hull's section, and how she floats with her cargo aboard."""

from dataclasses import dataclass, field
from math import pi, radians
from typing import Annotated, Literal

import numpy as np

from lab.preset.fields import Columns, Table
from lab.preset.outline import at_height, box_hull
from lab.preset.units import show
from solvers.machine.marks import Doc, Interval, Unit
from solvers.machine.quantity import flat
from solvers.ship.hydrostatics import turned

OFFSETS = "station", "z", "half_breadth"  # columns of her hull's file
MOST_OFFSETS = 100_000  # rows
FREEDOM = {"roll": (False, False, True), "heave-roll": (False, True, True), "sway-heave-roll": (True, True, True)}

Length = Annotated[float, Unit("m"), Interval(ge=1e-3, le=1e3)]  # of a model or a ship
Points = Annotated[tuple[tuple[float, float], ...], Unit("m")]
Point = Annotated[tuple[float, float], Unit("m")]


@dataclass(frozen=True)
class Rig:
    """The rig that holds a model, per metre of length: moving masses and dashpots in sway and heave, a sway spring."""

    sway_mass: Annotated[float, Unit("kg/m"), Interval(ge=0), Doc("Mass that moves with the model in sway.")] = 0.0
    heave_mass: Annotated[float, Unit("kg/m"), Interval(ge=0), Doc("Mass that moves with the model in heave.")] = 0.0
    sway_damping: Annotated[float, Unit("N s/m^2"), Interval(ge=0), Doc("Dashpot in sway.")] = 0.0
    heave_damping: Annotated[float, Unit("N s/m^2"), Interval(ge=0), Doc("Dashpot in heave.")] = 0.0
    sway_spring: Annotated[float, Unit("Pa"), Interval(ge=0), Doc("Spring in sway.")] = 0.0


@dataclass(frozen=True)
class Hatch:
    """A hatch in the middle of the deck."""

    breadth: Annotated[Length, Doc("Breadth of the hatch.")]
    coaming: Annotated[Length, Doc("Height of its coaming above the deck.")]


@dataclass(frozen=True)
class BilgeKeels:
    """A pair of bilge keels in the middle of the bilges."""

    breadth: Annotated[Length, Doc("Breadth of each keel.")]
    length: Annotated[Length, Doc("Length of each keel along the ship.")]


@dataclass(frozen=True)
class Ship:
    """The hull's section and how the ship floats with her cargo aboard; the tank of the preset is her hold.

    The hull is a box of `breadth` and `height` with the origin at the middle of its keel, or an `outline` with corners
    in the hull's own axes. A box may have a `hatch`: its coaming keeps water out as sides do, and its upper edges are
    openings. Sway and heave are the motions of her axis from its position at rest (`axis_motion`), in equations,
    recordings, figures and pictures; she is heeled about it. With a negative GM she lolls, and ω₀ is that of small
    rolls about her angle of loll. `damping` and `quadratic_damping` are those of φ̈ + 2 ζ ω₀ φ̇ + b φ̇|φ̇| + ω₀² φ.
    `hydrodynamics` changes what is linear in waves and motion. Buoyancy is that of her section times `length`, or with
    `offsets` of her whole hull, on an even keel. The default of `repose` is that of the source's acetate, the first of
    the critical angles that it found by tilting (Spandonidis 2016, section 7.1).
    """

    draught: Annotated[Length, Doc("Draught with her cargo aboard.")]
    gravity_height: Annotated[
        float, Unit("m"), Doc("Height of the centre of gravity of ship and cargo above the hull's origin.")
    ]
    breadth: Annotated[Length | None, Doc("Breadth of a box.")] = None
    height: Annotated[Length | None, Doc("Depth of a box, from keel to deck.")] = None
    outline: Annotated[
        Points | None, Doc("Corners of the hull in its own axes, y and z each, in place of breadth and height.")
    ] = None
    gyradius: Annotated[
        Length | None, Doc("Gyradius in roll of ship and cargo together; give it or `roll_period`.")
    ] = None
    roll_period: Annotated[
        Annotated[float, Unit("s"), Interval(gt=0)] | None, Doc("Natural period of roll, in place of `gyradius`.")
    ] = None
    bare: Annotated[
        bool,
        Doc("Whether `gravity_height` and `gyradius` are hers without the water in her tanks; her draught is with it."),
    ] = False
    length: Annotated[
        Length | None,
        Doc("Her length; without offsets, of so many metres of her section. The length of her hold counts beside it."),
    ] = None
    hold: Annotated[Point, Doc("Where the tank's origin is in the hull's axes, y and z.")] = (0.0, 0.0)
    axis: Annotated[
        Point | None, Doc("The ship's point of reference in the hull's axes; the middle of the waterline without it.")
    ] = None
    freedom: Annotated[Literal[*FREEDOM], Doc("In which directions she is free to move.")] = "sway-heave-roll"
    coupling: Annotated[
        Literal["instant", "staggered"],
        Doc("Whether she responds to the load of each instant, or takes steps with an extrapolated load (staggered)."),
    ] = "instant"
    coupling_step: Annotated[
        float, Unit("s"), Interval(ge=1e-4, le=0.1), Doc('Her step with coupling = "staggered".')
    ] = 0.01
    radiation: Annotated[Literal["memory", "at-frequency", "none"], Doc("How the waves that she makes act on her.")] = (
        "memory"
    )
    hydrodynamics: Annotated[
        Literal["section", "strips", "hull"],
        Doc(
            "What waves that meet her and that she makes are computed of: her section, in the plane; strips across her "
            "whole hull; or that hull in space, by Capytaine (the extra ship3d)."
        ),
    ] = "section"
    offsets: Annotated[
        Table | None,
        Columns(OFFSETS, most=MOST_OFFSETS),
        Doc(
            "A CSV file of her hull's offsets, by which she also floats and rights at any heel, on an even keel; "
            "without it her hull is a prism, her section all along `length`."
        ),
    ] = None
    excitation: Annotated[
        Literal["diffraction", "froude-krylov", "wave-slope"], Doc("How the waves that meet her act on her.")
    ] = "diffraction"
    damping: Annotated[
        float, Interval(ge=0, le=1), Doc("Viscous roll damping ζ as a fraction of the critical damping.")
    ] = 0.0
    linear_damping: Annotated[
        Annotated[float, Unit("N s"), Interval(ge=0)] | None,
        Doc("Linear roll damping, moment over rate per metre of length, in place of `damping`."),
    ] = None
    quadratic_damping: Annotated[float, Interval(ge=0), Doc("Quadratic roll damping b, per rad.")] = 0.0
    viscous_damping: Annotated[
        Literal["given", "ikeda"],
        Doc(
            "Whether viscous roll damping is given by the keys above, or computed by Ikeda's method from her sections "
            "and `bilge_keels`."
        ),
    ] = "given"
    heel: Annotated[
        float,
        Unit("rad"),
        Interval(ge=-pi, le=pi),
        Doc("Heel at the start, positive to port; 0: as she rests, upright or at her angle of loll."),
    ] = 0.0
    release: Annotated[
        float,
        Unit("s"),
        Interval(ge=0),
        Doc("When she is let go, heeled slowly until then; one that lolls after a period of roll, if this is 0."),
    ] = 0.0
    capsize: Annotated[
        Annotated[float, Unit("rad"), Interval(gt=0)] | None,
        Doc("Roll at which she counts as capsized and the run ends; false: never."),
    ] = 0.5 * pi
    repose: Annotated[
        float,
        Unit("rad"),
        Interval(ge=0, le=0.5 * pi),
        Doc(
            "The cargo's angle of repose, for the curve of righting levers with relaxed cargo and the IMSBC Code alone."
        ),
    ] = radians(25.0)
    scale: Annotated[
        Annotated[float, Interval(gt=0)] | None,
        Doc("Length of the full-scale ship over the model's; it changes only texts."),
    ] = None
    rig: Annotated[Rig, Doc("The rig that holds a model.")] = field(default_factory=Rig)
    hatch: Annotated[Hatch | None, Doc("A hatch in the deck of a box.")] = None
    bilge_keels: Annotated[BilgeKeels | None, Doc('Bilge keels, for viscous_damping = "ikeda".')] = None
    openings: Annotated[Points, Doc("Points through which she floods once they are under water.")] = ()
    deck: Annotated[
        Annotated[float, Unit("m")] | None, Doc("Height of the deck's edge above the origin, for an `outline`.")
    ] = None

    @property
    def corners(self) -> np.ndarray:
        """The hull's outline (m, 2), m, with the hatch's coaming."""
        if self.outline is not None:
            return np.array(self.outline)
        return box_hull(self.breadth, self.height, self._coaming)

    @property
    def _coaming(self) -> list[list[float]]:
        """The corners of the hatch's coaming to starboard, from the deck up."""
        if self.hatch is None:
            return []
        half = 0.5 * self.hatch.breadth
        return [[half, self.height], [half, self.height + self.hatch.coaming]]

    @property
    def flooding_points(self) -> tuple[tuple[float, float], ...]:
        """The edges of the hatch and all other openings (m)."""
        edge = self._coaming[-1:]
        return (*((side * y, z) for side in (1.0, -1.0) for y, z in edge), *self.openings)

    @property
    def deck_height(self) -> float | None:
        """Height of the deck's edge above the hull's origin (m), None if not given for an outline."""
        return self.height if self.outline is None else self.deck

    @property
    def deck_edges(self) -> tuple[tuple[float, float], ...]:
        """The outermost points of the hull at deck height, starboard and port (m); none if the deck is not known."""
        return () if self.deck_height is None else at_height(self.corners, self.deck_height)

    @property
    def about(self) -> tuple[float, float]:
        """The ship's axis in the hull's axes (m)."""
        return self.axis or (0.0, float(self.corners[:, 1].min()) + self.draught)

    @property
    def heave(self) -> float:
        """Heave of the hull's origin at rest (m)."""
        return -self.draught - float(self.corners[:, 1].min())

    @property
    def hold_at_rest(self) -> tuple[float, float]:
        """Where the tank's origin is in the earth's axes as she rests upright, y and z (m)."""
        return self.hold[0], self.heave + self.hold[1]


def axis_place(ship: Ship) -> str:
    """Where the ship's axis is, in words."""
    y, z = ship.about
    beside = "" if y == 0.0 else f"{show(abs(y), 'm')} to {'starboard' if y > 0.0 else 'port'} of and "
    return f"{beside}{show(z, 'm')} above her origin" + ("" if ship.axis else ", in the waterline")


def axis_motion(ship: Ship, pose: np.ndarray) -> np.ndarray:
    """Sway and heave (m) of the ship's axis from its position at rest, and roll (rad), from the tank's poses (…, 3),
    in space (…, 6).

    Everywhere in the lab, sway and heave of a ship are defined in this way.
    """
    pose = flat(pose)
    arm = turned(tuple(np.subtract(ship.hold, ship.about)), pose[..., 2])
    rest = np.array([ship.about[0], ship.heave + ship.about[1]])
    return np.concatenate([pose[..., :2] - arm - rest, pose[..., 2:]], axis=-1)
