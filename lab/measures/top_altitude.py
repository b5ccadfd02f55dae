"""How high the cargo reaches: the top of its highest grain, in the tank's frame (Spandonidis 2016, 4.5).

top_altitude_start, top_altitude_end: the highest point of any grain at the first and the last picture frame.
top_fall: the difference between them.
bulk_altitude_end: the height below which BULK of the grains' tops lie at the last frame; a single grain in the air
does not change it.
Grains that have left the scene do not count. Error: none of its own; the top is known only at picture frames.
"""

from collections.abc import Mapping

import numpy as np

from lab.measures.drawing import BLUE, GREY, VERMILION, Sheet, band, level, note
from lab.measures.value import Value, over_worlds
from lab.recording import Recording

OF = "grains"
BULK = 95.0  # per cent
EMPTY = "no grain is left in the scene"


def applies(recording: Recording) -> bool:
    """Parts move in the tank, or the tank stands still and only gravity moves the cargo."""
    still = not np.ptp(recording.series["pose"], axis=0).any()
    return len(recording.frames["time"]) > 0 and (bool(recording.parts) or still)


def measure(recording: Recording) -> dict[str, Value]:
    """top_altitude_start, top_altitude_end, top_fall and bulk_altitude_end (mm)."""
    ends = np.array([altitudes(recording, frame) for frame in (0, len(recording.frames["time"]) - 1)])
    (first, _), (last, bulk) = 1e3 * np.moveaxis(ends, 2, 1)
    return {
        "top_altitude_start": over_worlds(first, "mm", missing=EMPTY),
        "top_altitude_end": over_worlds(last, "mm", missing=EMPTY),
        "top_fall": over_worlds(first - last, "mm", missing=EMPTY),
        "bulk_altitude_end": over_worlds(bulk, "mm", missing=EMPTY),
    }


def altitudes(recording: Recording, frame: int) -> np.ndarray:
    """Altitude (W, 2), m, of the highest point and of the bulk in a frame; NaN for an empty scene."""
    tops = recording.frames["position"][frame][..., 1].astype(float) + recording.radius
    found = np.full((len(tops), 2), np.nan)
    for world, top in enumerate(tops):
        seen = top[np.isfinite(top)]
        if len(seen):
            found[world] = seen.max(), np.percentile(seen, BULK)
    return found


def draw(sheet: Sheet, recording: Recording, values: Mapping[str, Value]) -> None:
    """The top of the cargo in time: its highest grain, and the height most grains stay below."""
    time = recording.frames["time"][:]
    if len(time) < 2:
        return
    tops = 1e3 * np.array([altitudes(recording, frame) for frame in range(len(time))])
    ((axes,),) = sheet.panels()
    band(axes, time, tops[..., 0], BLUE, "highest grain")
    band(axes, time, tops[..., 1], VERMILION, f"{BULK:g} % of the grains lie lower")
    axes.set_xlabel("time (s)")
    axes.set_xlim(time[0], time[-1])
    level(sheet, axes, values.get("top_altitude_end"), "top at the end", GREY)
    note(sheet, axes, values.get("top_fall"), "fall of the top")
    axes.set_ylabel("altitude of the top\nin the tank (mm)")


FIGURES = {"altitude": draw}
