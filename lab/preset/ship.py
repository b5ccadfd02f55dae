"""The ship, water and waves of a preset, and the position and motion of the ship's axis.

`lab.assembly.ship` builds the solver's vessel from them.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import pi, radians
from typing import Annotated, Literal

import numpy as np
from pydantic import TypeAdapter

from lab.preset.units import show
from solvers.machine.marks import Interval, Unit
from solvers.ship.hydrostatics import turned

FREEDOM = {"roll": (False, False, True), "heave-roll": (False, True, True), "sway-heave-roll": (True, True, True)}

Length = Annotated[float, Unit("m"), Interval(ge=1e-3, le=1e3)]  # of a model or a ship
AngularFrequency = Annotated[float, Unit("rad/s"), Interval(gt=0)]


@dataclass(frozen=True)
class RigGiven:
    """The rig that holds a model, per metre of length: moving masses and dashpots in sway and heave, a sway spring."""

    sway_mass: Annotated[float, Unit("kg/m"), Interval(ge=0)] = 0.0
    heave_mass: Annotated[float, Unit("kg/m"), Interval(ge=0)] = 0.0
    sway_damping: Annotated[float, Unit("N s/m^2"), Interval(ge=0)] = 0.0
    heave_damping: Annotated[float, Unit("N s/m^2"), Interval(ge=0)] = 0.0
    sway_spring: Annotated[float, Unit("Pa"), Interval(ge=0)] = 0.0


@dataclass(frozen=True)
class HatchGiven:
    """A hatch in the middle of the deck: its breadth, and the height of its coaming above the deck."""

    breadth: Length
    coaming: Length


@dataclass(frozen=True)
class ShipGiven:
    """The hull's section and how the ship floats with her cargo aboard; the tank of the preset is her hold.

    The hull is a box of `breadth` and `height` (depth to the deck) with the origin at the middle of its keel, or an
    `outline` with corners in the hull's own axes. A box may have a `hatch`: its coaming keeps water out as sides do,
    and its upper edges are openings. `openings`: further points, of any hull, through which the ship floods once they
    are under water. `deck`: height of the deck's edge above the origin, for an `outline`; that of a box is `height`.
    `draught`, `gravity_height` (above the origin) and `gyradius` or `roll_period` are those of ship and cargo together,
    as the cargo lies at the start. `hold`: position of the tank's origin. `axis`: the ship's point of reference, by
    default the middle of the waterline. Sway and heave are the motions of this point from its position at rest
    (`axis_motion`), in equations, recordings, figures and pictures; `freedom` frees or holds them, and the ship is
    heeled about this point. The source's model has `radiation` at the waves' frequency, and the waves' slope as
    `excitation` of roll. `damping` is a fraction of the critical damping, `quadratic_damping` is per rad:
    φ̈ + 2 ζ ω₀ φ̇ + b φ̇|φ̇| + ω₀² φ. `repose`: the cargo's angle of repose, used only for the righting-arm curve with
    relaxed cargo, not by the grains of a run; the default is that of the source's acetate, the first of the critical
    angles that it found by tilting (Spandonidis 2016, section 7.1). `scale`: ratio of the full-scale ship's length to
    the model's; it changes only texts.
    """

    draught: Length
    gravity_height: Annotated[float, Unit("m")]
    breadth: Length | None = None
    height: Length | None = None
    outline: Annotated[tuple[tuple[float, float], ...], Unit("m")] | None = None
    gyradius: Length | None = None
    roll_period: Annotated[float, Unit("s"), Interval(gt=0)] | None = None
    hold: Annotated[tuple[float, float], Unit("m")] = (0.0, 0.0)
    axis: Annotated[tuple[float, float], Unit("m")] | None = None
    freedom: Literal[*FREEDOM] = "sway-heave-roll"
    radiation: Literal["memory", "at-frequency", "none"] = "memory"
    excitation: Literal["diffraction", "froude-krylov", "wave-slope"] = "diffraction"
    damping: Annotated[float, Interval(ge=0, le=1)] = 0.0
    quadratic_damping: Annotated[float, Interval(ge=0)] = 0.0
    heel: Annotated[float, Unit("rad"), Interval(ge=-pi, le=pi)] = 0.0
    release: Annotated[float, Unit("s"), Interval(ge=0)] = 0.0
    capsize: Annotated[float, Unit("rad"), Interval(gt=0)] | None = 0.5 * pi
    repose: Annotated[float, Unit("rad"), Interval(ge=0, le=0.5 * pi)] = radians(25.0)
    scale: Annotated[float, Interval(gt=0)] | None = None
    rig: RigGiven = field(default_factory=RigGiven)
    hatch: HatchGiven | None = None
    openings: Annotated[tuple[tuple[float, float], ...], Unit("m")] = ()
    deck: Annotated[float, Unit("m")] | None = None

    @property
    def corners(self) -> np.ndarray:
        """The hull's outline (m, 2), m, with the hatch's coaming."""
        if self.outline is not None:
            return np.array(self.outline)
        half, port = 0.5 * self.breadth, [[-y, z] for y, z in reversed(self._coaming)]
        sides = [[-half, 0.0], [half, 0.0], [half, self.height]], [[-half, self.height]]
        return np.array([*sides[0], *self._coaming, *port, *sides[1]])

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
        if self.deck_height is None:
            return ()
        begin, end = self.corners, np.roll(self.corners, -1, axis=0)
        low, high = np.minimum(begin[:, 1], end[:, 1]), np.maximum(begin[:, 1], end[:, 1])
        level = self.deck_height
        meets = (low <= level) & (level <= high)
        share = np.divide(level - begin[:, 1], end[:, 1] - begin[:, 1], where=high > low, out=np.zeros(len(begin)))
        across = (begin[:, 0] + share * (end[:, 0] - begin[:, 0]))[meets]
        across = np.concatenate([across, end[meets & (high == low), 0]])
        return (float(across.max()), level), (float(across.min()), level)

    @property
    def about(self) -> tuple[float, float]:
        """The ship's axis in the hull's axes (m)."""
        return self.axis or (0.0, float(self.corners[:, 1].min()) + self.draught)

    @property
    def heave(self) -> float:
        """Heave of the hull's origin at rest (m)."""
        return -self.draught - float(self.corners[:, 1].min())


