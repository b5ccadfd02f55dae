"""The highest pressures at each gauge of pressure. Pressures are those over the air's, the water's own weight included.

gauge_largest_NAME: the highest of the run; its note says when. It is the peak between samples, so that it does not
depend on how often pressures are recorded.

Of a tank that one harmonic motion drives, over its whole cycles after the soft start and the first cycle:
gauge_peak_NAME: the mean of the highest pressures of the cycles. Error: the standard error of this mean, from the
scatter of the cycles, taken as independent. gauge_peak_scatter_NAME: the standard deviation of the cycles' peaks; of
water that breaks it is a fifth of the peak or more, in experiments as well (Souto-Iglesias et al. 2011).
"""

from collections.abc import Mapping

import numpy as np

from lab.measures.drawing import BLUE, GREY, VERMILION, Sheet, band, level
from lab.measures.gauges import cycles, key, over_cycles, pressure_gauges
from lab.measures.motion import driving
from lab.measures.value import Value, over_worlds
from lab.preset.units import show
from lab.recording import Recording

OF = "water"
MOST_DRAWN = 4  # gauges of a figure


def applies(recording: Recording) -> bool:
    """There are gauges of pressure."""
    return bool(pressure_gauges(recording))


def measure(recording: Recording) -> dict[str, Value]:
    """gauge_largest_NAME, gauge_peak_NAME and gauge_peak_scatter_NAME (Pa)."""
    time, found = recording.series["time"], {}
    for k, name in enumerate(pressure_gauges(recording)):
        peak = recording.series["gauge_peak"][..., k]
        when = ", ".join(show(float(time[row]), "s") for row in peak.argmax(axis=0))
        note = f"at {when}" if peak.any() else "it stays dry"
        found[key("gauge_largest", name)] = over_worlds(peak.max(axis=0), "Pa", note=note)
        if driving(recording) is not None:
            parts = [cycles(recording, one) for one in peak.T]
            highest = [np.array([one[rows].max() for rows in of]) for one, of in zip(peak.T, parts, strict=True)]
            mean, scatter = over_cycles(highest, "Pa")
            found |= {key("gauge_peak", name): mean, key("gauge_peak_scatter", name): scatter}
    return found


def draw(sheet: Sheet, recording: Recording, values: Mapping[str, Value]) -> None:
    """The pressure at each of the first gauges, below it the peaks between samples, and the mean peak of the cycles."""
    time, names = recording.series["time"], pressure_gauges(recording)[:MOST_DRAWN]
    panels = sheet.panels(heights=(1,) * len(names))
    for k, (name, (axes,)) in enumerate(zip(names, panels, strict=True)):
        band(axes, time, recording.series["gauge_peak"][..., k], GREY, "highest between samples")
        band(axes, time, recording.series["gauge_pressure"][..., k], BLUE, "pressure")
        axes.set_xlim(time[0], time[-1])
        level(sheet, axes, values.get(key("gauge_peak", name)), f"mean peak at {name}", VERMILION)
        axes.set_ylabel(f"{name} (Pa)")
    panels[-1, 0].set_xlabel("time (s)")


FIGURES = {"gauges": draw}
