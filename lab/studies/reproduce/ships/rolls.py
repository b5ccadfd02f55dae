"""The roll of ships with loose and frozen cargo, drawn as figures 7.6 to 7.19 of Spandonidis (2016), and told."""

from collections.abc import Collection, Sequence

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from lab.measures.value import Value, over_worlds
from lab.report.numbers import BARS
from lab.report.plots import BELOW, canvas
from lab.studies.reproduce.estimates import Verdict, mean, together
from lab.studies.reproduce.experiment import ANY, Found, Kind, Row, Tolerance, alone, counted, observed, stated
from lab.studies.reproduce.figures import leading_number
from lab.studies.reproduce.runs import Outcome

FREQUENCY, AMPLITUDE = "waves.frequency", "waves.amplitude"
DIGITS = Tolerance(1.0, "the source's 'approximately', to whole degrees")
STEP = Tolerance(0.3, "the step of our frequencies")
LARGE = 30.0  # deg: not reached with loose cargo in the source
PEAK = 36.0, 4.4  # deg, rad/s: of frozen cargo in the source, in waves of 10 mm
SIZE = (6.4, 5.2)
# Of loose and of frozen cargo: mean amplitude, absolute maximum, when she capsized; and how they are drawn
LOOSE = ("roll_amplitude", "largest_roll", "capsized_at")
FROZEN = ("frozen_amplitude", "frozen_largest_roll", "frozen_capsized_at")
STYLES = {LOOSE: {"fmt": "o-"}, FROZEN: {"fmt": "s--", "mfc": "white"}}
CROSSES = {LOOSE: {"marker": "X"}, FROZEN: {"marker": "X", "mfc": "white"}}
PANELS = "amplitude of the roll\n(deg), " + BARS, "largest roll of the run\n(deg), " + BARS
TOP, APART = 0.96, 0.06  # of a panel's height: where the first crosses are, and the next family's below


def rolls_figure(found: Found, key: str, label: str, frozen: Collection[str]) -> Figure:
    """Mean amplitude and absolute maximum of the roll against the number in a key of the grid, ± standard deviation.

    Curves of every run with loose cargo, and of those named in `frozen` with frozen cargo. Ships that capsized are
    crosses at the top and in no curve.
    """
    figure, panels = canvas(SIZE, 2, sharex=True)
    colours = colormaps["viridis"](np.linspace(0.0, 0.75, len(found)))
    kinds = {LOOSE: ("loose", found), FROZEN: ("frozen", frozen)}
    drawn = [
        (names, f"{name}, {word}", name) for names, (word, chosen) in kinds.items() for name in found if name in chosen
    ]
    hue = dict(zip(found, colours, strict=True))
    for level, (names, legend, family) in enumerate(drawn):
        outcomes = found[family]
        at = [leading_number(one.setting[key]) for one in outcomes]
        for axes, measure in zip(panels, names[:2], strict=True):
            _curve(axes, at, [_upright(one, measure, names[2]) for one in outcomes], hue[family], legend, STYLES[names])
            lost = [x for x, one in zip(at, outcomes, strict=True) if _capsized(one, names[2])]
            height = np.full(len(lost), TOP - APART * level)
            axes.plot(lost, height, ls="", color=hue[family], transform=axes.get_xaxis_transform(), **CROSSES[names])
    for axes, quantity in zip(panels, PANELS, strict=True):
        axes.set_ylabel(quantity)
        axes.set_ylim(0.0, axes.get_ylim()[1] / (TOP - APART * len(drawn)))  # room for the crosses
    panels[1].set_xlabel(label)
    handles, _ = panels[0].get_legend_handles_labels()
    handles += [Line2D([], [], ls="", color="black", label=f"capsized, {kinds[k][0]}", **CROSSES[k]) for k in kinds]
    figure.legend(handles=handles, loc=BELOW, ncols=3)
    return figure


def _curve(axes: Axes, at: Sequence[float], values: Sequence[Value | None], colour, label: str, style: dict) -> None:
    """Draw a curve, with a gap at each missing value."""
    middle = [np.nan if value is None or value.value is None else value.value for value in values]
    spread = [0.0 if value is None or value.std is None else value.std for value in values]
    axes.errorbar(at, middle, spread, ms=4, capsize=2, lw=1.2, color=colour, label=label, **style)


def _upright(one: Outcome, measure: str, capsized: str) -> Value | None:
    """A measure over the worlds that did not capsize."""
    value, when = one[measure], one[capsized]
    if value is None or when is None:
        return value
    kept = [np.nan if x is None or t is not None else x for x, t in zip(value.worlds, when.worlds, strict=True)]
    return over_worlds(kept, value.unit)


def _capsized(one: Outcome, capsized: str) -> bool:
    """Whether any of the run's worlds did."""
    return one[capsized] is not None and one[capsized].value is not None


def largest_rolls(found: Found) -> list[Row]:
    """The largest rolls over the frequencies, with frozen and with loose cargo."""
    runs, rows = found["10 mm"], []
    frozen, loose = (_largest(runs, name) for name in ("frozen_amplitude", "roll_amplitude"))
    if frozen:
        value, at = frozen
        rows.append(stated("largest with frozen cargo", PEAK[0], value, DIGITS, exact=True))
        there = Value(at, "rad/s", worlds=(at,))
        rows.append(stated("largest with frozen cargo: frequency", PEAK[1], there, STEP, exact=True))
    quantity, source = "largest with loose cargo", "less than 30 deg, and less than frozen"
    if not (loose and frozen):
        return [*rows, observed(quantity, source, "not found", Verdict.CANNOT_TELL, ANY).against(Kind.SIGN)]
    rolls = mean(loose[0])
    verdict = together([rolls.lies(-np.inf, LARGE), rolls.lies(-np.inf, frozen[0].value)])
    said = f"{counted(loose[0])} at {loose[1]:g} rad/s"
    return [*rows, observed(quantity, source, said, verdict, ANY).against(Kind.SIGN)]


def _largest(runs: Sequence[Outcome], name: str) -> tuple[Value, float] | None:
    """The largest value of a measure, and at which frequency."""
    known = [(one[name], leading_number(one.setting[FREQUENCY])) for one in runs if mean(one[name]) is not None]
    return max(known, key=lambda pair: pair[0].value, default=None)


def end(one: Outcome) -> str:
    """How a ship's run ended, with loose cargo and frozen."""
    return f"{_fate(one, LOOSE)}; frozen {_fate(one, FROZEN)}"


def _fate(one: Outcome, names: tuple[str, str, str]) -> str:
    steady, when = one[names[0]], one[names[2]]
    said = alone if names is FROZEN else counted
    if when and when.value is not None:
        return f"capsizes at {said(when)}"
    return f"rolls {said(steady)}" if steady and steady.value is not None else "not steady"
