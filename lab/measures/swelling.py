"""How the filling height in the middle of a swayed tank rises and falls (Pöschel & Rosenkranz 1997; Spandonidis 2016,
section 4.5).

The height is that of the free surface over the floor, the mean over the columns in the middle tenth of the width
(`wave`), in the picture frames of the steady part (`steady_part`).

fill_height: its mean. Error: standard error of the means of blocks, each a driving period.
swelling_frequency: the frequency at which its spectrum is highest, between two swings in the steady part and half the
picture rate. Error: half the resolution, 1/(2 T) of a part T long.
swelling_amplitude: the height of the spectrum there. Error: half the difference between the two halves.
swelling_ratio: that frequency divided by the driving frequency. It is 1 or 2 where the surface follows the sway.
"""

from collections.abc import Mapping

import numpy as np

from lab.measures.drawing import BLUE, GREY, VERMILION, Sheet, band, level, note, swing
from lab.measures.motion import driving
from lab.measures.spectrum import PADDING, amplitude_spectrum
from lab.measures.steady import SHORT, Steady, averaged, steady_part
from lab.measures.value import Value, over_worlds
from lab.measures.wave import LEAST_FRAMES, PLACES, columns_in_time, finite_mean, stretches
from lab.recording import Recording

OF = "grains"
LEAST_RATE = 4.0  # pictures a driving period
SWINGS = 2  # in the steady part, at least


def applies(recording: Recording) -> bool:
    """Sway drives the tank, and there are enough pictures in a period."""
    drive, time = driving(recording), recording.frames["time"][:]
    if drive is None or drive[0] != "sway" or len(time) <= LEAST_FRAMES:
        return False
    return LEAST_RATE * drive[1].frequency * float(np.median(np.diff(time))) <= 1


def measure(recording: Recording) -> dict[str, Value]:
    """fill_height (mm), swelling_frequency (Hz), swelling_amplitude (mm) and swelling_ratio."""
    time, frequency = recording.frames["time"][:], driving(recording)[1].frequency
    steady = steady_part(recording, time)
    if steady is None or steady.rows.stop - steady.rows.start < LEAST_FRAMES:
        return {"fill_height": over_worlds(np.full(recording.worlds, np.nan), "mm", missing=SHORT)}
    height = 1e3 * middle_height(recording, steady.rows.start)
    whole = Steady(slice(0, len(height)), steady.blocks)
    swelling, size = np.array([_dominant(time[steady.rows][part], height[part]) for part in whole.parts]).swapaxes(0, 1)
    resolution = np.full(recording.worlds, 0.5 / (time[-1] - time[steady.rows.start]))
    missing = "the middle of the tank ran bare"
    return {
        "fill_height": averaged(height, whole, "mm", missing=missing),
        "swelling_frequency": over_worlds(
            swelling[0], "Hz", uncertainties=resolution, kind="resolution", missing=missing
        ),
        "swelling_amplitude": over_worlds(
            size[0], "mm", uncertainties=np.abs(size[1] - size[2]) / 2, kind="halves", missing=missing
        ),
        "swelling_ratio": over_worlds(
            swelling[0] / frequency, "1", uncertainties=resolution / frequency, kind="resolution", missing=missing
        ),
    }


def middle_height(recording: Recording, start: int = 0) -> np.ndarray:
    """Height (F', W), m, of the surface over the floor in the middle of the tank, in the frames from `start` on."""
    columns = columns_in_time(recording, start)
    middle = stretches(columns.shape[2])[PLACES.index("middle")]
    return finite_mean(columns[:, :, middle]) - recording.outline[:, 1].min()


def _dominant(time: np.ndarray, height: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Frequency (W,), Hz, at which the spectrum of heights (F', W) is highest, and how high; NaN without a surface."""
    known = np.isfinite(height).all(axis=0)
    frequencies, amplitudes = amplitude_spectrum(time, np.where(known, height, 0.0))
    highest = amplitudes[SWINGS * PADDING :].argmax(axis=0) + SWINGS * PADDING
    size = amplitudes[highest, range(len(known))]
    return np.where(known, frequencies[highest], np.nan), np.where(known, size, np.nan)


def draw(sheet: Sheet, recording: Recording, values: Mapping[str, Value]) -> None:
    """The height of the surface in the middle of the tank in time, with its mean and its swelling."""
    ((axes,),) = sheet.panels()
    time = recording.frames["time"][:]
    band(axes, time, 1e3 * middle_height(recording), BLUE, "surface in the middle")
    steady, filled = steady_part(recording, time), values.get("fill_height")
    if steady is not None and filled is not None and filled.value is not None:
        span = time[steady.rows.start], time[-1]
        level(sheet, axes, filled, "mean", GREY, span)
        swing(sheet, axes, filled.value, values.get("swelling_amplitude"), "swelling", VERMILION, span)
        note(sheet, axes, values.get("swelling_frequency"), "swelling frequency")
    axes.set_xlabel("time (s)")
    axes.set_xlim(time[0], time[-1])
    axes.set_ylabel("height over the floor (mm)")


FIGURES = {"swelling": draw}
