"""How steep the heap under an outlet lies: its angle of repose as in the shipboard test (IMSBC Code; Spandonidis 2016,
appendix D), at the last picture frame.

The heap is everything between the outlet's lips and the base, the edge of the outline straight below the outlet.
The tank's width is cut into columns about two mean diameters wide. The surface of a column is the top of the highest
grain that is reached from below without a gap (`column_tops`), so that grains in the air do not count. The highest
column is the apex. The flank on either side consists of the columns between LOW and HIGH of the apex's height above the
base, around the half height at which the Code measures. This leaves out the foot with its stray grains and the top,
which the jet or the funnel's tip makes blunt. The angle is that of the Theil-Sen line (Sen 1968) through a flank of at
least five columns. A heap lower than LEAST has no angle. In a tank that is turned about the axis z the heap has its
apex on that axis, and a flank in each of SECTORS sectors of azimuth, whose distance from the axis is cut into columns.

heap_angle_port, heap_angle_starboard: of the flanks of a heap in a plane or under a slit, positive where the surface
falls away from the apex. heap_angle: the mean of all. Error: half the 68 % confidence interval of the slope (Sen), as
an angle.
heap_angle_spread: standard deviation of the angles of the sectors about their mean.
heap_height: of the apex above the base. Error: none of its own, but a grain more or less is a diameter.
"""

from collections.abc import Mapping

import numpy as np

from lab.measures.drawing import BLUE, GREY, VERMILION, Sheet, band, level
from lab.measures.outlet import Outlet, find_outlet, passed
from lab.measures.surface_slope import inclination
from lab.measures.value import Value, over_worlds
from lab.measures.wave import column_tops, half_along
from lab.recording import Recording
from solvers.tank.solids.solid import Turned

OF = "grains"
LOW, HIGH = 0.2, 0.8  # of the apex's height
SECTORS = 8
LEAST = 5.0  # mean diameters high: a lower heap has too few grains for a slope
MISSING = "no heap"


def applies(recording: Recording) -> bool:
    """Grains run out of an outlet."""
    return len(recording.frames["time"]) > 0 and find_outlet(recording) is not None


def measure(recording: Recording) -> dict[str, Value]:
    """heap_angle, heap_angle_port, heap_angle_starboard or heap_angle_spread (deg), and heap_height (d)."""
    flanks, heights = heap(recording, find_outlet(recording), len(recording.frames["time"]) - 1)
    angles, errors = np.degrees(flanks[:, :, 0]), np.degrees(flanks[:, :, 1])
    found = {"heap_angle": _angle(angles.mean(axis=1), np.linalg.norm(errors, axis=1) / angles.shape[1])}
    if is_turned(recording):
        found["heap_angle_spread"] = over_worlds(angles.std(axis=1, ddof=1), "deg", missing=MISSING)
    else:
        for side, name in enumerate(("port", "starboard")):
            found[f"heap_angle_{name}"] = _angle(angles[:, side], errors[:, side])
    found["heap_height"] = over_worlds(heights / recording.mean_diameter, "d", missing="no grain below the outlet")
    return found


def is_turned(recording: Recording) -> bool:
    """Whether the tank is turned about the axis z."""
    return isinstance(recording.preset.tank.solid, Turned)


def heap(recording: Recording, outlet: Outlet, frame: int) -> tuple[np.ndarray, np.ndarray]:
    """Angle and its error (W, flanks, 2), rad, of each flank in a frame, and heights (W,), m.

    The flanks are port and starboard, or the sectors by azimuth.
    """
    position = recording.frames["position"][frame].astype(float)
    lips, turned = outlet.lips_at(recording, frame), is_turned(recording)
    flanks = np.full((recording.worlds, SECTORS if turned else 2, 2), np.nan)
    heights = np.full(recording.worlds, np.nan)
    for world in range(recording.worlds):
        seen = position[world], recording.radius[world], recording.outline, lips[world]
        profiles = sector_profiles(*seen) if turned else _flanks(*_surface(*seen, half_along(recording)))
        if not any(len(z) for _, z in profiles):
            continue
        heights[world] = top = max(z.max(initial=0.0) for _, z in profiles)
        if top > LEAST * recording.mean_diameter[world]:
            for number, (away, z) in enumerate(profiles):
                flank = (away > 0) & (z > LOW * top) & (z < HIGH * top)
                slope, error = inclination(away[flank], z[flank])
                flanks[world, number] = -slope, error
    return flanks, heights


