"""Impacts of water on the wall of a rolled tank beside SPHERIC's benchmark 10.

Botia-Vera, Souto-Iglesias & Bulian (2011), ISOPE: sensor 1, at the still level of the side wall. An arrival is the
first time at which the pressure exceeds 1 kPa, an impulse the integral from 30 ms before the highest pressure to 200 ms
after it. Peaks of single runs scatter by a fifth, and in a liquid without air they are hits of a few particles whose
pressure is ρ c U and lasts a millisecond. So means over 10 ms are compared, too.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np
from matplotlib.figure import Figure
from scipy.special import chdtri

from lab.report.numbers import plus_minus
from lab.report.plots import BELOW, BLUE, GREY, VERMILION, canvas
from lab.studies.reproduce.estimates import Verdict
from lab.studies.reproduce.experiment import Found, Row, Told, observed
from lab.studies.reproduce.figures import SIZE
from lab.studies.reproduce.runs import Outcome
from lab.studies.reproduce.water.costs import COSTS, cost
from lab.studies.reproduce.water.measured import drawn
from lab.studies.reproduce.water.theory.shallow_water import ShallowTank
from solvers.motion.history import History

ABOVE = 1000.0  # Pa: the wave is there
BEFORE, AFTER = 0.030, 0.200  # s, of an impulse about its peak
AVERAGE = 0.010  # s
EARLIER, LATER = 0.3, 0.4  # s, of an impact about its measured arrival
MEASURED = "spheric10_lateral_water/pressure_sensor1.csv"
DRAWN = -0.05, 0.25  # s about the arrival
FIRST = 2.3738  # s
CELLS = 150  # of shallow water
A_FIFTH = 0.1, 0.3  # read so, since the sheet gives no number with its hundred repeats


@dataclass(frozen=True)
class Impact:
    """An impact: arrival s, peak Pa, largest mean over 10 ms Pa, impulse Pa s."""

    arrival: float
    peak: float
    mean: float
    impulse: float


def find_impact(time: np.ndarray, pressure: np.ndarray, highest: np.ndarray, about: float) -> Impact | None:
    """The impact near a time (s) in the pressure (T,) Pa of a gauge, and its highest between samples; None if none."""
    near = (time >= about - EARLIER) & (time <= about + LATER)
    time, pressure, highest = time[near], pressure[near], highest[near]
    if not (highest > ABOVE).any():
        return None
    top = time[highest.argmax()]
    within = (time >= top - BEFORE) & (time <= top + AFTER)
    samples = max(1, round(AVERAGE / (time[1] - time[0])))
    means = np.convolve(pressure, np.full(samples, 1.0 / samples), "valid")
    impulse = float(np.trapezoid(pressure[within], time[within]))
    return Impact(float(time[np.argmax(highest > ABOVE)]), float(highest.max()), float(means.max()), impulse)


def impact(one: Outcome, about: float) -> Impact | None:
    """The impact at the first gauge near a time (s); None if there is none."""
    series = one.recording.series
    pressure, highest = (series[name][:, 0, 0] for name in ("gauge_pressure", "gauge_peak"))
    return find_impact(series["time"], pressure, highest, about)


def _part(name: str, factor: float = 1.0) -> Callable[[Outcome, float], float]:
    """The number of the impact near a time; NaN if there is none."""

    def number(one: Outcome, about: float) -> float:
        found = impact(one, about)
        return np.nan if found is None else factor * getattr(found, name)

    return number


def impulse_over_shallow(one: Outcome, about: float) -> float:
    """The impulse near a time (s) over that of shallow water in the same tank, made to roll alike; NaN without one."""
    preset, found = one.recording.preset, impact(one, about)
    if found is None:
        return np.nan
    tank = preset.tank.width, preset.water.depth, preset.run.gravity, next(iter(preset.gauges.values())).place[1]
    time, pressed = shallow_pressure(tank, preset.motion.history.history, about + LATER)
    near = time >= about - EARLIER
    time, pressed = time[near], preset.water.density * pressed[near]
    top = time[pressed.argmax()]
    within = (time >= top - BEFORE) & (time <= top + AFTER)
    return found.impulse / float(np.trapezoid(pressed[within], time[within]))


@cache  # takes seconds
def shallow_pressure(tank: tuple[float, float, float, float], history: History, duration: float) -> np.ndarray:
    """Times (s) and pressures over the density (m²/s²) of shallow water in the wall to the left, (2, T).

    Of a tank by its width (m), depth (m), gravity (m/s²) and the gauge's height (m), which rolls about its floor.
    """
    width, depth, gravity, height = tank
    water = ShallowTank(width, depth, -history.centre[1], gravity, CELLS)
    roll = history.motions["roll"].curve
    return water.followed(roll, duration, lambda now, state: water.wall_pressure(now, state, height))


NUMBERS = {
    "impact_arrival": ("s", _part("arrival")),
    "impact_peak": ("kPa", _part("peak", 1e-3)),
    "impact_mean": ("kPa", _part("mean", 1e-3)),
    "impact_impulse": ("Pa s", _part("impulse")),
    "impulse_over_shallow": ("1", impulse_over_shallow),
}


def repeats(found: Found) -> Told:
    """How first impacts scatter over the starts of each run: means and standard deviations over single runs."""
    rows, cells = [], []
    for label, outcomes in found.items():
        hits = [hit for one in outcomes if (hit := impact(one, FIRST))]
        columns = (("arrival", 1.0, 3), ("peak", 1e-3, 2), ("mean", 1e-3, 2), ("impulse", 1.0, 0))
        told = [_spread([scale * getattr(hit, name) for hit in hits], digits) for name, scale, digits in columns]
        cells.append([*cost(label, outcomes[0]), f"{len(hits)} of {len(outcomes)}", *told])
        if len(hits) > 1:
            rows.append(_scatter(label, np.array([hit.peak for hit in hits])))
    heads = [*COSTS, "impacts", "arrival, s", "peak, kPa", "mean over 10 ms, kPa", "impulse, Pa s"]
    return Told(rows, None, [heads, *cells])


def _spread(values: Sequence[float], digits: int) -> str:
    """Mean and standard deviation as text; of one value itself, of none nothing."""
    if len(values) < 2:
        return "".join(f"{value:.{digits}f}" for value in values)
    return plus_minus(float(np.mean(values)), float(np.std(values, ddof=1)))


def _scatter(label: str, peaks: np.ndarray) -> Row:
    """Whether peaks (n,) of runs scatter by about a fifth, by the 95 % interval of a standard deviation.

    That is s √((n − 1)/χ²), with the quantiles of χ² of n − 1 degrees of freedom.
    """
    share, freedom = float(peaks.std(ddof=1) / peaks.mean()), len(peaks) - 1
    low, high = (share * float(np.sqrt(freedom / chdtri(freedom, tail))) for tail in (0.025, 0.975))
    verdict = Verdict.CANNOT_TELL
    if A_FIFTH[0] <= low and high <= A_FIFTH[1]:
        verdict = Verdict.AGREES
    elif high < A_FIFTH[0] or low > A_FIFTH[1]:
        verdict = Verdict.DIFFERS
    ours, read = f"{share:.2f} ({low:.2f} to {high:.2f}) of {len(peaks)} runs", f"{A_FIFTH[0]:g} to {A_FIFTH[1]:g}"
    return observed(f"scatter of first peaks, {label}", "a fifth", ours, verdict, read)


def figure(found: Found, arrivals: Sequence[float], peaks: Sequence[float]) -> Figure:
    """The pressure about impacts that arrive at times (s), cut off where short hits are; the range of `peaks` (kPa).

    Of the last three runs, of each its first start.
    """
    drawing, panels = canvas((SIZE[0], 3.6), 1, len(arrivals), sharey=True)
    measured = drawn(panels[0], MEASURED)
    for axes, each in zip(panels, arrivals, strict=True):
        axes.axhspan(*peaks, color=GREY, alpha=0.15, lw=0, label="peaks of a hundred repeats, ± 2 std")
        for (label, outcomes), colour in zip(list(found.items())[-3:], (BLUE, VERMILION, "0.6"), strict=False):
            series = outcomes[0].recording.series
            axes.plot(series["time"], 1e-3 * series["gauge_pressure"][:, 0, 0], color=colour, lw=0.9, label=label)
        if measured is not None:
            axes.plot(measured[0], 1e-3 * measured[1], color="black", lw=0.9, label="measured")
        axes.set(xlim=(each + DRAWN[0], each + DRAWN[1]), ylim=(-0.3, 6.0), xlabel="time (s)")
    panels[0].set_ylabel("pressure at sensor 1 (kPa)")
    drawing.legend(*panels[0].get_legend_handles_labels(), loc=BELOW, ncols=3)
    return drawing
