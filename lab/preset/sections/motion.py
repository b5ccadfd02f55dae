"""The motion of the tank in a preset: every registered motion, and a recorded one."""

from dataclasses import dataclass, make_dataclass
from typing import Annotated

from lab.preset.sections.history import HistoryGiven, check_start, read_history
from solvers.machine.marks import Interval, Unit
from solvers.motion import MOTIONS
from solvers.motion.history import History


@dataclass(frozen=True)
class MotionGroup:
    """The motions of the tank."""

    soft_start: Annotated[float, Unit("s"), Interval(ge=0)] = 0.0

    @property
    def parts(self) -> dict[str, object]:
        """The motions in use by name, innermost first; those from a record are outermost."""
        named = {name: getattr(self, name) for name in MOTIONS}
        used = {name: part for name, part in named.items() if part is not None}
        recorded = self.history.motions if self.history else {}
        return used | {f"history.{name}": part for name, part in recorded.items()}


def _motions(name: str, history: type) -> type:
    """A section with every registered motion and a `history`, any of which may be left out."""
    kinds = {**MOTIONS, "history": history}
    return make_dataclass(
        name, [(key, kind | None, None) for key, kind in kinds.items()], bases=(MotionGroup,), frozen=True
    )


MotionGiven = _motions("MotionGiven", HistoryGiven)
Motion = _motions("Motion", History)


def full_motion(given: MotionGiven) -> Motion:
    """The resolved motions; a record is read from its file."""
    kept = {name: getattr(given, name) for name in ("soft_start", *MOTIONS)}
    if given.history is None:
        return Motion(**kept)
    history = read_history(given.history)
    check_start(history, given.soft_start)
    return Motion(**kept, history=history)
