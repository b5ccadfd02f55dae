"""The wave on the free surface of a shaken cargo, from the picture frames, in the tank's frame.

The tank's width is cut into columns about two mean diameters wide, in space its length as well. The surface of a column
is the top of the highest grain that is reached from below without a gap of more than GAP diameters between tops, so
that grains in the air do not count; in space it is the mean over the columns behind each other. An elevation is the
height of the surface minus its height in the first frame, that of the settled bed.

wave_port, wave_middle, wave_starboard: sqrt(2) times the standard deviation in time of the elevation, averaged over
the tenth of the width at the port wall, in the middle, and at the starboard wall: the amplitude of a sinusoid of the
same power.
wave_mode: the same of a(t) = 2/L times the integral of the elevation times cos(pi y/L) over the width L, y from
the port wall: the share of the first sloshing mode (Faltinsen & Timokha 2009), positive where the
surface is higher at port.
wave_frequency: where the spectrum of a(t) is highest. Error: half the resolution, 1/(2 T) of a part T long.
All over the steady part (`steady_part`). Error of the amplitudes: half the difference between its halves.
A surface of grains is rough: a bed at rest in the tank has none of these, one that only jostles about a tenth
of a diameter.
"""

from collections.abc import Mapping

import numpy as np

from lab.measures.drawing import BLUE, GREEN, GREY, PERIODS, VERMILION, Sheet, band, close_up, middle_of, swing
from lab.measures.motion import driving, is_shaken, is_tilt
from lab.measures.spectrum import PADDING, amplitude_spectrum
from lab.measures.steady import SHORT, Steady, steady_part
from lab.measures.value import Value, over_worlds
from lab.recording import Recording

OF = "grains"
COLUMN = 2.0  # mean diameters
GAP = 1.5  # mean diameters
END = 0.1  # of the tank's width, at either wall
LEAST_FRAMES = 16
FLAT = 0.05  # of a mean diameter: a mode with less has no frequency
PLACES = ("port", "middle", "starboard")


def applies(recording: Recording) -> bool:
    """The tank is shaken, and there are pictures of it."""
    return is_shaken(recording) and not is_tilt(recording) and len(recording.frames["time"]) > LEAST_FRAMES


def measure(recording: Recording) -> dict[str, Value]:
    """wave_port, wave_middle, wave_starboard, wave_mode (mm) and wave_frequency (Hz)."""
    time = recording.frames["time"][:]
    steady = steady_part(recording, time)
    if steady is None or steady.rows.stop - steady.rows.start < LEAST_FRAMES:
        missing = over_worlds(np.full(recording.worlds, np.nan), "mm", missing=SHORT)
        return {f"wave_{name}": missing for name in (*PLACES, "mode")}
    places, mode = wave_course(recording, steady.rows.start)
    named = dict(zip(PLACES, np.moveaxis(places, 2, 0), strict=True)) | {"mode": mode}
    found = {f"wave_{name}": _amplitude(1e3 * course, steady) for name, course in named.items()}
    frequencies, amplitudes = amplitude_spectrum(time[steady.rows], np.nan_to_num(mode))
    highest = frequencies[amplitudes[PADDING:].argmax(axis=0) + PADDING]
    swings = np.nan_to_num(mode.std(axis=0)) > FLAT * recording.mean_diameter
    resolution = 0.5 / (time[-1] - time[steady.rows.start])
    found["wave_frequency"] = over_worlds(
        np.where(swings, highest, np.nan),
        "Hz",
        uncertainties=np.where(swings, resolution, np.nan),
        kind="resolution",
        missing="the surface does not swing",
    )
    return found


