"""Diffusion of the dynamic part of the density."""


class Fourtakas:
    """ψ = 2 (ρ_j − ρ_i − ρ_H) r_ji/r² (Fourtakas, Dominguez, Vacondio & Rogers 2019, eq. 16), ρ_H = ρ0 g·r_ji/c0².

    The hydrostatic difference is taken off, which costs less than gradients.

    Limits: the linear equation of state, and gravity alone: water at rest in an accelerated tank is diffused a little.
    Waves are damped more than with gradients: a standing wave of 20 layers by a further 0.3 % of the critical damping.

    Units: ψ kg/m⁴, ρ kg/m³, r m.
    """

    acts = True
    renormalised = False
    dynamic = True
