"""The motion of the tank in a preset: every registered motion, and a recorded one."""

from dataclasses import dataclass, make_dataclass
from typing import Annotated

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
        """The motions in use by name, innermost first; those from a record are outermost."""
        named = {name: getattr(self, name) for name in OF_TANK}
        used = {name: part for name, part in named.items() if part is not None}
        recorded = self.history.history.motions if self.history else {}
        return used | {f"history.{name}": part for name, part in recorded.items()}


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
    """Raise LabError for a record that a tank so large (m) cannot follow, or that starts in motion."""
    if motion.history:
        check_record(motion.history, max(extent))
        check_start(motion.history.history, motion.soft_start)
