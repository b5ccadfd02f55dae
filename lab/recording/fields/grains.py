"""Coarse graining: density, velocity and stress of a bed as fields, from grains and the forces between them."""

from collections.abc import Mapping

import numpy as np

from lab.recording.fields.grid import Grid
from solvers.grains.pressing import NOBODY, Pressing

PIECES = 8  # of a branch between two grains, over which its stress is spread


def coarse_grained(
    grid: Grid,
    reach: float,
    place: np.ndarray,
    velocity: np.ndarray,
    mass: np.ndarray,
    size: np.ndarray,
    pressing: Pressing,
    thickness: float,
) -> Mapping[str, np.ndarray]:
    """Fields at the nodes of a grid, of n grains with places (n, axes) m, velocities, masses (kg) and sizes.

    With Lucy's function φ of a `reach` c (m), after Goldhirsch (2010): ρ = Σ m_i φ(r − r_i), v = Σ m_i v_i φ/ρ; contact
    stress −Σ f_ij r_ij ∫₀¹ φ(r − r_i + s r_ij) ds over contacts, each once, from grain i to j; kinetic stress
    Σ m_i v_i' v_i' φ, v_i' = v_i − v(r_i). Both press where they are positive. The branch r_ij of a contact with a wall
    leads from the grain's centre to it (Weinhart et al. 2012). The integral is the mean over PIECES of the branch.

    size: of the grains, area (m²) in the plane, volume (m³) in space; `solid` is their share of a place. thickness (m)
    of the layer in the plane, by which mass and force are divided; 1 in space. Returns solid (1), density (kg/m³),
    velocity (m/s), stress and kinetic_stress (Pa), (*shape, axes, axes), pressure (Pa).

    Limits: of elastic forces along the normals, as the contacts of a recording have them, without friction. Within c of
    a wall or of the surface a part of φ is outside, and density is less than in the bed.
    """
    axes, known = grid.axes, np.isfinite(place).all(axis=1)
    number = np.cumsum(known) - 1  # of a grain among those that are known
    place, velocity, mass, size = place[known], velocity[known], mass[known] / thickness, size[known]
    sums = grid.spread(place, np.column_stack([size, mass, mass[:, None] * velocity]), reach)
    density = sums[..., 1]
    with np.errstate(invalid="ignore", divide="ignore"):
        mean = sums[..., 2:] / density[..., None]
    own = velocity - _at(grid, mean, place)
    agitation = (mass[:, None, None] * own[:, :, None] * own[:, None, :]).reshape(len(mass), -1)
    kinetic = grid.spread(place, np.nan_to_num(agitation), reach).reshape(*grid.shape, axes, axes)
    stress = _stress_of_contacts(grid, reach, place, number, known, pressing, thickness)
    return {
        "solid": sums[..., 0],
        "density": density,
        "velocity": mean,
        "stress": stress,
        "kinetic_stress": kinetic,
        "pressure": np.trace(stress, axis1=-2, axis2=-1) / axes,
    }


def _stress_of_contacts(
    grid: Grid,
    reach: float,
    place: np.ndarray,
    number: np.ndarray,
    known: np.ndarray,
    pressing: Pressing,
    thickness: float,
) -> np.ndarray:
    """The stress (*shape, axes, axes) Pa that contacts carry; `number` of each grain among the `known` ones."""
    axes, (one, other) = grid.axes, pressing.grains.T
    counted = known[one] & ((other == NOBODY) | known[np.maximum(other, 0)])
    one, other, force = number[one[counted]], other[counted], pressing.force[counted]
    mutual = other != NOBODY
    end = np.where(mutual[:, None], place[number[np.maximum(other, 0)]], pressing.place[counted])
    branch = end - place[one]
    amount = -(force[:, :, None] * branch[:, None, :]).reshape(len(force), -1) / (PIECES * thickness)
    found = np.zeros((*grid.shape, axes * axes))
    for piece in range(PIECES):
        found += grid.spread(place[one] + (piece + 0.5) / PIECES * branch, amount, reach)
    return found.reshape(*grid.shape, axes, axes)


def _at(grid: Grid, field: np.ndarray, place: np.ndarray) -> np.ndarray:
    """A field of the nodes at places (n, axes) m: that of the nearest node."""
    node = np.clip(np.round((place - grid.first) / grid.spacing).astype(int), 0, np.array(grid.shape) - 1)
    return field[tuple(node.T)]
