"""A hull as a rigid body in sway, heave and roll, per metre of length, stepped in time.

Its pose is that of one of its points, the axis P, `about`: y, z (m, earth's axes) and roll φ (rad). Sway and heave are
the motions of P, wherever they are told of. With c from P to the centre
of gravity in the earth's axes, Newton's and Euler's laws about P are

    [[m, 0, −m c_z], [0, m, m c_y], [−m c_z, m c_y, I_G + m c²]] (a_P, φ̈) = force, moment + m φ̇² (c_y, c_z, 0).

The water resists motion with A v̇ + B v + memory (Cummins 1962), or with A and B at one frequency. A state (6 + s,) is
the pose, the velocities of P and of roll, and the memory's s states; nothing else is kept between steps.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from math import inf
from typing import Protocol

import numpy as np

from solvers.machine.errors import BadState
from solvers.ship.body import Body
from solvers.ship.hydrostatics import turned
from solvers.ship.potential.memory import Memory
from solvers.ship.potential.radiation import Hydrodynamics

NO_LOAD = np.zeros(3)
HEAVE = 1  # of a pose
BEYOND = 1e6  # a velocity (m/s or rad/s) that is no ship's


class WaterLoad(Protocol):
    """The water's force on the hull apart from what its motion radiates."""

    def force(self, pose: np.ndarray, time: float) -> np.ndarray:
        """Force y, z (N/m) and moment (N) about P, (3,), at a pose (m, m, rad) and time (s)."""

    @property
    def still(self) -> "WaterLoad":
        """The same in calm water."""


@dataclass(frozen=True, eq=False)
class Radiation:
    """The water's resistance to motion about P: `added_mass` and `damping` (3, 3), and its memory if it has one."""

    added_mass: np.ndarray
    damping: np.ndarray
    memory: Memory | None = None


def remembered(table: Hydrodynamics, memory: Memory) -> Radiation:
    """Cummins' (1962): the added mass of infinite frequency and a system that stands for the retardation."""
    return Radiation(table.infinite_added_mass, np.zeros((3, 3)), memory)


def frozen_at(table: Hydrodynamics, frequency: float) -> Radiation:
    """The coefficients of one frequency (rad/s): exact in a steady motion of that frequency, and in no other."""
    one = table.at([frequency])
    return Radiation(one.added_mass[0], one.damping[0])


@dataclass(frozen=True)
class RollDamping:
    """Viscous moment −B₁ φ̇ − B₂ φ̇ |φ̇|: `linear` (N s) and `quadratic` (N s²), per metre of hull, per rad."""

    linear: float = 0.0
    quadratic: float = 0.0


def _nothing() -> np.ndarray:
    return np.zeros(3)


@dataclass(frozen=True, eq=False)
class Rig:
    """What holds a model in sway, heave and roll (3,) each: masses that move along, dashpots, springs from a pose."""

    mass: np.ndarray = field(default_factory=_nothing)
    damping: np.ndarray = field(default_factory=_nothing)
    spring: np.ndarray = field(default_factory=_nothing)
    rest: np.ndarray = field(default_factory=_nothing)


@dataclass(frozen=True, eq=False)
class Ship:
    """A hull with all that is fixed to it, the water and the rig; `free` says which of sway, heave, roll can move."""

    body: Body
    load: WaterLoad
    radiation: Radiation
    about: tuple[float, float] = (0.0, 0.0)
    damping: RollDamping = RollDamping()
    rig: Rig = field(default_factory=Rig)
    free: tuple[bool, bool, bool] = (True, True, True)
    gravity: float = 9.81

    def lever(self, roll: float) -> np.ndarray:
        """From P to the centre of gravity (2,) m, earth's axes."""
        return turned((self.body.centre[0] - self.about[0], self.body.centre[1] - self.about[1]), roll)

    def inertia(self, roll: float) -> np.ndarray:
        """Of body, rig and added mass, (3, 3)."""
        y, z = self.lever(roll).tolist()
        mass, turning = self.body.mass, self.body.inertia
        body = np.array(
            [[mass, 0.0, -mass * z], [0.0, mass, mass * y], [-mass * z, mass * y, turning + mass * (y * y + z * z)]]
        )
        return body + np.diag(self.rig.mass) + self.radiation.added_mass

    def resistance(self, state: np.ndarray) -> np.ndarray:
        """Force and moment (3,) against the motion: radiated without the added mass, viscous, of the rig's dashpots."""
        return self.radiated(state) + self.viscous(state[3:6])

    def radiated(self, state: np.ndarray) -> np.ndarray:
        """Force and moment (3,) that make waves."""
        force = self.radiation.damping @ state[3:6]
        memory = self.radiation.memory
        return force if memory is None else force + memory.exit @ state[6:]

    def viscous(self, velocity: np.ndarray) -> np.ndarray:
        """Force and moment (3,) of viscous roll damping and of the rig's dashpots."""
        force = self.rig.damping * velocity
        force[2] += (self.damping.linear + self.damping.quadratic * abs(velocity[2])) * velocity[2]
        return force


