"""Waves in a tank by nonlinear potential flow: boundary elements round the water, stepped with its surface.

Longuet-Higgins & Cokelet (1976), Proc. R. Soc. A 350, 1, with nodes that stay where they are along the tank, so that
the surface is a height η(x, t) with a potential φ(x, t) on it (Zakharov 1968):

η_t = q √(1 + η_x²),   φ_t = −g η − ½ φ_x² + ½ (1 + η_x²) W²,   W = (q √(1 + η_x²) + φ_x η_x)/(1 + η_x²)

with q the outward normal velocity, from Green's identity over piston, surface and end wall with ln r and its image in
the floor. In a tank that sways, x and φ are relative to it, and φ_t has −ẍ x besides. Potentials are linear along an
element, whose integrals are exact; time is stepped by Runge and Kutta's fourth order. No wave may break.
"""

from collections.abc import Callable

import numpy as np
from scipy.interpolate import CubicSpline

GRAVITY = 9.81
CORNER = 1e-9  # m, up to which two nodes are in one place
PACE = 0.3  # of √(Δx/g), the step
# After each step, what differs from node to node is taken (Shapiro 1970, order 8).
SHAPIRO = np.array([-1.0, 8.0, -28.0, 56.0, 186.0, 56.0, -28.0, 8.0, -1.0]) / 256.0
_FOUND: dict[tuple, CubicSpline] = {}


