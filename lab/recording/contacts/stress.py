"""The stress in grains, and how many contacts they have, from the forces on them."""

import numpy as np

from solvers.grains.pressing import NOBODY, Pressing


def stresses(pressing: Pressing, place: np.ndarray, radius: np.ndarray) -> np.ndarray:
    """Mean stress (n, axes, axes) Pa in each grain: σ_ij = −(1/V) Σ f_i l_j (Love 1927, § 123; Weber 1966).

    V = (4/3) π R³, f is the force on the grain at a contact, l the arm from its centre to it; place (n, axes), radius
    (n,) m. Positive where it presses. In the plane grains are spheres in one layer, so what acts across it is zero. It
    is symmetric where the forces point at the centre, as on discs.

    Limits: of the forces without friction and damping, and of grains that are nearly in equilibrium.
    Units: N, m, Pa.
    """
    virial = np.zeros((len(radius), place.shape[1], place.shape[1]))
    one, other = pressing.grains.T
    np.subtract.at(virial, one, pressing.force[:, :, None] * (pressing.place - place[one])[:, None, :])
    mutual = other != NOBODY
    arm = pressing.place[mutual] - place[other[mutual]]
    np.add.at(virial, other[mutual], pressing.force[mutual][:, :, None] * arm[:, None, :])
    return virial / (4.0 / 3.0 * np.pi * radius[:, None, None] ** 3)


def pressures(pressing: Pressing, place: np.ndarray, radius: np.ndarray) -> np.ndarray:
    """Mean pressure (n,) Pa in each grain: p = tr σ / 3, in the plane a third of what acts there (`stresses`)."""
    return np.trace(stresses(pressing, place, radius), axis1=1, axis2=2) / 3.0


def coordination(contacts: np.ndarray | float, grains: np.ndarray | float) -> np.ndarray:
    """Mean coordination number Z = 2 contacts / grains, a contact with a wall counting twice; NaN without grains."""
    return 2.0 * np.asarray(contacts) / np.where(np.asarray(grains) > 0, grains, np.nan)
