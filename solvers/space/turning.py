"""Turns in space as unit quaternions (s, v), s = cos θ/2 and v = sin θ/2 n of a turn by θ about n, as lists.

Components of v are in the order of the axes. Formulas: Goldstein, Poole & Safko (2002), Classical Mechanics, section
4.5 (Euler parameters); own notation.
"""

import numpy as np
import taichi as ti

from solvers.machine.quantity import SPACE
from solvers.space.axes import cross, dot

WHOLE = 1 + SPACE  # numbers of a quaternion
SMALL = 1e-8  # rad, below which sin θ/θ is 1 to rounding
Y, Z, X = range(SPACE)


@ti.func
def product(a: ti.template(), b: ti.template()):
    """The turn b, then a, of unit length again."""
    v, u = [a[1], a[2], a[3]], [b[1], b[2], b[3]]
    across = cross(v, u)
    first, rest = a[0] * b[0] - dot(v, u), [a[0] * u[k] + b[0] * v[k] + across[k] for k in ti.static(range(SPACE))]
    whole = [first, rest[0], rest[1], rest[2]]
    size = 1.0 / ti.sqrt(dot(whole, whole))
    return [size * whole[k] for k in ti.static(range(WHOLE))]


@ti.func
def step_of(rate: ti.template(), dt):
    """The turn at a rate (rad/s) for a time dt (s)."""
    half = 0.5 * dt * ti.sqrt(dot(rate, rate))
    scale = 0.5 * dt
    if half > SMALL:
        scale *= ti.sin(half) / half
    return [ti.cos(half), scale * rate[0], scale * rate[1], scale * rate[2]]


@ti.func
def matrix_of(q: ti.template()):
    """The rotation matrix of a turn, row by row: (s² − v²) 1 + 2 v vᵀ + 2 s v×."""
    s, v = q[0], [q[1], q[2], q[3]]
    even = s * s - dot(v, v)
    return [
        2.0 * (v[0] * v[0]) + even,
        2.0 * (v[0] * v[1] - s * v[2]),
        2.0 * (v[0] * v[2] + s * v[1]),
        2.0 * (v[1] * v[0] + s * v[2]),
        2.0 * (v[1] * v[1]) + even,
        2.0 * (v[1] * v[2] - s * v[0]),
        2.0 * (v[2] * v[0] - s * v[1]),
        2.0 * (v[2] * v[1] + s * v[0]),
        2.0 * (v[2] * v[2]) + even,
    ]


@ti.func
def quaternion_of(m: ti.template()):
    """The turn of a rotation matrix (row by row) by less than half a turn."""
    s = 0.5 * ti.sqrt(1.0 + m[0] + m[4] + m[8])
    part = 0.25 / s
    return [s, part * (m[7] - m[5]), part * (m[2] - m[6]), part * (m[3] - m[1])]


def drawn_by(q: np.ndarray) -> np.ndarray:
    """The rotation matrices (..., 3, 3) of turns (..., 4)."""
    s, v = q[..., 0, None, None], q[..., 1:]
    square = (v * v).sum(axis=-1)[..., None, None]
    across = np.zeros((*v.shape, SPACE))
    for a, b, c in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        across[..., b, c], across[..., c, b] = -v[..., a], v[..., a]
    return (s * s - square) * np.eye(SPACE) + 2.0 * v[..., None] * v[..., None, :] + 2.0 * s * across


def angles_of(turn: np.ndarray) -> np.ndarray:
    """Pitch, yaw and roll (..., 3) rad of rotation matrices (..., 3, 3), see `PrescribedInSpace`."""
    up = turn[..., Z, :]
    pitch = np.arcsin(np.clip(-up[..., X], -1.0, 1.0))
    yaw = np.arctan2(turn[..., Y, X], turn[..., X, X])
    return np.stack([pitch, yaw, np.arctan2(up[..., Y], up[..., Z])], axis=-1)
