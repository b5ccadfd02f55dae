"""Grains in water, for tests: small tanks, as `cargolab verify` has them."""

from dataclasses import replace

import numpy as np

from lab.studies.verify.wet.scenes import SIZE as DIAMETER
from lab.studies.verify.wet.scenes import SPACING, glass, rows, wet
from solvers.fluid.given import Water, particles
from solvers.grains.given import Grains
from solvers.mixture.given import Mixture
from solvers.simulation import Simulation
from tests.oracles.scenes import box

__all__ = ["DIAMETER", "rows", "soaked"]


def soaked(
    place: np.ndarray, width: float, height: float, level: float, count: int, units: int = 1, **changes: object
) -> Simulation:
    """A tank with grains at `place` (1, n, 2) m and so many particles of water up to a `level` (m).

    `changes` are those of the scene, such as motions or parts.
    """
    drops = particles(1, count)
    drops["volume"][0] = SPACING**2
    grains = Grains(np.full(place.shape[:2], 0.5 * DIAMETER), glass(), glass(), stiffness_scale=1e-3)
    water = Water(SPACING, 10.0, alpha=0.02)
    scene = wet(box(width, height), grains, water, drops, Mixture(level=level), thickness=DIAMETER, **changes)
    scene = replace(scene, schedule="per-band" if units > 1 else "per-world")
    return Simulation(scene, place, units, arch="cpu", units=units)