def start(ship: Ship, heave: float, roll: float = 0.0, velocity: np.ndarray = NO_LOAD) -> np.ndarray:
    """The state of a hull whose origin is at a heave (m) at a roll (rad) about P, the water calm until then.

    Turned about P, which stays where it is in y: above y = 0 the origin is upright.
    """
    arm = turned(ship.about, roll)
    memory = ship.radiation.memory
    states = 0 if memory is None else len(memory.matrix)
    return np.concatenate([[ship.about[0], heave + arm[1], roll], np.where(ship.free, velocity, 0.0), np.zeros(states)])


def rate(ship: Ship, state: np.ndarray, time: float, cargo: np.ndarray = NO_LOAD) -> np.ndarray:
    """Time derivative (6 + s,) of a state; `cargo` (3,) is the force and moment about P of what is not fixed."""
    pose, velocity = state[:3], state[3:6]
    y, z = ship.lever(pose[2])
    mass, spin = ship.body.mass, velocity[2]
    force = ship.load.force(pose, time) + cargo - ship.resistance(state)
    force -= ship.rig.spring * (pose - ship.rig.rest)
    force += mass * np.array([spin * spin * y, spin * spin * z - ship.gravity, -ship.gravity * y])
    free = np.flatnonzero(ship.free)
    acceleration = np.zeros(3)
    acceleration[free] = np.linalg.solve(ship.inertia(pose[2])[np.ix_(free, free)], force[free])
    memory = ship.radiation.memory
    if memory is None:
        return np.concatenate([velocity, acceleration])
    return np.concatenate([velocity, acceleration, memory.matrix @ state[6:] + memory.entry @ velocity])


def advance(ship: Ship, state: np.ndarray, time: float, interval: float, cargo: np.ndarray = NO_LOAD) -> np.ndarray:
    """The state an interval (s) later, `cargo` held."""
    return runge_kutta(lambda at, t: rate(ship, at, t, cargo), state, time, interval)


def runge_kutta(slope: Callable, state: np.ndarray, time: float, interval: float) -> np.ndarray:
    """One interval (s) of the classical method of Runge and Kutta (Kutta 1901)."""
    half = 0.5 * interval
    first = slope(state, time)
    second = slope(state + half * first, time + half)
    third = slope(state + half * second, time + half)
    fourth = slope(state + interval * third, time + interval)
    return state + interval / 6.0 * (first + 2.0 * (second + third) + fourth)


@dataclass(frozen=True, eq=False)
class Voyage:
    """States (n, 6 + s) at times (n,) s, the start first.

    `capsized` is when (s) roll passed its limits, `flooded` when an opening went under water, or None.
    """

    time: np.ndarray
    state: np.ndarray
    capsized: float | None
    flooded: float | None = None

    @property
    def roll(self) -> np.ndarray:
        """Roll (n,) rad."""
        return self.state[:, 2]


def sail(
    ship: Ship,
    state: np.ndarray,
    interval: float,
    duration: float,
    limits: tuple[float, float] = (-inf, inf),
    begin: float = 0.0,
    openings: tuple[tuple[float, float], ...] = (),
) -> Voyage:
    """Motion from a state at the time `begin` (s), ended where roll leaves its limits (rad) or an opening (m) is wet.

    Openings are points of the hull, whose load then is a `loads.Floating`.
    Raises `BadState` where it is no longer a number or faster than any ship: the interval is too long for the ship's
    fastest motion or memory.
    """
    count = round(duration / interval)
    states, capsized, flooded = [state], None, None
    for k in range(count):
        state = advance(ship, state, begin + k * interval, interval)
        now = begin + (k + 1) * interval
        if not np.abs(state).max() < BEYOND:
            raise BadState(0, f"the ship's motion ran away at {now:.4g} s; shorten the interval.")
        states.append(state)
        if not limits[0] < state[2] < limits[1]:
            capsized = now
        elif openings and ship.load.depths(openings, state[:3], now).max() > 0.0:
            flooded = now
        if capsized is not None or flooded is not None:
            break
    return Voyage(begin + interval * np.arange(len(states)), np.array(states), capsized, flooded)
