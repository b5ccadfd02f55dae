"""Two outlines in a plane: how deep a point of one lies in the other, where they cross, and which regions they share.

Points are complex numbers y + i z (m). An arc is (from, to), polar angles (rad) in its grain's own frame, from < to.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import acos, ceil, pi, sqrt

import numpy as np
from scipy.optimize import brentq

from solvers.grains.shapes.contour import Contour
from solvers.machine.errors import BadOutline

SAMPLES = 8  # to a wave of the highest harmonic of either outline
LEAST_WAVES = 8
AROUND = 0.1  # rad: added to either end of the arc that faces another grain
TOUCHING = 1e-9  # rad: an arc that falls short of a whole turn by less is one of no length

Arc = tuple[float, float]


@dataclass(frozen=True)
class Placed:
    """A contour with its origin at (y, z) m, turned counter-clockwise by `angle` (rad)."""

    contour: Contour
    y: float
    z: float
    angle: float

    def place(self, theta: np.ndarray) -> np.ndarray:
        """The outline's points at these polar angles (rad) of its own frame."""
        return complex(self.y, self.z) + self.contour.polar(theta) * np.exp(1j * (theta + self.angle))

    def trace(self, theta: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The outline's points, and their derivative (m) by θ."""
        turn = np.exp(1j * (theta + self.angle))
        away = self.contour.polar(theta) * turn
        return complex(self.y, self.z) + away, self.contour.polar(theta, 1) * turn + 1j * away

    def normal(self, theta: np.ndarray) -> np.ndarray:
        """Outward unit normal at these polar angles."""
        along = self.trace(theta)[1]
        return -1j * along / np.abs(along)

    def seen(self, point: np.ndarray) -> np.ndarray:
        """A point in the grain's own frame."""
        return (point - complex(self.y, self.z)) * np.exp(-1j * self.angle)


@dataclass(frozen=True)
class Shared:
    """One region that two outlines share: the arcs of either that bound it, as many of the one as of the other.

    Counter-clockwise, arc k of the second follows arc k of the first.
    """

    first: tuple[Arc, ...]
    second: tuple[Arc, ...]


def depth(first: Placed, second: Placed, theta: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """How deep (m) the points θ of the first outline lie in the second by polar radius, and the derivative by θ.

    R_j(φ) − d with d, φ polar coordinates in the second's frame: steps 1 to 4 of Spandonidis (2016), table 8.1.
    """
    point, along = first.trace(theta)
    own = second.seen(point)
    distance, phi = np.abs(own), np.angle(own)
    rate = along * np.exp(-1j * second.angle) / own  # of ln(own), by θ
    inside = second.contour.polar(phi) - distance
    return inside, second.contour.polar(phi, 1) * rate.imag - distance * rate.real


def samples(first: Placed, second: Placed, arc: Arc) -> np.ndarray:
    """Angles of an arc of the first outline, ends included, close enough to see every wave of the depth."""
    a, b = first.contour, second.contour
    waves = len(a.descriptors) + len(b.descriptors) * max(1.0, a.bounding_radius / b.smallest_radius)
    share = (arc[1] - arc[0]) / (2.0 * pi)
    return np.linspace(*arc, 1 + max(LEAST_WAVES, ceil(SAMPLES * max(LEAST_WAVES, waves) * share)))


def extremes(first: Placed, second: Placed, theta: np.ndarray, cells: np.ndarray) -> np.ndarray:
    """Angles at which the depth is extreme, one in each of these cells of θ (the numbers of their first angles)."""

    def slope(angle: float) -> float:
        return float(depth(first, second, angle)[1])

    return np.array([_root(slope, theta[k], theta[k + 1]) for k in cells])


def shared(first: Placed, second: Placed) -> tuple[Shared, ...]:
    """The regions that two outlines share, none if they do not cross.

    Raises BadOutline where one outline lies wholly inside the other.
    """
    entries, exits = _crossings(first, second)
    if not len(entries):
        if depth(first, second, 0.0)[0] > 0.0 or depth(second, first, 0.0)[0] > 0.0:
            raise BadOutline("one grain lies wholly inside the other, where no contact rule has a meaning.")
        return ()
    phi_in, phi_out = (np.angle(second.seen(first.place(theta))) for theta in (entries, exits))
    ahead = np.mod(phi_in[None, :] - phi_out[:, None], 2.0 * pi)
    ahead[ahead > 2.0 * pi - TOUCHING] = 0.0
    following = ahead.argmin(axis=1)  # the entry that the second outline comes to from each exit
    regions, left = [], set(range(len(entries)))
    while left:
        k, ring = min(left), []
        while k in left:
            left.remove(k)
            ring.append(k)
            k = int(following[k])
        arcs = tuple((float(entries[k]), float(exits[k])) for k in ring)
        others = tuple((float(phi_out[k]), float(phi_out[k] + ahead[k, following[k]])) for k in ring)
        regions.append(Shared(arcs, others))
    return tuple(regions)


def _root(function: Callable[[float], float], low: float, high: float) -> float:
    """A root between two angles; one of them, where rounding has it that both are on the same side."""
    at_low, at_high = function(low), function(high)
    if at_low * at_high > 0.0:
        return low if abs(at_low) < abs(at_high) else high
    return brentq(function, low, high, xtol=1e-15)


def _facing(first: Placed, second: Placed) -> Arc:
    """An arc of the first outline with all of its points that the second may hold, judged by the bounding circles."""
    centre = complex(first.seen(complex(second.y, second.z)))
    apart, reach, other = abs(centre), first.contour.bounding_radius, second.contour.bounding_radius
    if apart >= reach + other:
        return 0.0, 0.0
    if apart <= other:
        return 0.0, 2.0 * pi
    farthest = min(reach, sqrt(apart**2 - other**2))  # where the circle of the second is widest, as seen from the first
    half = acos((apart**2 + farthest**2 - other**2) / (2.0 * apart * farthest))
    half += AROUND
    if half >= pi:
        return 0.0, 2.0 * pi
    direction = float(np.angle(centre))
    return direction - half, direction + half


def _crossings(first: Placed, second: Placed) -> tuple[np.ndarray, np.ndarray]:
    """Angles at which the first outline enters the second, and at which it leaves it next, in order.

    Between two samples the depth may rise above zero and fall again, or the reverse: where that is possible the
    extreme in between is found, too.
    """

    def inside(theta: np.ndarray) -> np.ndarray:
        return depth(first, second, np.mod(theta, 2.0 * pi))[0]  # the very same number after a turn

    theta = samples(first, second, _facing(first, second))
    deep, slope = depth(first, second, theta)
    steepest = np.maximum(np.abs(slope[:-1]), np.abs(slope[1:])) * np.diff(theta)
    near = np.minimum(np.abs(deep[:-1]), np.abs(deep[1:])) < steepest
    turning = np.flatnonzero(near & (slope[:-1] * slope[1:] < 0.0))
    theta = np.sort(np.concatenate([theta, extremes(first, second, theta, turning)]))
    within = inside(theta) > 0.0
    changes = np.flatnonzero(within[:-1] != within[1:])
    roots = [_root(inside, theta[k], theta[k + 1]) for k in changes]
    if within[0]:
        roots = [*roots[1:], *(root + 2.0 * pi for root in roots[:1])]  # an exit comes first, of the last entry's arc
    return np.array(roots[::2]), np.array(roots[1::2])
