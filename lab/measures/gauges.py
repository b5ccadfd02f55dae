"""What the measures of water's gauges share: the gauges by name, the cycles of a driven tank, peaks and impulses."""

from collections.abc import Iterator
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from lab.measures.drawing import Sheet
from lab.measures.motion import driving, soft_start
from lab.measures.value import Value, over_worlds
from lab.preset.units import show
from lab.recording import Recording

if TYPE_CHECKING:
    from matplotlib.axes import Axes

BINS = 16  # parts of a period, the quietest of which parts cycles
BEFORE, AFTER = 0.030, 0.200  # s, of the peak of an impact: what its impulse is taken over
LEAST_SAMPLES = 10  # of an impact
COARSE = f"no impact is recorded whole by {LEAST_SAMPLES} samples or more"
MOST_DRAWN = 4  # gauges of a figure
FEW = "the run has no whole cycle after its first"


def pushes(recording: Recording) -> np.ndarray:
    """How hard the water presses on the edge of each gauge of force (T, W, K), N: the part outwards, square to it.

    The first sample is the mean of nothing yet; it has what the second has.
    """
    edges, corners = list(recording.preset.liquid.edges), np.array(recording.preset.tank.corners)
    along = (np.roll(corners, -1, axis=0) - corners)[edges]
    outwards = np.stack([along[:, 1], -along[:, 0]], axis=1) / np.linalg.norm(along, axis=1)[:, None]
    found = (recording.series["edge_force"] * outwards).sum(axis=-1)
    found[:1] = found[1:2]
    return found


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


def highest(recording: Recording, signal: np.ndarray) -> list[np.ndarray]:
    """The highest of a signal (T, W) in each cycle of a driven tank: lists (W) of (C,)."""
    parts = [cycles(recording, one) for one in signal.T]
    return [np.array([one[rows].max() for rows in of]) for one, of in zip(signal.T, parts, strict=True)]


def peaks(recording: Recording, kind: str, name: str, signal: np.ndarray, unit: str) -> dict[str, Value]:
    """KIND_largest_NAME of a signal (T, W), and of a driven tank KIND_peak_NAME and KIND_peak_scatter_NAME."""
    time = recording.series["time"]
    when = ", ".join(show(float(time[row]), "s") for row in signal.argmax(axis=0))
    note = f"at {when}" if signal.any() else "it stays dry"
    found = {key(f"{kind}_largest", name): over_worlds(signal.max(axis=0), unit, note=note)}
    if driving(recording) is not None:
        mean, scatter = over_cycles(highest(recording, signal), unit)
        found |= {key(f"{kind}_peak", name): mean, key(f"{kind}_peak_scatter", name): scatter}
    return found


def impulse(recording: Recording, time: np.ndarray, signal: np.ndarray, peak: np.ndarray, unit: str) -> Value:
    """The mean impulse of the cycles of a driven tank, of any other run that of the highest peak, of (T, W) at `time`.

    `peak` (T, W) is the signal's highest since the sample before, or the signal itself.
    """
    if driving(recording) is not None:
        parts = [cycles(recording, one) for one in peak.T]
        impulses = [_impulses(time, *worlds) for worlds in zip(signal.T, peak.T, parts, strict=True)]
        return over_cycles(impulses, unit)[0]
    whole = [slice(0, len(time))]
    impulses = [_impulses(time, *worlds, whole) for worlds in zip(signal.T, peak.T, strict=True)]
    numbers = [values[0] if len(values) else np.nan for values in impulses]
    return over_worlds(numbers, unit, missing=COARSE)


def _impulses(time: np.ndarray, signal: np.ndarray, peak: np.ndarray, parts: list[slice]) -> np.ndarray:
    """The impulse (C,) of the highest peak in each part of a run, of those recorded whole and finely enough."""
    found = []
    for rows in parts:
        top = time[rows.start + int(peak[rows].argmax())]
        begin, end = np.searchsorted(time, [top - BEFORE - 1e-9, top + AFTER + 1e-9])
        recorded = time[0] <= top - BEFORE and top + AFTER <= time[-1]
        if recorded and end - begin >= LEAST_SAMPLES:
            found.append(np.trapezoid(signal[begin:end], time[begin:end]))
    return np.array(found)


def panels_of(sheet: Sheet, time: np.ndarray, names: list[str], unit: str) -> Iterator[tuple[int, str, "Axes"]]:
    """The number, name and panel of each of the first gauges of a figure, one above the other."""
    names = names[:MOST_DRAWN]
    panels = sheet.panels(heights=(1,) * len(names))
    for k, (name, (axes,)) in enumerate(zip(names, panels, strict=True)):
        axes.set_xlim(time[0], time[-1])
        axes.set_ylabel(f"{name} ({unit})")
        yield k, name, axes
    panels[-1, 0].set_xlabel("time (s)")
