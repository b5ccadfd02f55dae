"""`cargolab roll-damping --decay`: period, extinction coefficients and damping of a ship that is let go heeled.

The record's turning points are found as by the measure `decay` (`lab.measures.ship_decay`). The height h of a swing is
half its width, so that a heel at rest is not in it. Froude's (1872) extinction curve is

    δh = p h + q h² + r h³

with δh the loss of height from a swing to the next and h the mean of both, in deg, by least squares, once without r and
once with it. An error of one turning point is in two losses, which the standard errors know of; intervals are of 95 %
(Student). Of the motion φ̈ + 2 ζ ω₀ φ̇ + b φ̇|φ̇| + ω₀² φ = 0 it is p = 2 tanh(π ζ/2√(1 − ζ²)) and to first order
q = 4 b/3 · π/180 (Himeno 1981); ζ and b themselves are fitted to all swings together, as that measure does.
"""

from dataclasses import dataclass
from pathlib import Path

import matplotlib
import numpy as np

from lab.base.errors import LabError
from lab.measures.ship_decay import PER, Decay, decay, turning_points
from lab.measures.value import half_width
from lab.naval.rolling.records import read_roll
from lab.naval.tables import Table, write
from lab.report.page import save_figure
from lab.report.plots import BELOW, BLUE, GREY, STYLE, VERMILION, canvas

ORDERS = {"linear and quadratic": 2, "with a cubic term": 3}
NAMES = "p", "q", "r"
UNITS = "", "1/deg", "1/deg2"
SPARE = 3  # decrements more than coefficients, the fewest that a fit is made of
SIZE = (8.4, 3.9)


@dataclass(frozen=True, eq=False)
class Extinction:
    """Coefficients (k,) of δh, h in deg, their standard errors, the degrees of freedom and the rms residual (deg)."""

    coefficients: np.ndarray
    errors: np.ndarray
    freedom: int
    residual: float

    @property
    def halves(self) -> np.ndarray:
        """Half widths (k,) of the 95 % intervals."""
        return np.array([half_width(float(error), self.freedom) for error in self.errors])


def extinction(heights: np.ndarray, order: int) -> Extinction | None:
    """Froude's curve of an order through heights (n,) deg of successive swings; None for too few."""
    fall, middle = heights[:-1] - heights[1:], 0.5 * (heights[:-1] + heights[1:])
    count = len(fall)
    if count < order + SPARE:
        return None
    powers = np.arange(1, order + 1)
    rows, scale = middle[:, None] ** powers, middle.max() ** powers
    back = np.linalg.pinv(rows / scale) / scale[:, None]
    found = back @ fall
    shared = 0.5 * (np.eye(count, count + 2) - np.eye(count, count + 2, k=2))  # decrements from turning points
    both = shared @ shared.T
    left = np.eye(count) - rows @ back
    rest = left @ fall
    variance = float(rest @ rest) / float(np.trace(left @ both @ left.T))
    errors = np.sqrt(variance * np.diag(back @ both @ back.T))
    return Extinction(found, errors, count - order, float(np.sqrt(np.mean(rest**2))))


def examine(path: Path, folder: Path) -> tuple[str, dict[str, Table], dict[str, float]]:
    """Write tables and figure of a decay test; returns text, tables and numbers. Raises LabError for no decay."""
    time, roll = read_roll(path)
    whole = decay(time, roll)
    if whole is None:
        raise LabError(f"{path.name}: has too few swings to tell a damping by; let her roll on for four or more.")
    _, turns = turning_points(time, roll)
    heights = 0.5 * np.degrees(np.abs(np.diff(turns)))
    curves = {name: extinction(heights, order) for name, order in ORDERS.items()}
    tables = {"decay": _swings(heights, whole), "extinction": _coefficients(curves)}
    numbers = _numbers(whole)
    write(tables, folder)
    _draw(folder / "decay.png", path.name, heights, whole, curves)
    return "\n".join(_words(path, whole, heights, curves, numbers)), tables, numbers


def _numbers(found: Decay) -> dict[str, float]:
    (share, slope), (of_share, of_slope) = found.line, found.errors
    return {
        "half cycles": len(found.amplitude),
        "period s": 2.0 * np.pi / found.frequency,
        "period error s": 2.0 * np.pi * found.frequency_error / found.frequency**2,
        "zeta": share,
        "zeta error": of_share,
        "quadratic 1/rad": PER * slope,
        "quadratic error 1/rad": PER * of_slope,
    }


