"""Roll about a fixed axis with a cargo that slides as one heap: eq. 7.1 of Spandonidis (2016) for many waves at once.

    (I + δI) φ̈ + B₁ φ̇ + B₂ φ̇|φ̇| + W GZ(φ) = W GM A k D(t) cos ωt + M_cargo,  k = ω²/g

per metre of length; D is the soft start of eq. F.1 and GZ(φ) any righting lever of the ship with her cargo frozen. The
heap is the plane filling of `solvers.ship.cargo`: it stays at rest in the hold until its surface is steeper than its
angle of repose, and then slides at once, as far as it must (the play operator of Prandtl 1928). Unlike grains it needs
no time to slide, and only gravity acts on it.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import sqrt

import numpy as np

from solvers.ship.cargo import filling_centre
from solvers.ship.motion import RollDamping, runge_kutta
from solvers.ship.section import Section, box
from solvers.ship.waves import soft_start

LEANS = np.radians(np.linspace(-120.0, 120.0, 481))  # of a heap's table; rolls to ± 90 deg with any repose up to 30


@dataclass(frozen=True, eq=False)
class Heap:
    """A loose cargo of a mass (kg/m) and an angle of `repose` (rad), or one angle for each of many ships.

    `inertia` (kg m) is about the ship's axis while it lies level; `centres` (n, 2) m from that axis, in the hull's
    frame, with the surface at each of `LEANS` against the deck.
    """

    mass: float
    inertia: float
    repose: float | np.ndarray
    centres: np.ndarray

    @property
    def height(self) -> float:
        """Height of its centre of mass above the axis (m) while its surface is level."""
        return float(np.interp(0.0, LEANS, self.centres[:, 1]))

    def slid(self, lean: np.ndarray, roll: np.ndarray) -> np.ndarray:
        """Lean of the surface (rad) once the ship has reached a roll (rad)."""
        return np.clip(lean, roll - self.repose, roll + self.repose)

    def arm(self, lean: np.ndarray, roll: np.ndarray) -> np.ndarray:
        """Horizontal distance (m) of its centre of mass to starboard of the axis."""
        y, z = (np.interp(lean, LEANS, column) for column in self.centres.T)
        return np.cos(roll) * y - np.sin(roll) * z


def box_heap(width: float, height: float, depth: float, floor: float, mass: float, repose: float) -> Heap:
    """In a rectangular hold (m), level to a depth; its floor is `floor` (m) above the axis, so mostly below 0."""
    hold = Section(box(width, height).outline + np.array([0.0, floor]))
    centres = np.array([filling_centre(hold, width * depth, lean) for lean in LEANS])
    level = floor + 0.5 * depth
    return Heap(mass, mass * ((width**2 + depth**2) / 12.0 + level**2), repose, centres)


def softening_lever(height: float, vanishing: float) -> Callable[[np.ndarray], np.ndarray]:
    """GZ = GM φ (1 − (φ/φ_v)²) (m), `height` GM (m): softer from the first degree, none at φ_v (rad)."""
    return lambda roll: height * roll * (1.0 - (roll / vanishing) ** 2)


@dataclass(frozen=True, eq=False)
class HeapShip:
    """A ship of a weight (N/m) and GM (m) in regular waves, her cargo a heap or, without one, frozen.

    `lever` is GZ (m) at rolls (rad) with the cargo frozen, `inertia` (kg m) I + δI with it. `twice`: the cargo counts
    twice, as eq. 7.2 and 7.5 read together: its weight at its own centre among the righting moments, and once more,
    with its inertia, in the contact forces on the walls, since these carry it. `openings` (k, 2) m, hull's frame, from
    the axis, which is in the calm surface: where one goes under the waves' surface she floods.
    """

    weight: float
    height: float
    lever: Callable[[np.ndarray], np.ndarray]
    inertia: float
    gravity: float
    damping: RollDamping
    heap: Heap | None = None
    twice: bool = False
    openings: np.ndarray | None = None

    @property
    def whole_inertia(self) -> float:
        """What is turned (kg m), the cargo as often as it counts."""
        return self.inertia + (self.heap.inertia if self.twice else 0.0)

    @property
    def natural_frequency(self) -> float:
        """Natural frequency of small rolls (rad/s), which do not move the heap."""
        again = -self.heap.mass * self.gravity * self.heap.height if self.twice else 0.0
        return sqrt((self.weight * self.height + again) / self.whole_inertia)

    def tuned(self, frequency: float) -> "HeapShip":
        """The same ship with the inertia that gives small rolls this natural frequency (rad/s)."""
        again = self.whole_inertia - self.inertia
        return replace(self, inertia=(self.natural_frequency / frequency) ** 2 * self.whole_inertia - again)

    def cargo_moment(self, lean: np.ndarray, roll: np.ndarray) -> np.ndarray:
        """Moment (N) of the cargo's weight beyond that in the righting lever with frozen cargo."""
        lean = self.heap.slid(lean, roll)
        moved = self.heap.arm(lean, roll) - self.heap.arm(np.zeros_like(roll), roll)
        again = self.heap.arm(lean, roll) if self.twice else 0.0
        return -self.heap.mass * self.gravity * (moved + again)

    def floods(self, roll: np.ndarray, elevation: Callable[[np.ndarray], np.ndarray]) -> np.ndarray:
        """Whether an opening is under the surface, whose elevation (m) is a function of the place y (m)."""
        if self.openings is None:
            return np.zeros(np.shape(roll), dtype=bool)
        y, z = self.openings.T[..., None]
        across, up = np.cos(roll) * y - np.sin(roll) * z, np.sin(roll) * y + np.cos(roll) * z
        return (elevation(across) > up).any(axis=0)

    def acceleration(self, roll: np.ndarray, speed: np.ndarray, lean: np.ndarray, push: np.ndarray) -> np.ndarray:
        """Acceleration of the roll (rad/s²) under a wave moment `push` (N)."""
        resisted = (self.damping.linear + self.damping.quadratic * np.abs(speed)) * speed
        moment = push - self.weight * self.lever(roll) - resisted
        if self.heap is not None:
            moment = moment + self.cargo_moment(lean, roll)
        return moment / self.whole_inertia


