"""The loss of a ship: whether she capsizes, floods or sinks, when, at which roll, and how to report it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from solvers.machine.quantity import ROLL

VERBS = {"capsized": "capsizes", "flooded": "floods", "sunk": "sinks"}


@dataclass(frozen=True)
class End:
    """The loss of a ship: `kind`, a key of VERBS; time (s); roll at that time (rad, positive to port)."""

    kind: str
    time: float
    roll: float

    @property
    def words(self) -> str:
        """A text such as "floods at 4.52 s, 39.8 deg to port"."""
        side = "port" if self.roll > 0.0 else "starboard"
        return f"{VERBS[self.kind]} at {self.time:.4g} s, {abs(np.degrees(self.roll)):.3g} deg to {side}"


def end_of(capsized: float, flooded: float, roll: float, sunk: float = -1.0) -> End | None:
    """The loss of a ship, None if she was not lost.

    capsized, flooded, sunk: times (s), −1 if it did not happen; roll: since then (rad).
    """
    times = {"capsized": float(capsized), "flooded": float(flooded), "sunk": float(sunk)}
    lost = {kind: when for kind, when in times.items() if when >= 0.0}
    kind = min(lost, key=lost.get, default=None)
    return End(kind, lost[kind], float(roll)) if kind else None


def ends(series: Mapping[str, np.ndarray]) -> list[End | None]:
    """The loss of the ship in each world of a recording's series, None if she was not lost or there is no ship."""
    if "capsized" not in series or not len(series["time"]):
        return [None] * series["pose"].shape[1]
    # The world of a lost ship stops, so the last sample has her roll at that time.
    capsized, roll = series["capsized"][-1], series["pose"][-1, :, ROLL]
    sunk = series["sunk"][-1] if "sunk" in series else [-1.0] * len(roll)
    rows = zip(capsized, series["flooded"][-1], roll, sunk, strict=True)
    return [end_of(*row) for row in rows]


def losses_sentence(found: Sequence[End | None]) -> str:
    """One sentence on the ships that were lost in a run; empty if none was."""
    if len(found) == 1:
        return f"She {found[0].words}." if found[0] else ""
    parts = []
    for kind, verb in VERBS.items():
        times = [end.time for end in found if end and end.kind == kind]
        if times:
            when = f"at {times[0]:.4g} s" if len(times) == 1 else f"after {min(times):.4g} to {max(times):.4g} s"
            parts.append(f"with {len(times)} of {len(found)} beds she {verb} {when}")
    return f"{'; '.join(parts).capitalize()}." if parts else ""
