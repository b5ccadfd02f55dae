"""When the upper layer of a wet bed begins to move in the tank.

The layer holds the grains whose tops lie within LAYER mean diameters of the surface of their column (`wet_bed`) in
the first frame, that of the settled bed. It has moved when the mean of their distances from their first places, in the
tank's frame, reaches a mean diameter.

onset_time: when it does, between two frames by a straight line. Error: half their distance in time.
onset_amplitude: how far the tank has moved from its first pose by then, the largest roll (deg), else sway or heave
(mm): of a motion that grows, the amplitude at which the bed gives way.
layer_shift: how far the layer has moved at the last frame, in mean diameters.
"""

from collections.abc import Mapping

import numpy as np

from lab.measures.drawing import BLUE, GREY, VERMILION, Sheet, band, mark
from lab.measures.value import Value, over_worlds
from lab.measures.wet_bed import WetBed, is_wet, wet_bed
from lab.recording import Recording
from solvers.machine.quantity import ROLL

OF = "grains"
LAYER = 1.0  # mean diameters
STILL = "its upper layer never moved by a diameter"


def applies(recording: Recording) -> bool:
    """Grains and water share the tank."""
    return is_wet(recording)


def measure(recording: Recording) -> dict[str, Value]:
    """onset_time (s), onset_amplitude (deg or mm) and layer_shift (d)."""
    bed = wet_bed(recording)
    moved = layer_course(bed)
    when, step = onset(bed.time, moved), 0.5 * float(np.median(np.diff(bed.time)))
    moves, unit, factor = tank_course(recording)
    time = recording.series["time"]
    largest = np.maximum.accumulate(factor * moves).T
    amplitude = [np.interp(at, time, one) if np.isfinite(at) else np.nan for at, one in zip(when, largest, strict=True)]
    return {
        "onset_time": over_worlds(
            when, "s", uncertainties=np.where(np.isfinite(when), step, np.nan), kind="resolution", missing=STILL
        ),
        "onset_amplitude": over_worlds(amplitude, unit, missing=STILL),
        "layer_shift": over_worlds(moved[-1], "d"),
    }


def layer_course(bed: WetBed) -> np.ndarray:
    """Mean distance (F, W) of the upper layer's grains from their first places, in mean diameters."""
    first, radius, size = bed.read("position", 0), bed.recording.radius, bed.recording.mean_diameter
    low, width, found = bed.recording.outline[:, 0].min(), float(np.ptp(bed.recording.outline[:, 0])), []
    upper = []
    for w, tops in enumerate(bed.tops[0]):
        column = np.clip(((first[w, :, 0] - low) / width * len(tops)).astype(int), 0, len(tops) - 1)
        upper.append(first[w, :, 1] + radius[w] > tops[column] - LAYER * size[w])
    for frame in range(len(bed.time)):
        apart = np.linalg.norm(bed.read("position", frame) - first, axis=2) / size[:, None]
        found.append([float(np.nanmean(one[layer])) for one, layer in zip(apart, upper, strict=True)])
    return np.array(found)


def onset(time: np.ndarray, moved: np.ndarray) -> np.ndarray:
    """When (W,), s, distances (F, W) first reach 1, between two frames by a straight line; NaN where they never do."""
    found = np.full(moved.shape[1], np.nan)
    for w, course in enumerate(moved.T):
        over = np.flatnonzero(course >= 1.0)
        if len(over):
            k = int(over[0])
            found[w] = np.interp(1.0, course[k - 1 : k + 1], time[k - 1 : k + 1]) if k else time[0]
    return found


def tank_course(recording: Recording) -> tuple[np.ndarray, str, float]:
    """How far (T, W) the tank is from its first pose: its roll (rad) if it rolls, else its way (m); unit and factor."""
    moved = np.abs(recording.series["pose"] - recording.series["pose"][0])
    if moved[..., ROLL].any():
        return moved[..., ROLL], "deg", float(np.degrees(1.0))
    return np.hypot(moved[..., 0], moved[..., 1]), "mm", 1e3


def draw(sheet: Sheet, recording: Recording, values: Mapping[str, Value]) -> None:
    """How far the upper layer has moved, below the motion of the tank."""
    bed = wet_bed(recording)
    (upper,), (lower,) = sheet.panels(heights=(1, 2))
    moves, unit, factor = tank_course(recording)
    time = recording.series["time"]
    band(upper, time, factor * moves, GREY)
    upper.set_ylabel(f"tank from its\nfirst pose ({unit})")
    band(lower, bed.time, layer_course(bed), BLUE, "upper layer")
    lower.axhline(1.0, color=GREY, lw=0.6)
    mark(sheet, lower, values.get("onset_time"), "onset", VERMILION)
    lower.set_xlim(time[0], time[-1])
    lower.set_xlabel("time (s)")
    lower.set_ylabel("moved by (d)")


FIGURES = {"upper_layer": draw}
