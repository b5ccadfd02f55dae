"""How high the water rises.

run_up_NAME: the largest depth at each level gauge, less that at the start. Error: none of its own; a gauge averages
over a width of two smoothing lengths.
highest_water: the greatest height of any particle over the tank's lowest point, drops in the air included, in the
picture frames, and half a spacing more, since water reaches beyond the middle of a particle. Error: half a spacing. A
crest between two frames may be missed. The note says if it came within a spacing of the tank's highest point.
"""

from collections.abc import Mapping

import numpy as np

from lab.measures.drawing import BLUE, GREEN, GREY, VERMILION, Sheet, band
from lab.measures.gauges import key
from lab.measures.value import Value, over_worlds
from lab.preset.sections.water.liquid import spacing
from lab.recording import Recording

OF = "water"
COLOURS = BLUE, VERMILION, GREEN, GREY


def applies(recording: Recording) -> bool:
    """Every run of water with weight has a highest level."""
    return recording.preset.run.gravity > 0.0


def measure(recording: Recording) -> dict[str, Value]:
    """run_up_NAME and highest_water (mm)."""
    found = {}
    for k, name in enumerate(recording.names["level"]):
        rise = recording.series["level_depth"][..., k]
        found[key("run_up", name)] = over_worlds(1e3 * (rise.max(axis=0) - rise[0]), "mm")
    if not len(recording.frames["time"]):
        return found
    floor, top = (float(end(recording.outline[:, 1])) for end in (np.min, np.max))
    size = spacing(recording.preset)
    highest = np.full(recording.worlds, -np.inf)
    for frame in range(len(recording.frames["time"])):
        place = recording.frames["water_position"][frame]
        highest = np.fmax(highest, np.fmax.reduce(place[..., 1].astype(float), axis=1))
    highest = highest + 0.5 * size
    reached = int(np.count_nonzero(top - highest <= size))
    many = f" in {reached} of {recording.worlds} tanks" if recording.worlds > 1 else ""
    note = f"it reaches the {'rim' if recording.open_edges else 'lid'}{many}" if reached else ""
    error = np.full(recording.worlds, 500.0 * size)
    values = over_worlds(1e3 * (highest - floor), "mm", uncertainties=error, kind="resolution", note=note)
    return found | {"highest_water": values}


def draw(sheet: Sheet, recording: Recording, values: Mapping[str, Value]) -> None:
    """The depths at the level gauges in time."""
    names = recording.names["level"][: len(COLOURS)]
    if not names:
        return
    ((axes,),) = sheet.panels()
    time, depth = recording.series["time"], recording.series["level_depth"]
    for k, (name, colour) in enumerate(zip(names, COLOURS, strict=False)):
        band(axes, time, 1e3 * depth[..., k], colour, f"depth at {name}")
    axes.set_xlim(time[0], time[-1])
    axes.set_xlabel("time (s)")
    axes.set_ylabel("depth of the water (mm)")


FIGURES = {"levels": draw}
