"""The mean at each gauge of the water, and how far it goes from it.

gauge_mean_NAME: of the pressure (Pa), of the depth (mm), or of the push on an edge (N, `lab.measures.force_peaks`),
over the steady part (`steady_part`; of a tilt, and of a run that is too short for one, over the whole run). Error:
standard error of the means of blocks, a driving period each where there is one.
gauge_std_NAME: the standard deviation in the same time. Error: half the difference between the two halves of it.
"""

import numpy as np

from lab.measures.driven_load import with_halves
from lab.measures.gauges import key, pushes
from lab.measures.steady import BLOCKS, LEAST_SAMPLES, Steady, averaged, steady_part
from lab.measures.value import Value
from lab.recording import Recording

OF = "water"


def applies(recording: Recording) -> bool:
    """There are gauges, and samples for blocks."""
    return bool(recording.preset.gauges) and len(recording.series["time"]) > LEAST_SAMPLES


def measure(recording: Recording) -> dict[str, Value]:
    """gauge_mean_NAME and gauge_std_NAME (Pa, mm, N)."""
    time, found = recording.series["time"], {}
    steady = steady_part(recording, time) or Steady(slice(1, len(time)), BLOCKS)
    for name, values, unit in _signals(recording):
        found[key("gauge_mean", name)] = averaged(values, steady, unit)
        spread = np.array([values[part].std(axis=0) for part in steady.parts])
        found[key("gauge_std", name)] = with_halves(spread, unit, "not found")
    return found


def _signals(recording: Recording) -> list[tuple[str, np.ndarray, str]]:
    """The name, the samples (T, W) and the unit of each gauge."""
    series, found = recording.series, []
    for names, read, unit in (
        (recording.names["gauge"], lambda: series["gauge_pressure"], "Pa"),
        (recording.names["level"], lambda: 1e3 * series["level_depth"], "mm"),
        (recording.names["edge"], lambda: pushes(recording), "N"),
    ):
        values = read() if names else None
        found += [(name, values[..., k], unit) for k, name in enumerate(names)]
    return found
