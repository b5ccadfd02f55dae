"""Restitution of viscoelastic spheres, and the dissipative time that gives it (Brilliantov et al. 1996)."""

from functools import cache


def restitution(beta_v: float) -> float:
    """Coefficient of restitution of the viscoelastic law against x = β v^(1/5).

    β = (γ_n/m_eff)(m_eff/k)^(3/5). In units of the elastic collision the motion is ξ̈ = −ξ^(3/2) − x ξ^(1/2) ξ̇ from
    ξ = 0, ξ̇ = 1; the contact ends where the force does.
    """
    from scipy.integrate import solve_ivp  # slow to import, and only scenes that give a restitution need it

    def motion(_, state):
        overlap = max(state[0], 0.0)
        return [state[1], -(overlap**1.5) - beta_v * overlap**0.5 * state[1]]

    def force_ends(t, state):
        return state[0] + beta_v * state[1] if t > 1e-6 else 1.0

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


@cache
def damping_for(e: float) -> float:
    """The x = β v^(1/5) that gives restitution e < 1; near 1, e = 1 − 1.15344 x (Schwager and Pöschel 1998)."""
    if e > 1.0 - 1e-4:
        return (1.0 - e) / 1.15344
    from scipy.optimize import brentq

    return brentq(lambda x: restitution(x) - e, 1e-6, 1e4, xtol=1e-9)


def dissipative_time_for(e: float, speed: float, stiffness: float, mass: float) -> float:
    """The dissipative time A (s) that gives restitution e at an impact speed (m/s), k in N/m^1.5, m_eff in kg."""
    if e >= 1.0:
        return 0.0
    # x = β v^(1/5) with γ_n = (3/2) A k
    return damping_for(e) * speed**-0.2 * (mass / stiffness) ** 0.4 / 1.5
