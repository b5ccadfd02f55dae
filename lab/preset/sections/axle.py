"""The axle of a preset, about which the tank rolls freely, and the mass that slides above it."""

from dataclasses import dataclass
from functools import cached_property
from math import inf, pi
from typing import Annotated

from lab.base.errors import LabError
from lab.preset.fields import ANY, Columns, Table
from lab.preset.sections.history import KEY as KEY_OF_HISTORY
from lab.preset.sections.history import MOST_SAMPLES, Record, check_end, check_record, check_start
from lab.preset.units import show
from solvers.machine.marks import Doc, Interval, Unit, Usual
from solvers.motion import axle as solver
from solvers.motion.harmonic import Sway
from solvers.motion.history import Recorded

SHORTEST = 0.1  # s, in which a tank with something in it is heeled
Length = Annotated[float, Unit("m"), Interval(gt=0, le=1e3)]


@dataclass(frozen=True)
class Slide:
    """A mass that slides along a rail through the axle, level in the upright tank, harmonically or as a file says."""

    mass: Annotated[float, Unit("kg"), Interval(gt=0), Doc("The sliding mass.")]
    amplitude: Annotated[Length | None, Usual(0.0, 0.2, "mm"), Doc("Half its way to and fro.")] = None
    period: Annotated[
        Annotated[float, Unit("s"), Interval(gt=0)] | None, Usual(0.5, 4.0, "s"), Doc("Period of a harmonic slide.")
    ] = None
    phase: Annotated[float, Unit("rad"), Doc("Its phase at the start; 0 starts from the axle.")] = 0.0
    soft_start: Annotated[float, Unit("s"), Interval(ge=0), Doc("Time in which the slide comes up.")] = 0.0
    file: Annotated[
        Table | None,
        Columns((), (ANY,), MOST_SAMPLES),
        Doc("CSV file with columns of numbers, times and places of the mass, in place of amplitude and period."),
    ] = None
    time_column: Annotated[str, Doc("Name of the file's column with times (s).")] = "time"
    column: Annotated[str, Doc("Name of the file's column with the mass's place along the rail.")] = "x"
    length_unit: Annotated[str | None, Doc("Unit of that column; m if left out.")] = None
    time_unit: Annotated[str | None, Doc("Unit of the times; s if left out.")] = None

    @cached_property
    def motion(self) -> Sway | Recorded:
        """The slide as the solver takes it. Raises LabError."""
        if self.file is None:
            return Sway(self.amplitude, 1.0 / self.period, self.phase)
        return self.record.history.motions["sway"]

    @cached_property
    def record(self) -> Record:
        """The slide's file as that of a sway. Raises LabError for a column that is not there."""
        columns = self.file.columns
        for key, name in (("time_column", self.time_column), ("column", self.column)):
            if name not in columns:
                raise LabError(f"axle.slide.{key}: the file has no column {name}; it has {', '.join(columns)}.")
        own = {"time": columns[self.time_column], "sway": columns[self.column]}
        return Record(Table(self.file.name, own), self.length_unit, time_unit=self.time_unit)


@dataclass(frozen=True)
class Axle:
    """A fixed axle about which the tank rolls freely; it answers to what is in the tank.

    (I0 + m x²) φ̈ + 2 m x ẋ φ̇ − g S sin φ + m g x cos φ = −K sign φ̇ − B φ̇ + Q (Bulian, Souto-Iglesias, Delorme &
    Botia-Vera 2010). The contents' moment Q is not among the keys, nor is what the contents add to `inertia`.
    """

    place: Annotated[tuple[float, float], Unit("m"), Doc("Where the axle is in the tank's axes, y and z.")]
    inertia: Annotated[
        float, Unit("kg m^2"), Interval(gt=0), Doc("Moment of inertia I0 of tank and structure about the axle, empty.")
    ]
    moment: Annotated[
        float,
        Unit("kg m"),
        Doc("Static moment S of tank and structure: mass times the height of its centre over the axle, mostly < 0."),
    ]
    friction: Annotated[float, Unit("N m"), Interval(ge=0), Doc("Moment K of dry friction.")] = 0.0
    damping: Annotated[float, Unit("N m s"), Interval(ge=0), Doc("Linear damping B.")] = 0.0
    length: Annotated[Length | None, Doc("Length of the tank along the axle; the slab's thickness without it.")] = None
    heel: Annotated[float, Unit("rad"), Interval(ge=-pi, le=pi), Doc("Heel at which the tank is let go.")] = 0.0
    release: Annotated[float, Unit("s"), Interval(ge=0), Doc("When the tank is let go, heeled slowly until then.")] = (
        0.0
    )
    slide: Annotated[Slide | None, Doc("A mass that slides on a rail through the axle.")] = None

    @cached_property
    def solved(self) -> solver.Axle:
        """The axle as the solver takes it. Raises LabError."""
        own = self.place, self.inertia, self.moment, self.friction, self.damping
        sliding = {"length": self.length, "heel": self.heel, "release": self.release}
        if self.slide:
            sliding |= {"mass": self.slide.mass, "slide": self.slide.motion, "soft_start": self.slide.soft_start}
        return solver.Axle(*own, **sliding)


def check_axle(axle: Axle | None, ship: bool, moves: bool, holds: bool, duration: float, side: float) -> None:
    """Raise LabError for keys that contradict each other.

    `ship`, `moves`, `holds`: whether there is a ship, a prescribed motion, anything in the tank, whose larger side is
    `side` (m); the run lasts for `duration` (s).
    """
    if axle is None:
        return
    if ship:
        raise LabError("axle: a ship carries her tank herself; leave out [axle] or [ship].")
    if moves:
        raise LabError("motion: a tank on an axle rolls by itself; leave out the motions, or the axle.")
    if axle.heel and axle.release < SHORTEST and holds:
        least = show(SHORTEST, "s")
        raise LabError(f'axle.release: what is in the tank bears no sudden heel; give at least "{least}".')
    if axle.slide:
        _check_slide(axle.slide, duration, side)


def _check_slide(slide: Slide, duration: float, side: float) -> None:
    harmonic = {"amplitude": slide.amplitude, "period": slide.period}
    if slide.file is not None:
        for name, given in harmonic.items():
            if given is not None:
                raise LabError(f"axle.slide.{name}: the mass slides as its file has it; leave out {name}, or the file.")
        _check_record(slide, duration, side)
        return
    for name, given in harmonic.items():
        if given is None:
            raise LabError(f"axle.slide.{name}: missing; give amplitude and period, or a file.")


def _check_record(slide: Slide, duration: float, side: float) -> None:
    """Raise LabError for a record that no smooth curve fits, that starts in motion, or that ends before the run."""
    try:
        check_record(slide.record, side)
        check_start(slide.record.history, slide.soft_start or 0.0)
        check_end(slide.record.history, duration if duration < inf else 0.0)
    except LabError as error:
        raise LabError(_of_slide(str(error))) from None


def _of_slide(words: str) -> str:
    """What is said of a recorded motion of the tank, said of the slide."""
    changes = {
        KEY_OF_HISTORY: "axle.slide.file",
        "motion.history": "axle.slide",
        "motion.soft_start": "axle.slide.soft_start",
        "the motion's record": "the slide's record",
        "sway": "the mass",
    }
    for tank, slide in changes.items():
        words = words.replace(tank, slide)
    return words
