"""Damping from a decay test: linear and quadratic, from the heights of successive swings."""

from dataclasses import dataclass
from math import pi

import numpy as np

from solvers.machine.errors import Unavailable

LEAST_SWINGS = 4


@dataclass(frozen=True)
class Decay:
    """Frequency (rad/s) of the swings, and damping per moment of inertia in φ̈ + b₁ φ̇ + b₂ φ̇|φ̇| + ω₀² φ = 0.

    `linear` b₁ (1/s) and `quadratic` b₂ (1/rad); times the inertia, added mass included, they are B₁ and B₂, the wave
    damping among B₁.
    """

    frequency: float
    linear: float
    quadratic: float


def fit_decay(time: np.ndarray, roll: np.ndarray) -> Decay:
    """Damping from a free roll (n,) rad at even times (n,) s.

    By averaging over a swing (Krylov and Bogoliubov) the amplitude a falls as d ln a/dt = −b₁/2 − (4/3π) ω b₂ a: a
    straight line against a, fitted by least squares. Raises `Unavailable` where there are too few swings.
    """
    when, turn = _turning_points(np.asarray(time, dtype=float), np.asarray(roll, dtype=float))
    if len(turn) < LEAST_SWINGS + 1:
        raise Unavailable(f"a decay test needs {LEAST_SWINGS} swings or more, and {max(len(turn) - 1, 0)} were found.")
    # Half the way from one turning point to the next: a lasting heel drops out.
    size, middle = 0.5 * np.abs(np.diff(turn)), 0.5 * (when[1:] + when[:-1])
    frequency = pi * (len(when) - 1) / (when[-1] - when[0])
    fall = -np.diff(np.log(size)) / np.diff(middle)
    ratio = size[1:] / size[:-1]
    mean = size[:-1] * np.where(np.abs(ratio - 1.0) > 1e-9, (ratio - 1.0) / np.log(ratio), 1.0)
    weight = mean  # a small swing's logarithm is the less certain
    design = np.column_stack([np.ones_like(mean), mean])
    constant, slope = np.linalg.lstsq(design * weight[:, None], fall * weight)[0]
    return Decay(float(frequency), float(2.0 * constant), float(0.75 * pi * slope / frequency))


def _turning_points(time: np.ndarray, roll: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Times and values at the tops and bottoms, each of a parabola through three samples."""
    before, here, after = roll[:-2], roll[1:-1], roll[2:]
    top = (here - before) * (after - here) < 0.0
    before, here, after = before[top], here[top], after[top]
    bend = before - 2.0 * here + after
    offset = 0.5 * (before - after) / bend
    step = time[1] - time[0]
    return time[1:-1][top] + offset * step, here - 0.25 * (before - after) * offset