def roll_with_heap(
    ship: HeapShip,
    amplitude: np.ndarray,
    frequency: np.ndarray,
    interval: float,
    duration: float,
    limit: float,
    lasts: float = 0.0,
) -> tuple[np.ndarray, np.ndarray]:
    """Times (n,) s and rolls (n, k) rad from rest in waves of amplitudes (k,) m and frequencies (k,) rad/s.

    Their soft start lasts `lasts` (s). Once a roll has passed ± `limit` (rad), or she has flooded, it is not a number.
    """
    size = ship.weight * ship.height * amplitude * frequency**2 / ship.gravity
    lean = np.zeros(len(frequency))

    def elevation(y: np.ndarray, time: float) -> np.ndarray:
        """The wave whose slope at the axis, D(t) A k cos ωt, is that of the moment."""
        return soft_start(time, lasts) * amplitude * np.sin(frequency**2 / ship.gravity * y - frequency * time)

    def rate(state: np.ndarray, time: float) -> np.ndarray:
        push = soft_start(time, lasts) * size * np.cos(frequency * time)
        return np.array([state[1], ship.acceleration(*state, lean, push)])

    state, time = np.zeros((2, len(frequency))), interval * np.arange(round(duration / interval) + 1)
    rolls = [state[0]]
    for now in time[:-1]:
        state = runge_kutta(rate, state, now, interval)
        flooded = ship.floods(state[0], lambda y, after=now + interval: elevation(y, after))
        state[:, (np.abs(state[0]) > limit) | flooded] = np.nan
        if ship.heap is not None:
            lean = ship.heap.slid(lean, state[0])
        rolls.append(state[0])
    return time, np.array(rolls)
