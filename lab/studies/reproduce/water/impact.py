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
from scipy.integrate import cumulative_trapezoid
from scipy.special import chdtri

from lab.report.numbers import plus_minus
from lab.report.plots import BELOW, BLUE, GREY, VERMILION, canvas
from lab.studies.reproduce.estimates import Verdict
from lab.studies.reproduce.experiment import Found, ReportSection, Row, observed
from lab.studies.reproduce.figures import SIZE
from lab.studies.reproduce.runs import Outcome
from lab.studies.reproduce.water.costs import COSTS, cost
from lab.studies.reproduce.water.measured import drawn
from lab.studies.reproduce.water.theory.shallow_water import Roll, ShallowTank
from solvers.motion.history import History

ABOVE = 1000.0  # Pa: the wave is there
BEFORE, AFTER = 0.030, 0.200  # s, of an impulse about its peak
AVERAGE = 0.010  # s
EARLIER, LATER = 0.3, 0.4  # s, of an impact about its measured arrival
MEASURED = "spheric10_lateral_water/pressure_sensor1.csv"
DRAWN = -0.05, 0.25  # s about the arrival
FIRST = 2.3738  # s
PERIOD = 1.6365  # s, of the roll
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


def over_shallow(name: str) -> Callable[[Outcome, float], float]:
    """A number of the `cycle` about an impact over that of shallow water in the same tank, made to roll alike."""

    def number(one: Outcome, about: float) -> float:
        preset, series = one.recording.preset, one.recording.series
        duration = float(series["time"][-1])
        if duration < about + 0.5 * PERIOD:
            return np.nan
        tank = preset.tank.width, preset.water.depth, preset.run.gravity
        courses = series["time"], *(series[key][:, 0] for key in ("water_total", "water_work"))
        alike = cycle(*shallow_energy(tank, preset.motion.history.history, duration), about)
        return cycle(*courses, about)[name] / (preset.water.density * preset.tank.thickness * alike[name])

    return number


def made_at_walls(one: Outcome, about: float) -> float:
    """What the wall particles gave the water in the cycle about an impact, over the work of the walls themselves.

    Wall particles hold no energy for good, so that what they give is made by the scheme.
    """
    time, held, work = (one.recording.series[key] for key in ("time", "water_wall_energy", "water_work"))
    ends = about + 0.5 * PERIOD * np.array([-1.0, 1.0])
    had, has = (np.interp(ends, time, course[:, 0], right=np.nan) for course in (held, work))
    return float(-(had[1] - had[0]) / (has[1] - has[0]))


def cycle(time: np.ndarray, energy: np.ndarray, work: np.ndarray, about: float) -> dict[str, float]:
    """What walls have `given` the water and what it has `lost` in the roll's period about an impact, and `stored` since
    the start at its end (J), of the courses (T,) of its energy and of the walls' work."""
    ends = about + 0.5 * PERIOD * np.array([-1.0, 1.0])
    (before, after), (had, has) = np.interp(ends, time, energy), np.interp(ends, time, work)
    return {"given": has - had, "lost": has - had - (after - before), "stored": float(after - energy[0])}


def shallow(tank: tuple[float, float, float], history: History) -> tuple[ShallowTank, Roll]:
    """Shallow water in a tank by its width (m), depth (m) and gravity (m/s²), which rolls about its floor; its roll."""
    width, depth, gravity = tank
    water = ShallowTank(width, depth, -history.centre[1], gravity, CELLS)
    return water, history.motions["roll"].curve


@cache  # takes seconds
def shallow_pressure(tank: tuple[float, float, float, float], history: History, duration: float) -> np.ndarray:
    """Times (s) and pressures over the density (m²/s²) of shallow water in the wall to the left, (2, T).

    Of a tank as `shallow` has it, and the gauge's height (m).
    """
    water, roll = shallow(tank[:3], history)
    return water.followed(roll, duration, lambda now, state: water.wall_pressure(now, state, tank[3]))


@cache
def shallow_energy(tank: tuple[float, float, float], history: History, duration: float) -> np.ndarray:
    """Times (s), energies and the work of walls so far (m⁴/s²) of shallow water, (3, T), in a tank of `shallow`."""
    water, roll = shallow(tank, history)
    both = lambda now, state: np.array([water.energy(now, state), -now[1] * water.moment(now, state)])  # noqa: E731
    time, energy, power = water.followed(roll, duration, both)
    return np.array([time, energy, cumulative_trapezoid(power, time, initial=0.0)])


NUMBERS = {
    "impact_arrival": ("s", _part("arrival")),
    "impact_peak": ("kPa", _part("peak", 1e-3)),
    "impact_mean": ("kPa", _part("mean", 1e-3)),
    "impact_impulse": ("Pa s", _part("impulse")),
    "impulse_over_shallow": ("1", impulse_over_shallow),
    **{f"{name}_over_shallow": ("1", over_shallow(name)) for name in ("given", "lost", "stored")},
    "made_at_walls": ("1", made_at_walls),
}


def repeats(found: Found) -> ReportSection:
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
    return ReportSection(rows, None, [heads, *cells])


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
