"""Diffusion of density without corrections."""


class Molteni:
    """ψ = 2 (ρ_j − ρ_i) r_ji/r² (Molteni & Colagrossi 2009, eq. 12): diffusion of density without corrections.

    Limits: at a free surface it diffuses the hydrostatic profile, too: a resting surface creeps up.

    Units: ψ kg/m⁴, ρ kg/m³, r m.
    """

    acts = True
    renormalised = False
    dynamic = False
