"""The run of a preset: duration, repeats, step, accuracy and device."""

import math
from dataclasses import dataclass, field
from typing import Annotated, Literal

from lab.base.errors import LabError
from lab.preset.accuracy import DEFAULT, LEVELS
from lab.preset.sections.history import check_end
from lab.preset.sections.motion import Motion
from solvers.machine.marks import Interval, Unit

Time = Annotated[float, Unit("s"), Interval(gt=0)]


@dataclass(frozen=True)
class RunGiven:
    """Duration, repeats, step, accuracy and device; by default `duration` lasts until the last motion ends."""

    duration: Time | None = None
    repeats: Annotated[int, Interval(ge=1, le=100_000)] = 1
    seed: Annotated[int, Interval(ge=0, le=2**31 - 1)] = 1
    settle: bool = True
    step: Annotated[float, Unit("s"), Interval(gt=0, le=1.0)] | Literal["auto"] = "auto"
    force_step: bool = False
    accuracy: Literal[*LEVELS] = DEFAULT
    gravity: Annotated[float, Unit("m/s^2"), Interval(gt=0)] = 9.81
    settle_limit: Time = 5.0
    rest: Annotated[float, Interval(gt=0)] = 1e-6
    threads: Annotated[int, Interval(ge=0, le=1024)] = 0
    arch: Literal["auto", "cpu", "cuda", "vulkan"] = "auto"
    schedule: Literal["auto", "per-world", "per-band", "per-grain"] = "auto"
    precision: Literal["f64", "f32", "mixed"] = "f64"
    integrator: Literal["verlet", "symplectic-euler", "gear"] = "verlet"


@dataclass(frozen=True)
class Run(RunGiven):
    """The run with its duration."""

    duration: Time = field(kw_only=True)


def duration_of(run: RunGiven, motion: Motion) -> float:
    """The run's duration (s): as given, else until the last motion that has an end is over."""
    try:
        derived = run.duration or max((part.duration() for part in motion.parts.values()), default=0.0)
    except ArithmeticError:
        derived = math.inf
    if not 0.0 < derived < math.inf:
        raise LabError('run.duration: missing, and no motion has an end of its own; give e.g. "8 s".')
    if motion.history:
        check_end(motion.history, derived)
    return derived
