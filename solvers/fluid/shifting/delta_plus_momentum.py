"""Shifting of the δ+ scheme with the momentum that goes with it."""

from solvers.fluid.shifting.delta_plus import DeltaPlus


class DeltaPlusMomentum(DeltaPlus):
    """m_i du_i/dt += Σ V_i V_j (ρ_j w_j δu_j + ρ_i w_i δu_i)·∇W (Sun, Colagrossi, Marrone, Antuono & Zhang 2019).

    δu as of `delta-plus`, but zero within 2 h of a free surface, where sums are not those of a liquid: the same flux
    with a shift along the surface slows the corners of a turning square patch by a quarter. A particle that is shifted
    comes to where the water has another velocity; the momentum that its shift carries away flows back from its
    neighbours. Fluxes between pairs are equal and opposite, so that momentum is kept to rounding; moment of momentum is
    to the error of sums over neighbours. w is the velocity over that of the tank's origin: particles keep their masses,
    so that the flux of a velocity that all have in common is not quite zero, and water must not feel how fast its tank
    moves. The like terms of density, as small as the compression, are left out.

    Limits: volume and energy are not corrected. Exchange of mass as well (Antuono, Sun, Marrone & Colagrossi 2021) made
    masses differ by a factor of ten within two radians of the patch, and is not offered.

    Units: δu and w m/s.
    """

    carries = True
