"""The impulse of the water's push on each edge with a gauge of force, which scatters far less than its peaks.

force_impulse_NAME: the integral of the push (`lab.measures.force_peaks`), N s, over the same time round its peak and by
the same rule as that of a gauge of pressure (`lab.measures.gauge_impulse`): the mean of the cycles with its standard
error, or that of the largest push alone. The samples are means over intervals, and stand in the middle of these.
"""

from lab.measures.driven_load import between
from lab.measures.gauges import impulse, key, pushes
from lab.measures.value import Value
from lab.recording import Recording

OF = "water"


def applies(recording: Recording) -> bool:
    """There are gauges of force, and more than one sample."""
    return bool(recording.names["edge"]) and len(recording.series["time"]) > 1


def measure(recording: Recording) -> dict[str, Value]:
    """force_impulse_NAME (N s)."""
    time, push = between(recording.series["time"]), pushes(recording)
    return {
        key("force_impulse", name): impulse(recording, time, push[..., k], push[..., k], "N s")
        for k, name in enumerate(recording.names["edge"])
    }
