"""The drag on a square that moves through a full box: Navier and Stokes' equations by finite differences.

Harlow & Welch's (1965) staggered grid in the frame of the earth, whose lines across the box move: between them and the
box's ends they spread as the square goes, beside it they go with it (Hirt, Amsden & Cook 1974). With w the velocity of
a line,

∂u/∂t|_grid = −(u − w) u_x − v u_y − p_x + ν (u_xx + u_yy),   u_x + v_y = 0.

Adams and Bashforth's second order in time; what diverges is taken by a pressure (Chorin 1968), whose equations are
solved by conjugate gradients with factors of a matrix of some steps before. One half of the box is enough, as the flow
is its own mirror image as long as the wake does not swing. At the corners the pressure is singular, so that the error
falls only as the cells there, which are half as long as others beside the square. It shares nothing with the particles.
"""

from collections.abc import Callable

import numpy as np
from scipy.optimize import brentq
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import LinearOperator, cg, splu

DIFFUSION, ADVECTION = 0.075, 0.125  # of h²/ν and of h over the speed of the square, the longest step
LONGEST = 5e-3  # s, in which the square's acceleration hardly changes
REFACTORED = 40  # steps at most with the same factors
SLOW = 6  # iterations, after which factors are found anew
SETTLED = 1e-8  # of the divergence, which is left

Curve = Callable[[float, int], float]  # the way (m) of the square at a time (s), or its derivative of that order
_FOUND: dict[tuple, tuple[np.ndarray, np.ndarray]] = {}


