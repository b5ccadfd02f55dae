"""The prismatic tank with chamfers of other sizes: natural frequencies by linear theory, and what changes at P1 to P3.

Runs are named by their filling, motion and chamfer, "50 %, roll, 40 mm". Chamfers of USUAL are the presets'.
"""

from collections.abc import Iterator, Sequence

import numpy as np
from matplotlib.figure import Figure

from lab.measures.value import Value
from lab.preset.sections.water.liquid import depth
from lab.report.numbers import with_error
from lab.report.plots import BELOW, BLUE, GREEN, VERMILION, canvas
from lab.studies.reproduce.experiment import Found, Row, observed
from lab.studies.reproduce.figures import SIZE
from lab.studies.reproduce.runs import Outcome
from lab.studies.reproduce.water.prismatic import DRY, peak_at

USUAL = "50 mm"
GAUGES = (1, 2, 3)
COLOURS = (GREEN, BLUE, VERMILION)
HOW = "standard error of nine cycles each, taken as independent"


def first_mode(one: Outcome) -> float:
    """The first natural frequency (Hz) of the run's tank and depth by linear theory, with finite elements."""
    from lab.studies.verify.water.laplace import first_mode as solved  # slow to load

    preset = one.recording.preset
    return solved(np.array(preset.tank.corners), depth(preset)).rate / (2.0 * np.pi)


NUMBERS = {"first_mode": ("Hz", lambda one, _: first_mode(one))}


def rows(found: Found) -> list[Row]:
    """By how much mean peaks with other chamfers differ from those with USUAL ones, told beside their errors."""
    told = []
    for motion, chamfers in _groups(found):
        for size, outcomes in chamfers.items():
            if USUAL in chamfers and size != USUAL:
                changes = [_change(outcomes, chamfers[USUAL], gauge) for gauge in GAUGES]
                said = f"mean peaks at P1, P2, P3, {motion}, chamfers of {size} less {USUAL}"
                told.append(observed(said, "not stated", "; ".join(changes), None, HOW))
    return told


def figure(found: Found) -> Figure:
    """Mean peaks at each gauge by the size of the chamfers, with their standard errors."""
    drawn, panels = canvas((SIZE[0], 2.8), 1, len(GAUGES))
    for gauge, axes in zip(GAUGES, panels, strict=True):
        for (motion, chamfers), colour in zip(_groups(found), COLOURS, strict=False):
            peaks = {size: peak_at(outcomes, gauge) for size, outcomes in chamfers.items()}
            wet = sorted((float(size.split()[0]), one) for size, one in peaks.items() if one.value is not None)
            if wet:
                size, value, error = zip(*((at, one.value, one.uncertainty) for at, one in wet), strict=True)
                axes.errorbar(size, value, error, marker="o", ms=4, lw=1.0, capsize=3, color=colour, label=motion)
        axes.set(title=f"P{gauge}", xlabel="chamfers (mm)", xlim=(36, 64), xticks=(40, 50, 60))
        axes.set_ylim(bottom=0.0)
    panels[0].set_ylabel("mean peak (Pa)")
    drawn.legend(*panels[0].get_legend_handles_labels(), loc=BELOW, ncols=len(COLOURS))
    return drawn


def _groups(found: Found) -> Iterator[tuple[str, dict[str, Sequence[Outcome]]]]:
    """Runs of each filling and motion by the size of their chamfers."""
    groups: dict[str, dict[str, Sequence[Outcome]]] = {}
    for label, outcomes in found.items():
        motion, size = label.rsplit(", ", 1)
        groups.setdefault(motion, {})[size] = outcomes
    yield from groups.items()


def _change(one: Sequence[Outcome], usual: Sequence[Outcome], gauge: int) -> str:
    """The difference at a gauge in words."""
    own, other = peak_at(one, gauge), peak_at(usual, gauge)
    if own.value is None and other.value is None:
        return DRY
    if own.value is None or other.value is None:
        return f"{_words(own)} for {_words(other)}"
    return with_error(own.value - other.value, float(np.hypot(own.uncertainty, other.uncertainty)), "Pa", "+")


def _words(value: Value) -> str:
    return DRY if value.value is None else f"{value.value:.0f} Pa"
