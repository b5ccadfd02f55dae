"""How steep the free surface lies: its inclination against the horizontal while the tank tilts.

The tank's width, and in space its length, is cut into columns two mean diameters wide; the top of the
highest grain of each is a point of the surface. Columns by the walls (a tenth of the width on either
side, where the bed climbs or hollows) and columns where less than two grains lie on each other (bare
floor) are left out. The Theil-Sen line (Sen 1968: the median of the slopes of all pairs) through the
rest is not moved by a grain in the air.
Its angle plus the tank's tilt is the inclination in the earth frame,
counted positive in the direction of the tilt: a bed that moves as one with the tank has the tilt
itself, a liquid zero.

surface_slope: at the last picture frame, after the avalanches the heap's angle of repose;
largest_surface_slope: the largest in any frame, the steepest surface that held.
Error: half the 68 % confidence interval of the slope (Sen), as an angle. The largest of many noisy
numbers lies above the true largest by about that error.
"""

from collections.abc import Mapping
from statistics import NormalDist
from typing import TYPE_CHECKING
from weakref import WeakKeyDictionary

import numpy as np

from lab.measures.drawing import BLUE, GREEN, GREY, VERMILION, Sheet, level, mark
from lab.measures.motion import is_tilt, outward_leg
from lab.measures.value import Value, over_worlds
from lab.recording import Recording
from solvers.machine.quantity import ROLL

OF = "grains"
if TYPE_CHECKING:
    from matplotlib.axes import Axes

COLUMN = 2.0  # mean diameters
MARGIN = 0.1  # of the tank's width
LEAST_LAYER = 2.0  # mean diameters
LEAST_COLUMNS = 5
MOST_FRAMES = 400  # looked at for the course in time
CONFIDENCE = 0.68

Course = tuple[np.ndarray, np.ndarray, np.ndarray]
_courses: WeakKeyDictionary[Recording, Course] = WeakKeyDictionary()  # found so far: numbers and figure need the same


def applies(recording: Recording) -> bool:
    """The tank tilts."""
    return is_tilt(recording) and len(recording.frames["time"]) > 0


def measure(recording: Recording) -> dict[str, Value]:
    """surface_slope and largest_surface_slope (deg, earth frame)."""
    _, slope, error = surface_course(recording)
    missing = "too little free surface"
    worlds = range(recording.worlds)
    steepest = np.argmax(np.nan_to_num(slope, nan=-np.inf), axis=0)
    return {
        "surface_slope": over_worlds(slope[-1], "deg", uncertainties=error[-1], kind="fit", missing=missing),
        "largest_surface_slope": over_worlds(
            slope[steepest, worlds],
            "deg",
            uncertainties=error[steepest, worlds],
            kind="fit",
            missing=missing,
        ),
    }


def surface_course(recording: Recording) -> Course:
    """Frame numbers (K,), inclination and its error (K, W), deg; NaN where there is no surface."""
    if recording not in _courses:
        _courses[recording] = _find_course(recording)
    return _courses[recording]


def _find_course(recording: Recording) -> Course:
    count = len(recording.frames["time"])
    frames = np.unique(np.linspace(0, count - 1, min(count, MOST_FRAMES)).astype(int))
    tilt = recording.frames["pose"][:][frames, :, ROLL]
    slope, error = np.full(tilt.shape, np.nan), np.full(tilt.shape, np.nan)
    solid = recording.preset.tank.solid
    along = 2.0 * solid.half(recording.outline) if solid else None
    for row, frame in enumerate(frames):
        position = recording.frames["position"][int(frame)].astype(float)
        for world in range(recording.worlds):
            points = free_surface(position[world], recording.radius[world], recording.outline, along)
            slope[row, world], error[row, world] = inclination(*points)
    direction = [outward_leg(recording.series["pose"][:, w, ROLL]).direction for w in range(tilt.shape[1])]
    return frames, np.degrees(slope + tilt) * direction, np.degrees(error)