class WaveTank:
    """Water of a `depth` (m) between a wall or piston, x from 0, and a wall at `length` (m), with `nodes` on top.

    With `swayed` the tank moves, else the piston.
    """

    def __init__(self, depth: float, length: float, nodes: int, swayed: bool = False):
        self.depth, self.length, self.swayed = depth, length, swayed
        ends = 2 + int(depth / length * nodes)  # elements of the walls are as long as those of the surface
        self.along, self.up = np.linspace(0.0, 1.0, nodes), np.linspace(0.0, 1.0, ends)
        self.left, self.top = np.arange(ends), ends + np.arange(nodes)
        self.right = ends + nodes + np.arange(ends)

    def places(self, way: float) -> np.ndarray:
        """Places (nodes,) m along the tank of the nodes on top, the piston having gone a `way` (m)."""
        return way + (self.length - way) * self.along

    def outflow(self, way: float, speed: float, rise: np.ndarray, potential: np.ndarray) -> np.ndarray:
        """The outward normal velocity (nodes,) m/s of the surface, the piston having a `speed` (m/s)."""
        high = self.depth + rise
        left = np.column_stack([np.full(len(self.up), way), self.up * high[0]])
        right = np.column_stack([np.full(len(self.up), self.length), self.up[::-1] * high[-1]])
        single, double = _influences(np.concatenate([left, np.column_stack([self.places(way), high]), right]))
        double[np.diag_indices_from(double)] -= double.sum(axis=1)  # a potential that is alike everywhere moves nothing
        inwards = np.zeros(len(double))
        inwards[self.left] = speed
        known = single @ inwards - double[:, self.top] @ potential
        double[:, self.top] = -single[:, self.top]
        for wall, top in ((self.left[-1], 0), (self.right[0], -1)):  # the corners belong to both
            double[wall], double[wall, wall], known[wall] = 0.0, 1.0, potential[top]
        return -np.linalg.solve(double, known)[self.top]

    def rates(self, motion: np.ndarray, state: np.ndarray) -> np.ndarray:
        """How fast η (m/s) and φ (m²/s²) change at the nodes, which go with the piston in part, (2, nodes).

        `motion` (3,): place (m), velocity (m/s) and acceleration (m/s²) of piston or tank.
        """
        way, speed, pull = (0.0, 0.0, motion[2]) if self.swayed else (*motion[:2], 0.0)
        rise, potential = state
        steep, along = CubicSpline(self.along, state, axis=1)(self.along, 1) / (self.length - way)
        square = 1.0 + steep**2
        upwards = self.outflow(way, speed, rise, potential) * np.sqrt(square)
        vertical = (upwards + along * steep) / square
        changes = [upwards, 0.5 * (square * vertical**2 - along**2) - GRAVITY * rise - pull * self.places(way)]
        return np.array(changes) + speed * (1.0 - self.along) * np.array([steep, along])

    def rises(self, curve: Callable, duration: float, distances: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Times (T,) s and the rise (T, n) m at distances (n,) m from where the piston began, or from the wall.

        `curve(time, order)` are place (m), velocity (m/s) and acceleration (m/s²) of piston or tank at times (n,) s.
        """
        longest = PACE * np.sqrt(self.length * self.along[1] / GRAVITY)
        halves = np.linspace(0.0, duration, 2 * int(np.ceil(duration / longest)) + 1)
        motion, step = np.column_stack([curve(halves, order) for order in range(3)]), halves[2]
        state, found = np.zeros((2, len(self.along))), []
        for k in range(0, len(halves) - 1, 2):
            found.append(CubicSpline(self.places(0.0 if self.swayed else motion[k, 0]), state[0])(distances))
            state = self.stepped(state, motion[k : k + 3], step)
            state[:, 4:-4] = np.array([np.convolve(one, SHAPIRO, "valid") for one in state])
        return halves[:-1:2], np.array(found)

    def stepped(self, state: np.ndarray, motion: np.ndarray, step: float) -> np.ndarray:
        """The state after a step; `motion` (3, 3) is that at its start, middle and end."""
        first = self.rates(motion[0], state)
        second = self.rates(motion[1], state + 0.5 * step * first)
        third = self.rates(motion[1], state + 0.5 * step * second)
        fourth = self.rates(motion[2], state + step * third)
        return state + step / 6.0 * (first + 2.0 * (second + third) + fourth)


def rise_at(
    tank: WaveTank, curve: Callable, duration: float, distances: tuple[float, ...]
) -> Callable[[np.ndarray], np.ndarray]:
    """The rise (T, n) m at distances (n,) m as a function of time (T,) s; see `WaveTank.rises`.

    It takes seconds to find, and is found once in a process.
    """
    asked = tank.depth, tank.length, len(tank.along), tank.swayed, duration, distances
    asked += (curve(np.linspace(0.0, duration, 1000), 0).tobytes(),)
    if asked not in _FOUND:
        _FOUND[asked] = CubicSpline(*tank.rises(curve, duration, np.array(distances)))
    return _FOUND[asked]


def _influences(nodes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """∫ N_j G ds and ∫ N_j ∂G/∂n ds as seen from each node, (N, N), along a chain of nodes (N, 2).

    N_j is the hat over the elements beside node j, n the normal to the right of the chain, and G = ln r + ln r', r'
    being the distance from the node's image in the floor. Two nodes in one place, at corners, have no element.
    """
    whole = np.flatnonzero(np.hypot(*np.diff(nodes, axis=0).T) > CORNER)
    start, side = nodes[whole], nodes[whole + 1] - nodes[whole]
    length = np.hypot(*side.T)
    t_x, t_y = side.T / length
    single, double = np.zeros((len(nodes), len(nodes))), np.zeros((len(nodes), len(nodes)))
    for seen_from in (nodes, nodes * [1.0, -1.0]):
        r_x, r_y = (seen_from[:, None, k] - start[:, k] for k in range(2))
        x, y = r_x * t_x + r_y * t_y, r_x * t_y - r_y * t_x  # along the element and beside it
        near, far = x**2 + y**2, (x - length) ** 2 + y**2
        log_near, log_far = (0.5 * np.log(np.maximum(square, 1e-30)) for square in (near, far))
        angle = np.where(np.abs(y) < 1e-12 * length, 0.0, np.arctan2(length * y, near - x * length))
        logs = (length - x) * log_far + x * log_near - length + y * angle
        rising = 0.5 * (far * (log_far - 0.5) - near * (log_near - 0.5)) + x * logs
        turned = y * (log_near - log_far) - x * angle
        for sums, constant, linear in ((single, logs, rising / length), (double, -angle, turned / length)):
            sums[:, whole] += constant - linear
            sums[:, whole + 1] += linear
    return single, double
