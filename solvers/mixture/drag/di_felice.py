"""Drag of Di Felice, from a single grain to a packed bed."""

import taichi as ti

SLOWEST = 1e-6  # Reynolds number below which drag is linear


class DiFelice:
    """F_d = C_D (π/8) ρ d² ε² |w| w ε^−χ, w = u_f − u_g (Di Felice 1994), as a coefficient.

    C_D = (0.63 + 4.8/√Re)² (Dalla Valle 1948), χ = 3.7 − 0.65 exp(−(1.5 − lg Re)²/2), Re = ρ d ε |w|/μ. A slow grain
    alone in water has 96 % of Stokes' drag; a bed of slow grains settles as ε^4.7.

    Limits: random beds of equal spheres.

    Units: w m/s, d m, ρ kg/m³, μ Pa s; the coefficient kg/(m³ s).
    """

    @staticmethod
    @ti.func
    def coefficient(speed, porosity, size, density, viscosity):
        """β/(1 − ε) at a speed |w|."""
        reynolds = ti.max(density * size * porosity * speed / viscosity, SLOWEST)
        off = 1.5 - ti.log(reynolds) * 0.4342944819
        power = 3.7 - 0.65 * ti.exp(-0.5 * off * off)
        root = 0.63 * ti.sqrt(reynolds) + 4.8
        return 0.75 * viscosity / (size * size) * root * root * porosity ** (1.0 - power)