def wave_course(recording: Recording, start: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """Elevations (F', W, 3), m, at PLACES and of the first mode (F', W) in the frames from `start` on."""
    rest = surface_columns(recording, 0)
    elevation = columns_in_time(recording, start) - rest
    places = np.stack([finite_mean(elevation[:, :, place]) for place in stretches(elevation.shape[2])], axis=2)
    share = (np.arange(elevation.shape[2]) + 0.5) / elevation.shape[2]
    return places, 2 * finite_mean(elevation * np.cos(np.pi * share))


def columns_in_time(recording: Recording, start: int = 0) -> np.ndarray:
    """Height (F', W, C), m, of the free surface in the frames from `start` on (`surface_columns`)."""
    return np.array([surface_columns(recording, frame) for frame in range(start, len(recording.frames["time"]))])


def stretches(count: int) -> list[np.ndarray]:
    """Which of so many columns are at each of PLACES."""
    share = (np.arange(count) + 0.5) / count
    near = [share < END, np.abs(share - 0.5) < END / 2, share > 1 - END]
    return [
        place if place.any() else np.abs(share - middle) <= np.abs(share - middle).min()
        for place, middle in zip(near, (0.0, 0.5, 1.0), strict=True)
    ]


def surface_columns(recording: Recording, frame: int) -> np.ndarray:
    """Height (W, C) of the free surface in each column from port to starboard, m; NaN where there is no grain."""
    position = recording.frames["position"][frame].astype(float)
    diameter = float(recording.mean_diameter.mean())  # of all beds, so that their columns are as many
    beds, half = zip(position, recording.radius, strict=True), half_along(recording)
    return np.array([column_tops(*bed, recording.outline, diameter, half) for bed in beds])


def half_along(recording: Recording) -> float | None:
    """How far (m) the tank reaches along x to either side; None in the plane."""
    solid = recording.preset.tank.solid
    return solid.half(recording.outline) if solid else None


def column_tops(
    position: np.ndarray, radius: np.ndarray, outline: np.ndarray, diameter: float, half: float | None = None
) -> np.ndarray:
    """Height (C,) of the surface of grains at position (n, axes), m, in columns about two diameters (m) wide.

    In space the tank reaches to ±`half` (m) along x, and the heights of the columns behind each other are averaged.
    """
    (left, floor), (right, _) = outline.min(axis=0), outline.max(axis=0)
    count = max(3, int((right - left) / (COLUMN * diameter)))
    deep = 1 if half is None else max(1, int(2.0 * half / (COLUMN * diameter)))
    held = (position[:, 0] > left) & (position[:, 0] < right) & (position[:, 1] > floor)
    column = np.minimum((count * (position[held, 0] - left) / (right - left)).astype(int), count - 1)
    if deep > 1:
        behind = (deep * (position[held, 2] + half) / (2.0 * half)).astype(int)
        column = column * deep + np.clip(behind, 0, deep - 1)
    top = position[held, 1] + radius[held]
    order = np.lexsort((top, column))
    column, top = column[order], top[order]
    first = np.diff(column, prepend=-1) > 0
    gap = np.diff(top, prepend=0.0) > GAP * diameter
    parted = np.cumsum(gap & ~first)
    bound = parted == parted[np.maximum.accumulate(np.where(first, np.arange(len(top)), 0))]
    tops = np.full(count * deep, np.nan)
    np.fmax.at(tops, column[bound], top[bound])
    return tops if deep == 1 else finite_mean(tops.reshape(count, deep))


def finite_mean(values: np.ndarray) -> np.ndarray:
    """Mean over the last axis of what is finite; NaN where nothing is."""
    known = np.isfinite(values)
    count = known.sum(axis=-1)
    return np.where(known, values, 0.0).sum(axis=-1) / np.where(count > 0, count, np.nan)


def _amplitude(course: np.ndarray, steady: Steady) -> Value:
    """sqrt(2) standard deviations of a course (F', W), mm, that begins with the steady part."""
    middle = len(course) // 2
    whole, first, second = (np.sqrt(2) * part.std(axis=0) for part in (course, course[:middle], course[middle:]))
    return over_worlds(
        whole, "mm", uncertainties=np.abs(first - second) / 2, kind="halves", missing="a wall stood bare"
    )


def draw(sheet: Sheet, recording: Recording, values: Mapping[str, Value]) -> None:
    """Elevation of the free surface at both walls and in the middle, and the first sloshing mode."""
    places, mode = wave_course(recording)
    time, drive = recording.frames["time"][:], driving(recording)
    begin = time[0] if drive is None else close_up(time, drive[1].frequency)
    (upper,), (lower,) = sheet.panels(heights=(3, 2))
    shown = time >= begin
    for k, colour in enumerate((BLUE, GREY, VERMILION)):
        name = f"{PLACES[k]} wall" if k != 1 else PLACES[k]
        band(upper, time[shown], 1e3 * places[shown][:, :, k], colour, name)
    upper.set_ylabel("elevation of\nthe surface (mm)")
    if drive is not None:
        upper.set_title(f"last {PERIODS} periods")
    band(lower, time[shown], 1e3 * mode[shown], GREEN, "first mode cos(πy/L), higher at port")
    steady = steady_part(recording, time)
    if steady is not None:
        middle, span = 1e3 * middle_of(mode[steady.rows]), (max(begin, time[steady.rows.start]), time[-1])
        swing(sheet, lower, middle, values.get("wave_mode"), "amplitude of the mode", GREY, span)
    lower.set_ylabel("mode (mm)")
    lower.set_xlabel("time (s)")
    lower.set_xlim(begin, time[-1])


FIGURES = {"wave": draw}
