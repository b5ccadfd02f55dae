"""The highest pressures at each gauge of pressure. Pressures are those over the air's, the water's own weight included.

gauge_largest_NAME: the highest of the run; its note says when. It is the peak between samples, so that it does not
depend on how often pressures are recorded.

Of a tank that one harmonic motion drives, over its whole cycles after the soft start and the first cycle:
gauge_peak_NAME: the mean of the highest pressures of the cycles. Error: the standard error of this mean, from the
scatter of the cycles, taken as independent. gauge_peak_scatter_NAME: the standard deviation of the cycles' peaks; of
water that breaks it is a fifth of the peak or more, in experiments as well (Souto-Iglesias et al. 2011).
"""

from collections.abc import Mapping

from lab.measures.drawing import BLUE, GREY, VERMILION, Sheet, band, level
from lab.measures.gauges import key, panels_of, peaks
from lab.measures.value import Value
from lab.recording import Recording

OF = "water"


def applies(recording: Recording) -> bool:
    """There are gauges of pressure."""
    return bool(recording.names["gauge"])


def measure(recording: Recording) -> dict[str, Value]:
    """gauge_largest_NAME, gauge_peak_NAME and gauge_peak_scatter_NAME (Pa)."""
    found = {}
    for k, name in enumerate(recording.names["gauge"]):
        found |= peaks(recording, "gauge", name, recording.series["gauge_peak"][..., k], "Pa")
    return found


def draw(sheet: Sheet, recording: Recording, values: Mapping[str, Value]) -> None:
    """The pressure at each of the first gauges, below it the peaks between samples, and the mean peak of the cycles."""
    time = recording.series["time"]
    for k, name, axes in panels_of(sheet, time, recording.names["gauge"], "Pa"):
        band(axes, time, recording.series["gauge_peak"][..., k], GREY, "highest between samples")
        band(axes, time, recording.series["gauge_pressure"][..., k], BLUE, "pressure")
        level(sheet, axes, values.get(key("gauge_peak", name)), f"mean peak at {name}", VERMILION)


FIGURES = {"gauges": draw}