def _words(path: Path, whole: Decay, heights: np.ndarray, curves: dict, numbers: dict[str, float]) -> list[str]:
    degrees = np.degrees(whole.amplitude)
    freedom = max(len(heights) - 3, 1)
    share, other = (half_width(numbers[name], freedom) for name in ("zeta error", "quadratic error 1/rad"))
    lines = [
        f"{path.name}: {len(heights)} swings of {heights[0]:.3g} to {heights[-1]:.3g} deg",
        f"period {numbers['period s']:.4g} s (standard error {numbers['period error s']:.2g} s)",
        f"zeta {numbers['zeta']:.4f}, b {numbers['quadratic 1/rad']:.4f} 1/rad, within {share:.2g} and {other:.2g} "
        "(95 %), ship.damping and ship.quadratic_damping of a preset, waves included",
    ]
    for turn in _round(degrees):
        lines.append(f"  zeta at {turn:g} deg: {whole.line[0] + whole.line[1] * np.radians(turn):.4f}")
    for name, curve in curves.items():
        if curve is None:
            lines.append(f"Froude's curve {name}: cannot tell; too few swings.")
            continue
        each = zip(NAMES, curve.coefficients, curve.halves, UNITS, strict=False)
        told = ", ".join(f"{one} {value:.4g} within {half:.2g} {unit}".rstrip() for one, value, half, unit in each)
        lines.append(f"Froude's curve {name}: {told} (95 %, n = {len(heights) - 1}; rms {curve.residual:.2g} deg)")
    return lines


def _round(degrees: np.ndarray) -> list[float]:
    """Some round amplitudes (deg) within the record."""
    return [turn for turn in (1.0, 2.0, 5.0, 10.0, 15.0, 20.0, 25.0) if degrees.min() <= turn <= degrees.max()]


def _swings(heights: np.ndarray, whole: Decay) -> Table:
    fall, middle = heights[:-1] - heights[1:], 0.5 * (heights[:-1] + heights[1:])
    rows = zip(middle, fall, fall / middle**2, whole.damping, strict=True)
    return ("amplitude deg", "decrement deg", "N 1/deg", "zeta"), [[f"{value:.5g}" for value in row] for row in rows]


def _coefficients(curves: dict[str, Extinction | None]) -> Table:
    header = "curve", "coefficient", "unit", "value", "standard error", "half of 95 % interval", "n"
    rows = []
    for name, curve in curves.items():
        if curve is None:
            continue
        each = zip(NAMES, UNITS, curve.coefficients, curve.errors, curve.halves, strict=False)
        count = curve.freedom + len(curve.coefficients)
        rows += [(name, one, unit, *(f"{value:.5g}" for value in values), count) for one, unit, *values in each]
    return header, rows


def _draw(path: Path, name: str, heights: np.ndarray, whole: Decay, curves: dict) -> Path:
    """The decrement over amplitude with Froude's curves, and ζ of each half cycle with the fit."""
    fall, middle = heights[:-1] - heights[1:], 0.5 * (heights[:-1] + heights[1:])
    line = np.linspace(0.0, 1.05 * middle.max(), 100)
    with matplotlib.rc_context(STYLE):
        figure, (left, right) = canvas(SIZE, 1, 2)
        left.plot(middle, fall, "o", ms=4, color=BLUE, label="half cycles")
        for (label, curve), look in zip(curves.items(), ("-", ":"), strict=True):
            if curve is not None:
                values = sum(c * line ** (k + 1) for k, c in enumerate(curve.coefficients))
                left.plot(line, values, look, color=VERMILION, label=f"Froude's curve, {label}")
        left.set_ylabel("decrement in half a cycle (deg)")
        degrees = np.degrees(whole.amplitude)
        right.plot(degrees, whole.damping, "o", ms=4, color=BLUE)
        fit = whole.line[0] + whole.line[1] * np.radians(line)
        right.plot(line, fit, color=GREY, label="ζ and b fitted to all swings")
        right.set_ylabel("share of critical damping ζ")
        for axes in (left, right):
            axes.set_xlabel("amplitude of roll (deg)")
            axes.set_xlim(0.0, line.max())
            axes.set_ylim(min(0.0, axes.get_ylim()[0]))
        figure.suptitle(f"{name}: decay of roll, {2.0 * np.pi / whole.frequency:.4g} s", x=0.01, ha="left")
        figure.legend(loc=BELOW, ncols=4)
        return save_figure(path, figure)
