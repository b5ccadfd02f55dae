"""Linear springs and dashpots in contacts: their restitution, and how a time step sees them.

A contact begins somewhere inside a step, and its velocities are predicted for the time of the places. What is here is
for all contacts of that kind, of grains and of bodies.
"""

from functools import cache
from math import acos, acosh, exp, log, sqrt

import taichi as ti

from solvers.machine.wide import minus
from solvers.space.extremes import greater, lesser
from solvers.space.tangent import capped


def linear_restitution(ratio: float) -> float:
    """Restitution of a linear spring and dashpot of damping ratio ζ (Schwager and Pöschel 2007).

    e = exp(−2 ζ θ) with θ = arccos ζ/√(1 − ζ²), which is arcosh ζ/√(ζ² − 1) past critical damping.
    """
    root = sqrt(abs(1.0 - ratio * ratio))
    if root < 1e-6:
        return exp(-2.0)
    return exp(-2.0 * ratio * (acos(ratio) if ratio < 1.0 else acosh(ratio)) / root)


@cache
def damping_ratio_for(e: float) -> float:
    """The damping ratio ζ of a linear spring and dashpot that gives restitution e."""
    from scipy.optimize import brentq  # slow to import, and only making a scene needs it

    return brentq(lambda ratio: log(linear_restitution(ratio) / e), 0.0, 1.0 + 1.0 / sqrt(e), xtol=1e-13)


@ti.func
def felt_rate(overlap, rate, dt):
    """Rate of overlap (m/s) for a dashpot that acts at full strength from first touch.

    A contact begins somewhere inside a step. With r = ξ/Δt, min(3r/2, max(ξ̇, 2ξ̇ − r/2)) gives the first two kicks of
    a new contact the total impulse of the dashpot since first touch; afterwards it is ξ̇. Without this correction the
    error of the restitution is proportional to the step, and twelve times as large at 50 steps a collision. Grains that
    do not overlap feel no dashpot.
    """
    crossed = overlap / dt
    return lesser(1.5 * crossed, greater(rate, 2.0 * rate - 0.5 * crossed))


@ti.func
def pressed(spring, dashpot, overlap, rate, dt):
    """F_n (N) = k ξ + γ ξ̇, cut at zero, of a spring k (N/m) and dashpot γ (N s/m) at the overlap ξ (m)."""
    return greater(spring * overlap + dashpot * felt_rate(overlap, rate, dt), 0.0)


@ti.func
def over_the_step(slip, before, ahead):
    """Slip (m/s) over the step that ended, from the predicted one and that over the step before (0: a new contact).

    `ahead` is the share α of a step by which the integrator predicts velocities.
    """
    return ti.select(before == 0.0, slip, (slip + ahead * before) * (1.0 / (1.0 + ahead)))


@ti.func
def stretched(held: ti.template(), spring, overlap, rate, slip: ti.template(), over: ti.template(), cap, dt):
    """The force S (N) that a tangential spring k_t (N/m) holds, Ṡ = k_t u_s under a Coulomb cap (N).

    It held `held` and has slipped at `over` (m/s) in the step that ended or, in the first one of a contact, at `slip`
    since first touch. ξ (m) and ξ̇ (m/s) are the overlap and its rate.
    """
    turns = ti.static(range(len(slip)))
    begins, since = overlap < rate * dt, overlap / rate
    gone = [ti.select(begins, slip[k] * since, over[k] * dt) for k in turns]
    return capped([held[k] + spring * gone[k] for k in turns], cap)


@ti.func
def dragged(held: ti.template(), dashpot, slip: ti.template(), cap):
    """F_t (N) = −(S + γ_t u_s), of at most the Coulomb `cap` (N)."""
    return capped([minus(held[k]) - dashpot * slip[k] for k in ti.static(range(len(slip)))], cap)
