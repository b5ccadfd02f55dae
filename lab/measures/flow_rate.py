"""How fast the grains run out of an outlet, and whether they arch over it.

A grain has passed when its centre is below the outlet's lips. The rate is the slope of a straight line through the
number of grains passed against time. The line is fitted between the two frames at which SHARES of all grains that pass
in the run have passed. By then the flow has set in, and neither the heap below nor the end of the supply slows it yet.

flow_rate: grains in a second. mass_flow_rate: their mass in a second, of a sheet one grain thick. Error: standard
error of the slopes of BLOCKS parts of that time. In a plane Beverloo's law (Beverloo, Leniger & van de Velde 1961)
reads W = C rho sqrt(g) (D - k d)^(3/2).
outlet_width: D, in mean diameters d.
passed_fraction: share of the grains that have passed by the last frame.
clogged: 1 where the flow has stopped by itself, 0 where not; its mean over the beds is the share of beds that clog.
The flow has stopped by itself if no grain passes in the last QUIET of the run, at least LEFT of the grains are still
above, and no grain lies one to four diameters below the outlet. Otherwise the heap has stopped it.
"""

from collections.abc import Mapping

import numpy as np

from lab.measures.drawing import BLUE, VERMILION, Sheet, band
from lab.measures.outlet import Outlet, find_outlet, passed
from lab.measures.value import Value, over_worlds
from lab.measures.wall_force import grain_mass, said
from lab.recording import Recording

OF = "grains"
SHARES = (0.2, 0.6)  # of all that pass
BLOCKS = 4
QUIET = 0.1  # of the run's duration
LEFT = 0.05  # of the grains
BELOW = (1.0, 4.0)  # mean diameters
FEW = "too few grains pass to tell a rate"


def applies(recording: Recording) -> bool:
    """Grains run out of an outlet."""
    return len(recording.frames["time"]) > 1 and find_outlet(recording) is not None


def measure(recording: Recording) -> dict[str, Value]:
    """flow_rate (1/s), mass_flow_rate (g/s), outlet_width (d), passed_fraction (%) and clogged."""
    outlet, time = find_outlet(recording), recording.frames["time"][:]
    out = passed(recording, outlet)
    found = {"flow_rate": _rate(time, out.sum(axis=2), "1/s")}
    found["mass_flow_rate"] = _rate(time, 1e3 * (out * grain_mass(recording)).sum(axis=2), "g/s", note=said(recording))
    width = np.hypot(*np.diff(outlet.lips, axis=0)[0])
    return found | {
        "outlet_width": over_worlds(width / recording.mean_diameter, "d"),
        "passed_fraction": over_worlds(100 * out[-1].mean(axis=1), "%"),
        "clogged": over_worlds(clogged(recording, outlet, out), "1"),
    }


def clogged(recording: Recording, outlet: Outlet, out: np.ndarray) -> np.ndarray:
    """Whether the flow has stopped (W,) though there is room below; `out` (F, W, n): which grains have passed."""
    time = recording.frames["time"][:]
    before = np.searchsorted(time, time[-1] - QUIET * (time[-1] - time[0]))
    quiet = (out[-1] == out[before]).all(axis=1) & (out[-1].mean(axis=1) <= 1 - LEFT)
    place = recording.frames["position"][-1].astype(float)
    lips = outlet.lips_at(recording, -1)
    (left, right), level = lips[:, :, :1].swapaxes(0, 1), lips[:, :, 1].mean(axis=1)[:, None]
    depth = (level - place[..., 1]) / recording.mean_diameter[:, None]
    filled = (place[..., 0] > left) & (place[..., 0] < right) & (depth > BELOW[0]) & (depth < BELOW[1])
    return (quiet & ~filled.any(axis=1)).astype(float)


def _rate(time: np.ndarray, out: np.ndarray, unit: str, note: str = "") -> Value:
    """Rate at which `out` (F, W) grows while SHARES of it pass."""
    slopes = np.array([_slope(time, amount) for amount in out.T])
    return over_worlds(slopes[:, 0], unit, uncertainties=slopes[:, 1], kind="averaging", note=note, missing=FEW)


def _slope(time: np.ndarray, amount: np.ndarray) -> tuple[float, float]:
    """Slope of an amount (F,) between SHARES of its end, and its error; NaN where these are too few frames."""
    begin, end = np.searchsorted(np.maximum.accumulate(amount), np.multiply(SHARES, amount.max()))
    if amount.max() <= 0 or end - begin < 2 * BLOCKS:
        return np.nan, np.nan
    blocks = np.array_split(np.arange(begin, end), BLOCKS)
    parts = [np.polyfit(time[rows], amount[rows], 1)[0] for rows in blocks]
    return float(np.polyfit(time[begin:end], amount[begin:end], 1)[0]), float(np.std(parts, ddof=1) / np.sqrt(BLOCKS))


def draw(sheet: Sheet, recording: Recording, values: Mapping[str, Value]) -> None:
    """The grains that have passed in time, and a line as steep as the flow rate through the part it was fitted to."""
    time = recording.frames["time"][:]
    out = passed(recording, find_outlet(recording)).sum(axis=2)
    ((axes,),) = sheet.panels()
    band(axes, time, out, BLUE, "passed")
    rate, mean = values.get("flow_rate"), out.mean(axis=1)
    share = mean / max(mean.max(), 1.0)
    fitted = (share >= SHARES[0]) & (share <= SHARES[1])
    if rate is not None and rate.value is not None and fitted.any():
        line = mean[fitted].mean() + rate.value * (time[fitted] - time[fitted].mean())
        axes.plot(time[fitted], line, color=VERMILION, ls="--", label=f"flow rate {sheet.words(rate)}")
    axes.set_xlabel("time (s)")
    axes.set_xlim(time[0], time[-1])
    axes.set_ylim(bottom=0)
    axes.set_ylabel("grains below the outlet")


FIGURES = {"flow": draw}
