"""Diffusion of the dynamic part of the density."""


class Fourtakas:
    """ψ = 2 (ρ_j − ρ_i − ρ^H_ij) r_ji/r² with the hydrostatic difference ρ^H_ij = ρ0 g·r_ji/c0².

    Fourtakas, Dominguez, Vacondio & Rogers (2019), eq. 16, for the linear equation of state and gravity alone: it costs
    less than gradients, but water at rest in an accelerated tank is diffused a little.
    """

    acts = True
    renormalised = False
    dynamic = True
