"""Single collisions of two spheres, or of a sphere and a plane: the contact laws integrated without the solver.

Positions and velocities are those of the first body relative to the second. The normal points to the first body and the
tangent is the normal turned counter-clockwise by 90°, so that the slip is u = v·t − (ℓ₁ ω₁ + ℓ₂ ω₂). The lever arms
reach to where the undeformed outlines cross, to first order; a sphere's on a plane is R − ξ/2.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import inf, sqrt

import numpy as np
from scipy.integrate import solve_ivp

LONGEST = 50.0  # times depth over speed of the elastic collision, which itself takes 2.94
STICK, FORWARDS, BACKWARDS = 0.0, 1.0, -1.0  # what the spring does: it holds, or slides at the cap
Y, Z, V_Y, V_Z, SPIN, OTHER_SPIN, SPRUNG = range(7)
NO_OVERLAP = 1e-30  # m, keeps roots finite


@dataclass(frozen=True)
class Bodies:
    """Radii (m) and masses (kg) of two spheres; without `other_radius` the second one is a plane below."""

    radius: float
    mass: float
    other_radius: float = 0.0
    other_mass: float = inf

    @property
    def m_eff(self) -> float:
        """1/(1/m₁ + 1/m₂) in kg."""
        return 1.0 / (1.0 / self.mass + 1.0 / self.other_mass)

    def contact(self, state: np.ndarray) -> tuple:
        """Overlap (m), its rate, slip (m/s), normal (2,), levers (2,) m and what turning adds to ξ̈ (m/s²)."""
        v = state[V_Y : V_Z + 1]
        if not self.other_radius:
            n, overlap = np.array([0.0, 1.0]), self.radius - state[Z]
            levers, bent = (self.radius - 0.5 * overlap, 0.0), 0.0
        else:
            distance = sqrt(state[Y] ** 2 + state[Z] ** 2)
            n, reach = state[Y : Z + 1] / distance, self.radius + self.other_radius
            overlap = reach - distance
            first = self.radius / reach * (reach + overlap) - overlap
            levers = first, distance - first
            bent = -((v[1] * n[0] - v[0] * n[1]) ** 2) / distance
        slip = v[1] * n[0] - v[0] * n[1] - (levers[0] * state[SPIN] + levers[1] * state[OTHER_SPIN])
        return overlap, -(v @ n), slip, n, levers, bent

    def moved(self, state: np.ndarray, n: np.ndarray, levers: tuple, pressing: float, shearing: float) -> list[float]:
        """Rates of place, velocity and spins under both forces (N) on the first body."""
        spin_up = -levers[0] * shearing / (0.4 * self.mass * self.radius**2)
        other = -levers[1] * shearing / (0.4 * self.other_mass * self.other_radius**2) if self.other_radius else 0.0
        push = (pressing * n + shearing * np.array([-n[1], n[0]])) / self.m_eff
        return [state[V_Y], state[V_Z], push[0], push[1], spin_up, other]


@dataclass(frozen=True)
class Normal:
    """F_n = k ξ^p + c ξ^q ξ̇, never less than zero.

    Hertz p = 3/2, with viscoelastic damping q = 1/2, with a dashpot q = 0; linear p = 1, q = 0.
    """

    stiffness: float
    damping: float = 0.0
    power: float = 1.5
    damping_power: float = 0.5

    def force(self, overlap: float, rate: float) -> float:
        """N."""
        overlap = max(overlap, 0.0)
        damped = self.damping * overlap**self.damping_power * rate if overlap > 0.0 else 0.0
        return max(0.0, self.stiffness * overlap**self.power + damped)

    def growth(self, overlap: float, rate: float, bending: float) -> float:
        """dF_n/dt (N/s) at ξ, ξ̇ and ξ̈."""
        p, q, xi = self.power, self.damping_power, max(overlap, NO_OVERLAP)
        changed = q * xi ** (q - 1.0) * rate**2 + xi**q * bending
        return self.stiffness * p * xi ** (p - 1.0) * rate + self.damping * changed

    def ends(self, overlap: float, rate: float) -> float:
        """Zero where the force vanishes."""
        return self.stiffness * max(overlap, 0.0) ** (self.power - self.damping_power) + self.damping * rate


@dataclass(frozen=True)
class Shear:
    """F_t = −(S + γ u) within ± μ F_n, Ṡ = k_t u with k_t = `stiffness` ξ^`power`, and γ = `time` k_t + `damper`.

    Mindlin's spring has the power 1/2 and loses S |ξ̇|/(2 ξ) while the contact unloads; Cundall and Strack's has 0.
    Haff and Werner's damper is alone.
    """

    friction: float
    stiffness: float = 0.0
    power: float = 0.5
    time: float = 0.0
    damper: float = 0.0

    def spring(self, overlap: float) -> float:
        """k_t (N/m)."""
        return self.stiffness * max(overlap, NO_OVERLAP) ** self.power

    def winding(self, overlap: float, rate: float, slip: float, sprung: float) -> float:
        """Ṡ (N/s) of a spring that holds S (N)."""
        shrinking = self.power * sprung * rate / max(overlap, NO_OVERLAP) if rate < 0.0 else 0.0
        return self.spring(overlap) * slip + shrinking


@dataclass(frozen=True)
class Impact:
    """What comes of two bodies that touch with the velocity (y, z) m/s and spins (rad/s) of `meet`."""

    bodies: Bodies
    normal: Normal
    shear: Shear

    def meet(self, along: float, down: float, spins: tuple[float, float] = (0.0, 0.0)) -> np.ndarray:
        """Relative velocity along y and z (m/s) and both spins (rad/s) after an impact from above.

        The first body comes down on the second at `down` and moves by `along` in y. By DOP853 at 1e-11, which stops
        where the spring begins or ends to slide, or for a damper alone, which may be far stiffer than the collision, by
        Radau at 1e-10.
        """
        reach = self.bodies.radius + self.bodies.other_radius
        state = np.array([0.0, reach, along, -down, *spins, 0.0])
        power = self.normal.power + 1.0
        deepest = (0.5 * power * self.bodies.m_eff * down**2 / self.normal.stiffness) ** (1.0 / power)
        return (self._sprung if self.shear.stiffness else self._damped)(state, deepest, down)[V_Y:SPRUNG]

    def _damped(self, state: np.ndarray, deepest: float, down: float) -> np.ndarray:
        faster = abs(state[V_Y]) + down + self.bodies.radius * abs(state[SPIN])
        spin = faster / self.bodies.radius
        scales = np.array([deepest, deepest, faster, down, spin, spin, 1.0])
        span, ends = (0.0, LONGEST * deepest / down), [self._force_ends()]
        path = solve_ivp(self._motion(STICK), span, state, "Radau", events=ends, rtol=1e-10, atol=1e-11 * scales)
        return path.y[:, -1]

    def _sprung(self, state: np.ndarray, deepest: float, down: float) -> np.ndarray:
        time, mode, last = 0.0, STICK, LONGEST * deepest / down
        faster = abs(state[V_Y]) + down + self.bodies.radius * abs(state[SPIN])
        force = self.normal.stiffness * deepest**self.normal.power
        spin = faster / self.bodies.radius
        scales = np.array([deepest, deepest, faster, down, spin, spin, force])
        while True:
            path = solve_ivp(
                self._motion(mode),
                (time, last),
                state,
                "DOP853",
                events=[self._force_ends(), *self._changes(mode)],
                rtol=1e-11,
                atol=1e-12 * scales,
                max_step=0.05 * deepest / down,
            )
            time, state = path.t[-1], path.y[:, -1].copy()
            if len(path.t_events[0]) or time >= last:
                return state
            if mode == STICK:
                mode = FORWARDS if len(path.t_events[1]) else BACKWARDS
            else:
                overlap, rate = self.bodies.contact(state)[:2]
                state[SPRUNG], mode = mode * self.shear.friction * self.normal.force(overlap, rate), STICK

    def _motion(self, mode: float) -> Callable:
        def motion(_, state):
            overlap, rate, slip, n, levers, _bent = self.bodies.contact(state)
            pressing = self.normal.force(overlap, rate)
            cap = self.shear.friction * pressing
            spring = state[SPRUNG] if mode == STICK else mode * cap
            damping = self.shear.time * self.shear.spring(overlap) + self.shear.damper
            rates = self.bodies.moved(state, n, levers, pressing, -min(max(spring + damping * slip, -cap), cap))
            return [*rates, self.shear.winding(overlap, rate, slip, spring) if mode == STICK else 0.0]

        return motion

    def _changes(self, mode: float) -> list[Callable]:
        """Events at which a sticking spring reaches the friction limit, or a sliding one sticks again."""

        def room(side: float) -> Callable:
            def event(_, state):
                overlap, rate = self.bodies.contact(state)[:2]
                return self.shear.friction * self.normal.force(overlap, rate) - side * state[SPRUNG]

            return event

        def slides_on(_, state):
            overlap, rate, slip, _n, _levers, bent = self.bodies.contact(state)
            pressing = self.normal.force(overlap, rate)
            growth = self.normal.growth(overlap, rate, bent - pressing / self.bodies.m_eff)
            winding = self.shear.winding(overlap, rate, slip, mode * self.shear.friction * pressing)
            return mode * winding - self.shear.friction * growth

        events = [room(FORWARDS), room(BACKWARDS)] if mode == STICK else [slides_on]
        for event in events:
            event.direction, event.terminal = -1, True
        return events

    def _force_ends(self) -> Callable:
        def event(time, state):
            overlap, rate = self.bodies.contact(state)[:2]
            return self.normal.ends(overlap, rate) if time > 0.0 else 1.0

        event.direction, event.terminal = -1, True
        return event
