"""The motion of the tank in a preset: every registered motion, a recorded one, and those of plug-ins."""

from dataclasses import dataclass, fields, make_dataclass
from typing import Annotated

from lab.base.errors import LabError
from lab.preset.sections.history import KEY as RECORD
from lab.preset.sections.history import Record, check_record, check_start
from solvers.machine.marks import Doc, Interval, Unit
from solvers.motion import OF_TANK


@dataclass(frozen=True)
class MotionGroup:
    """The motions of the tank."""

    soft_start: Annotated[
        float, Unit("s"), Interval(ge=0), Doc("Time in which harmonic and recorded motions come up.")
    ] = 0.0

    @property
    def parts(self) -> dict[str, object]:
        """The motions in use by name, innermost first; those of plug-ins are outside, those from a record outermost."""
        named = {name: getattr(self, name) for name in OF_TANK}
        used = {name: part for name, part in named.items() if part is not None}
        for name, part in self.own.items():
            several = getattr(part, "motions", None)
            used |= {f"{name}.{one}": motion for one, motion in several.items()} if several else {name: part}
        recorded = self.history.history.motions if self.history else {}
        return used | {f"history.{name}": part for name, part in recorded.items()}

    @property
    def own(self) -> dict[str, object]:
        """The motions of plug-ins in use, by name, in alphabetical order, whichever was loaded first."""
        names = sorted({field.name for field in fields(self)} - OF_LAB)
        return {name: part for name in names if (part := getattr(self, name)) is not None}


OF_LAB = {"soft_start", "history", *OF_TANK}  # the keys that are no plug-ins
KINDS = [(name, kind, f"The tank's {name}.") for name, kind in OF_TANK.items()]
KINDS.append(("history", Record, "The tank's motion from a file."))
Motion = make_dataclass(
    "Motion",
    [(name, Annotated[kind | None, Doc(says)], None) for name, kind, says in KINDS],
    bases=(MotionGroup,),
    frozen=True,
)
"""The motions of the tank, any of which may be left out."""
Motion.__module__ = __name__  # so that it can be sent to another process


def check_motion(motion: Motion, extent: tuple[float, float]) -> None:
    """Raise LabError for a record that a tank so large (m) cannot follow, or a motion that starts in motion."""
    for name, part in motion.own.items():
        if hasattr(part, "motions"):
            _check_own(f"motion.{name}", part, motion.soft_start)
    if motion.history:
        check_record(motion.history, max(extent))
        check_start(motion.history.history, motion.soft_start)


def _check_own(key: str, part: object, soft_start: float) -> None:
    """Raise LabError for a function's motion that no tank follows, or that starts in motion."""
    part.check()
    try:
        check_start(part, soft_start)
    except LabError as error:
        raise LabError(str(error).replace(RECORD, key)) from None
