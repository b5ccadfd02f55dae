"""The linear spring equivalent to a Hertz contact, for laws with linear springs."""

import taichi as ti


def spring_coefficient(speed: float) -> float:
    """Factor (4/5)^(4/5) v^(2/5) of `spring_stiffness`, for the speed v (m/s) at which both overlaps are equal."""
    return 0.8**0.8 * speed**0.4


@ti.pyfunc
def spring_stiffness(coefficient, stiffness, mass):
    """k_l (N/m) = (4/5)^(4/5) (k⁴ m v²)^(1/5), with the same largest overlap as Hertz; k in N/m^1.5, m_eff in kg.

    Equal energies at the largest overlap, k_l ξ²/2 = (2/5) k ξ^(5/2) = m v²/2, give k_l = (4/5) k √ξ at that ξ.
    """
    return coefficient * stiffness**0.8 * mass**0.2
