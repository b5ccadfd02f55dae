"""Hysteretic contact: stiffer in unloading than in loading, for grains that yield."""

from math import pi, sqrt

import taichi as ti

from solvers.grains.laws.linear_spring import spring_coefficient, spring_stiffness
from solvers.grains.materials import Interface, hertz_stiffness
from solvers.machine.limit import Limit
from solvers.machine.wide import entry
from solvers.space.extremes import greater

STEPS = 36.0  # per half period of the stiffer, unloading spring; restitution 0.02 … 1 is right to 0.1 %


@ti.data_oriented
class Hysteretic:
    """F_n = k₁ ξ in first loading, k₂ (ξ − ξ₀) in unloading and reloading (Walton and Braun 1986).

    Spandonidis (2016), table 4.1, fifth row. The force is never less than zero. k₁/k₂ = e², so the restitution is e at
    every speed and size; k₁ is such that at the restitution speed the largest overlap equals that of elastic Hertz
    contact. The memory is the plastic overlap ξ₀ = (1 − e²) ξ_max, so that F_n = k₂ (ξ − ξ₀) in loading and unloading;
    it is reset when the grains separate. A small vibration about a load stays on the k₂ line without loss.

    Limits: grains that yield at every impact, by a share that does not depend on its speed; the plastic overlap is
    forgotten as soon as two grains part, so no flat spot stays.

    Units: F_n N, ξ and ξ₀ m, k₁ and k₂ N/m, e a pure number.
    """

    wide = True
    constants = ("unloading",)
    memory = ("plastic",)

    def coefficients(self, between: Interface) -> list[float]:
        """[k₂'s coefficient, 1 − e²]."""
        kept = between.restitution**2
        return [spring_coefficient(between.restitution_speed) / kept, 1.0 - kept]

    def limits(self, between: Interface, mass: float, radius: float, speed: float) -> list[Limit]:
        """Longest steps (s) and what sets them."""
        stiffness = hertz_stiffness(between.young_modulus, radius)
        unloading = spring_stiffness(self.coefficients(between)[0], stiffness, mass)
        return [Limit(pi * sqrt(mass / unloading) / STEPS, f"1/{STEPS:.0f} of half the unloading spring's period")]

    def deepest(self, between: Interface, mass: float, radius: float, speed: float) -> float:
        """Largest overlap (m) of a head-on impact at a speed (m/s), v √(m/k₁)."""
        coefficient = spring_coefficient(between.restitution_speed)
        stiffness = spring_stiffness(coefficient, hertz_stiffness(between.young_modulus, radius), mass)
        return speed * sqrt(mass / stiffness)

    @ti.func
    def prepare(self, c: ti.template(), stiffness, mass, radius, dt):
        """k₂ (N/m)."""
        return ti.Vector([spring_stiffness(c[0], stiffness, mass)])

    @ti.func
    def force(self, c: ti.template(), contacts: ti.template(), w, block, approach, overlap, root, rate, dt):
        """F_n (N) of a block of contacts from the overlap ξ (m)."""
        plastic = greater(contacts.plastic[w, block], c[1] * overlap)
        plastic = ti.select(overlap > 0.0, plastic, 0.0 * plastic)
        contacts.plastic[w, block] = plastic
        return contacts.unloading[w, block] * greater(overlap - plastic, 0.0)

    @ti.func
    def energy(self, contacts: ti.template(), w, block, lane, overlap, root):
        """Recoverable energy k₂ (ξ − ξ₀)²/2 (J) of one contact."""
        elastic = ti.max(0.0, overlap - entry(contacts.plastic, w, block, lane))
        return 0.5 * entry(contacts.unloading, w, block, lane) * elastic * elastic
