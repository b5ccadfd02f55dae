"""The run of a preset: duration, repeats, step, accuracy and device."""

import math
from dataclasses import dataclass, replace
from typing import Annotated, Literal

from lab.base.errors import LabError
from lab.preset.accuracy import DEFAULT, LEVELS
from lab.preset.fields import Alike, Of
from lab.preset.sections.history import check_end
from lab.preset.sections.motion import Motion
from solvers.machine.marks import Doc, Interval, Unit, Usual

Time = Annotated[float, Unit("s"), Interval(gt=0)]


@dataclass(frozen=True)
class Run:
    """Duration, repeats, step, accuracy and device."""

    duration: Annotated[
        Time | None, Doc("How long the tank moves after settling; until the last motion ends without it.")
    ] = None
    repeats: Annotated[int, Interval(ge=1, le=100_000), Doc("Number of beds, each with a seed of its own.")] = 1
    seed: Annotated[int, Interval(ge=0, le=2**31 - 1), Doc("Seed of the first bed; the others count on from it.")] = 1
    settle: Annotated[bool, Doc("Whether the cargo settles before the tank moves.")] = True
    step: Annotated[
        Annotated[float, Unit("s"), Interval(gt=0, le=1.0)] | Literal["auto"],
        Doc("Time step; derived from the material and the speeds without it."),
    ] = "auto"
    force_step: Annotated[bool, Doc("Allow a step past the derived one.")] = False
    accuracy: Annotated[
        Literal[*LEVELS],
        Of("grains", "water"),
        Doc("Level of accuracy, which sets the grains' stiffness and step, or the spacing of the water."),
    ] = DEFAULT
    gravity: Annotated[
        float, Unit("m/s^2"), Interval(ge=0), Usual(0.1, 9.81, "m/s^2"), Doc("Acceleration of gravity; 0: none.")
    ] = 9.81
    settle_limit: Annotated[Time, Doc("Longest time for settling.")] = 5.0
    rest: Annotated[
        float, Of("grains"), Interval(gt=0), Doc("Mean kinetic energy of grains at rest, in m g d of a grain.")
    ] = 1e-6
    threads: Annotated[int, Alike(), Interval(ge=0, le=1024), Doc("Threads on the CPU; 0: one a core.")] = 0
    arch: Annotated[
        Literal["auto", "cpu", "cuda", "vulkan"],
        Alike(),
        Doc("Device that computes; auto: a graphics processor for many particles."),
    ] = "auto"
    schedule: Annotated[
        Literal["auto", "per-world", "per-band", "per-grain"], Doc("How the work is divided among threads.")
    ] = "auto"
    precision: Annotated[Literal["f64", "f32", "mixed"], Doc("Digits of the numbers.")] = "f64"
    integrator: Annotated[
        Literal["verlet", "symplectic-euler", "gear"], Of("grains"), Doc("Scheme that advances the grains in time.")
    ] = "verlet"

    @property
    def settles(self) -> bool:
        """Whether grains settle before the tank moves; without gravity they start where they are placed."""
        return self.settle and self.gravity > 0.0


def duration_of(run: Run, motion: Motion) -> float:
    """The run's duration (s): as given, else until the last motion that has an end is over. Raises LabError."""
    try:
        derived = run.duration or max((part.duration() for part in motion.parts.values()), default=0.0)
    except ArithmeticError:
        derived = math.inf
    if not 0.0 < derived < math.inf:
        raise LabError('run.duration: missing, and no motion has an end of its own; give e.g. "8 s".')
    if motion.history:
        check_end(motion.history.history, derived)
    for part in motion.own.values():
        if hasattr(part, "motions"):
            check_end(part, derived)
    return derived


def with_ends(run: Run, motion: Motion) -> Motion:
    """The motion, with those of plug-ins that have no end of their own ending with the run. Raises LabError."""
    endless = [name for name, part in motion.own.items() if getattr(part, "end", 0.0) is None]
    if not endless:
        return motion
    length = duration_of(run, replace(motion, **dict.fromkeys(endless)))
    return replace(motion, **{name: replace(getattr(motion, name), end=length) for name in endless})
