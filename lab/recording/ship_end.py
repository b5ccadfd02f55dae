"""How a ship was lost, if she was: she capsizes or floods, when, how far over, and the words for it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

VERBS = {"capsized": "capsizes", "flooded": "floods"}


@dataclass(frozen=True)
class End:
    """What became of a ship (`kind`, one of VERBS), when (s), and her roll then (rad, positive to port)."""

    kind: str
    time: float
    roll: float

    @property
    def words(self) -> str:
        """floods at 4.52 s, 39.8 deg to port."""
        side = "port" if self.roll > 0.0 else "starboard"
        return f"{VERBS[self.kind]} at {self.time:.4g} s, {abs(np.degrees(self.roll)):.3g} deg to {side}"


def end_of(capsized: float, flooded: float, roll: float) -> End | None:
    """From when (s) a ship capsized and when she flooded, −1 where she did not, and how she lies (rad) since."""
    times = {"capsized": float(capsized), "flooded": float(flooded)}
    lost = {kind: when for kind, when in times.items() if when >= 0.0}
    kind = min(lost, key=lost.get, default=None)
    return End(kind, lost[kind], float(roll)) if kind else None


def ends(series: Mapping[str, np.ndarray]) -> list[End | None]:
    """Of each ship of a recording's series; none of a tank that is in no ship."""
    if "capsized" not in series or not len(series["time"]):
        return [None] * series["pose"].shape[1]
    # A ship that is lost stands still, so the last sample has her as she was then.
    rows = zip(series["capsized"][-1], series["flooded"][-1], series["pose"][-1, :, 2], strict=True)
    return [end_of(*row) for row in rows]


def told(found: Sequence[End | None]) -> str:
    """One sentence on a run whose ships have these ends; empty where none was lost."""
    if len(found) == 1:
        return f"She {found[0].words}." if found[0] else ""
    parts = []
    for kind, verb in VERBS.items():
        times = [end.time for end in found if end and end.kind == kind]
        if times:
            when = f"at {times[0]:.4g} s" if len(times) == 1 else f"after {min(times):.4g} to {max(times):.4g} s"
            parts.append(f"with {len(times)} of {len(found)} beds she {verb} {when}")
    return f"{'; '.join(parts).capitalize()}." if parts else ""
