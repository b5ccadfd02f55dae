"""How a ship floats with water in her rooms: heel, sinkage and trim, at each moment at rest (quasi-static).

The water aboard is an added weight, with its centre where it lies level at that heel and trim; free surfaces are so
counted exactly. Buoyancy is that of the whole hull:

    M + ρ Σ v_i = ρ ∇

and the moments of M, ρ v_i and ρ ∇ about both level axes are in balance.

The method of lost buoyancy gives the same position: there water in a room that is open to the sea is no weight, and the
room no part of the hull. What differs is told in `solvers.ship.flooding.residual`.

From where she lies she turns with her moment to the nearest heel at which it vanishes and turns its sign: so a ship
with a negative GM lolls, and stays on the side where she is.
"""

from dataclasses import dataclass, field

import numpy as np

from solvers.ship.flooding.rooms import Filled, Rooms
from solvers.ship.flooding.solids import Less, Prisms, Stations, Wet
from solvers.ship.water import Water

FIRST, LARGEST = 1e-4, np.radians(2.0)  # steps (rad) of the search for a heel
NUDGE = 1e-5  # rad: how far off a balanced heel its stability is asked for
BALANCED = 1e-11  # of volume, and of volume times the hull's size: what is off by no more counts as balanced
MOST_STEPS, MOST_NEAR = 50, 12
STEEPEST = 0.5  # slope of the water along her: beyond she plunges
LEVEL, SLOPE, ROLL = range(3)  # of a pose
CLOSE = 1e-12  # of the volume: sinkage and trim are found as well as that


class Plunges(Exception):
    """The water in her ends has no trim at which buoyancy carries it."""


@dataclass(frozen=True)
class Pose:
    """How the sea lies about her, in her axes turned by the roll (rad): z = level + slope x."""

    level: float
    slope: float = 0.0
    roll: float = 0.0

    @property
    def tilt(self) -> float:
        """Height above the sea of a metre of z."""
        return 1.0 / float(np.hypot(1.0, self.slope))

    @property
    def up(self) -> np.ndarray:
        """The vertical (3,) in the hull's own axes."""
        turned = np.array([-self.slope, np.sin(self.roll), np.cos(self.roll)])
        return turned * self.tilt

    def heights(self, points: np.ndarray) -> np.ndarray:
        """Heights (…,) m above the sea of points (…, 3) m of the hull."""
        return np.asarray(points) @ self.up - self.level * self.tilt

    def turned(self, point) -> np.ndarray:
        """A point (3,) m of the hull in the turned axes."""
        x, y, z = point
        cos, sin = np.cos(self.roll), np.sin(self.roll)
        return np.array([x, cos * y - sin * z, sin * y + cos * z])


