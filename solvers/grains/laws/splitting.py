"""Dampers and springs too stiff for the step: how they are split, and how stiff they may be."""

from math import inf, sqrt

import taichi as ti

from solvers.machine.quantity import PLANE, SPACE
from solvers.space.extremes import greater
from solvers.space.tangent import capped

# Shares of a single contact's m/Δt (damper) and m/Δt² (spring) that stay stable if a grain touches all its neighbours.
# The contacts of a grain act on it together: a network of them is as stiff as one contact times the largest eigenvalue
# of J M⁻¹ Jᵀ, with J from the velocities and spins of the grains to the slips of the contacts, each weighed by the root
# of its own m_t = (2/7) m_eff. A contact counts with (5/7) m_eff/m to each of its grains; by Gershgorin's theorem these
# come to 4.3 at most where equal spheres touch six others each in a plane. It is no more where sizes and densities
# differ (by eigenvalues): to a small grain each contact counts up to twice, but it has no room for six larger ones; to
# a large one many small grains count little. With velocities predicted by half a step a damper is stable up to m/Δt,
# and with a spring with history while 4 × damper + spring is less than 4. The split damper (`lagging`) is stable while
# 2 × PROMPT + FOLLOWING is less than 2, here in networks up to 5.
AT_ONCE = 0.2
SPRING = 0.1
PROMPT, FOLLOWING = 0.1, 0.2
# What a network in space bears of all this: in the densest packing a sphere touches twelve others. There the largest
# eigenvalue is 40/7 for slips and 4 for the normals of contacts, in the plane 30/7 and 3 (by eigenvalues of crystals
# that grow; packings by chance, squeezed by up to a fifth and of sizes up to 1 to 10, stay below: 5.1 and 3.8).
NETWORK = {PLANE: 1.0, SPACE: 0.75}
SMALLEST_OVERLAP = 1e-30  # m; keeps the division finite in contacts with a gap


def spring_limit(stiffness: float, inertia: float, network: float) -> float:
    """The longest step (s) that keeps a spring (N/m or N m) on an inertia (kg or kg m²) stable in a `network`."""
    return sqrt(network * SPRING * inertia / stiffness) if stiffness > 0.0 else inf


def shear_limit(stiffness: float, inertia: float, time: float, network: float) -> float:
    """The longest step (s) at which a spring k (N/m) with history and its dashpot A k are stable together in a network.

    A k Δt + k Δt²/4 = 0.2 m, of m what the `network` bears, with the dissipative time A (s) and the inertia m (kg).
    """
    return 2.0 * (sqrt(time * time + network * AT_ONCE * inertia / stiffness) - time) if stiffness > 0.0 else inf


@ti.func
def relieved(root, rate, dt):
    """Share of its load that a Hertz contact keeps over a step, ξ^(3/2) now over that before, at most 1.

    From √ξ (√m) and ξ̇ (m/s).
    """
    overlap = root * root
    kept = overlap / (overlap + greater((0.0 - dt) * rate, 0.0) + SMALLEST_OVERLAP)
    return kept * ti.sqrt(kept)


@ti.func
def lagging(damping, share, velocity, lag, room):
    """Force of the part of a damper that the step does not resolve, from its previous value `lag`, capped at `room`.

    Velocity and forces are vectors (`solvers.space.tangent`).

    A damper γ on `velocity` is split. γ_f = min(γ, 0.1 m/Δt) acts at once; the rest, `damping` = γ − γ_f, acts through
    a first-order low-pass filter, Ṡ = [(γ − γ_f) u − S]/T, with `share` = Δt/T = min(1, 0.2 (m/Δt)/γ) per step, so
    that the step also resolves the filter's stiffness (γ − γ_f)/T. The velocity stops within a few steps, and under a
    lasting load F it is F/γ, the creep of the law itself, whatever the step. A damper with γ < 0.1 m/Δt is not split.

    A new load is followed within T = 5 γ Δt²/m. Until then the contact gives way by F T/γ = 5 F Δt²/m, like a spring k
    = 0.2 m/Δt², several times as stiff as the normal contact at the derived step. What this spring holds, S²/(2 k), is
    not the law's: a damper returns nothing. So where a load goes, S has to go with it. Friction laws give as `lag` the
    previous S times what the contact has kept of its normal force (`relieved`), as springs with history shrink with
    their stiffness (Thornton, Cummins and Cleary 2013), and as `room` what γ_f leaves of the Coulomb cap (conditional
    integration, as in controllers). The work of friction on the grains then rises by no more than S²/(2 k) ≤ (μ F_n
    Δt)²/(0.4 m) in a contact that still bears F_n, and never for good.
    """
    turns = ti.static(range(len(lag)))
    return capped([lag[k] + share * (damping * velocity[k] - lag[k]) for k in turns], room)
