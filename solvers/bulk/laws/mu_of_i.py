"""Friction that grows with the inertial number."""

import taichi as ti


@ti.data_oriented
class MuOfI:
    """|s| = μ(I) p with μ(I) = μ_s + (μ_2 − μ_s) / (1 + I_0/I), I = γ̇ d √(ρ_s/p) (Jop, Forterre & Pouliquen 2006).

    The shear rate γ̇ is that of the plastic part of a step, (|s_t| − |s|)/(G Δt) of the shear stress s_t that was tried
    elastically. With α = G Δt √p I_0/(d √ρ_s) the stress is then the smaller root of
    |s|² − (α + |s_t| + μ_2 p) |s| + μ_s p α + μ_2 p |s_t| = 0, which follows from the two (the return mapping of
    Dunatunga & Kamrin 2015 in closed form).

    Limits: a local law. Layers of a few grains, and beds about to start, hold more (Kamrin & Henann 2014).

    Units: stresses in Pa, γ̇ in 1/s, d in m, ρ_s, of a grain's own matter, in kg/m³; μ_s, μ_2, I_0 and I have none.
    """

    @ti.func
    def held(self, tried, pressure, friction, faster, share):
        """The shear stress (Pa) that stays of one that was `tried`; `share` √p is α, `faster` μ_2."""
        slow, fast, alpha = friction * pressure, faster * pressure, share * ti.sqrt(pressure)
        whole = fast + tried + alpha
        product = fast * tried + slow * alpha
        return 2.0 * product / (whole + ti.sqrt(ti.max(whole * whole - 4.0 * product, 0.0)))
