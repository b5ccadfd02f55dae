"""Dampers and springs too stiff for the step: how they are split, and how stiff they may be."""

from math import inf, sqrt

import taichi as ti

from solvers.grains.laws.extremes import greater, lesser, within
from solvers.machine.wide import size

# Shares of a single contact's m/Δt (damper) and m/Δt² (spring) that stay stable if a grain touches all its neighbours.
# The contact network's largest eigenvalue is 4.3 for six equal spheres around one in a plane, and the scheme, with
# velocities predicted by half a step, is stable while 4 × damper + spring in these units is less than 4.
AT_ONCE = 0.2
FOLLOWING = 0.02
SPRING = 0.1
SETTLED = 150.0  # steps: an overlap that would take longer to vanish is at rest, and one in a collision is not


def spring_limit(stiffness: float, inertia: float) -> float:
    """The longest step (s) that keeps a spring (N/m or N m) on an inertia (kg or kg m²) stable."""
    return sqrt(SPRING * inertia / stiffness) if stiffness > 0.0 else inf


def shear_limit(stiffness: float, inertia: float, time: float) -> float:
    """The longest step (s) at which a spring k (N/m) with history and its dashpot A k are stable together in a network.

    A k Δt + k Δt²/4 = 0.2 m, with the dissipative time A (s) and the inertia m (kg).
    """
    return 2.0 * (sqrt(time * time + AT_ONCE * inertia / stiffness) - time) if stiffness > 0.0 else inf


@ti.func
def settled(root, rate, dt):
    """1 for contacts at rest along the normal, from √ξ (√m) and ξ̇ (m/s), and 0 in collisions but for their turning."""
    return ti.select(root * root > SETTLED * dt * size(rate), 1.0 + 0.0 * root, 0.0 * root)


@ti.func
def lagging(damping, share, velocity, lag, room):
    """Force of the part of a damper that the step does not resolve, from its previous value `lag`, within ±`room`.

    A damper γ on `velocity` is split. γ_f = min(γ, 0.2 m/Δt) acts at once; the rest, `damping` = γ − γ_f, acts through
    a first-order low-pass filter, Ṡ = [(γ − γ_f) u − S]/T, with `share` = Δt/T = min(1, 0.02 (m/Δt)/γ) per step, so
    that the step also resolves the filter's stiffness (γ − γ_f)/T. The velocity stops within a few steps, and under a
    lasting load F it is F/γ, the creep of the law itself, whatever the step. A damper with γ < 0.2 m/Δt is not split.

    A new load is followed within T = 50 γ Δt²/m. Until then the contact gives way by F T/γ = 50 F Δt²/m, like a spring:
    beds of 6 mm grains settled and tilted at draft (35 µs, T = 0.06 s, or 0.2 s while grains are slow and steps
    doubled) shift by 0.02 mm until 2 deg, with 12 µs by 0.01 mm. At what angle they slip does not show it (`cargolab
    bench accuracy`).

    The filter is for lasting loads. In a collision of a few tens of steps it would take up the slip before the contact
    sticks, and then drive it the other way. So friction laws give a `share` of zero until the contact has `settled`,
    and as `room` what γ_f leaves of the Coulomb cap (conditional integration, as in controllers).
    """
    return within(lag + share * (damping * velocity - lag), room)


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
