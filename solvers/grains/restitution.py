"""Restitution of damped contacts as a function of damping, and the inverse. A contact ends when its force vanishes."""

from collections.abc import Callable
from functools import wraps

# Powers of the overlap ξ to which the damping of a Hertz contact is proportional.
VISCOELASTIC = 0.5  # Brilliantov et al. (1996)
CONSTANT = 0.0  # a linear dashpot
# C of 1 − e = C x for weak damping x, by power: C = 2 (5/4)^q B(q, 3/2)/(5/2), q = 2 (power + 1)/5, from the work of
# the damping along the elastic collision; 1.15344 in Schwager and Pöschel (1998).
FIRST_ORDER = {VISCOELASTIC: 1.15344, CONSTANT: 1.78781}

# What has been solved, by the name of the function, its number and its power; what another process puts in is believed.
solved: dict[tuple[str, float, float], float] = {}


def _solved_once(solve: Callable[[float, float], float]) -> Callable[..., float]:
    @wraps(solve)
    def once(number: float, power: float = VISCOELASTIC) -> float:
        key = solve.__name__, float(number), power
        if key not in solved:
            solved[key] = solve(number, power)
        return solved[key]

    return once


@_solved_once
def restitution(damping: float, power: float = VISCOELASTIC) -> float:
    """Coefficient of restitution of a Hertz contact with a damping x proportional to ξ^power.

    In units of the elastic collision, time (m²/(k² v))^(1/5) and length v times that, the motion is
    ξ̈ = −ξ^(3/2) − x ξ^power ξ̇ from ξ = 0, ξ̇ = 1. For the viscoelastic law x = β v^(1/5) with
    β = (γ_n/m_eff)(m_eff/k)^(3/5).
    """
    from scipy.integrate import solve_ivp  # slow to import, and only making a scene needs it

    def motion(_, state):
        overlap = max(state[0], 0.0)
        return [state[1], -(overlap**1.5) - damping * overlap**power * state[1]]

    def force_ends(t, state):
        return max(state[0], 0.0) ** (1.5 - power) + damping * state[1] if t > 1e-6 else 1.0

    force_ends.terminal, force_ends.direction = True, -1
    path = solve_ivp(
        motion,
        (0.0, 100.0),
        [0.0, 1.0],
        events=force_ends,
        method="DOP853",
        rtol=1e-9,
        atol=1e-12,
        max_step=0.2,
    )
    return -float(path.y[1, -1])


@_solved_once
def damping_for(e: float, power: float = VISCOELASTIC) -> float:
    """The damping x of a Hertz contact that gives restitution e."""
    if e > 1.0 - 1e-4:
        return (1.0 - e) / FIRST_ORDER[power]
    from scipy.optimize import brentq

    return brentq(lambda x: restitution.__wrapped__(x, power) - e, 1e-6, 1e4, xtol=1e-9)


def dissipative_time_for(e: float, speed: float, stiffness: float, mass: float) -> float:
    """The dissipative time A (s) that gives restitution e at an impact speed (m/s), k in N/m^1.5, m_eff in kg."""
    if e >= 1.0:
        return 0.0
    # x = β v^(1/5) with γ_n = (3/2) A k
    return damping_for(e) * speed**-0.2 * (mass / stiffness) ** 0.4 / 1.5


def restitution_from(time: float, speed: float, stiffness: float, mass: float) -> float:
    """The restitution at an impact speed (m/s) that a dissipative time A (s) gives, k in N/m^1.5, m_eff in kg."""
    return restitution(1.5 * time * (stiffness / mass) ** 0.4 * speed**0.2)
