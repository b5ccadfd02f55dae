"""Shallow water in a tank that rolls about an axle: Verhagen & van Wijngaarden (1965), J. Fluid Mech. 22, 737.

h_t + (h u)_x = 0,   (h u)_t + (h u² + ½ G h²)_x = h (−g sin φ + φ̈ (½ h − d) + φ̇² x)

along the floor of the tank, which is d below the axle and rolls by φ; the pressure at a height z is ρ G (h − z) with

G = g cos φ + φ̈ x + φ̇² d + 2 φ̇ u.

Waves are as long as the tank is wide, over h, so their speed does not depend on their length; those that break are
bores, which keep mass and momentum. Finite volumes: linear in a cell by van Leer's (1977) limiter, with the flux of
Harten, Lax & van Leer (1983) between cells, stepped by Heun's method. It shares nothing with the particles.
"""

from collections.abc import Callable

import numpy as np

COURANT = 0.45
DRY = 1e-4  # of the depth at rest, the least in a cell

Roll = Callable[[float, int], float]  # roll (rad) at a time (s), or its derivative of that order


class ShallowTank:
    """Water of a `depth` (m) in a tank of a `width` (m), in `cells`, under an axle `above` its floor (m)."""

    def __init__(self, width: float, depth: float, above: float, gravity: float, cells: int = 300):
        self.depth, self.above, self.gravity = depth, above, gravity
        self.edges = np.linspace(-0.5 * width, 0.5 * width, cells + 1)
        self.places, self.cell = 0.5 * (self.edges[1:] + self.edges[:-1]), width / cells

    def rest(self) -> np.ndarray:
        """Depth (m) and discharge (m²/s) of level water, (2, cells)."""
        return np.array([np.full(len(self.places), self.depth), np.zeros(len(self.places))])

    def pull(self, roll: np.ndarray, places: np.ndarray, speed: np.ndarray) -> np.ndarray:
        """G (n,) m/s² at places (n,) m of water with a speed (n,) m/s; `roll` (3,) with its first two derivatives."""
        angle, rate, angular = roll
        return self.gravity * np.cos(angle) + angular * places + rate**2 * self.above + 2.0 * rate * speed

    def rates(self, roll: np.ndarray, state: np.ndarray) -> tuple[np.ndarray, float]:
        """How fast depth (m/s) and discharge (m²/s²) change in the cells, (2, cells), and the fastest wave (m/s)."""
        angle, rate, angular = roll
        deep, flow = state
        walls = self.edges[[0, -1]]  # at which p_x is what moves the water with them
        tilt = (-self.gravity * np.sin(angle) - angular * self.above + rate**2 * walls) / self.pull(roll, walls, 0.0)
        deeps, speeds = _beyond(deep, 1.0, self.cell * tilt), _beyond(flow / deep, -1.0, np.zeros(2))
        (deep_l, deep_r), (speed_l, speed_r) = _at_edges(deeps), _at_edges(speeds)
        pull_l, pull_r = self.pull(roll, self.edges, speed_l), self.pull(roll, self.edges, speed_r)
        wave_l, wave_r = np.sqrt(pull_l * deep_l), np.sqrt(pull_r * deep_r)
        slow = np.minimum(np.minimum(speed_l - wave_l, speed_r - wave_r), 0.0)
        fast = np.maximum(np.maximum(speed_l + wave_l, speed_r + wave_r), 0.0)
        left = np.array([deep_l * speed_l, deep_l * (speed_l**2 + 0.5 * pull_l * deep_l)])
        right = np.array([deep_r * speed_r, deep_r * (speed_r**2 + 0.5 * pull_r * deep_r)])
        jump = np.array([deep_r - deep_l, deep_r * speed_r - deep_l * speed_l])
        flux = (fast * left - slow * right + slow * fast * jump) / (fast - slow)
        flux[0, [0, -1]] = 0.0  # nothing goes through walls
        change = -np.diff(flux, axis=1) / self.cell
        force = -self.gravity * np.sin(angle) + angular * (0.5 * deep - self.above) + rate**2 * self.places
        change[1] += deep * force
        return change, float(max(fast.max(), -slow.min()))

    def stepped(self, state: np.ndarray, now: np.ndarray, then: Callable[[float], np.ndarray]) -> tuple:
        """The state after a step as long as waves allow, and that step (s); `then(step)` is the roll at its end."""
        change, fastest = self.rates(now, state)
        step = COURANT * self.cell / fastest
        ahead = self._wet(state + step * change)
        return self._wet(0.5 * (state + ahead + step * self.rates(then(step), ahead)[0])), step

    def _wet(self, state: np.ndarray) -> np.ndarray:
        state[0] = np.maximum(state[0], DRY * self.depth)
        return state

    def moment(self, roll: np.ndarray, state: np.ndarray) -> float:
        """The water's moment about the axle over ρ and over the tank's length, m⁴/s²; counterclockwise as the roll.

        It is that of the pressures on floor and walls.
        """
        deep, flow = state
        pull, ends = self.pull(roll, self.places, flow / deep), 1.5 * deep[[0, -1]] - 0.5 * deep[[1, -2]]
        walls = self.pull(roll, self.edges[[0, -1]], np.zeros(2)) * ends**2 * (0.5 * self.above - ends / 6.0)
        return float(walls[1] - walls[0] - np.sum(self.places * pull * deep) * self.cell)

    def energy(self, roll: np.ndarray, state: np.ndarray) -> float:
        """The water's energy over the earth, over ρ and over the tank's length, m⁴/s², by its height over the axle.

        Water goes along the floor and with the tank, by (u − φ̇ z, φ̇ x) about the axle. Walls give it −M φ̇ with its
        `moment` M, and what it does not gain of that is lost in bores.
        """
        (angle, rate, _), (deep, flow), low = roll, state, -self.above
        square, cube = (((low + deep) ** power - low**power) / power for power in (2, 3))
        along, turned = flow**2 / deep - 2.0 * rate * square * flow / deep, rate**2 * (self.places**2 * deep + cube)
        lifted = self.gravity * (self.places * np.sin(angle) * deep + np.cos(angle) * square)
        return float(np.sum(0.5 * (along + turned) + lifted) * self.cell)

    def wall_pressure(self, roll: np.ndarray, state: np.ndarray, height: float) -> float:
        """The pressure over ρ (m²/s²) in the wall to the left, so high (m) over the floor; none over the water."""
        deep = 1.5 * state[0, 0] - 0.5 * state[0, 1]
        return float(self.pull(roll, self.edges[:1], np.zeros(1))[0] * max(deep - height, 0.0))

    def moments(self, roll: Roll, duration: float) -> np.ndarray:
        """Times (T,) s and moments (T,) m⁴/s² of water that is at rest at first."""
        return self.followed(roll, duration, self.moment)

    def followed(self, roll: Roll, duration: float, number: Callable[[np.ndarray, np.ndarray], object]) -> np.ndarray:
        """Times (T,) s and a number (T,), or k, of roll and state of water that is at rest at first, (1 + k, T)."""

        def at(time: float) -> np.ndarray:
            return np.array([roll(time, order) for order in range(3)])

        state, time, found = self.rest(), 0.0, []
        while time < duration:
            found.append((time, *np.atleast_1d(number(at(time), state))))
            start = time
            state, step = self.stepped(state, at(start), lambda step: at(start + step))  # noqa: B023
            time += step
        return np.array(found).T


def _beyond(values: np.ndarray, sign: float, rises: np.ndarray) -> np.ndarray:
    """Values (n,) of the cells with two more beyond each wall, mirrored in it.

    `rises` (2,) are from cell to cell at the walls: the surface is inclined there, where a wall pushes the water.
    """
    left, right = rises[0] * np.array([3.0, 1.0]), rises[1] * np.array([1.0, 3.0])
    return np.concatenate([sign * values[1::-1] - left, values, sign * values[:-3:-1] + right])


def _at_edges(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Values (n + 1,) to the left and to the right of the edges between cells, from those of n + 4 cells."""
    before, after = np.diff(values)[:-1], np.diff(values)[1:]
    least = np.minimum(np.minimum(2.0 * np.abs(before), 2.0 * np.abs(after)), 0.5 * np.abs(before + after))
    slope = np.where(before * after > 0.0, np.sign(before) * least, 0.0)
    inner = values[1:-1]
    return (inner + 0.5 * slope)[:-1], (inner - 0.5 * slope)[1:]
