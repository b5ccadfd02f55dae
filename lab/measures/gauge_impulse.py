"""The impulse per area of impacts at each gauge of pressure, which scatters far less than their peaks.

gauge_impulse_NAME: the integral of the pressure from 30 ms before its peak to 200 ms after it, as the reference data of
SPHERIC's benchmark 10 are compared (Souto-Iglesias, Botia-Vera & Bulian 2011), by the trapezoidal rule on the samples.
Of a tank that one harmonic motion drives: the mean over its cycles (`lab.measures.gauges`), and as its error the
standard error of that mean, from the scatter of the cycles. Of any other run: that of the highest peak alone.
An impact whose 230 ms are not all recorded is left out.
"""

import numpy as np

from lab.measures.gauges import cycles, key, over_cycles, pressure_gauges
from lab.measures.motion import driving
from lab.measures.value import Value, over_worlds
from lab.recording import Recording

OF = "water"
BEFORE, AFTER = 0.030, 0.200  # s
LEAST_SAMPLES = 10  # of an impact
COARSE = f"no impact is recorded whole by {LEAST_SAMPLES} samples or more"


def applies(recording: Recording) -> bool:
    """There are gauges of pressure, and more than one sample."""
    return bool(pressure_gauges(recording)) and len(recording.series["time"]) > 1


def measure(recording: Recording) -> dict[str, Value]:
    """gauge_impulse_NAME (Pa s)."""
    time, found = recording.series["time"], {}
    for k, name in enumerate(pressure_gauges(recording)):
        pressure, peak = recording.series["gauge_pressure"][..., k], recording.series["gauge_peak"][..., k]
        if driving(recording) is not None:
            parts = [cycles(recording, one) for one in peak.T]
            impulses = [_impulses(time, *worlds) for worlds in zip(pressure.T, peak.T, parts, strict=True)]
            found[key("gauge_impulse", name)] = over_cycles(impulses, "Pa s")[0]
        else:
            whole = [slice(0, len(time))]
            impulses = [_impulses(time, *worlds, whole) for worlds in zip(pressure.T, peak.T, strict=True)]
            numbers = [values[0] if len(values) else np.nan for values in impulses]
            found[key("gauge_impulse", name)] = over_worlds(numbers, "Pa s", missing=COARSE)
    return found


def _impulses(time: np.ndarray, pressure: np.ndarray, peak: np.ndarray, parts: list[slice]) -> np.ndarray:
    """The impulse (C,), Pa s, of the highest peak in each part of a run, of those recorded whole and finely enough."""
    found = []
    for rows in parts:
        top = time[rows.start + int(peak[rows].argmax())]
        begin, end = np.searchsorted(time, [top - BEFORE - 1e-9, top + AFTER + 1e-9])
        recorded = time[0] <= top - BEFORE and top + AFTER <= time[-1]
        if recorded and end - begin >= LEAST_SAMPLES:
            found.append(np.trapezoid(pressure[begin:end], time[begin:end]))
    return np.array(found)
