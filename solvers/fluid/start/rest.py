"""Water at rest: its particles, under hydrostatic pressure."""

from collections.abc import Callable, Sequence

import numpy as np

from solvers.fluid.given import Water, particles
from solvers.fluid.phases.reduced_pressure import ReducedPressure
from solvers.fluid.start.lattice import lattice, lattice_in_space
from solvers.fluid.start.packing import packed
from solvers.fluid.start.plates import packed_beside
from solvers.fluid.start.round_bodies import packed_round
from solvers.fluid.states.tait import GAMMA
from solvers.tank.parts import Part

EXPONENTS = {"linear": 1, "tait": GAMMA}  # γ of the equations of state


def laid_packed(polygon: np.ndarray, level: float, water: Water) -> tuple[np.ndarray, float]:
    """Places (n, 2) m and the volume (m²) of each, see `packed`."""
    packing = packed(polygon, level, water)
    return packing.points, packing.volume


def laid_lattice(polygon: np.ndarray, level: float, water: Water) -> tuple[np.ndarray, float]:
    """Places (n, 2) m and the volume (m²) of each, see `lattice`."""
    return lattice(polygon, level, water.spacing)


STARTS: dict[str, Callable[[np.ndarray, float, Water], tuple[np.ndarray, float]]] = {
    "packed": laid_packed,
    "lattice": laid_lattice,
}


def hydrostatic_deviation(depth: np.ndarray, gravity: float, sound: float, state: str) -> np.ndarray:
    """Relative density deviation s = ρ/ρ0 − 1 of water at rest at depths (m) below its surface.

    dp/dz = −ρ g with p = ρ0 c0²/γ ((ρ/ρ0)^γ − 1) gives (ρ/ρ0)^(γ−1) = 1 + (γ − 1) g d/c0²; for the linear equation of
    state, γ = 1, ρ/ρ0 = exp(g d/c0²). Own derivation.
    """
    share, more = gravity * np.asarray(depth, dtype=float) / sound**2, EXPONENTS[state] - 1
    return np.expm1(np.log1p(more * share) / more) if more else np.expm1(share)


def at_rest(
    polygon: np.ndarray,
    level: float,
    water: Water,
    gravity: float,
    parts: Sequence[Part] = (),
    outline: np.ndarray | None = None,
    along: float | None = None,
) -> np.ndarray:
    """The particles (n,) of water at rest in a polygon up to a level (m).

    Beside `parts` in a tank with this `outline` (m, 2) m they are packed, see `packed_beside`. In space the polygon is
    the section of a prism, `along` (m) long, and they are a lattice, packed near parts, see `packed_round`.

    Each has the volume that it takes, so that its mass ρ0 (1 + s) V is that of the compressed water: with equal masses
    the level would sink by g H²/(2 c0²). With ρ0 as of `uncompressed` level and mass are both those of incompressible
    water. Raises ValueError if no particle fits in.
    """
    if parts and along is not None:
        points, volume = packed_round(polygon, level, water, parts, along)
    elif parts:
        packing = packed_beside(polygon, level, water, parts, outline)
        points, volume = packing.points, packing.volume
    elif along is not None:
        points, volume = lattice_in_space(polygon, level, water.spacing, along)
    else:
        points, volume = STARTS[water.start](polygon, level, water)
    found = particles(len(points), axes=points.shape[1])
    found["position"] = points
    weight = ReducedPressure.weight(water, gravity)
    found["deviation"] = hydrostatic_deviation(level - points[:, 1], weight, water.sound_speed, water.state)
    found["volume"] = volume
    return found


def uncompressed(start: np.ndarray, density: float, share: np.ndarray | float = 1.0) -> float:
    """ρ0 (kg/m³) without pressure of water whose particles (n,) have a mean `density` (kg/m³) over their area.

    ρ0 = ρ Σ V/Σ (1 + s) V, so that Σ ρ0 (1 + s) V = ρ Σ V: some g H/(2 c0²) less than ρ, half a per cent where c0² =
    100 g H. The motion of water alone under prescribed motions of its tank does not depend on ρ0, all forces are
    proportional to it. `share` (n,) is how much of each counts, as where tanks are of different length.
    """
    volume = share * start["volume"]
    return float(density * volume.sum() / ((1.0 + start["deviation"]) * volume).sum())
