"""The hardest pushes of the water on each edge with a gauge of force.

The push is the part of the force outwards, square to the edge; of water that slides along walls there is no other. It
is that on the tank's whole thickness, the water's own weight included. Each sample is the mean over the time since the
sample before, so that a peak shorter than the sampling interval is averaged.

force_largest_NAME: the largest of the samples; its note says when.

Of a tank that one harmonic motion drives, over its whole cycles after the soft start and the first cycle:
force_peak_NAME: the mean of the largest pushes of the cycles. Error: the standard error of this mean, from the scatter
of the cycles, taken as independent. force_peak_scatter_NAME: the standard deviation of the cycles' peaks.
"""

from collections.abc import Mapping

from lab.measures.drawing import BLUE, GREEN, VERMILION, Sheet, band, level
from lab.measures.gauges import key, panels_of, peaks, pushes
from lab.measures.value import Value
from lab.recording import Recording

OF = "water"


def applies(recording: Recording) -> bool:
    """There are gauges of force, and more than one sample: the first is the mean of nothing yet."""
    return bool(recording.names["edge"]) and len(recording.series["time"]) > 1


def measure(recording: Recording) -> dict[str, Value]:
    """force_largest_NAME, force_peak_NAME and force_peak_scatter_NAME (N)."""
    push, found = pushes(recording), {}
    for k, name in enumerate(recording.names["edge"]):
        found |= peaks(recording, "force", name, push[..., k], "N")
    return found


def draw(sheet: Sheet, recording: Recording, values: Mapping[str, Value]) -> None:
    """The push on each of the first edges with its mean, and with the mean peak of the cycles."""
    time, push = recording.series["time"], pushes(recording)
    for k, name, axes in panels_of(sheet, time, recording.names["edge"], "N"):
        band(axes, time, push[..., k], BLUE, "push on the edge")
        level(sheet, axes, values.get(key("gauge_mean", name)), f"mean at {name}", GREEN)
        level(sheet, axes, values.get(key("force_peak", name)), f"mean peak at {name}", VERMILION)


FIGURES = {"forces": draw}