Profile = tuple[np.ndarray, np.ndarray]  # distances from the apex and heights (k,), m


def _flanks(y: np.ndarray, z: np.ndarray) -> list[Profile]:
    """The profiles to port and starboard of the highest column."""
    if not len(z):
        return []
    return [(sign * (y - y[np.argmax(z)]), z) for sign in (-1.0, 1.0)]


def sector_profiles(position: np.ndarray, radius: np.ndarray, outline: np.ndarray, lips: np.ndarray) -> list[Profile]:
    """The profiles of a heap about the axis z, a sector of azimuth each, of grains at position (n, 3) m."""
    held = np.isfinite(position).all(axis=1)
    sector = (SECTORS * (np.arctan2(position[held, 2], position[held, 0]) / (2.0 * np.pi) + 0.5)).astype(int)
    away = np.column_stack([np.hypot(position[held, 0], position[held, 2]), position[held, 1]])
    size = radius[held]
    half, lip = (np.column_stack([np.maximum(line[:, 0], 0.0), line[:, 1]]) for line in (outline, lips))
    return [_surface(away[sector == number], size[sector == number], half, lip, None) for number in range(SECTORS)]


def _surface(
    position: np.ndarray, radius: np.ndarray, outline: np.ndarray, lips: np.ndarray, half: float | None
) -> Profile:
    """Middles of the columns (k,), m, that the heap has, and its height (k,) above the base there."""
    if not len(position):
        return np.empty(0), np.empty(0)
    middle, level = lips.mean(axis=0)
    base = base_below(outline, middle, level)
    low = position[:, 1] < level
    diameter = 2 * radius.mean()
    tops = column_tops(position[low], radius[low], outline, diameter, half) - base
    left, right = outline[:, 0].min(), outline[:, 0].max()
    columns = left + (np.arange(len(tops)) + 0.5) * (right - left) / len(tops)
    held = tops > 0.5 * diameter
    return columns[held], tops[held]


def base_below(outline: np.ndarray, y: float, z: float) -> float:
    """Height (m) of the highest edge of the outline straight below a point in the tank."""
    a, b = outline, np.roll(outline, -1, axis=0)
    across = (a[:, 0] <= y) != (b[:, 0] <= y)
    a, b = a[across], b[across]
    heights = a[:, 1] + (y - a[:, 0]) / (b[:, 0] - a[:, 0]) * (b[:, 1] - a[:, 1])
    return float(heights[heights <= z].max())


def _angle(angles: np.ndarray, errors: np.ndarray) -> Value:
    return over_worlds(angles, "deg", uncertainties=errors, kind="fit", missing=MISSING)


def draw(sheet: Sheet, recording: Recording, values: Mapping[str, Value]) -> None:
    """The heap under an outlet in time: how steep it is, and how many of the grains have passed."""
    outlet, time = find_outlet(recording), recording.frames["time"][:]
    if len(time) < 2:
        return
    flanks = [heap(recording, outlet, frame)[0][:, :, 0] for frame in range(len(time))]
    (upper,), (lower,) = sheet.panels(heights=(2, 1))
    band(upper, time, np.degrees(np.mean(flanks, axis=2)), BLUE)
    upper.set_ylabel("angle of the heap (deg)")
    upper.set_ylim(bottom=0)
    band(lower, time, 100 * passed(recording, outlet).mean(axis=2), VERMILION)
    lower.set_ylabel("below the\noutlet (%)")
    lower.set_xlabel("time (s)")
    lower.set_xlim(time[0], time[-1])
    level(sheet, upper, values.get("heap_angle"), "heap at the end", GREY)


FIGURES = {"heap": draw}
