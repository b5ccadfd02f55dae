"""The gauges of a recording of water, and the cycles of the motion that drives it, for the measures of water."""

from itertools import pairwise

import numpy as np

from lab.measures.motion import driving, soft_start
from lab.measures.value import Value, over_worlds
from lab.preset.sections.water.liquid import parted
from lab.recording import Recording

BINS = 16  # parts of a period, the quietest of which parts cycles
FEW = "the run has no whole cycle after its first"


def pressure_gauges(recording: Recording) -> list[str]:
    """Names of the gauges of pressure, in the order of their columns."""
    return list(parted(recording.preset.gauges)[0])


def level_gauges(recording: Recording) -> list[str]:
    """Names of the gauges of level, in the order of their columns."""
    return list(parted(recording.preset.gauges)[1])


def key(prefix: str, name: str) -> str:
    """The name of a number of one gauge."""
    return f"{prefix}_{name.replace('-', '_')}"


def cycles(recording: Recording, signal: np.ndarray) -> list[slice]:
    """Rows of the whole cycles of a driven run after its soft start and its first cycle; none of other runs.

    They are parted at the phase at which the signal (T,) is lowest on average, so that no impact falls on a cut.
    """
    drive, time = driving(recording), recording.series["time"]
    if drive is None or len(time) < 2:
        return []
    frequency = drive[1].frequency
    begin = soft_start(recording) + 1.0 / frequency
    phase = (time * frequency) % 1.0
    later = time >= begin
    place = np.floor(BINS * phase).astype(int) % BINS
    sums = np.bincount(place[later], signal[later], BINS)
    counts = np.bincount(place[later], minlength=BINS)
    if not counts.all():
        return []
    quietest = (int(np.argmin(sums / counts)) + 0.5) / BINS
    first = np.ceil(begin * frequency - quietest) + quietest
    cuts = np.arange(first, time[-1] * frequency + 1e-9) / frequency
    rows = np.searchsorted(time, cuts - 1e-9)
    return [slice(a, b) for a, b in pairwise(rows) if b - a > 1]


def over_cycles(numbers: list[np.ndarray], unit: str, note: str = "") -> tuple[Value, Value]:
    """The mean of one number a cycle in each world, lists (W) of (C,), with its error, and the standard deviation."""
    few = [np.nan if len(values) < 1 else float(np.mean(values)) for values in numbers]
    spread = [np.nan if len(values) < 2 else float(np.std(values, ddof=1)) for values in numbers]
    errors = [one / max(len(values), 1) ** 0.5 for one, values in zip(spread, numbers, strict=True)]
    count = max((len(values) for values in numbers), default=0)
    said = "; ".join(filter(None, [f"{count} cycles" if count else "", note]))
    mean = over_worlds(few, unit, uncertainties=errors, kind="cycles", note=said, missing=FEW)
    return mean, over_worlds(spread, unit, note=said, missing="fewer than two cycles")
