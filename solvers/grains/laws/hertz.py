"""Elastic Hertz contact (Hertz 1882), without dissipation."""

import taichi as ti

from solvers.grains.materials import Interface, hertz_stiffness
from solvers.machine.limit import Limit
from solvers.machine.wide import entry

# Per collision, with Verlet's scheme and contacts that begin anywhere in a step. An elastic collision then keeps its
# speed to 0.03 %, and the speed along a wall after an oblique one is right to 0.5 % (with 18: to 0.1 % and 2 %).
ELASTIC_STEPS = 25.0


def hertz_duration(mass: float, radius: float, young: float, speed: float) -> float:
    """Duration (s) of an elastic Hertz collision, 2.87 (m*²/(R* E*² v))^(1/5) (Johnson 1985, eq. 11.24)."""
    return 2.87 * (mass**2 / (radius * young**2 * speed)) ** 0.2


@ti.data_oriented
class Hertz:
    """F_n = k ξ^(3/2), k = (4/3) E* √R_eff (Spandonidis 2016, table 4.1, second row).

    The material's restitution and dissipative time are ignored: every collision keeps its energy.

    Limits: small overlaps, ξ ≪ R, of smooth spheres that do not yield, and impacts slow beside waves in the grains
    (Johnson 1985, chapter 11). Only friction takes energy from a bed.

    Units: F_n N, ξ m, k N/m^(3/2), E* Pa, R_eff m.
    """

    wide = True
    constants = ()
    memory = ()

    def coefficients(self, between: Interface) -> list[float]:
        """None."""
        return []

    def limits(self, between: Interface, mass: float, radius: float, speed: float) -> list[Limit]:
        """Longest steps (s) and what sets them."""
        collision = hertz_duration(mass, radius, between.young_modulus, speed)
        return [Limit(collision / ELASTIC_STEPS, f"1/{ELASTIC_STEPS:.0f} of the Hertz collision")]

    def deepest(self, between: Interface, mass: float, radius: float, speed: float) -> float:
        """Largest overlap (m) of a head-on impact without losses, (5 m v²/(4 k))^(2/5)."""
        return (1.25 * mass * speed**2 / hertz_stiffness(between.young_modulus, radius)) ** 0.4

    @ti.func
    def force(self, c: ti.template(), contacts: ti.template(), w, block, approach, overlap, root, rate, dt):
        """F_n (N) of a block of contacts from the overlap ξ (m) and its root √ξ."""
        return contacts.stiffness[w, block] * root * overlap

    @ti.func
    def energy(self, contacts: ti.template(), w, block, lane, overlap, root):
        """Elastic energy (2/5) k ξ^(5/2) (J) of one contact."""
        return 0.4 * entry(contacts.stiffness, w, block, lane) * overlap * overlap * root
