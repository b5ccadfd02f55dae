"""The impulse per area of impacts at each gauge of pressure, which scatters far less than their peaks.

gauge_impulse_NAME: the integral of the pressure from 30 ms before its peak to 200 ms after it, as the reference data of
SPHERIC's benchmark 10 are compared (Souto-Iglesias, Botia-Vera & Bulian 2011), by the trapezoidal rule on the samples.
Of a tank that one harmonic motion drives: the mean over its cycles (`lab.measures.gauges`), and as its error the
standard error of that mean, from the scatter of the cycles. Of any other run: that of the highest peak alone.
An impact whose 230 ms are not all recorded is left out.
"""

import numpy as np

from lab.measures.gauges import impulse, key
from lab.measures.value import Value
from lab.recording import Recording

OF = "water"


def applies(recording: Recording) -> bool:
    """There are gauges of pressure, and more than one sample."""
    return bool(recording.names["gauge"]) and len(recording.series["time"]) > 1


def measure(recording: Recording) -> dict[str, Value]:
    """gauge_impulse_NAME (Pa s)."""
    series = recording.series
    columns = zip(np.moveaxis(series["gauge_pressure"], -1, 0), np.moveaxis(series["gauge_peak"], -1, 0), strict=True)
    return {
        key("gauge_impulse", name): impulse(recording, series["time"], pressure, peak, "Pa s")
        for name, (pressure, peak) in zip(recording.names["gauge"], columns, strict=True)
    }
