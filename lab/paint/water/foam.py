"""Foam: where water is fast at its surface and mixes with air.

After Ihmsen, Akinci, Akinci & Teschner (2012), sec. 3.1: air is trapped where neighbours move against each other,
I = Σ |v_ij| (1 − v̂_ij · x̂_ij) W(x_ij) with W = 1 − r/R (their eqs. 2 and 3). Speeds are measured by that of a fall
through the tank's height; the ends of the ramps are our choice. Foam is only painted: the water is computed without.
"""

import numpy as np
import taichi as ti

from lab.paint.painter import Index, Table
from lab.paint.water.grid import REACH
from lab.paint.water.vorticity import FINEST, Values, in_cells

GRAVITY = 9.81  # m/s², for the speed of the fall
ALONE = 0.7, 0.5  # levels at a particle between which it has so few neighbours that it is foam
SURFACE = 0.995, 0.93  # levels at a particle between which it belongs to the surface
FAST = 0.2, 0.6  # speeds over that of the fall between which foam begins and is full
TRAPPED = 0.04, 0.16  # the same of I; in gravity waves it stays below
STIRRED = 0.08, 0.3  # speeds as FAST, of water that traps air


def foam(place: np.ndarray, velocity: np.ndarray, reached: np.ndarray, spacing: float, height: float) -> np.ndarray:
    """How far each particle (n,) is foam, 0 to 1.

    place (n, 2) m, velocity (n, 2) m/s, of particles about `spacing` (m) apart in a tank of this height (m); reached
    (n,): the level of the water's sum at each.
    """
    fall = np.sqrt(2.0 * GRAVITY * height)
    speed = np.hypot(*velocity.T) / fall
    found = ramp(speed, FAST) * ramp(reached, ALONE)
    lively = ramp(speed, STIRRED) * ramp(reached, SURFACE)
    if lively.any():
        found = np.maximum(found, lively * ramp(trapped(place, velocity, spacing) / fall, TRAPPED))
    return found


def trapped(place: np.ndarray, velocity: np.ndarray, spacing: float) -> np.ndarray:
    """I (n,) m/s of particles at places (n, 2) m with velocities (n, 2) m/s: 0 where neighbours move alike."""
    reach = max(REACH * spacing, FINEST * float(np.ptp(place, axis=0).max()))
    order, cell, starts, columns = in_cells(place, reach)
    sums, found = np.zeros(len(place)), np.empty(len(place))
    _against(sums, np.ascontiguousarray(np.column_stack([place, velocity])[order]), cell, starts, columns, reach)
    found[order] = sums
    return found


def ramp(value: np.ndarray, ends: tuple[float, float]) -> np.ndarray:
    """0 at the first end, 1 at the second, linear between them."""
    return np.clip((value - ends[0]) / (ends[1] - ends[0]), 0.0, 1.0)


@ti.kernel
def _against(sums: Values, state: Table, cell: Index, starts: Index, columns: ti.i32, reach: ti.f64):
    for i in range(sums.shape[0]):
        total = 0.0
        for row in range(-1, 2):
            first = cell[i] + row * columns
            for j in range(starts[first - 1], starts[first + 2]):
                away = ti.Vector([state[i, 0] - state[j, 0], state[i, 1] - state[j, 1]])
                apart = away.norm()
                if 0.0 < apart < reach:
                    rate = ti.Vector([state[i, 2] - state[j, 2], state[i, 3] - state[j, 3]])
                    total += (rate.norm() - rate.dot(away) / apart) * (1.0 - apart / reach)
        sums[i] = total
