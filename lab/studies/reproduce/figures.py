"""Figures of reports: shift of the centre of mass against tilt, a measure against a key of the grid, and others."""

from collections.abc import Callable

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from lab.measures import critical_angle
from lab.measures.motion import is_tilt
from lab.report.numbers import BARS
from lab.report.plots import BELOW, BLUE, GREY
from lab.studies.reproduce.experiment import Found
from lab.studies.reproduce.runs import Outcome

SIZE = (6.4, 3.4)
POINTS = 800
DROP, THEN = 0.05, 9.81  # s, when the floor of the stack begins to fall; m/s²
SECONDS = 2.0  # length of a swayed bed's course


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
    axes.set_xlabel("tilt (deg)")
    axes.set_ylabel(f"shift of the centre of mass\ndownhill (mean diameters),\n{BARS}")
    figure.legend(loc=BELOW, ncols=3)
    return figure


def against(
    found: Found, key: str, label: str, of: str, quantity: str, line: str = "", above: float = -np.inf
) -> Figure:
    """A measure against the number in a key of the grid, a curve a run, ± standard deviation.

    line: the run that is a level line; above: points up to this number are left out.
    """
    families = {name: outcomes for name, outcomes in found.items() if name != line}
    figure, axes, colours = _begin(len(families))
    for (name, outcomes), colour in zip(families.items(), colours, strict=True):
        measured = [(leading_number(one.setting[key]), one[of]) for one in outcomes]
        points = [(x, value) for x, value in measured if x > above and value and value.value is not None]
        x, values = zip(*points, strict=True) if points else ((), ())
        means, beds = [value.value for value in values], max((value.n for value in values), default=0)
        spread = [value.std or 0.0 for value in values]
        axes.errorbar(x, means, spread, fmt="o-", ms=3.5, capsize=2, color=colour, label=_named(name, beds))
    axes.set_xlabel(label)
    axes.set_ylabel(f"{quantity}\n{BARS}")
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


def stack(found: Found) -> Figure:
    """The centre of mass of the falling stack beside free fall."""
    series = found["stack"][0].recording.series
    time, middle = series["time"], 1e3 * series["centre_of_mass"][:, 0, 1]
    figure = Figure(figsize=(6.4, 3.2), layout="constrained")
    axes = figure.add_subplot()
    axes.plot(time, middle - middle[0], color=BLUE, label="centre of mass of the stack")
    fallen = time > DROP
    axes.plot(time[fallen], -500.0 * THEN * (time[fallen] - DROP) ** 2, color=GREY, ls=":", label="free fall")
    axes.set_xlabel("time (s)")
    axes.set_ylabel("altitude, change (mm)")
    axes.legend()
    return figure


def heaps(found: Found, box: str) -> Figure:
    """Angles of heaps at rest and of the box at the slide, ± standard deviation."""
    figure = Figure(figsize=(6.4, 2.6), layout="constrained")
    axes = figure.add_subplot()
    angles = {says: runs[0]["critical_angle" if says == box else "heap_angle"] for says, runs in found.items()}
    known = {says: value for says, value in angles.items() if value and value.value is not None}
    for row, value in enumerate(known.values()):
        axes.errorbar(value.value, row, xerr=value.std or 0.0, fmt="o", ms=4, capsize=2.5, color=BLUE)
    axes.axvline(21.0, color=GREY, ls=":")
    axes.annotate("source, 25 mm/s", (21.1, 0.6), fontsize=7, color=GREY)
    axes.set_yticks(range(len(known)), [f"{says} (n = {value.n})" for says, value in known.items()])
    axes.invert_yaxis()
    axes.set_xlabel(f"heap at rest, box at the slide (deg), {BARS}")
    return figure


def descriptors(found: Found) -> Figure:
    """Critical angles over that of discs against the descriptor."""
    figure = Figure(figsize=(6.4, 3.4), layout="constrained")
    axes = figure.add_subplot()
    discs = found["discs"][0]["critical_angle"]
    for name, outcomes in found.items():
        points = [(next(iter(one.setting.values()))[-1], one["critical_angle"]) for one in outcomes if one.setting]
        known = [(x, v.value / discs.value, (v.std or 0.0) / discs.value) for x, v in points if v and v.value]
        if known:
            axes.errorbar(*zip(*known, strict=True), fmt="o-", ms=3.5, capsize=2, label=name)
    axes.axhline(1.0, color=GREY, ls=":", lw=1.0)
    axes.set_xlabel("descriptor relative to R0")
    axes.set_ylabel(f"critical angle over that of discs\n{BARS}")
    axes.legend()
    return figure


def courses(found: Found, motion: str, early: float, cost: bool = True) -> Figure:
    """Courses of discs, smooth outlines and nodes, compared until `early`, and the cost of a grain and step.

    motion: "tilt" (deg) or "sway" (s), which the centre of mass is drawn over.
    """
    figure = Figure(figsize=(7.2, 3.4) if cost else SIZE, layout="constrained")
    axes = figure.subplots(1, 1 + cost, squeeze=False)[0]
    of, labels = COURSES[motion]
    _draw_courses(axes[0], found, of, early, labels)
    if cost:
        axes[1].plot([_nodes(one) for one in found["nodes"]], [_time(one) for one in found["nodes"]], "o-", ms=3.5)
        for name, style in (("discs", ":"), ("smooth", "--")):
            axes[1].axhline(_time(found[name][0]), color=GREY, ls=style, lw=1.0, label=name)
        axes[1].set(xlabel="nodes", ylabel="time per grain and step, compiling\nand output included (µs)")
        axes[1].set_ylim(bottom=0.0)
        axes[1].legend()
    return figure


def _draw_courses(axes: Axes, found: Found, of: Callable, early: float, labels: tuple[str, str]) -> None:
    """Courses (x, y in m) of discs, smooth outlines, and few, more and many nodes."""
    by_nodes = {_nodes(one): one for one in found["nodes"]}
    nodes = {f"{n} nodes": by_nodes[n] for n in (36, 120, 500) if n in by_nodes}
    for name, one in {"discs": found["discs"][0], "smooth outlines": found["smooth"][0], **nodes}.items():
        x, y = of(one)
        axes.plot(x, 1e3 * y, label=name, lw=1.2)
    axes.axvline(early, color=GREY, ls=":", lw=1.0)
    axes.set(xlabel=labels[0], ylabel=labels[1])
    axes.legend()


def _tilted(one: Outcome) -> tuple[np.ndarray, np.ndarray]:
    """Tilt (deg) and how far the centre of mass of the first bed has gone downhill (m)."""
    return critical_angle.shift_curve(one.recording, 0)


def _swayed(one: Outcome) -> tuple[np.ndarray, np.ndarray]:
    """Time (s) and how far the centre of mass of the first bed is across the tank (m), at the beginning."""
    time, y = one.recording.series["time"], one.recording.series["centre_of_mass"][:, 0, 0]
    begun = time <= SECONDS
    return time[begun], y[begun] - y[0]


COURSES = {
    "tilt": (_tilted, ("tilt (deg)", "shift downhill of one bed (mm)")),
    "sway": (_swayed, ("time (s)", "centre of mass of one bed (mm)")),
}


def _nodes(one: Outcome) -> int:
    return one.setting["contact.nodes"]


def _time(one: Outcome) -> float:
    return 1e6 * one.cost["wall_s"] / one.cost["grain_steps"]
