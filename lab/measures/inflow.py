"""Water that has entered a ship through openings in her hull.

entered_NAME: the volume that has entered through each opening by the end of the run, less what has left by it.
Error: one particle of water, over the length of the room; none for water that stands level, whose volume is exact.
"""

from collections.abc import Mapping

import numpy as np

from lab.measures.drawing import BLUE, GREEN, GREY, VERMILION, Sheet, band
from lab.measures.value import Value, over_worlds
from lab.preset.sections.water.inflow import inlets_of
from lab.recording import Recording

OF = "water"
COLOURS = BLUE, VERMILION, GREEN, GREY


def applies(recording: Recording) -> bool:
    """The ship has openings that lead to rooms."""
    return bool(recording.preset.inflow)


def measure(recording: Recording) -> dict[str, Value]:
    """entered_NAME (l)."""
    last, preset = 1e3 * recording.series["inflow_volume"][-1], recording.preset
    found = {}
    for k, (name, inlet) in enumerate(zip(recording.names["inlet"], inlets_of(preset), strict=True)):
        error = {}
        if preset.water.model == "sph":
            of_one = 1e3 * inlet.along * preset.liquid.spacing**2
            error = {"uncertainties": np.full(len(last), of_one), "kind": "resolution"}
        found[f"entered_{name}"] = over_worlds(last[:, k], "l", **error)
    return found


def draw(sheet: Sheet, recording: Recording, values: Mapping[str, Value]) -> None:
    """The volume that has entered through each opening, and the flow through it."""
    time, volume = recording.series["time"], recording.series["inflow_volume"]
    if not volume.any():
        return
    (upper,), (lower,) = sheet.panels(heights=(2, 1))
    for k, name in enumerate(recording.names["inlet"]):
        colour = COLOURS[k % len(COLOURS)]
        band(upper, time, 1e3 * volume[..., k], colour, name)
        band(lower, time, 1e3 * recording.series["inflow_rate"][..., k], colour)
    upper.set_ylabel("water entered (l)")
    lower.set_ylabel("flow (l/s)")
    lower.set_xlabel("time (s)")
    lower.set_xlim(time[0], time[-1])


FIGURES = {"inflow": draw}
