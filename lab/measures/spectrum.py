"""How far the motion of the bed is from a pure oscillation: the harmonics of its centre of mass in the tank.

A constant, a drift and oscillations at f/2, f, 2f, ... 5f are fitted by least squares to the coordinate that the
motion drives (y of sway and roll, z of heave). The fit covers the last half of the time after the soft start, cut to a
multiple of four whole driving periods; over such a window the terms do not disturb each other.

subharmonic, second_harmonic, third_harmonic: amplitudes at f/2, 2f, 3f (the first is `response_amplitude`). A
subharmonic is a bed that repeats itself only every other period.
distortion: sqrt(sum of the squared amplitudes at 2f ... 5f) over that at f, the total harmonic distortion.
Error: half the difference between the two halves of the window. Noise has an amplitude at every frequency; the
figure shows its level.
"""

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from lab.measures.drawing import BLUE, GREY, VERMILION, Sheet, error_of, median_band
from lab.measures.motion import driving, soft_start
from lab.measures.steady import STILL, Steady, amplitude_value, harmonics, steady_part, steady_window
from lab.measures.value import Value, over_worlds
from lab.recording import Recording

OF = "grains"
if TYPE_CHECKING:
    from matplotlib.axes import Axes

ORDERS = (0.5, 1.0, 2.0, 3.0, 4.0, 5.0)
FITTED = {0.5: "subharmonic", 1.0: "response_amplitude", 2.0: "second_harmonic", 3.0: "third_harmonic"}
PERIODS = 4  # the window is a multiple of them
LEAST_SAMPLES = 12  # a period: the fifth harmonic must not be an alias
PADDING = 4
QUIETEST = 1e-4  # of the largest amplitude: where the scale of a drawn spectrum begins
HIGHEST = 5.6  # driving frequencies: where it ends
SHORT = "the run has less than four steady periods"


def applies(recording: Recording) -> bool:
    """A harmonic motion drives the tank and is sampled finely enough."""
    drive, time = driving(recording), recording.series["time"]
    if drive is None or len(time) < 2:
        return False
    return float(np.median(np.diff(time))) * drive[1].frequency * LEAST_SAMPLES <= 1


def measure(recording: Recording) -> dict[str, Value]:
    """subharmonic, second_harmonic, third_harmonic (mm) and distortion."""
    frequency = driving(recording)[1].frequency
    time, signal = recording.series["time"], driven_coordinate(recording)
    rows = steady_window(time, soft_start(recording), frequency, PERIODS)
    if rows is None:
        answers = np.full((3, len(ORDERS), recording.worlds), np.nan, dtype=complex)
    else:
        parts = Steady(rows, PERIODS).parts
        answers = 1e3 * np.array([harmonics(time[part], signal[part], frequency, ORDERS) for part in parts])
    size = np.abs(answers)
    moving = size[0, 1] > 1e3 * STILL * recording.mean_diameter
    with np.errstate(divide="ignore", invalid="ignore"):
        distortion = np.where(moving, np.sqrt((size[:, 2:] ** 2).sum(axis=1)) / size[:, 1], np.nan)
    error = np.abs(distortion[1] - distortion[2]) / 2
    follows = SHORT if rows is None else "the bed follows the tank"
    return {
        "subharmonic": amplitude_value(answers[:, 0], "mm", missing=SHORT),
        "second_harmonic": amplitude_value(answers[:, 2], "mm", missing=SHORT),
        "third_harmonic": amplitude_value(answers[:, 3], "mm", missing=SHORT),
        "distortion": over_worlds(distortion[0], "1", uncertainties=error, kind="halves", missing=follows),
    }


def driven_coordinate(recording: Recording) -> np.ndarray:
    """The coordinate (T, W) of the centre of mass that the motion drives, m."""
    name, _ = driving(recording)
    return recording.series["centre_of_mass"][..., 1 if name == "heave" else 0]


def amplitude_spectrum(time: np.ndarray, signal: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies (K,), Hz, and amplitudes (K, W) of evenly sampled signals (T, W), less their straight line.

    Hann's window, scaled so that an oscillation shows its amplitude, and padded with zeros so that a peak is drawn
    by PADDING points for each that the length can tell apart.
    """
    count = len(time)
    trend = np.stack([np.ones(count), np.linspace(-1, 1, count)], axis=1)
    rest = signal - trend @ np.linalg.lstsq(trend, signal, rcond=None)[0]
    window = np.hanning(count + 1)[:-1, None]
    amplitude = 2 * np.abs(np.fft.rfft(window * rest, PADDING * count, axis=0)) / window.sum()
    return np.fft.rfftfreq(PADDING * count, (time[-1] - time[0]) / (count - 1)), amplitude


def draw(sheet: Sheet, recording: Recording, values: Mapping[str, Value]) -> None:
    """Amplitude spectrum of the centre of mass of a driven bed over its steady part."""
    time = recording.series["time"]
    steady, frequency = steady_part(recording, time), driving(recording)[1].frequency
    if steady is None:
        return
    centre = 1e3 * recording.series["centre_of_mass"][steady.rows]
    centre = centre[:, np.isfinite(centre).all(axis=(0, 2))]
    if not centre.any():
        return
    ((axes,),) = sheet.panels()
    highest = 0.0
    for axis, colour, name in ((0, BLUE, "y, to starboard"), (1, VERMILION, "z, up")):
        frequencies, amplitudes = amplitude_spectrum(time[steady.rows], centre[..., axis])
        kept = (frequencies > 0) & (frequencies < HIGHEST * frequency)
        median_band(axes, frequencies[kept], amplitudes[kept], colour, name)
        highest = max(highest, amplitudes[kept].max(initial=0.0))
    axes.set_yscale("log")
    axes.set_ylim(QUIETEST * highest, 2 * highest)
    axes.set_xlim(0, HIGHEST * frequency)
    _name_orders(axes, frequency)
    _draw_fitted(axes, values, frequency)
    axes.set_xlabel(f"frequency (Hz), driven at f = {frequency:.3g} Hz")
    axes.set_ylabel("amplitude of the centre of mass\nin the tank (mm)")


def _draw_fitted(axes: "Axes", values: Mapping[str, Value], frequency: float) -> None:
    """The fitted amplitudes of the driven coordinate with their errors, over their frequencies; the drive's in Hz."""
    fitted = [(order, values[name]) for order, name in FITTED.items() if name in values]
    fitted = [(order * frequency, value) for order, value in fitted if value.value is not None]
    if fitted:
        places, found = zip(*fitted, strict=True)
        errors = [error_of(value) for value in found]
        sizes = [value.value for value in found]
        axes.errorbar(places, sizes, errors, fmt="ko", ms=3.5, capsize=2.5, lw=1.0, label="fitted amplitudes")


def _name_orders(axes: "Axes", frequency: float) -> None:
    """Upright lines at the multiples of the driving frequency (Hz) that are fitted."""
    place = {"xycoords": axes.get_xaxis_transform(), "textcoords": "offset points", "va": "top"}
    for order in ORDERS:
        axes.axvline(order * frequency, color=GREY, ls=":", lw=0.8)
        name = {0.5: "f/2", 1.0: "f"}.get(order, f"{order:g}f")
        axes.annotate(name, (order * frequency, 1), (2, -2), color=GREY, fontsize=8, **place)


FIGURES = {"spectrum": draw}
