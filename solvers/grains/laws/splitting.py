"""How stiff dampers and springs act on a step that does not resolve them, and how stiff those may be."""

import taichi as ti

from solvers.grains.laws.extremes import greater, lesser, within

# Shares of a contact's own limit m/Δt (damper) and m/Δt² (spring) that stay stable with every neighbour of a grain in
# touch: the contact network's largest eigenvalue is 4.3 for six equal spheres around one in a plane, and the scheme,
# with velocities predicted by half a step, is stable while 4 × damper + spring in these units is less than 4.
AT_ONCE = 0.2
FOLLOWING = 0.02
SPRING = 0.1


def spring_limit(stiffness: float, inertia: float) -> float:
    """The longest step (s) that keeps a spring (N/m or N m) on an inertia (kg or kg m²) stable."""
    return (SPRING * inertia / stiffness) ** 0.5 if stiffness > 0.0 else float("inf")


@ti.func
def lagging(damping, share, velocity, lag, cap):
    """The part of a damper that the step does not resolve, by its last value `lag`.

    A damper γ on `velocity` is split. γ_f = min(γ, 0.2 m/Δt) acts at once; the rest, `damping` = γ − γ_f, acts through
    a first-order low-pass, Ṡ = [(γ − γ_f) u − S]/T, of which each step takes `share` = Δt/T = min(1, 0.02 (m/Δt)/γ),
    so that the step resolves the low-pass's stiffness (γ − γ_f)/T as well. The velocity stops within a few steps, and
    under a lasting load F it is F/γ, the creep of the law itself, whatever the step. A damper with γ < 0.2 m/Δt acts as
    it is.
    """
    return within(lag + share * (damping * velocity - lag), cap)


@ti.func
def felt_rate(overlap, rate, dt):
    """The overlap's rate (m/s) as a dashpot feels it that acts at full strength from the first touch.

    The contact begins somewhere inside a step. With r = ξ/Δt, min(3r/2, max(ξ̇, 2ξ̇ − r/2)) gives a new contact's
    first two kicks together what the dashpot does from the first touch on; after these it is ξ̇. Without it the
    restitution errs in proportion to the step, twelve times as much at 50 steps a collision; and grains that do not
    overlap feel nothing.
    """
    crossed = overlap / dt
    return lesser(1.5 * crossed, greater(rate, 2.0 * rate - 0.5 * crossed))
