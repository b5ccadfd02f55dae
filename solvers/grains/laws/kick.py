"""Normal forces as the mean over a kick, where a contact begins or ends within one.

Verlet's scheme changes a velocity by Δt F_n, the impulse of a time Δt around the positions. Where F_n has a kink or a
root's start in this time, F at its middle is not the mean, and the error of a restitution falls slowly with the step
and depends on where in a step the contact begins. For a path that is straight over the kick, ξ ± h with h = ξ̇ Δt/2,
the means are known in closed form: the scheme keeps its second order, has no memory, and the moment of first touch no
longer matters. The spring keeps its value at the middle, so that it stays a force with a potential.
"""

import taichi as ti

from solvers.machine.wide import minus
from solvers.space.extremes import greater, lesser


@ti.func
def reached(approach, rate, dt):
    """Overlaps (m), not less than zero, at the end and at the beginning of a kick of Δt (s).

    `approach` is the overlap at the positions (m; negative: a gap) and `rate` its rate (m/s).
    """
    half = (0.5 * dt) * rate
    return greater(approach + half, 0.0), greater(approach - half, 0.0)


@ti.func
def cut_at_zero(spring, damper, rise):
    """Mean over a kick of max(F, 0), for the force F of spring and damper (N), which changes by 2 `rise` (N) in it.

    Dry grains do not attract, so a contact ends where its force vanishes, with the damper pulling. Where a falling line
    crosses zero within the kick, |F| < δ, its mean above zero is (F + δ)²/(4δ). Here it is max(F, (F + δ)/4), without a
    division; over all moments at which a contact may end both come to the same impulse, (2/3) δ². δ is at most what the
    damper pulls, so that a spring alone keeps its potential.
    """
    force, fall = spring + damper, lesser(greater(minus(rise), 0.0), greater(minus(damper), 0.0))
    return greater(greater(force, 0.25 * (force + fall)), 0.0)
