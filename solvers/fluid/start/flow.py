"""Water that moves at first: its velocities, and the pressure that they take.

Free water is strained and turns, u = σ (y, −z) + ω (−z, y) from a centre, and may be pulled there by −Ω² r per mass.
Then ∇²p = −ρ (∂_i u_j ∂_j u_i + 2 Ω²) = −2 ρ (σ² − ω² + Ω²), everywhere the same, with p = 0 at the surface: in a drop
of the radius R p = ρ (σ² + Ω²)(R² − r²)/2 (Monaghan 1994, J. Comput. Phys. 110, 399; Monaghan & Rafiee 2013, Int. J.
Numer. Meth. Fluids 71, 537), in a square a series (Le Touzé et al. 2013, Int. J. Numer. Meth. Fluids 73, 660).
"""

import numpy as np

from solvers.fluid.given import Water
from solvers.fluid.states import STATES

HARMONICS = 40  # highest power of the harmonic polynomials
A_SIDE = 400  # points at which the surface is looked at, at least


def stirred(arm: np.ndarray, strain: float, rotation: float) -> np.ndarray:
    """Velocities (n, 2) m/s at places (n, 2) m from the centre, of rates (1/s) of strain and rotation."""
    y, z = arm.T
    return np.stack([strain * y - rotation * z, rotation * y - strain * z], axis=1)


def torsion(outline: np.ndarray, place: np.ndarray) -> np.ndarray:
    """φ (n,) m² at places (n, 2) m in a polygon (m, 2) m: ∇²φ = −2 with φ = 0 at its edge (Prandtl 1903, of torsion).

    φ = h − r²/2 with harmonic polynomials h, real and imaginary parts of (y + i z)^n, that fit r²/2 along the edge by
    least squares (Trefftz 1926). Limits: it is exact for circles and good to 1e-3 of the largest φ for convex outlines;
    corners that point inwards it rounds.
    """
    middle, size = outline.mean(axis=0), float(np.ptp(outline, axis=0).max()) / 2.0
    ends = np.roll(outline, -1, axis=0) - outline
    a_side = max(2, A_SIDE // len(outline))
    edge = (outline[:, None] + ends[:, None] * ((np.arange(a_side) + 0.5) / a_side)[:, None]).reshape(-1, 2)
    edge, place = (edge - middle) / size, (place - middle) / size
    weights = np.repeat(np.sqrt(np.hypot(*ends.T) / size), a_side)
    fit = np.linalg.lstsq(weights[:, None] * _harmonics(edge), weights * 0.5 * (edge**2).sum(axis=1), rcond=1e-12)[0]
    return size**2 * (_harmonics(place) @ fit - 0.5 * (place**2).sum(axis=1))


def _harmonics(place: np.ndarray) -> np.ndarray:
    """Harmonic polynomials (n, k) at places (n, 2)."""
    powers = (place[:, :1] + 1j * place[:, 1:]) ** np.arange(HARMONICS + 1)
    return np.concatenate([powers.real, powers.imag[:, 1:]], axis=1)


def vortices(place: np.ndarray, sides: np.ndarray) -> np.ndarray:
    """Velocities (n, 2) of Taylor and Green's vortices at places (n, 2) m from a corner of a box with `sides` (2,) m.

    u = (−cos ay sin bz, (a/b) sin ay cos bz) with a = 2π/width, b = 2π/height: 1 at most along y.
    """
    a, b = wave = 2.0 * np.pi / np.asarray(sides)
    y, z = (wave * place).T
    return np.stack([-np.cos(y) * np.sin(z), a / b * np.sin(y) * np.cos(z)], axis=1)


def vortex_pressure(place: np.ndarray, sides: np.ndarray) -> np.ndarray:
    """Their p/ρ (n,), −(cos 2ay + (a/b)² cos 2bz)/4 at a speed of 1 m/s (Taylor & Green 1937, for a = b)."""
    a, b = wave = 2.0 * np.pi / np.asarray(sides)
    y, z = (2.0 * wave * place).T
    return -0.25 * (np.cos(y) + (a / b) ** 2 * np.cos(z))


def compressed(pressure: np.ndarray, water: Water) -> np.ndarray:
    """Relative density deviation of a water under p/ρ0 (n,) m²/s²."""
    return STATES[water.state].deviation(pressure / water.sound_speed**2)
