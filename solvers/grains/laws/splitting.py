"""Dampers and springs too stiff for the step: how they are split, and how stiff they may be."""

import taichi as ti

from solvers.grains.laws.extremes import greater, lesser, within

# Shares of a single contact's m/Δt (damper) and m/Δt² (spring) that stay stable if a grain touches all its neighbours.
# The contact network's largest eigenvalue is 4.3 for six equal spheres around one in a plane, and the scheme, with
# velocities predicted by half a step, is stable while 4 × damper + spring in these units is less than 4.
AT_ONCE = 0.2
FOLLOWING = 0.02
SPRING = 0.1


def spring_limit(stiffness: float, inertia: float) -> float:
    """The longest step (s) that keeps a spring (N/m or N m) on an inertia (kg or kg m²) stable."""
    return (SPRING * inertia / stiffness) ** 0.5 if stiffness > 0.0 else float("inf")


@ti.func
def lagging(damping, share, velocity, lag, cap):
    """Force of the part of a damper that the step does not resolve, from its previous value `lag`, within ±`cap`.

    A damper γ on `velocity` is split. γ_f = min(γ, 0.2 m/Δt) acts at once; the rest, `damping` = γ − γ_f, acts through
    a first-order low-pass filter, Ṡ = [(γ − γ_f) u − S]/T, with `share` = Δt/T = min(1, 0.02 (m/Δt)/γ) per step, so
    that the step also resolves the filter's stiffness (γ − γ_f)/T. The velocity stops within a few steps, and under a
    lasting load F it is F/γ, the creep of the law itself, whatever the step. A damper with γ < 0.2 m/Δt is not split.
    """
    return within(lag + share * (damping * velocity - lag), cap)


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
