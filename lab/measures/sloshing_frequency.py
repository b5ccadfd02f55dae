"""How often the water swings to and fro, from the depth at the first level gauge, else from its centre of mass.

sloshing_frequency: where the tank ends at rest, for at least LEAST_PERIODS, that of the free oscillation that is left:
the highest peak of its amplitude spectrum, between its points by a parabola. Else that of the last half of the run; a
steady motion swings as the tank does. Error: half the distance to the next frequency that so long a time can tell
apart, 1/(2 T), at rest half the difference between the two halves of the time, if that is larger.
sloshing_damping: the share of critical damping with which a free oscillation decays, from the amplitudes of its two
halves: ζ = ln(A1/A2)/(2 π f T/2). Error: none of its own.
The note has the first frequency of linear theory for a rectangular tank of the length l with water of the depth d,
ω² = (π g/l) tanh(π d/l) (Faltinsen & Timokha 2009).
"""

from collections.abc import Mapping

import numpy as np

from lab.measures.drawing import BLUE, GREY, Sheet, median_band
from lab.measures.spectrum import PADDING, amplitude_spectrum
from lab.measures.steady import harmonics
from lab.measures.value import Value, over_worlds
from lab.preset.sections.water.liquid import depth
from lab.recording import Recording

OF = "water"
LEAST_SAMPLES = 32
LEAST_PERIODS = 3
STILL = 1e-9  # m/s, rad/s: rates of a tank at rest
FLAT = 1e-3  # of the depth: what deviates less from its mean has no frequency
SHOWN = 6.0  # frequencies of a figure's range
SHORT = "too few swings"
CALM = "the water does not swing"


def applies(recording: Recording) -> bool:
    """The water has weight, and the run has enough samples for a spectrum."""
    return recording.preset.run.gravity > 0.0 and len(recording.series["time"]) > LEAST_SAMPLES


def measure(recording: Recording) -> dict[str, Value]:
    """sloshing_frequency (Hz), and sloshing_damping (%) of a free oscillation."""
    rows, free = swinging(recording)
    time, signal = recording.series["time"][rows], _signal(recording)[rows]
    driven = bool(np.abs(recording.series["pose_rate"][rows]).max(initial=0.0) > STILL)
    if len(time) < LEAST_SAMPLES or not (free or driven):
        return {"sloshing_frequency": over_worlds(np.full(recording.worlds, np.nan), "Hz", missing=SHORT)}
    frequency = peak_frequency(time, signal)
    error = np.full(recording.worlds, 0.5 / (time[-1] - time[0]))
    half = len(time) // 2
    if free:
        halves = [peak_frequency(time[part], signal[part]) for part in (slice(0, half), slice(half, None))]
        error = np.fmax(0.5 * np.abs(halves[0] - halves[1]), 0.0)
    notes = {"note": "; ".join(filter(None, ["" if free else "driven", _theory(recording)])), "missing": CALM}
    kind = "halves" if free else "resolution"
    found = {"sloshing_frequency": over_worlds(frequency, "Hz", uncertainties=error, kind=kind, **notes)}
    if free:
        found["sloshing_damping"] = over_worlds(100.0 * _damping(time, signal, frequency), "%", missing=CALM)
    return found


def swinging(recording: Recording) -> tuple[slice, bool]:
    """The rows that are looked at, and whether the tank is at rest there: the end of the run, else its last half."""
    time, rate = recording.series["time"], np.abs(recording.series["pose_rate"]).max(axis=(1, 2))
    moving = np.flatnonzero(rate > STILL)
    rest = int(moving[-1]) + 1 if len(moving) else 0
    if len(time) - rest >= LEAST_SAMPLES:
        frequency = peak_frequency(time[rest:], _signal(recording)[rest:])
        if np.nanmax(frequency, initial=0.0) * (time[-1] - time[rest]) >= LEAST_PERIODS:
            return slice(rest, len(time)), True
    return slice(len(time) // 2, len(time)), False


def peak_frequency(time: np.ndarray, signal: np.ndarray) -> np.ndarray:
    """The frequency (W,), Hz, of the highest peak of the spectrum of signals (T, W); NaN of those that do not swing."""
    frequencies, amplitudes = amplitude_spectrum(time, signal)
    inner = amplitudes[PADDING:-1]
    top = inner.argmax(axis=0) + PADDING
    worlds = np.arange(signal.shape[1])
    low, middle, high = (amplitudes[top + shift, worlds] for shift in (-1, 0, 1))
    bend = low - 2.0 * middle + high
    offset = np.divide(0.5 * (low - high), bend, out=np.zeros_like(bend), where=bend < 0.0)
    found = (top + np.clip(offset, -0.5, 0.5)) * frequencies[1]
    return np.where(middle > 0.0, found, np.nan)


def _signal(recording: Recording) -> np.ndarray:
    """The depth (T, W) at the first level gauge, or the y of the centre of mass, m; constant where it hardly swings."""
    series = recording.series
    signal = series["level_depth"][..., 0] if recording.names["level"] else series["water_centre"][..., 0]
    swings = signal.std(axis=0) > FLAT * depth(recording.preset)
    return np.where(swings, signal, 0.0)


def _damping(time: np.ndarray, signal: np.ndarray, frequency: np.ndarray) -> np.ndarray:
    """Share (W,) of critical damping, from the amplitudes of both halves of a free oscillation."""
    half, found = len(time) // 2, np.full(len(frequency), np.nan)
    for w in np.flatnonzero(np.isfinite(frequency)):
        sizes = [
            float(np.abs(harmonics(time[part], signal[part, w : w + 1], float(frequency[w]), (1,)))[0, 0])
            for part in (slice(0, half), slice(half, 2 * half))
        ]
        if min(sizes) > 0.0:
            found[w] = np.log(sizes[0] / sizes[1]) / (2.0 * np.pi * frequency[w] * (time[half] - time[0]))
    return found


def _theory(recording: Recording) -> str:
    """The first frequency of linear theory, in words; empty for other tanks than rectangular ones."""
    preset = recording.preset
    if preset.tank.outline is not None or preset.water.depth is None or preset.water.full:
        return ""
    number = np.pi / preset.tank.width
    first = np.sqrt(number * preset.run.gravity * np.tanh(number * preset.water.depth)) / (2.0 * np.pi)
    return f"linear theory {first:.4g} Hz"


def draw(sheet: Sheet, recording: Recording, values: Mapping[str, Value]) -> None:
    """The amplitude spectrum from which the frequency is read."""
    rows, free = swinging(recording)
    time, signal = recording.series["time"][rows], _signal(recording)[rows]
    found = values.get("sloshing_frequency")
    if found is None or found.value is None or not signal.any():
        return
    ((axes,),) = sheet.panels(columns=1)
    frequencies, amplitudes = amplitude_spectrum(time, signal)
    kept = (frequencies > 0) & (frequencies < SHOWN * found.value)
    where = "depth at the level gauge" if recording.names["level"] else "centre of mass"
    median_band(axes, frequencies[kept], 1e3 * amplitudes[kept], BLUE, f"{where}, {'free' if free else 'driven'}")
    axes.axvline(found.value, color=GREY, ls=":", lw=0.8, label=f"highest at {sheet.words(found)}")
    axes.set_xlim(0, SHOWN * found.value)
    axes.set_xlabel("frequency (Hz)")
    axes.set_ylabel("amplitude (mm)")


FIGURES = {"sloshing": draw}
