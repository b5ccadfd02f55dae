"""The pressure in grains, from the forces on them."""

import numpy as np

from solvers.grains.pressing import NOBODY, Pressing


def pressures(pressing: Pressing, place: np.ndarray, radius: np.ndarray) -> np.ndarray:
    """Mean pressure (n,) Pa in each grain: p = −(1/3V) Σ f · l (Love 1927, § 123; Weber 1966), V = (4/3) π R³.

    f is the force on the grain at a contact, l the arm from its centre to it; place (n, 2), radius (n,) m. Grains are
    spheres in one layer, so nothing presses across it, and p is a third of what acts in the plane.

    Limits: of the forces without friction and damping, and of grains that are nearly in equilibrium.
    Units: N, m, Pa.
    """
    virial = np.zeros(len(radius))
    one, other = pressing.grains.T
    np.subtract.at(virial, one, (pressing.force * (pressing.place - place[one])).sum(axis=1))
    mutual = other != NOBODY
    arm = pressing.place[mutual] - place[other[mutual]]
    np.add.at(virial, other[mutual], (pressing.force[mutual] * arm).sum(axis=1))
    return virial / (4.0 * np.pi * radius**3)
