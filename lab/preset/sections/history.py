"""A tank's motion from a file: smooth its record within its digits, convert it to SI, refuse what no tank follows."""

from dataclasses import dataclass
from functools import cached_property
from typing import Annotated

import numpy as np

from lab.base.errors import LabError
from lab.preset.fields import Columns, Table
from lab.preset.units import parse, show
from solvers.machine.marks import Doc, Unit
from solvers.motion.frame import is_turn
from solvers.motion.history import LEAST_SAMPLES, History, Recorded
from solvers.motion.rounded import MANY, even_times, smoothed

KEY = "motion.history.file"
UNITS = {"sway": "m", "heave": "m", "roll": "rad", "surge": "m", "pitch": "rad", "yaw": "rad"}  # of its columns
MOST_SAMPLES = 100_000
FASTEST = 1e3  # m/s or rad/s: a faster motion probably has wrong units
HARDEST = 1e3  # m/s² or rad/s²: a hundred g, more than any tank is shaken or dropped with; mostly noise, or wrong units
# Beyond these a logged record is asked to say its unit, since it may be in mm, deg or ms: in tanks' larger sides (rigs
# move them by a part of one), in rad (57 deg; rigs roll by half of that), in s from sample to sample.
FAR, TURNED, SLOW = 2.0, 1.0, 1.0
AT_ZERO = 1e-3  # of the largest displacement: a record that starts closer to zero counts as starting at zero


@dataclass(frozen=True)
class Record:
    """A recorded motion: a CSV file with the column time and any of sway, heave, roll; in space surge, pitch, yaw too.

    It is smoothed within the last digit to which the file was printed (`solvers.motion.rounded`).
    """

    file: Annotated[
        Table,
        Columns(("time",), tuple(UNITS), MOST_SAMPLES),
        Doc("CSV file with the column time and any of sway, heave and roll, in space also surge, pitch and yaw."),
    ]
    length_unit: Annotated[str | None, Doc("Unit of sway, heave and surge in the file; m if left out.")] = None
    angle_unit: Annotated[str | None, Doc("Unit of roll, pitch and yaw in the file; rad if left out.")] = None
    time_unit: Annotated[str | None, Doc("Unit of time in the file; s if left out.")] = None
    centre: Annotated[tuple[float, float], Unit("m"), Doc("The fixed point, y and z, about which the tank turns.")] = (
        0.0,
        0.0,
    )

    @cached_property
    def history(self) -> History:
        """The motion in SI. Raises LabError for a unit of another kind, or where nothing moves."""
        length, angle = in_si(self.length_unit, "length_unit", "m"), in_si(self.angle_unit, "angle_unit", "rad")
        units = {name: angle if symbol == "rad" else length for name, symbol in UNITS.items()}
        columns = {name: np.array(values) for name, values in self.file.columns.items()}
        time = columns.pop("time")
        if not columns:
            raise LabError(f"{KEY}: nothing but times; a column sway, heave or roll is needed.")
        time, columns = as_moved(time, columns)
        moved = {name: tuple((units[name] * values).tolist()) for name, values in columns.items()}
        seconds = in_si(self.time_unit, "time_unit", "s")
        return History(tuple((seconds * time).tolist()), centre=self.centre, **moved)


def as_moved(time: np.ndarray, columns: dict[str, np.ndarray]) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Times (n,) and columns (n,) of a file without the rounding of their digits; unchanged if they are no record."""
    if not (np.diff(time) > 0.0).all():
        return time, columns
    try:
        with np.errstate(all="ignore"):
            even = even_times(time)
            return even, {name: smoothed(even, values) for name, values in columns.items()}
    except (ValueError, ArithmeticError, np.linalg.LinAlgError):  # what is wrong with it, `check_history` says
        return time, columns


def check_record(record: Record, side: float) -> None:
    """Raise LabError for a file that is no smooth motion, or in units that it should say; `side`: the tank's larger."""
    _check_times(np.array(record.history.time))
    _check_units(record, side)
    check_history(record.history)


def _check_units(record: Record, side: float) -> None:
    """Raise LabError for a record that seems to be in other units than those of SI, and does not say its own."""
    history = record.history
    if len(history.time) < MANY:
        return
    if record.time_unit is None:
        step = float(np.median(np.diff(history.time)))
        _ask(step >= SLOW, "time_unit", f"samples are {show(step, 's')} apart", ("ms", "milliseconds"), "s")
    for name, motion in history.motions.items():
        far = float(np.ptp(motion.values))
        turns = is_turn(motion.coordinate)
        if turns and record.angle_unit is None:
            turned = float(np.abs(motion.values).max())
            _ask(turned > TURNED, "angle_unit", f"{name} reaches {turned:.4g} rad", ("deg", "degrees"), "rad")
        elif not turns and record.length_unit is None:
            moved = f"{name} goes {far:.4g} m to and fro, beside a tank of {show(side, 'm')}"
            _ask(far > FAR * side, "length_unit", moved, ("mm", "millimetres"), "m")


def _ask(strange: bool, key: str, found: str, other: tuple[str, str], unit: str) -> None:
    if strange:
        short, name = other
        raise LabError(
            f'motion.history.{key}: {found}; say {key} = "{short}" if the file is in {name}, "{unit}" if it is right.'
        )


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
    if motion.hardest() > HARDEST:
        unit, key = f"{_rate(motion)}²", "angle_unit" if is_turn(motion.coordinate) else "length_unit"
        raise LabError(
            f"{KEY}: {name} has accelerations of {motion.hardest():.3g} {unit}, and no tank is shaken by more than "
            f"{HARDEST:g} {unit}; smooth out its noise, or look at {key} and time_unit."
        )


def in_si(unit: str | None, key: str, symbol: str) -> float:
    """One of a file's unit, or of SI's where none is said. Raises LabError for a unit of another kind."""
    try:
        return parse(f"1 {symbol if unit is None else unit}", symbol)
    except LabError as error:
        raise LabError(f"motion.history.{key}: {error}") from None


def _symbol(motion: Recorded) -> str:
    return "rad" if is_turn(motion.coordinate) else "m"


def _rate(motion: Recorded) -> str:
    return f"{_symbol(motion)}/s"


def _remedy() -> str:
    return 'let it come up by motion.soft_start, e.g. "2 s".'
