"""How high and how low the water's surface goes in each cycle of a tank that one harmonic motion drives.

crest_NAME and trough_NAME: the mean over the whole cycles after the soft start and the first cycle of the
highest and of the lowest depth at a level gauge in a cycle, less the depth at the start; so troughs are negative.
Error: the standard error of this mean, from the scatter of the cycles, taken as independent. crest_scatter_NAME
and trough_scatter_NAME: the standard deviations of the cycles. Water that also swings at a natural frequency beats:
that is no scatter of chance, and the error says then how much cycles differ.
"""

from collections.abc import Mapping

import numpy as np

from lab.measures.drawing import BLUE, GREEN, VERMILION, Sheet, band, level
from lab.measures.gauges import highest, key, over_cycles, panels_of
from lab.measures.motion import driving
from lab.measures.value import Value
from lab.recording import Recording

OF = "water"


def applies(recording: Recording) -> bool:
    """There are gauges of level in a driven tank."""
    return bool(recording.names["level"]) and driving(recording) is not None


def measure(recording: Recording) -> dict[str, Value]:
    """crest_NAME, trough_NAME, crest_scatter_NAME and trough_scatter_NAME (mm)."""
    raised, found = _raised(recording), {}
    for k, name in enumerate(recording.names["level"]):
        for end, sign in (("crest", 1.0), ("trough", -1.0)):
            ends = [sign * values for values in highest(recording, sign * raised[..., k])]
            mean, scatter = over_cycles(ends, "mm")
            found |= {key(end, name): mean, key(f"{end}_scatter", name): scatter}
    return found


def _raised(recording: Recording) -> np.ndarray:
    """By how much the surface is higher than at the start (T, W, K), mm, at each level gauge."""
    depth = recording.series["level_depth"]
    return 1e3 * (depth - depth[:1])


def draw(sheet: Sheet, recording: Recording, values: Mapping[str, Value]) -> None:
    """The surface at each of the first level gauges, with the mean crest and the mean trough of the cycles."""
    time, raised = recording.series["time"], _raised(recording)
    for k, name, axes in panels_of(sheet, time, recording.names["level"], "mm"):
        band(axes, time, raised[..., k], BLUE, "surface over that at the start")
        level(sheet, axes, values.get(key("crest", name)), f"mean crest at {name}", VERMILION)
        level(sheet, axes, values.get(key("trough", name)), f"mean trough at {name}", GREEN)


FIGURES = {"crests": draw}
