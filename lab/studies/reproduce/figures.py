"""Figures of any report: shift of the centre of mass against tilt, a measure against a key of the grid."""

import numpy as np
from matplotlib import colormaps
from matplotlib.figure import Figure

from lab.measures import critical_angle
from lab.measures.motion import is_tilt
from lab.report.numbers import BARS
from lab.report.plots import BELOW
from lab.studies.reproduce.experiment import Found

SIZE = (6.4, 3.4)
POINTS = 800


def shift(found: Found, points: str = "") -> Figure | None:
    """Mean shift downhill (mean diameters) of all beds, ± their standard deviation, a curve a run.

    points: name of a curve for each point of a grid, "{}" its value.
    """
    labelled = {
        points.format(*one.setting.values()) if points else name: one
        for name, outcomes in found.items()
        for one in (outcomes if points else outcomes[:1])
    }
    drawn = {label: outcome for label, outcome in labelled.items() if is_tilt(outcome.recording)}
    if not drawn:
        return None
    figure, axes, colours = _begin(len(drawn))
    for (label, outcome), colour in zip(drawn.items(), colours, strict=True):
        recording = outcome.recording
        curves = [critical_angle.shift_curve(recording, world) for world in range(recording.worlds)]
        common = np.linspace(0.0, min(tilt[-1] for tilt, _ in curves), POINTS)
        shifts = np.stack(
            [np.interp(common, tilt, s) / d for (tilt, s), d in zip(curves, recording.mean_diameter, strict=True)]
        )
        _band(axes, common, shifts, colour, label)
    axes.set(xlabel="tilt (deg)", ylabel=f"shift of the centre of mass\ndownhill (mean diameters),\n{BARS}")
    figure.legend(loc=BELOW, ncols=3)
    return figure


def against(
    found: Found, key: str, label: str, of: str, quantity: str, line: str = "", above: float = -np.inf
) -> Figure:
    """A measure against the number in a key of the grid, a curve a run, ± standard deviation.

    line: the run that is a level line; above: points up to this number are left out. Runs whose grid has no such key
    are left out.
    """
    has = {name: all(key in one.setting for one in outcomes) for name, outcomes in found.items()}
    families = {name: outcomes for name, outcomes in found.items() if name != line and has[name]}
    figure, axes, colours = _begin(len(families))
    for (name, outcomes), colour in zip(families.items(), colours, strict=True):
        measured = [(leading_number(one.setting[key]), one[of]) for one in outcomes]
        points = [(x, value) for x, value in measured if x > above and value and value.value is not None]
        x, values = zip(*points, strict=True) if points else ((), ())
        means, beds = [value.value for value in values], max((value.n for value in values), default=0)
        spread = [value.std or 0.0 for value in values]
        axes.errorbar(x, means, spread, fmt="o-", ms=3.5, capsize=2, color=colour, label=_named(name, beds))
    axes.set(xlabel=label, ylabel=f"{quantity}\n{BARS}")
    figure.legend(loc=BELOW, ncols=3)
    if line and (level := found[line][0][of]) and level.value is not None:
        axes.axhline(level.value, color="0.5", ls=":", lw=1.0, label=line)
    return figure


def leading_number(said: object) -> float:
    """The number at the beginning of a value with a unit."""
    return float(str(said).split()[0])


def _begin(count: int) -> tuple[Figure, object, np.ndarray]:
    figure = Figure(figsize=SIZE, layout="constrained")
    return figure, figure.add_subplot(), colormaps["viridis"](np.linspace(0.0, 0.85, count))


def _named(label: str, beds: int) -> str:
    return f"{label} ({beds} beds)" if beds > 1 else label


def _band(axes, x: np.ndarray, rows: np.ndarray, colour, label: str) -> None:
    mean = rows.mean(axis=0)
    axes.plot(x, mean, color=colour, label=_named(label, len(rows)))
    if len(rows) > 1:
        std = rows.std(axis=0, ddof=1)
        axes.fill_between(x, mean - std, mean + std, color=colour, alpha=0.15, lw=0)