class MovingSquare:
    """A square of a `side` (m) in the middle of the height of a `box` (2,) m, its middle at first at x = `start` (m).

    Liquid of kinematic `viscosity` (m²/s) and density 1. Half a side has `cells`; the one at the corner is shorter by
    the factor `finer`. Raises ArithmeticError where a pressure is not found.
    """

    def __init__(
        self,
        curve: Curve,
        side: float,
        box: tuple[float, float],
        start: float,
        viscosity: float,
        cells: int,
        finer: float = 2.0,
    ):
        self.curve, self.side, self.length, self.start, self.viscosity = curve, side, box[0], start, viscosity
        corner, above = 0.5 * side / (cells * finer), 0.5 * (box[1] - side)
        half = _spread(cells, corner / (0.5 * side))
        # The gap behind begins narrow and widens, that before narrows: cells beside the square are right on the way.
        self.behind = 1.0 - _spread(int(3.5 * cells), 0.5 * corner / side)[::-1]
        self.beside = side * np.concatenate([0.5 * half, 1.0 - 0.5 * half[-2::-1]])
        self.before = _spread(5 * cells, 0.25 * corner / side)
        over = 0.5 * side + above * _spread(int(2.5 * cells), corner / above)
        self.edges_y = np.concatenate([0.5 * side * (1.0 - half[::-1]), over[1:]])
        self.y, self.d_y = 0.5 * (self.edges_y[1:] + self.edges_y[:-1]), np.diff(self.edges_y)
        self.back, self.top = len(self.behind) - 1, cells
        self.front = self.back + 2 * cells
        shape = self.front + 5 * cells, len(self.y)
        self.u, self.v, self.p = np.zeros((shape[0] + 1, shape[1])), np.zeros((shape[0], shape[1] + 1)), np.zeros(shape)
        self.water = np.ones(shape, dtype=bool)
        self.water[self.back : self.front, : self.top] = False
        self.open_x, self.open_y = self.water[1:] & self.water[:-1], self.water[:, 1:] & self.water[:, :-1]
        self._pattern()
        self.time, self.last, self.before_last = 0.0, 0.0, None

    def lines(self, time: float) -> tuple[np.ndarray, np.ndarray, float]:
        """Places (m) and velocities (m/s) of the lines across the box, and the velocity (m/s) of the square."""
        tail, speed = self.start - 0.5 * self.side + float(self.curve(time, 0)), float(self.curve(time, 1))
        nose = tail + self.side
        places = tail * self.behind[:-1], tail + self.beside[:-1], nose + (self.length - nose) * self.before
        speeds = self.behind[:-1], np.ones(len(self.beside) - 1), 1.0 - self.before
        return np.concatenate(places), speed * np.concatenate(speeds), speed

    def run(self, until: float) -> tuple[np.ndarray, np.ndarray]:
        """Times (T,) s in the middle of the steps, and the pressure's and the friction's drag (T, 2) m³/s² there."""
        times, forces = [], []
        while self.time < until:
            step = self.longest_step()
            self.advance(step)
            times.append(self.time - 0.5 * step)
            forces.append(self.forces())
        return np.array(times), np.array(forces)

    def longest_step(self) -> float:
        """The step (s) that the narrowest cell allows."""
        narrow = min(np.diff(self.lines(self.time)[0]).min(), self.d_y.min())
        by_speed = ADVECTION * self.d_y.min() / max(abs(float(self.curve(self.time, 1))), 1e-9)
        return min(DIFFUSION * narrow**2 / self.viscosity, by_speed, LONGEST)

    def advance(self, step: float) -> None:
        """Advance a step (s): what drives the water, then the pressure that keeps its volume."""
        rates = self.rates()
        old = self.before_last or rates
        weight = 0.5 * step / (self.last or step)
        places, _, speed = self.lines(self.time + step)
        for part, new, past, push in zip((self.u, self.v), rates, old, self.gradient(places, self.p), strict=True):
            part += step * ((1.0 + weight) * new - weight * past - push)
        self.hold(speed)
        outflow = np.diff(self.u, axis=0) * self.d_y + np.diff(self.v, axis=1) * np.diff(places)[:, None]
        more = np.zeros_like(self.p)
        more[self.water] = self.pressure(places, -outflow[self.water] / step)
        for part, push in zip((self.u, self.v), self.gradient(places, more), strict=True):
            part -= step * push
        self.hold(speed)
        self.p += more
        self.time, self.last, self.before_last = self.time + step, step, rates

    def hold(self, speed: float) -> None:
        """Give walls and square their velocities."""
        self.u[[0, -1]] = 0.0
        self.u[self.back : self.front + 1, : self.top] = speed
        self.v[:, [0, -1]] = 0.0
        self.v[self.back : self.front, : self.top + 1] = 0.0

    def rates(self) -> tuple[np.ndarray, np.ndarray]:
        """∂u/∂t and ∂v/∂t (m/s²) on the grid by advection and friction."""
        places, speeds, speed = self.lines(self.time)
        x, d_x = 0.5 * (places[1:] + places[:-1]), np.diff(places)[:, None]
        u, v, back, front, top = self.u, self.v, self.back, self.front, self.top
        south, north, d_south, d_north = _beside(u[1:-1], self.y, self.edges_y)
        south[:, 0], d_south[:, 0] = u[1:-1, 0], 2.0 * self.y[0]  # the mirror
        south[back - 1 : front, top], d_south[back - 1 : front, top] = speed, self.y[top] - self.edges_y[top]
        middle = 0.5 * (v[:, 1:] + v[:, :-1])
        across = (middle[:-1] * d_x[1:] + middle[1:] * d_x[:-1]) / (d_x[1:] + d_x[:-1])
        rate_u, rate_v = np.zeros_like(u), np.zeros_like(v)
        rate_u[1:-1] = self._carried(u[1:-1] - speeds[1:-1, None], u[:-2], u[1:-1], u[2:], d_x[:-1], d_x[1:])
        rate_u[1:-1] += self._carried(across, south, u[1:-1], north, d_south, d_north)
        west, east, d_west, d_east = (part.T for part in _beside(v[:, 1:-1].T, x, places))
        east[back - 1, :top], d_east[back - 1, :top] = 0.0, places[back] - x[back - 1]
        west[front, :top], d_west[front, :top] = 0.0, x[front] - places[front]
        middle = 0.5 * (u[1:] + u[:-1])
        along = (middle[:, :-1] * self.d_y[1:] + middle[:, 1:] * self.d_y[:-1]) / (self.d_y[1:] + self.d_y[:-1])
        along -= 0.5 * (speeds[1:] + speeds[:-1])[:, None]
        rate_v[:, 1:-1] = self._carried(along, west, v[:, 1:-1], east, d_west, d_east)
        rate_v[:, 1:-1] += self._carried(v[:, 1:-1], v[:, :-2], v[:, 1:-1], v[:, 2:], self.d_y[:-1], self.d_y[1:])
        return rate_u, rate_v

    def _carried(self, speed, low, here, high, d_low, d_high) -> np.ndarray:
        """−speed ∂f/∂x + ν ∂²f/∂x² of values before, at and beyond a place, from which they are d_low and d_high."""
        rise, fall = (high - here) / d_high, (here - low) / d_low
        slope = (rise * d_low + fall * d_high) / (d_low + d_high)
        return 2.0 * self.viscosity * (rise - fall) / (d_low + d_high) - speed * slope

    def gradient(self, places: np.ndarray, p: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """p_x and p_y (m/s²) at the faces between cells of water."""
        x, along, up = 0.5 * (places[1:] + places[:-1]), np.zeros_like(self.u), np.zeros_like(self.v)
        along[1:-1] = np.diff(p, axis=0) / np.diff(x)[:, None] * self.open_x
        up[:, 1:-1] = np.diff(p, axis=1) / np.diff(self.y) * self.open_y
        return along, up

    def _pattern(self) -> None:
        """Where the matrix of the pressures has numbers: it stays, they change."""
        number = np.zeros(self.water.shape, dtype=int)
        number[self.water] = np.arange(self.water.sum())
        pairs = [(number[1:], number[:-1], self.open_x), (number[:, 1:], number[:, :-1], self.open_y)]
        self.one, self.two = (np.concatenate([pair[k][pair[2]] for pair in pairs]) for k in range(2))
        self.factors, self.steps, self.every = None, 0, np.arange(self.water.sum())

    def pressure(self, places: np.ndarray, sources: np.ndarray) -> np.ndarray:
        """The pressure (n,) m²/s² of the cells of water whose gradient flows out of them at `sources` (n,) m²/s²."""
        x, count = 0.5 * (places[1:] + places[:-1]), len(self.every)
        faces = (
            (self.d_y / np.diff(x)[:, None])[self.open_x],
            (np.diff(places)[:, None] / np.diff(self.y))[self.open_y],
        )
        tie = np.concatenate(faces)
        own = np.bincount(self.one, tie, count) + np.bincount(self.two, tie, count)
        own[-1] *= 1.0 + 1e-6  # one cell is tied to zero, else any constant would do
        numbers, rows = np.concatenate([-tie, -tie, own]), np.concatenate([self.one, self.two, self.every])
        matrix = coo_matrix((numbers, (rows, np.concatenate([self.two, self.one, self.every])))).tocsc()
        if self.factors is None or self.steps >= REFACTORED:
            self.factors, self.steps = splu(matrix, "MMD_AT_PLUS_A", options={"SymmetricMode": True}), 0
        rounds = []
        near = LinearOperator(matrix.shape, self.factors.solve)
        found, missed = cg(matrix, sources - sources.mean(), rtol=SETTLED, M=near, callback=rounds.append)
        if missed:
            raise ArithmeticError(f"The pressure round the square is not found at t = {self.time:.4g} s.")
        self.steps = REFACTORED if len(rounds) > SLOW else self.steps + 1
        return found - found.mean()

    def forces(self) -> tuple[float, float]:
        """What pressure and friction hold the square back with, m³/s² of a liquid of density 1."""
        places, _, speed = self.lines(self.time)
        x, p, back, front, top = 0.5 * (places[1:] + places[:-1]), self.p, self.back, self.front, slice(0, self.top)
        on_front = p[front, top] + (p[front, top] - p[front + 1, top]) * _half(places, x, front, front + 1)
        on_back = p[back - 1, top] + (p[back - 1, top] - p[back - 2, top]) * _half(places, x, back - 1, back - 2)
        slip = self.u[back : front + 1, self.top : self.top + 2] - speed
        near, far = self.y[self.top : self.top + 2] - self.edges_y[self.top]
        shear = (slip[:, 0] * far / near - slip[:, 1] * near / far) / (far - near)
        friction = -self.viscosity * np.trapezoid(shear, places[back : front + 1])
        return 2.0 * float(np.sum((on_front - on_back) * self.d_y[top])), 2.0 * friction


def drag(
    curve: Curve, side: float, box: tuple[float, float], start: float, viscosity: float, until: float, cells: int = 10
) -> tuple[np.ndarray, np.ndarray]:
    """Times (T,) s and the drag (T,) m³/s² on the square; see `MovingSquare`.

    It takes seconds to find, and is found once in a process.
    """
    asked = side, box, start, viscosity, until, cells, curve(np.linspace(0.0, until, 1000), 0).tobytes()
    if asked not in _FOUND:
        times, forces = MovingSquare(curve, side, box, start, viscosity, cells).run(until)
        _FOUND[asked] = times, forces.sum(axis=1)
    return _FOUND[asked]


def _spread(cells: int, first: float) -> np.ndarray:
    """Edges (cells + 1,) from 0 to 1 of cells that grow by one ratio from the `first`."""
    powers = np.arange(cells)
    ratio = brentq(lambda grown: first * np.sum(grown**powers) - 1.0, 0.5, 2.0)
    return np.concatenate([[0.0], np.cumsum(ratio**powers) / np.sum(ratio**powers)])


def _beside(values: np.ndarray, places: np.ndarray, walls: np.ndarray) -> tuple[np.ndarray, ...]:
    """Values before and beyond each of `values` (M, N) at `places` (N,) m, and how far those are; walls are at rest."""
    low, high = np.zeros_like(values), np.zeros_like(values)
    low[:, 1:], high[:, :-1] = values[:, :-1], values[:, 1:]
    gaps = np.concatenate([[places[0] - walls[0]], np.diff(places), [walls[-1] - places[-1]]])
    return low, high, np.tile(gaps[:-1], (len(values), 1)), np.tile(gaps[1:], (len(values), 1))


def _half(places: np.ndarray, x: np.ndarray, near: int, far: int) -> float:
    """Half the cell at a wall over the way from its middle to that of the next."""
    return 0.5 * (places[near + 1] - places[near]) / abs(x[far] - x[near])
