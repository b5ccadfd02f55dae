"""Diffusion of density, corrected by renormalised gradients."""


class Antuono:
    """ψ = (2 (ρ_j − ρ_i) − (G_i + G_j)·r_ji) r_ji/r² (Antuono, Colagrossi, Marrone & Molteni 2010, eq. 8).

    δ h c0 Σ V_j ψ·∇W is added to dρ/dt. G is the renormalised gradient of density, exact for linear fields: water at
    rest is not diffused, up to the surface itself (Antuono, Colagrossi & Marrone 2012).

    Limits: G is half a step old, and zero in spray, where its matrix is singular; it costs a third of a pass over
    pairs. G_i is the gradient that fits the neighbours' densities best, weighted with V_j |∇W|/r, and the power that is
    taken goes with Σ_i V_i Σ_j V_j (ρ_j − ρ_i − G_i·r_ji)² |∇W|/r: never negative, but next to nothing of smooth waves.

    Units: ψ kg/m⁴, ρ kg/m³, r m.
    """

    acts = True
    renormalised = True  # G is computed and used
    dynamic = False  # the hydrostatic part is taken off
