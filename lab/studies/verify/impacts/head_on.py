"""Head-on elastic impacts of two spheres, and of a sphere on a rigid plane: tests 1 and 2 of Chung and Ooi (2011)."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np
from matplotlib.figure import Figure
from scipy.integrate import solve_ivp

from lab.preset.accuracy import LEVELS
from lab.report.plots import BLUE, GREY, VERMILION, canvas
from lab.studies.case import Found, Line, Picture
from lab.studies.verify.impacts.meetings import Meetings, Substance

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
ONSETS = 100  # moments of a step at which contact begins
ROUNDING = 1.05  # of what the scheme errs by: between these moments, and the solver's own onset within a step
PRINTED = {
    "test 1, glass": ("274.1", "10.697", "40.34"),
    "test 1, limestone": ("368.3", "7.108", "54.20"),
    "test 2, aluminium": ("49.72", "11.370", "731.6"),
    "test 2, magnesium": ("52.12", "7.233", "767.0"),
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
            scheme = erred(normal_impacts()[name], LENGTHS[length])
            reason, source = f"Verlet's scheme on this law, {scheme.steps:.3g} steps", "DOP853 at 1e-11 of Hertz's law"
            for quantity, here, there, allowed in (
                ("force", force, hertz, scheme.force),
                ("overlap", depth, deep, scheme.overlap),
            ):
                worst = np.abs(here - there).max() / there.max()
                what = f"{name}: {quantity} at any time, of its largest, {where}"
                lines.append(Line.off(what, source, worst, allowed, reason))
        lines += peak_lines(name, fast)
    caption = "Tests 1 and 2: force over time at the derived step (dots) and draft's (crosses), and Hertz's"
    return Found(lines, [Picture("chung-ooi-1-2", force_figure(fast), caption)])


@dataclass(frozen=True)
class Scheme:
    """What Verlet's scheme errs by on Hertz's law at so many steps of a collision, wherever in a step it begins.

    In shares of the largest: force and overlap at any time; their peaks and the duration, as `peak_lines` reads them.
    """

    steps: float
    force: float
    overlap: float
    peak_force: float
    peak_overlap: float
    duration: float

    @property
    def any(self) -> float:
        """Of force and overlap the larger."""
        return max(self.force, self.overlap)


def erred(curve: Meetings, longer: float = 1.0) -> Scheme:
    """The scheme alone at the curve's derived step times `longer`: no part of the solver is in it.

    In units of the deepest overlap and its time ξ¨ = −ξ^(3/2), and the speed at touch is √0.8.
    """
    hertz, speed = curve.elastic(), np.sqrt(0.8)
    steps = hertz.duration / (longer * float(curve.steps()[0]))
    exact, lasts = _exact()
    step = lasts / steps
    begun = np.arange(ONSETS) / ONSETS * step  # of the last place before touch, earlier than it
    places = [-speed * (begun + step), -speed * begun]
    for _ in range(int(1.3 * steps) + 3):
        pushed = np.maximum(places[-1], 0.0) ** 1.5
        places.append(2.0 * places[-1] - places[-2] - step**2 * pushed)
    time, overlap = step * np.arange(-1, len(places) - 1)[:, None] - begun, np.array(places)
    wanted, inside = exact(time), (time > 0.0) & (time < 1.3 * lasts)
    force, right = (np.maximum(one, 0.0) ** 1.5 for one in (overlap, wanted))
    left = np.array([_left(time[:, k], overlap[:, k]) for k in range(ONSETS)])
    found = (
        np.abs(force - right)[inside].max(),
        np.abs(overlap - wanted)[inside].max(),
        max(abs(peak(one) - 1.0) for one in force.T),
        max(abs(peak(one) - 1.0) for one in overlap.T),
        np.abs(left / lasts - 1.0).max(),
    )
    return Scheme(steps, *(ROUNDING * float(one) for one in found))


def _left(time: np.ndarray, overlap: np.ndarray) -> float:
    """When the contact ends, by a straight line from the last place within it."""
    last = int(np.flatnonzero(overlap > 0.0)[-1])
    return float(np.interp(0.0, [-overlap[last], -overlap[last + 1]], time[last : last + 2]))


@cache
def _exact() -> tuple[Callable[[np.ndarray], np.ndarray], float]:
    """Overlap over time of ξ¨ = −ξ^(3/2) from √0.8 on, straight before and after, and when it ends; by DOP853."""
    ends = lambda _, state: state[0]  # noqa: E731
    ends.terminal, ends.direction = True, -1.0
    motion = lambda _, state: [state[1], -(max(state[0], 0.0) ** 1.5)]  # noqa: E731
    speed = np.sqrt(0.8)
    path = solve_ivp(motion, (0.0, 9.0), [0.0, speed], "DOP853", events=ends, dense_output=True, rtol=1e-12, atol=1e-14)
    lasts = float(path.t[-1])

    def overlap(time: np.ndarray) -> np.ndarray:
        within = path.sol(np.clip(time, 0.0, lasts).ravel())[0].reshape(time.shape)
        return within + speed * np.minimum(time, 0.0) - speed * np.maximum(time - lasts, 0.0)

    return overlap, lasts


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
    scheme = erred(normal_impacts()[name])
    allowed = scheme.peak_overlap, scheme.peak_force, scheme.duration
    lines, reason = [], f"Verlet's scheme on this law, {scheme.steps:.3g} steps"
    for (quantity, value, reference, unit), printed, most in zip(found, PRINTED[name], allowed, strict=True):
        quantity = f"{name}: {quantity}"
        told, digits = float(printed), 0.5 * 10.0 ** -len(printed.partition(".")[2])
        lines.append(Line(quantity, value, reference, "closed form (Hertz 1882)", most, reason, unit))
        allows = most + digits / told
        lines.append(Line(quantity, value, told, "the paper", allows, f"{reason}; digits printed", unit))
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
