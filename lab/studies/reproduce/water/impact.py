"""Impacts of water on the wall of a rolled tank beside SPHERIC's benchmark 10.

Botia-Vera, Souto-Iglesias & Bulian (2011), ISOPE: sensor 1, at the still level of the side wall. An arrival is the
first time at which the pressure exceeds 1 kPa, an impulse the integral from 30 ms before the highest pressure to 200 ms
after it. Peaks of single runs scatter by a fifth, and in a liquid without air they are hits of a few particles whose
pressure is ρ c U and lasts a millisecond. So means over 10 ms are compared, too.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure

from lab.report.plots import BELOW, BLUE, GREY, VERMILION, canvas
from lab.studies.reproduce.estimates import Estimate
from lab.studies.reproduce.experiment import Found, Row, Told, held
from lab.studies.reproduce.figures import SIZE
from lab.studies.reproduce.runs import Outcome
from lab.studies.reproduce.water.costs import beside
from lab.studies.reproduce.water.measured import drawn

ABOVE = 1000.0  # Pa: the wave is there
BEFORE, AFTER = 0.030, 0.200  # s, of an impulse about its peak
AVERAGE = 0.010  # s
EARLIER, LATER = 0.3, 0.4  # s, of an impact about its measured arrival
MEASURED = "spheric10_lateral_water/pressure_sensor1.csv"
DRAWN = -0.05, 0.25  # s about the arrival


@dataclass(frozen=True)
class Impact:
    """An impact: arrival s, peak Pa, largest mean over 10 ms Pa, impulse Pa s."""

    arrival: float
    peak: float
    mean: float
    impulse: float


EXPERIMENT = Impact(2.3738, 3683.0, 2213.0, 179.0), Impact(4.0470, 3890.0, 3017.0, 187.0)  # of the one record
WORDS = {
    "arrival": (
        "20 ms: what a sound computation of this size is expected to give",
        "s",
        lambda x: (x - 0.02, x + 0.02),
    ),
    "impulse": (
        "10 %: what a sound computation of this size is expected to give",
        "Pa s",
        lambda x: (0.9 * x, 1.1 * x),
    ),
    "peak": ("3.7 ± 1.5 kPa: twice the scatter of a hundred repeats", "Pa", lambda _: (2200.0, 5200.0)),
    "mean": ("40 %: twice the scatter of the peaks, read off for lack of its own", "Pa", lambda x: (0.6 * x, 1.4 * x)),
}
NAMES = {"arrival": "arrives at", "impulse": "impulse", "peak": "peak", "mean": "largest mean over 10 ms"}


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


def tell(found: Found) -> Told:
    """Both impacts beside the measured ones."""
    names = ("arrival", "peak", "10 ms mean", "impulse")
    return beside(found, [f"{order} {name}" for order in ("first", "second") for name in names], _cells, _rows, _figure)


def impacts(one: Outcome) -> list[Impact | None]:
    """The two impacts at the first gauge."""
    series = one.recording.series
    pressure, highest = (series[name][:, 0, 0] for name in ("gauge_pressure", "gauge_peak"))
    return [find_impact(series["time"], pressure, highest, each.arrival) for each in EXPERIMENT]


def _rows(label: str, outcome: Outcome) -> list[Row]:
    rows = []
    for order, measured, one in zip(("first", "second"), EXPERIMENT, impacts(outcome), strict=True):
        for name, (tolerance, unit, allowed) in WORDS.items():
            stated = getattr(measured, name)
            estimate = Estimate.exact(getattr(one, name)) if one else None
            said = f"{order} impact {NAMES[name]}, {label}"
            rows.append(held(said, f"{stated:.4g} {unit}", estimate, allowed(stated), tolerance, unit))
    return rows


def _cells(one: Outcome) -> Iterator[str]:
    for each in impacts(one):
        if each is None:
            yield from ["none"] * 4
        else:
            kilo = f"{1e-3 * each.peak:.2f} kPa", f"{1e-3 * each.mean:.2f} kPa"
            yield from (f"{each.arrival:.3f} s", *kilo, f"{each.impulse:.0f} Pa s")


def _figure(runs: dict[str, Outcome]) -> Figure:
    """The pressure about both impacts, cut off where short hits are."""
    figure, panels = canvas((SIZE[0], 3.6), 1, 2, sharey=True)
    measured = drawn(panels[0], MEASURED)
    for axes, each in zip(panels, EXPERIMENT, strict=True):
        axes.axhspan(2.2, 5.2, color=GREY, alpha=0.15, lw=0, label="peaks of a hundred repeats, ± 2 std")
        for (label, one), colour in zip(runs.items(), (BLUE, VERMILION, "0.6"), strict=False):
            series = one.recording.series
            axes.plot(series["time"], 1e-3 * series["gauge_pressure"][:, 0, 0], color=colour, lw=0.9, label=label)
        if measured is not None:
            axes.plot(measured[0], 1e-3 * measured[1], color="black", lw=0.9, label="measured")
        axes.set(xlim=(each.arrival + DRAWN[0], each.arrival + DRAWN[1]), ylim=(-0.3, 6.0), xlabel="time (s)")
    panels[0].set_ylabel("pressure at sensor 1 (kPa)")
    figure.legend(*panels[0].get_legend_handles_labels(), loc=BELOW, ncols=3)
    return figure