@dataclass(frozen=True)
class WaterGiven:
    """The water that the ship floats in; deep unless its depth is given."""

    density: Annotated[float, Unit("kg/m^3"), Interval(ge=500, le=2000)] = 1000.0
    depth: Annotated[float, Unit("m"), Interval(ge=1e-3, le=2e4)] | None = None


@dataclass(frozen=True)
class WavesGiven:
    """Waves that travel to starboard.

    Regular: `amplitude` and `frequency`. A packet: it peaks with `amplitude` at the ship at `time`; `spread` is the
    standard deviation of its frequency. A random sea: `height` is the significant wave height, `frequency` the peak's.
    """

    frequency: AngularFrequency
    kind: Literal["regular", "packet", "jonswap", "pierson-moskowitz"] = "regular"
    amplitude: Annotated[float, Unit("m"), Interval(ge=0)] | None = None
    height: Annotated[float, Unit("m"), Interval(ge=0)] | None = None
    spread: AngularFrequency | None = None
    time: Annotated[float, Unit("s"), Interval(ge=0)] | None = None
    peakedness: Annotated[float, Interval(ge=1, le=10)] = 3.3
    seed: Annotated[int, Interval(ge=0, le=2**31 - 1)] = 1
    soft_start: Annotated[float, Unit("s"), Interval(ge=0)] = 0.0


def recorded_ship(preset: Mapping) -> ShipGiven:
    """The ship of a recorded preset (all values in SI)."""
    return TypeAdapter(ShipGiven).validate_python(preset["ship"])


def axis_place(given: ShipGiven) -> str:
    """Where the ship's axis is, in words."""
    y, z = given.about
    beside = "" if y == 0.0 else f"{show(abs(y), 'm')} to {'starboard' if y > 0.0 else 'port'} of and "
    return f"{beside}{show(z, 'm')} above her origin" + ("" if given.axis else ", in the waterline")


def axis_motion(ship: ShipGiven, pose: np.ndarray) -> np.ndarray:
    """Sway and heave (m) of the ship's axis from its position at rest, and roll (rad), from the tank's poses (…, 3).

    Everywhere in the lab, sway and heave of a ship are defined in this way.
    """
    arm = turned(tuple(np.subtract(ship.hold, ship.about)), pose[..., 2])
    rest = np.array([ship.about[0], ship.heave + ship.about[1]])
    return np.concatenate([pose[..., :2] - arm - rest, pose[..., 2:]], axis=-1)
