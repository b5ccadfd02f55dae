"""How a ship answers to each frequency of a random sea: response amplitude operators (RAO) by spectra, in small waves.

The sea's elevation at her place at rest is the input, roll or heave the output, after the soft start. With their
spectra by Welch's method (1967), Hann's window, segments of SEGMENT peak periods, half overlapped,

    H = S_xy/S_xx,   γ² = |S_xy|²/(S_xx S_yy),

the RAO |H| and the coherence, which is 1 where the answer is linear in the sea and nothing else moves her.
roll_rao, heave_rao: the highest |H| where the sea has at least LEAST of its largest spectral density and γ² at least
COHERENT; roll_rao_frequency: where that of roll is. Error of an RAO: its random error,
|H| √(1 − γ²)/(|γ| √(2 n)), n the number of independent segments (Bendat & Piersol 2010, table 9.6); it says nothing of
what the segments' length smooths away, nor of her drifting through the waves.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from lab.assembly.ship import make_water, make_waves
from lab.measures.drawing import BLUE, GREY, Sheet
from lab.measures.ship import has_ship, in_random_sea, moved_axis
from lab.measures.value import Value, over_worlds
from lab.recording import Recording
from lab.recording.ship_end import ends

SEGMENT = 16.0  # peak periods
SEGMENTS = 4  # at least
LEAST, COHERENT = 0.05, 0.5
OVERLAPPED = 1.056  # of Hann's window: by what half overlapped segments are fewer than their number (Welch 1967)
SURE = 1.96  # standard errors: 95 %
COORDINATES = {"roll": (2, 180.0 / np.pi, "deg/m"), "heave": (1, 1.0, "1")}
MISSING = "the sea is too short, or nothing answers to it"


@dataclass(frozen=True, eq=False)
class Response:
    """|H| (f, W), its error and γ² at frequencies (f,) rad/s where the sea has waves."""

    frequency: np.ndarray
    size: np.ndarray
    error: np.ndarray
    coherence: np.ndarray


def applies(recording: Recording) -> bool:
    """There is a ship in a random sea, long enough for some segments."""
    if not (has_ship(recording) and in_random_sea(recording)):
        return False
    time, waves = recording.series["time"], recording.preset.waves
    segment = SEGMENT * 2.0 * np.pi / waves.frequency
    return time[-1] - waves.soft_start >= 0.5 * (SEGMENTS + 1) * segment and len(time) > SEGMENTS


def measure(recording: Recording) -> dict[str, Value]:
    """roll_rao (deg/m), roll_rao_frequency (rad/s) and heave_rao (1)."""
    lost, found = [end is not None for end in ends(recording.series)], {}
    for name, (column, factor, unit) in COORDINATES.items():
        one = response(recording, column, factor)
        known = np.where(one.coherence >= COHERENT, one.size, -1.0)
        top, worlds = known.argmax(axis=0), np.arange(recording.worlds)
        highest, error = known[top, worlds], one.error[top, worlds]
        gone = (highest < 0.0) | lost
        errors = np.where(gone, np.nan, error / SURE)
        sizes = np.where(gone, np.nan, highest)
        found[f"{name}_rao"] = over_worlds(sizes, unit, uncertainties=errors, kind="spectral", missing=MISSING)
        if name == "roll":
            where = np.where(gone, np.nan, one.frequency[top])
            found["roll_rao_frequency"] = over_worlds(where, "rad/s", missing=MISSING)
    return found


def response(recording: Recording, column: int, factor: float) -> Response:
    """The answer of a coordinate of her axis, times a factor, to the sea."""
    preset, time = recording.preset, recording.series["time"]
    rows = time > preset.waves.soft_start
    waves = make_waves(preset.waves, make_water(preset.sea, preset.run.gravity))
    rise = np.array([float(waves.elevation(np.zeros(1), t)[0]) for t in time[rows]])[:, None]
    answer = factor * moved_axis(recording, rows)[..., column]
    step = float(time[1] - time[0])
    length = round(SEGMENT * 2.0 * np.pi / preset.waves.frequency / step)
    return transfer(rise, answer, step, length)


def transfer(driven: np.ndarray, answer: np.ndarray, step: float, length: int) -> Response:
    """The answers (n, W) to what drives them (n, 1), samples of a `step` (s), by segments of so many samples."""
    from scipy.signal import csd, welch  # slow to import

    how = {"fs": 1.0 / step, "nperseg": length, "noverlap": length // 2, "detrend": "linear", "axis": 0}
    hertz, of_sea = welch(driven, **how)
    moved, both = welch(answer, **how)[1], csd(driven, answer, **how)[1]
    kept = of_sea[:, 0] >= LEAST * of_sea.max()
    of_sea, moved, both = of_sea[kept], moved[kept], both[kept]
    coherence = np.abs(both) ** 2 / np.maximum(of_sea * moved, 1e-300)
    size, segments = np.abs(both) / of_sea, (len(driven) - length) // (length - length // 2) + 1
    spread = np.sqrt(np.maximum(1.0 - coherence, 0.0) / np.maximum(coherence, 1e-12) / (2.0 * segments / OVERLAPPED))
    return Response(2.0 * np.pi * hertz[kept], size, SURE * spread * size, coherence)


def draw(sheet: Sheet, recording: Recording, values: Mapping[str, Value]) -> None:
    """Roll and heave over the sea's elevation with their 95 % bands, and the coherence below, of the first ship."""
    panels = sheet.panels(heights=(2, 1), widths=(1, 1), columns=2)
    for k, (name, (column, factor, unit)) in enumerate(COORDINATES.items()):
        one, (upper, lower) = response(recording, column, factor), panels[:, k]
        low, high = np.maximum(one.size - one.error, 0.0)[:, 0], (one.size + one.error)[:, 0]
        upper.fill_between(one.frequency, low, high, color=BLUE, alpha=0.2, lw=0)
        upper.plot(one.frequency, one.size[:, 0], color=BLUE, label="95 % band" if not k else None)
        upper.set_title(f"{name} over wave ({unit})" if unit != "1" else f"{name} over wave", fontsize="medium")
        upper.set_ylim(bottom=0.0)
        lower.plot(one.frequency, one.coherence[:, 0], color=GREY)
        lower.set_ylim(0.0, 1.05)
        lower.set_xlabel("wave frequency (rad/s)")
    panels[0, 0].set_ylabel("RAO")
    panels[1, 0].set_ylabel("coherence")


FIGURES = {"response": draw}
