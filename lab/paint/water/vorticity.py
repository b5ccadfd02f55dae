"""Vorticity of the water at its particles.

The slope of the velocity is that of the plane of least squares through the neighbours' velocities, each weighed by the
kernel of `lab.paint.water.grid`: with A = Σ V W Δr Δrᵀ and B = Σ V W Δu Δrᵀ it is B A⁻¹ (the corrected sum of Randles &
Libersky 1996, sec. 4, with W Δr in place of ∇W). A flow whose velocity is linear in space has its exact vorticity,
beside walls and at the surface, too.
"""

import numpy as np
import taichi as ti

from lab.paint.painter import Index, Table
from lab.paint.water.grid import REACH

FINEST = 1e-3  # least reach over the size of the water, which bounds the number of cells
ALONE = 1e-3  # of the trace of A squared: with a smaller determinant the neighbours lie in a row, and do not tell

Values = ti.types.ndarray(dtype=ti.f64, ndim=1)


def vorticity(place: np.ndarray, velocity: np.ndarray, spacing: float) -> np.ndarray:
    """∂u_z/∂y − ∂u_y/∂z (n,) in 1/s, positive counter-clockwise; NaN where the place is, 0 without enough neighbours.

    place (n, 2) m, velocity (n, 2) m/s, of particles about `spacing` (m) apart.
    """
    found = np.full(len(place), np.nan)
    there = np.flatnonzero(np.isfinite(place).all(axis=1) & np.isfinite(velocity).all(axis=1))
    if not len(there):
        return found
    reach = max(REACH * spacing, FINEST * float(np.ptp(place[there], axis=0).max()))
    order, number, starts, columns = in_cells(place[there], reach)
    turning = np.zeros(len(there))
    sorted_state = np.column_stack([place[there], velocity[there]])[order]
    _curl(turning, np.ascontiguousarray(sorted_state), number, starts, columns, reach)
    found[there[order]] = turning
    return found


def in_cells(place: np.ndarray, reach: float) -> tuple[np.ndarray, np.ndarray, np.ndarray, int]:
    """The order of places (n, 2) m by square cells of side `reach` (m), the cell of each in that order, the first of
    each cell, and the number of columns of cells; the outermost cells are empty.
    """
    cell = np.floor((place - place.min(axis=0)) / reach).astype(int) + 1
    columns, rows = cell.max(axis=0) + 2
    number = cell[:, 1] * columns + cell[:, 0]
    order = np.argsort(number, kind="stable")
    starts = np.searchsorted(number[order], np.arange(columns * rows + 1)).astype(np.int32)
    return order, number[order].astype(np.int32), starts, int(columns)


@ti.kernel
def _curl(turning: Values, state: Table, cell: Index, starts: Index, columns: ti.i32, reach: ti.f64):
    for i in range(turning.shape[0]):
        yy, yz, zz, zy_of, yz_of = 0.0, 0.0, 0.0, ti.Vector([0.0, 0.0]), ti.Vector([0.0, 0.0])
        for row in range(-1, 2):
            first = cell[i] + row * columns
            for j in range(starts[first - 1], starts[first + 2]):
                y, z = state[j, 0] - state[i, 0], state[j, 1] - state[i, 1]
                near = 1.0 - (y * y + z * z) / (reach * reach)
                if near > 0.0:
                    weight, away = near**3, ti.Vector([y, z])
                    yy, yz, zz = yy + weight * y * y, yz + weight * y * z, zz + weight * z * z
                    yz_of += weight * (state[j, 2] - state[i, 2]) * away
                    zy_of += weight * (state[j, 3] - state[i, 3]) * away
        size = yy * zz - yz * yz
        if size > ALONE * (yy + zz) ** 2:
            rises = (zz * zy_of[0] - yz * zy_of[1]) / size  # of u_z along y
            shears = (yy * yz_of[1] - yz * yz_of[0]) / size  # of u_y along z
            turning[i] = rises - shears