def free_surface(
    position: np.ndarray, radius: np.ndarray, outline: np.ndarray, along: float | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """Points y, z (k,), m, of the free surface of grains at position (n, axes), m, tank frame; spilled ones left out.

    In space the tank is `along` (m) long in x.
    """
    diameter = 2 * radius.mean()
    (left, floor), (right, _) = outline.min(axis=0), outline.max(axis=0)
    held = (position[:, 0] > left) & (position[:, 0] < right) & (position[:, 1] > floor)
    position, radius = position[held], radius[held]
    column, count = _columns(position[:, 0], left, right, COLUMN * diameter)
    if along is not None:
        column = column + count * _columns(position[:, 2], -0.5 * along, 0.5 * along, COLUMN * diameter)[0]
    top = position[:, 1] + radius
    # The last of each column when sorted by column, then by height, is its highest grain.
    order = np.lexsort((top, column))
    highest = order[np.flatnonzero(np.diff(column[order], append=-1))]
    y, z = position[highest, 0], top[highest]
    margin = MARGIN * (right - left)
    kept = (y > left + margin) & (y < right - margin)
    kept &= z - floor > LEAST_LAYER * diameter
    if along is not None:
        kept &= np.abs(position[highest, 2]) < (0.5 - MARGIN) * along
    return y[kept], z[kept]


def _columns(place: np.ndarray, begin: float, end: float, width: float) -> tuple[np.ndarray, int]:
    """The columns (n,) from `begin` to `end` in which places (n,) are, by number, and how many there are; all in m."""
    edges = np.arange(begin, end, width)
    return np.clip(np.searchsorted(edges, place, side="right") - 1, 0, len(edges) - 1), len(edges)


def inclination(y: np.ndarray, z: np.ndarray) -> tuple[float, float]:
    """Angle of the line through points (k,) and its error, rad; NaN for too few points."""
    if len(y) < LEAST_COLUMNS:
        return np.nan, np.nan
    slope, low, high = theil_sen(y, z)
    return float(np.arctan(slope)), float(np.arctan(high) - np.arctan(low)) / 2


def theil_sen(x: np.ndarray, y: np.ndarray) -> tuple[float, float, float]:
    """Slope of the Theil-Sen line through points (k,), and the ends of its CONFIDENCE interval (Sen 1968, eq. 2.6).

    It is what `scipy.stats.theilslopes` finds, in a fifth of its time.
    """
    apart = x[:, None] - x
    right = apart > 0.0
    slopes = np.sort((y[:, None] - y)[right] / apart[right])
    count = len(x)
    variance = (_ties_term(np.array([count])) - _ties_term(_repeats(x)) - _ties_term(_repeats(y))) / 18.0
    reach = -NormalDist().inv_cdf(0.5 * (1.0 - CONFIDENCE)) * np.sqrt(variance)
    low = max(round((len(slopes) - reach) / 2.0) - 1, 0)
    high = min(round((len(slopes) + reach) / 2.0), len(slopes) - 1)
    return float(np.median(slopes)), float(slopes[low]), float(slopes[high])


def _repeats(values: np.ndarray) -> np.ndarray:
    """How often each value occurs."""
    return np.unique(values, return_counts=True)[1]


def _ties_term(counts: np.ndarray) -> float:
    return float((counts * (counts - 1) * (2 * counts + 5)).sum())


def draw(sheet: Sheet, recording: Recording, values: Mapping[str, Value]) -> None:
    """Inclination of the free surface against the tilt, both counted in the direction of the tilt."""
    frames, slope, error = surface_course(recording)
    if not np.isfinite(slope).any():
        return
    ((axes,),) = sheet.panels()
    pose = recording.frames["pose"][:][frames, :, ROLL]
    for world in range(recording.worlds):
        leg = outward_leg(pose[:, world])
        tilt = np.degrees(leg.direction * pose[:, world])
        _draw_surface(axes, tilt, slope[:, world], error[:, world], leg.end, named=not world)
    reach = [0, np.degrees(np.abs(pose).max())]
    axes.plot(reach, reach, color=GREY, ls=":", lw=1.0, label="bed fixed to the tank")
    mark(sheet, axes, values.get("critical_angle"), "critical angle", VERMILION)
    axes.set_xlim(left=0)
    level(sheet, axes, values.get("largest_surface_slope"), "largest inclination", GREEN)
    axes.set_xlabel("tilt (deg)")
    axes.set_ylabel("inclination of the surface\nagainst the horizontal (deg)")


def _draw_surface(axes: "Axes", tilt: np.ndarray, slope: np.ndarray, error: np.ndarray, end: int, named: bool) -> None:
    """Inclination (K,) with its error over the tilt of one world; dashed from row `end` on."""
    line = {"color": BLUE, "lw": 0.9, "alpha": 0.8}
    axes.plot(tilt[:end], slope[:end], label="surface, band: uncertainty of the fit" if named else None, **line)
    axes.fill_between(tilt[:end], (slope - error)[:end], (slope + error)[:end], color=BLUE, alpha=0.12, lw=0)
    back = slice(end - 1, None)
    label = "way back" if named and np.ptp(tilt[back]) > 1 else None
    axes.plot(tilt[back], slope[back], ls="--", label=label, **line)


FIGURES = {"slope": draw}
