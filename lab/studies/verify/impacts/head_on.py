"""Head-on elastic impacts of two spheres, and of a sphere on a rigid plane: tests 1 and 2 of Chung and Ooi (2011)."""

from functools import cache
from math import pi

import numpy as np
from matplotlib.figure import Figure

from lab.preset.accuracy import LEVELS
from lab.report.plots import BLUE, GREY, VERMILION, canvas
from lab.studies.case import Found, Line, Picture
from lab.studies.verify.impacts.meetings import Meetings, Substance
from solvers.grains.laws.hertz import ELASTIC_STEPS

LENGTHS = (1.0, LEVELS["draft"].longer_steps)  # lengths of step in derived steps
DERIVED, DRAFT = range(2)
GLASS = Substance("glass", 48e9, 0.20, 2800.0)
LIMESTONE = Substance("limestone", 20e9, 0.25, 2500.0)
ALUMINIUM_2 = Substance("aluminium", 70e9, 0.30, 2699.0)
MAGNESIUM = Substance("magnesium", 40e9, 0.35, 1800.0)


@cache
def normal_impacts() -> dict[str, Meetings]:
    """Tests 1 and 2."""
    two = {f"test 1, {s.name}": Meetings(s, 0.01, 20.0, 0.35, mate="twin") for s in (GLASS, LIMESTONE)}
    return two | {f"test 2, {s.name}": Meetings(s, 0.1, 0.2, 0.35) for s in (ALUMINIUM_2, MAGNESIUM)}


# What the paper prints of tests 1 and 2: largest overlap (µm), largest force (kN), duration (µs).
PRINTED = {
    "test 1, glass": (274.1, 10.697, 40.34),
    "test 1, limestone": (368.3, 7.108, 54.20),
    "test 2, aluminium": (49.72, 11.370, 731.6),
    "test 2, magnesium": (52.12, 7.233, 767.0),
}


@cache
def pressed(name: str, fast: bool) -> list[tuple[np.ndarray, ...]]:
    """Times, overlaps and forces of a curve of tests 1 and 2, for each length."""
    return normal_impacts()[name].forces(LENGTHS[:1] if fast else LENGTHS)


def normal(fast: bool) -> Found:
    """Tests 1 and 2: the force over the time of an elastic impact, its depth and its duration."""
    lines = []
    for name in normal_impacts():
        for length, (_, depth, force, deep, hertz) in enumerate(pressed(name, fast)):
            where = ("derived step", f"{LENGTHS[length]:g} Δt, draft")[length]
            allowed, reason = late(LENGTHS[length]), f"Verlet's (ω Δt)²/24, {ELASTIC_STEPS / LENGTHS[length]:.3g} steps"
            source = "DOP853 at 1e-11 of Hertz's law"
            for quantity, here, there in (("force", force, hertz), ("overlap", depth, deep)):
                worst = np.abs(here - there).max() / there.max()
                what = f"{name}: {quantity} at any time, of its largest, {where}"
                lines.append(Line.off(what, source, worst, allowed, reason))
        lines += peak_lines(name, fast)
    caption = "Tests 1 and 2: force over time at the derived step (dots) and draft's (crosses), and Hertz's"
    return Found(lines, [Picture("chung-ooi-1-2", force_figure(fast), caption)])


def late(length: float) -> float:
    """By how much of the largest overlap Verlet's curve of half a period ends early, at so many derived steps.

    Its oscillation is too fast by a share (ω Δt)²/24 (Hairer, Lubich and Wanner 2006, IX). With N steps to half a
    period ω Δt = π/N, and the curve is shifted by π (π/N)²/24 of 1/ω at its end, where it is steepest.
    """
    return pi / 24.0 * (pi * length / ELASTIC_STEPS) ** 2


def peak_lines(name: str, fast: bool) -> list[Line]:
    """Depth, force and duration at the derived step beside Hertz's closed form and what the paper prints."""
    time, depth, force, _, _ = pressed(name, fast)[DERIVED]
    closed = normal_impacts()[name].elastic()
    leaving = (depth[-2] - depth[-1]) / (time[-1] - time[-2])
    found = (
        ("largest overlap", 1e6 * peak(depth), 1e6 * closed.deepest, "µm"),
        ("largest force", 1e-3 * peak(force), 1e-3 * closed.force, "kN"),
        ("duration", 1e6 * (time[-1] + depth[-1] / leaving), 1e6 * closed.duration, "µs"),
    )
    lines, reason = [], f"scheme O(Δt²), {ELASTIC_STEPS:g} steps a collision"
    for (quantity, value, reference, unit), printed in zip(found, PRINTED[name], strict=True):
        quantity = f"{name}: {quantity}"
        lines.append(Line(quantity, value, reference, "closed form (Hertz 1882)", 1.5e-3, reason, unit))
        lines.append(Line(quantity, value, printed, "the paper", 1.7e-3, f"{reason}; digits printed", unit))
    return lines


def peak(values: np.ndarray) -> float:
    """Largest value of a curve (T,), by the parabola through its three highest points."""
    k = int(np.clip(values.argmax(), 1, len(values) - 2))
    before, middle, after = values[k - 1 : k + 2]
    return middle + (after - before) ** 2 / (8.0 * (2.0 * middle - before - after))


def force_figure(fast: bool) -> Figure:
    """Forces over time at both lengths of step, and Hertz's."""
    figure, panels = canvas((6.4, 4.4), 2, 2)
    for axes, (name, curve) in zip(panels.flat, normal_impacts().items(), strict=True):
        c = curve.elastic()
        curves = pressed(name, fast)
        axes.plot(curves[0][0] / c.duration, curves[0][4] / c.force, color=GREY, lw=1.0)
        for (time, _, force, _, _), colour, mark in zip(curves, (BLUE, VERMILION), (".", "x"), strict=False):
            axes.plot(time / c.duration, force / c.force, mark, color=colour, ms=4)
        axes.set_title(name)
    return figure
