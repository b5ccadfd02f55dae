"""Linear spring and dashpot."""

from math import pi, sqrt

import taichi as ti

from solvers.grains.laws.linear_spring import spring_coefficient, spring_stiffness
from solvers.grains.materials import Interface, hertz_stiffness
from solvers.machine.limit import Limit
from solvers.machine.wide import entry
from solvers.space.impact import damping_ratio_for, pressed

# Steps per half undamped period, at least and times ζ: measured with `felt_rate`, restitution 0.02 … 1 right to 0.1 %.
STEPS, DAMPED_STEPS = 52.0, 240.0


@ti.data_oriented
class Linear:
    """F_n = k_l ξ + γ_n ξ̇, cut at zero (Cundall and Strack 1979; Spandonidis 2016, table 4.1, first row).

    k_l is such that at the restitution speed the largest overlap equals that of elastic Hertz contact. γ_n =
    2 ζ √(k_l m_eff), with ζ from the restitution of a contact that ends when its force vanishes (Schwager and Pöschel
    2007). The restitution is the same at every speed and size, the duration at every speed.

    Limits: real grains stiffen as they are pressed; a bed under a load other than that of an impact at the restitution
    speed is too soft or too stiff. The restitution does not depend on the speed, unlike that of real grains.

    Units: F_n N, ξ m, ξ̇ m/s, k_l N/m, γ_n N s/m, m_eff kg, ζ a pure number.
    """

    wide = True
    constants = ("spring", "dashpot")
    memory = ()

    def coefficients(self, between: Interface) -> list[float]:
        """[k_l's coefficient, 2 ζ]."""
        return [spring_coefficient(between.restitution_speed), 2.0 * damping_ratio_for(between.restitution)]

    def limits(self, between: Interface, mass: float, radius: float, speed: float) -> list[Limit]:
        """Longest steps (s) and what sets them."""
        coefficient, twice_ratio = self.coefficients(between)
        stiffness = spring_stiffness(coefficient, hertz_stiffness(between.young_modulus, radius), mass)
        steps = max(STEPS, DAMPED_STEPS * 0.5 * twice_ratio)
        return [Limit(pi * sqrt(mass / stiffness) / steps, f"1/{steps:.0f} of the undamped collision")]

    def deepest(self, between: Interface, mass: float, radius: float, speed: float) -> float:
        """Largest overlap (m) of a head-on impact without losses, v √(m/k_l)."""
        coefficient = spring_coefficient(between.restitution_speed)
        stiffness = spring_stiffness(coefficient, hertz_stiffness(between.young_modulus, radius), mass)
        return speed * sqrt(mass / stiffness)

    @ti.func
    def prepare(self, c: ti.template(), stiffness, mass, radius, dt):
        """k_l (N/m), γ_n (N s/m)."""
        spring = spring_stiffness(c[0], stiffness, mass)
        return ti.Vector([spring, c[1] * ti.sqrt(spring * mass)])

    @ti.func
    def force(self, c: ti.template(), contacts: ti.template(), w, block, approach, overlap, root, rate, dt):
        """F_n (N) of a block of contacts from the overlap ξ (m) and its rate ξ̇ (m/s)."""
        return pressed(contacts.spring[w, block], contacts.dashpot[w, block], overlap, rate, dt)

    @ti.func
    def energy(self, contacts: ti.template(), w, block, lane, overlap, root):
        """Elastic energy k_l ξ²/2 (J) of one contact."""
        return 0.5 * entry(contacts.spring, w, block, lane) * overlap * overlap
