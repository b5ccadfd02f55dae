"""A sphere thrown at a rigid wall under a law of friction, integrated on its own: the law as it is written.

Positive along the wall is the way it comes; its spin is positive where it rolls backwards, so that the slip of its
lowest point is u = v + ℓ ω, with the lever ℓ = R − ξ/2. Normal force: viscoelastic Hertz, until it vanishes.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import sqrt

import numpy as np
from scipy.integrate import solve_ivp

LONGEST = 50.0  # times depth over speed of the elastic collision, which itself takes 2.94
STICK, FORWARDS, BACKWARDS = 0.0, 1.0, -1.0  # what the spring does: it holds, or slides at the cap


@dataclass(frozen=True)
class Sphere:
    """A sphere and the law at the wall: radius (m), mass (kg), k (N/m^1.5), A (s) and friction μ.

    Mindlin's spring is k_t = `shear` √ξ, with `shear` = 8 G* √R in N/m^1.5; Haff and Werner's damper γ_s is in N s/m.
    """

    radius: float
    mass: float
    stiffness: float
    dissipative_time: float
    friction: float
    shear: float = 0.0
    damper: float = 0.0

    def pressing(self, overlap: float, rate: float) -> float:
        """Normal force (N), k √ξ (ξ + (3/2) A ξ̇), which does not pull."""
        root = sqrt(max(overlap, 0.0))
        return max(0.0, self.stiffness * root * (overlap + 1.5 * self.dissipative_time * rate))

    def slip(self, state: np.ndarray) -> float:
        """u (m/s) of the state ξ, ξ̇, v, ω …"""
        return state[2] + (self.radius - 0.5 * state[0]) * state[3]

    def moved(self, state: np.ndarray, pressing: float, shearing: float) -> list[float]:
        """Rates of ξ, ξ̇, v, ω under both forces (N)."""
        lever = self.radius - 0.5 * state[0]
        turning = lever * shearing / (0.4 * self.mass * self.radius**2)
        return [state[1], -pressing / self.mass, shearing / self.mass, turning]


def viscous_impact(ball: Sphere, down: float, along: float, deepest: float) -> tuple[float, float]:
    """Speed (m/s) along the wall and spin (rad/s) after an impact under F_t = −min(γ_s |u|, μ F_n) sign u.

    `down`, `along`: the speeds before (m/s); `deepest`: a length of the size of the overlap (m). By Radau at 1e-10:
    the damper may be far stiffer than the collision.
    """

    def motion(_, state):
        pressing = ball.pressing(state[0], state[1])
        cap = ball.friction * pressing
        return ball.moved(state, pressing, -min(max(ball.damper * ball.slip(state), -cap), cap))

    end = solve_ivp(
        motion,
        (0.0, LONGEST * deepest / down),
        [0.0, down, along, 0.0],
        "Radau",
        events=_force_ends(ball),
        rtol=1e-10,
        atol=[1e-10 * deepest, 1e-10 * down, 1e-12 * along, 1e-12 * along / ball.radius],
    )
    return end.y[2, -1], end.y[3, -1]


def sprung_impact(ball: Sphere, down: float, along: float, deepest: float) -> tuple[float, float]:
    """Speed (m/s) along the wall and spin (rad/s) after an impact under Mindlin's spring with history.

    F_t = −(S + A k_t u) within ± μ F_n, Ṡ = k_t u, less S |ξ̇|/(2 ξ) while the contact unloads, and S itself within
    the cap: it either holds or slides at the cap, and the integration (DOP853 at 1e-11) stops where that changes.
    """
    time, state, mode = 0.0, np.array([0.0, down, along, 0.0, 0.0]), STICK
    last = LONGEST * deepest / down
    tolerances = [1e-11 * deepest, 1e-11 * down, 1e-12 * along, 1e-12 * along / ball.radius, 1e-11 * ball.mass]
    while True:
        path = solve_ivp(
            _sprung_motion(ball, mode),
            (time, last),
            state,
            "DOP853",
            events=[_force_ends(ball), *_changes(ball, mode)],
            rtol=1e-11,
            atol=tolerances,
            max_step=0.05 * deepest / down,
        )
        time, state = path.t[-1], path.y[:, -1].copy()
        if len(path.t_events[0]):
            return state[2], state[3]
        if mode == STICK:
            mode = FORWARDS if len(path.t_events[1]) else BACKWARDS
        else:
            state[4], mode = mode * ball.friction * ball.pressing(state[0], state[1]), STICK


def _sprung_motion(ball: Sphere, mode: float) -> Callable:
    def motion(_, state):
        pressing = ball.pressing(state[0], state[1])
        cap = ball.friction * pressing
        spring = state[4] if mode == STICK else mode * cap
        dashpot = ball.dissipative_time * ball.shear * sqrt(max(state[0], 0.0)) * ball.slip(state)
        rates = ball.moved(state, pressing, -min(max(spring + dashpot, -cap), cap))
        return [*rates, _winding(ball, state, spring) if mode == STICK else 0.0]

    return motion


def _winding(ball: Sphere, state: np.ndarray, spring: float) -> float:
    """Ṡ (N/s) of a spring that holds."""
    overlap = max(state[0], 1e-30)
    wound = ball.shear * sqrt(overlap) * ball.slip(state)
    return wound + (spring * state[1] / (2.0 * overlap) if state[1] < 0.0 else 0.0)


def _changes(ball: Sphere, mode: float) -> list[Callable]:
    """Where a spring that holds reaches the cap on either side, or one that slides comes to hold."""

    def room(side: float) -> Callable:
        def event(_, state):
            return ball.friction * ball.pressing(state[0], state[1]) - side * state[4]

        return event

    def slides_on(_, state):
        overlap, rate = max(state[0], 1e-30), state[1]
        pressing = ball.pressing(overlap, rate)
        slowing, damping = -pressing / ball.mass, 1.5 * ball.dissipative_time
        root = sqrt(overlap)
        growth = ball.stiffness * (1.5 * root * rate + damping * (0.5 * rate**2 / root + root * slowing))
        return mode * _winding(ball, state, mode * ball.friction * pressing) - ball.friction * growth

    events = [room(FORWARDS), room(BACKWARDS)] if mode == STICK else [slides_on]
    for event in events:
        event.direction, event.terminal = -1, True
    return events


def _force_ends(ball: Sphere) -> Callable:
    def event(time, state):
        return state[0] + 1.5 * ball.dissipative_time * state[1] if time > 0.0 else 1.0

    event.direction, event.terminal = -1, True
    return event