@dataclass(frozen=True, eq=False)
class Floating:
    """A hull with a mass (kg) and its centre x, y, z (m) without water in her rooms, in calm water.

    `trims`: whether she trims freely; else she keeps the slope that she has. `side`: to which side she lolls from
    upright, 1 to port, −1 to starboard. Beyond a heel of `capsize` (rad) she is lost. `_slopes` keeps how the last
    balance changes with her pose, from which the search for the next one begins.
    """

    hull: Prisms | Stations | Less
    rooms: Rooms
    mass: float
    centre: np.ndarray
    water: Water
    trims: bool = True
    side: int = -1
    capsize: float = 0.5 * np.pi
    _slopes: dict = field(default_factory=dict, compare=False, repr=False)

    def sinks(self, volume: np.ndarray) -> bool:
        """Whether she weighs more with the water (n,) m³ than her whole hull displaces."""
        return bool(self.mass / self.water.density + volume.sum() >= self.hull.volume[0])

    def at_heel(self, volume: np.ndarray, roll: float, near: Pose) -> Pose:
        """The pose at a roll (rad) at which she floats with water (n,) m³, `near` another one. Raises `Plunges`."""
        if not self.trims:
            return Pose(self._level(self._needed(volume), near.slope, roll, near.level), near.slope, roll)
        free = LEVEL, SLOPE
        found = self._balanced(self._misses(volume, free), Pose(near.level, near.slope, roll), free)
        return Pose(*found[0].tolist()) if found else self._trimmed(volume, roll, near)

    def rest(self, volume: np.ndarray, near: Pose) -> Pose | None:
        """The pose at which she comes to rest with water (n,) m³ from one; None: she turns over. Raises `Plunges`."""
        found = self._nearby(volume, near)
        if found is not None:
            return found
        search = _Heel(self, volume, near)
        start, roll = search.moment(near.roll), None
        if abs(start) <= BALANCED * search.scale:
            if search.moment(near.roll + NUDGE) <= 0.0:
                return search.poses[near.roll]
            start = float(self.side if near.roll == 0.0 else np.sign(near.roll))
        roll = search.beyond(near.roll, 1.0 if start > 0.0 else -1.0)
        return None if roll is None else search.poses[roll]

    def moment(self, volume: np.ndarray, pose: Pose, filled: Filled | None = None) -> float:
        """Moment (N m) of buoyancy and weights about the level fore-and-aft axis, positive to port."""
        return float(self.water.density * self.water.gravity * self._off(volume, pose, filled)[ROLL])

    def wet(self, pose: Pose) -> Wet:
        """What of the hull is under water."""
        return self.hull.wet(np.array([pose.level]), pose.slope, pose.roll)

    def _needed(self, volume: np.ndarray) -> float:
        return self.mass / self.water.density + float(volume.sum())

    def _level(self, needed: float, slope: float, roll: float, guess: float) -> float:
        """The level (m) at which the hull displaces so much (m³): Newton's method, halved where it leaves a bracket."""
        low, high = (float(end[0]) for end in self.hull.reach(slope, roll))
        at = guess if low < guess < high else 0.5 * (low + high)
        for _ in range(MOST_STEPS):
            wet = self.hull.wet(np.array([at]), slope, roll)
            off, surface = float(wet.volume[0]) - needed, float(wet.surface[0])
            if abs(off) <= CLOSE * needed:
                break
            low, high = (at, high) if off < 0.0 else (low, at)
            new = at - off / surface if surface > 0.0 else low
            at = new if low < new < high else 0.5 * (low + high)
        return at

    def _nearby(self, volume: np.ndarray, near: Pose) -> Pose | None:
        """The balance near a pose; None if there is none that is stable, or it is not found."""
        free = (LEVEL, SLOPE, ROLL) if self.trims else (LEVEL, ROLL)
        off = self._misses(volume, free)
        found = self._balanced(off, near, free)
        if found is None:
            return None
        at, miss, table = found
        table[:, -1] = self._slope(off, at, miss, ROLL)
        try:
            rolls = table[-1, -1] - table[-1, :-1] @ np.linalg.solve(table[:-1, :-1], table[:-1, -1])
        except np.linalg.LinAlgError:
            return None
        return Pose(*at.tolist()) if rolls < 0.0 else None

    def _balanced(self, off, near: Pose, free: tuple[int, ...]):
        """A pose near one where nothing is off balance, what is left of that, and its slopes; None if not found.

        By Broyden's method (1965), which begins with the slopes of the last balance.
        """
        at = np.array([near.level, near.slope, near.roll])
        miss, table = off(at), self._slopes.get(free)
        if table is None:
            table = np.column_stack([self._slope(off, at, miss, k) for k in free])
        for _ in range(MOST_NEAR):
            if np.abs(miss).max() <= BALANCED:
                self._slopes[free] = table
                return at, miss, table
            try:
                step = -np.linalg.solve(table, miss)
            except np.linalg.LinAlgError:
                break
            at = at.copy()
            at[list(free)] += step
            if not (abs(at[ROLL] - near.roll) <= LARGEST and abs(at[SLOPE]) < STEEPEST):
                break
            new = off(at)
            table = table + np.outer(new - miss - table @ step, step) / max(float(step @ step), 1e-300)
            miss = new
        self._slopes.pop(free, None)
        return None

    def _misses(self, volume: np.ndarray, free: tuple[int, ...]):
        """What is off balance of a place (level, slope, roll), over the volume and its moment with the hull's size."""
        scale = self._needed(volume) * np.array([1.0, self.hull.size, self.hull.size])[list(free)]
        return lambda place: self._off(volume, Pose(*place.tolist()))[list(free)] / scale

    @staticmethod
    def _slope(off, at: np.ndarray, miss: np.ndarray, axis: int) -> np.ndarray:
        """Derivatives of what is off balance by level (m), slope or roll (rad)."""
        moved = at.copy()
        moved[axis] += NUDGE
        return (off(moved) - miss) / NUDGE

    def _off(self, volume: np.ndarray, pose: Pose, filled: Filled | None = None) -> np.ndarray:
        """What is off balance (3,): displaced volume (m³), and moments (m⁴) that pitch and roll her."""
        filled, wet = filled or self.rooms.filled(volume, pose.slope, pose.roll), self.wet(pose)
        density, gravity = self.water.density, pose.turned(self.centre)
        moment = wet.moment[0] - volume @ filled.centre - self.mass / density * gravity
        return np.array([wet.volume[0] - self._needed(volume), moment[0] + pose.slope * moment[2], moment[1]])

    def _trimmed(self, volume: np.ndarray, roll: float, near: Pose) -> Pose:
        """The slope at which nothing pitches her, in a bracket. Raises `Plunges` where there is none."""
        from scipy.optimize import brentq  # slow to import

        needed, level = self._needed(volume), near.level

        def surplus(slope: float) -> float:
            nonlocal level
            level = self._level(needed, slope, roll, level)
            return float(self._off(volume, Pose(level, slope, roll))[SLOPE])

        if surplus(-STEEPEST) * surplus(STEEPEST) > 0.0:
            raise Plunges
        slope = brentq(surplus, -STEEPEST, STEEPEST, xtol=1e-13)
        return Pose(self._level(needed, slope, roll, level), slope, roll)


class _Heel:
    """The search for the heel at which a ship with some water comes to rest; `poses` that it has seen, by heel."""

    def __init__(self, ship: Floating, volume: np.ndarray, near: Pose):
        self.ship, self.volume, self.last, self.poses = ship, volume, near, {}
        weight = (ship.mass + ship.water.density * volume.sum()) * ship.water.gravity
        self.scale = weight * ship.hull.size

    def moment(self, roll: float) -> float:
        """Moment (N m) at a heel (rad), and its pose is kept."""
        self.last = self.poses[roll] = self.ship.at_heel(self.volume, roll, self.last)
        return self.ship.moment(self.volume, self.last)

    def beyond(self, before: float, way: float) -> float | None:
        """The next heel in a direction at which the moment turns its sign; None: not before she is lost."""
        from scipy.optimize import brentq  # slow to import

        step = FIRST
        while True:
            after = before + way * step
            if self.moment(after) * way <= 0.0:
                break
            if abs(after) > self.ship.capsize:
                return None
            before, step = after, min(2.0 * step, LARGEST)
        if self.moment(before) * way > 0.0:
            after = brentq(self.moment, before, after, xtol=1e-13)
        if after not in self.poses:
            self.moment(after)
        return after
