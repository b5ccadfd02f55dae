"""A recorded ship, as measures need to know it: what she is, her waves, when she was lost, how she rolled."""

from collections.abc import Sequence
from functools import lru_cache
from itertools import pairwise
from pathlib import Path

import numpy as np

from lab.base.errors import LabError
from lab.measures.value import Value, over_worlds
from lab.preset.sections.ship import axis_motion
from lab.recording import Recording
from lab.recording.ship_end import VERBS, End
from solvers.machine.errors import Unavailable
from solvers.ship.outcome import Outcome, outcome
from solvers.ship.vessel import Vessel

LEAST_SAMPLES = 3
LEAST_CROSSINGS = 3


def has_ship(recording: Recording) -> bool:
    """Whether the tank is in a ship, and something of her motion is recorded."""
    return bool(recording.preset.ship) and len(recording.series["time"]) >= LEAST_SAMPLES


@lru_cache(maxsize=4)
def vessel_of(path: Path) -> Vessel | None:
    """The ship of the recording at `path` with her cargo as it lay at the start; None where she cannot be built."""
    from lab.assembly.scene import vessels
    from lab.recording import open_recording

    try:
        with open_recording(path) as recording:
            return vessels(recording.preset)[0]
    except (LabError, ValueError):
        return None


def wave_frequency(recording: Recording) -> float | None:
    """Angular frequency (rad/s) of regular waves; None without regular waves."""
    waves = recording.preset.waves
    return waves.frequency if waves and waves.kind == "regular" and waves.amplitude else None


def in_random_sea(recording: Recording) -> bool:
    """Whether the waves are those of a spectrum."""
    return bool(recording.preset.waves and recording.preset.waves.height)


def moved_axis(recording: Recording, rows: slice | np.ndarray = slice(None)) -> np.ndarray:
    """Sway and heave (m) of the ship's axis and roll (rad), (T', W, 3), in some rows of the series."""
    return axis_motion(recording.preset.ship, recording.series["pose"][rows])


def losses(prefix: str, recording: Recording, found: Sequence[End | None]) -> dict[str, Value]:
    """When ships (W,) capsized, flooded if they have openings, or sank if they take in water (s).

    The names begin with `prefix`.
    """
    kinds = {"capsized": "did not capsize"}
    if recording.preset.ship.flooding_points:
        kinds["flooded"] = "did not flood"
    if recording.preset.inflow and not prefix:
        kinds["sunk"] = "did not sink"
    times = {kind: [end.time if end and end.kind == kind else np.nan for end in found] for kind in kinds}
    return {f"{prefix}{kind}_at": over_worlds(times[kind], "s", missing=never) for kind, never in kinds.items()}


def significant_roll(recording: Recording, time: np.ndarray, roll: np.ndarray, lost: np.ndarray) -> Value:
    """Significant roll (deg) of rolls (T, W), rad, at time (T,), s; none for a ship that was lost (W,)."""
    begin = int(np.searchsorted(time, recording.preset.waves.soft_start))
    middle = (begin + len(time)) // 2
    parts = slice(begin, None), slice(begin, middle), slice(middle, None)
    whole, *halves = ([np.degrees(_highest_third(r[part])) for r in roll.T] for part in parts)
    size = np.where(lost, np.nan, whole)
    error = np.where(lost, np.nan, np.abs(np.subtract(*halves)) / 2)
    return over_worlds(size, "deg", uncertainties=error, kind="halves", missing="lost or too few swings")


def _highest_third(roll: np.ndarray) -> float:
    """Mean of the highest third of the swings of a roll (T,), rad, half the way from side to side; NaN for too few."""
    x = roll - roll.mean() if len(roll) else roll
    up = np.flatnonzero((x[:-1] < 0.0) & (x[1:] >= 0.0)) + 1
    if len(up) <= LEAST_CROSSINGS:
        return np.nan
    swings = 0.5 * np.array([np.ptp(x[a:b]) for a, b in pairwise(up)])
    return float(np.sort(swings)[-max(1, len(swings) // 3) :].mean())


def regular_outcome(time: np.ndarray, roll: np.ndarray, frequency: float, end: End | None) -> Outcome | None:
    """What became of a ship that rolled so (T,), rad, in waves of a frequency (rad/s); None for too short a run."""
    try:
        return outcome(time, roll, frequency, end.kind if end else "")
    except Unavailable:
        return None


def in_words(found: Outcome) -> str:
    """An outcome for a note."""
    return found.kind + (", several frequencies" if found.several and found.kind not in VERBS else "")
