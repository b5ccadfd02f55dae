"""A tank's motion from a file: convert its record to SI, and refuse what the tank could not follow."""

from dataclasses import dataclass
from functools import cached_property
from typing import Annotated

import numpy as np

from lab.base.errors import LabError
from lab.preset.fields import Columns, Table
from lab.preset.units import parse, show
from solvers.machine.marks import Doc, Unit
from solvers.motion.history import LEAST_SAMPLES, History, Recorded

KEY = "motion.history.file"
MOST_SAMPLES = 100_000
FASTEST = 1e3  # m/s or rad/s: a faster motion probably has wrong units
AT_ZERO = 1e-3  # of the largest displacement: a record that starts closer to zero counts as starting at zero


@dataclass(frozen=True)
class Record:
    """A recorded motion: a CSV file with the column time (s) and any of sway, heave and roll."""

    file: Annotated[
        Table,
        Columns(("time",), ("sway", "heave", "roll"), MOST_SAMPLES),
        Doc("CSV file with the column time (s) and any of sway, heave and roll."),
    ]
    length_unit: Annotated[str, Doc("Unit of sway and heave in the file.")] = "m"
    angle_unit: Annotated[str, Doc("Unit of roll in the file.")] = "rad"
    centre: Annotated[tuple[float, float], Unit("m"), Doc("The fixed point, y and z, about which the tank rolls.")] = (
        0.0,
        0.0,
    )

    @cached_property
    def history(self) -> History:
        """The motion in SI. Raises LabError for a unit of another kind, or where nothing moves."""
        units = {
            "sway": _in_si(self.length_unit, "length_unit", "m"),
            "heave": _in_si(self.length_unit, "length_unit", "m"),
            "roll": _in_si(self.angle_unit, "angle_unit", "rad"),
        }
        columns = {name: np.array(values) for name, values in self.file.columns.items() if name != "time"}
        if not columns:
            raise LabError(f"{KEY}: nothing but times; a column sway, heave or roll is needed.")
        moved = {name: tuple((units[name] * values).tolist()) for name, values in columns.items()}
        return History(self.file.columns["time"], centre=self.centre, **moved)


def check_history(history: History) -> None:
    """Raise LabError for too many samples, times that do not increase, or samples that no smooth curve fits."""
    _check_times(np.array(history.time))
    for name, motion in history.motions.items():
        if len(motion.values) != len(motion.time):
            raise LabError(f"{KEY}: {name} needs as many samples as there are times.")
        _check_curve(name, motion)


def check_start(history: History, soft_start: float) -> None:
    """Raise LabError for a record that starts away from zero or in motion, unless there is a soft start (s)."""
    for name, motion in history.motions.items() if soft_start == 0.0 else ():
        symbol, first = _symbol(motion), motion.values[0]
        if abs(first) > AT_ZERO * np.abs(motion.values).max():
            raise LabError(f"{KEY}: {name} starts at {show(first, symbol)}, not at zero; {_remedy()}")
        if not motion.rests[0]:
            speed = show(float(motion.curve(0.0, 1)), _rate(motion))
            raise LabError(f"{KEY}: {name} starts at {speed}, not at rest; {_remedy()}")


def check_end(history: History, duration: float) -> None:
    """Raise LabError if the run lasts longer (s) than a record that ends in motion."""
    for name, motion in history.motions.items():
        length = motion.duration()
        if duration > length * (1.0 + 1e-9) and not motion.rests[1]:
            speed = show(float(motion.curve(length, 1)), _rate(motion))
            raise LabError(
                f"run.duration: {show(duration, 's')} is longer than the motion's record, {show(length, 's')}, "
                f"which ends with {name} at {speed}, not at rest; shorten the run."
            )


def _check_times(time: np.ndarray) -> None:
    if not LEAST_SAMPLES <= len(time) <= MOST_SAMPLES:
        raise LabError(f"{KEY}: from {LEAST_SAMPLES} to {MOST_SAMPLES} samples are possible (got {len(time)}).")
    wrong = np.flatnonzero(np.diff(time) <= 0.0)
    if len(wrong):
        before, after = time[wrong[0]], time[wrong[0] + 1]
        raise LabError(f"{KEY}: times must rise from row to row, but {after:.10g} s follows {before:.10g} s.")


def _check_curve(name: str, motion: Recorded) -> None:
    """Raise LabError for absurd speeds, or times so close that the curve cannot be computed."""
    with np.errstate(all="ignore"):
        try:
            usable = motion.fastest(0.0) < FASTEST and np.isfinite(motion.parameters(0.0)).all()
        except ValueError:  # raised by scipy
            usable = False
    if not usable:
        raise LabError(f"{KEY}: {name} moves too fast to be followed; look at its numbers and units.")


def _in_si(unit: str, key: str, symbol: str) -> float:
    try:
        return parse(f"1 {unit}", symbol)
    except LabError as error:
        raise LabError(f"motion.history.{key}: {error}") from None


def _symbol(motion: Recorded) -> str:
    return "rad" if motion.coordinate == "turn" else "m"


def _rate(motion: Recorded) -> str:
    return f"{_symbol(motion)}/s"


def _remedy() -> str:
    return 'let it come up by motion.soft_start, e.g. "2 s".'
