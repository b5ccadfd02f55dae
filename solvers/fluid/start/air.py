"""Air at rest over water at rest: its particles, under their own hydrostatic pressure."""

from dataclasses import replace

import numpy as np

from solvers.fluid.given import Water, particles
from solvers.fluid.phases.adiabatic import GAMMA
from solvers.fluid.start.lattice import lattice
from solvers.fluid.start.packing import packed


def hydrostatic_air(height: np.ndarray, gravity: float, sound: float) -> np.ndarray:
    """Relative density deviation s = ρ/ρ_a − 1 of air at rest at heights (m) over where its pressure is that outside.

    dp/dz = −ρ g with p = p_a ((ρ/ρ_a)^1.4 − 1) gives (ρ/ρ_a)^0.4 = 1 − 0.4 g z/c². Raises ValueError where no air of
    so low a speed of sound can be that high.
    """
    share = 1.0 - (GAMMA - 1.0) * gravity * np.asarray(height, dtype=float) / sound**2
    if (share <= 0.0).any():
        raise ValueError(f"air with a speed of sound of {sound:.3g} m/s cannot be so high")
    return share ** (1.0 / (GAMMA - 1.0)) - 1.0


def deviation_at_rest(height: np.ndarray, volume: np.ndarray, water: Water, gravity: float) -> np.ndarray:
    """As `hydrostatic_air`, of particles (n,) with volumes (m²); air that is soft at first has its mass when stiff.

    Soft air is lighter by its own weight. If it kept that, it would be under suction in a closed tank once it is
    stiff; so its density is higher by as much everywhere, which lifts its pressure by half its weight at most. Where
    pressures are reduced (`ReducedPressure`) there is no deviation.
    """
    if water.air.reduced is not None:
        return np.zeros(len(height))
    soft = hydrostatic_air(height, gravity, water.softened.air.sound_speed)
    if water.softened is not water:
        soft += np.average(hydrostatic_air(height, gravity, water.air.sound_speed) - soft, weights=volume)
    return soft


def air_above(polygon: np.ndarray, level: float, water: Water, gravity: float) -> np.ndarray:
    """The particles (n,) of the air at rest that fills a polygon (m, 2) m over a `level` (m).

    At the level its pressure is that outside. Raises ValueError if no particle fits in.
    """
    upside_down = np.array(polygon, dtype=float)[::-1] * [1.0, -1.0]
    if water.start == "lattice":
        points, volume = lattice(upside_down, -level, water.spacing)
    else:
        packing = packed(upside_down, -level, water)
        points, volume = packing.points, packing.volume
    air = particles(len(points))
    air["position"], air["volume"], air["gas"] = points * [1.0, -1.0], volume, True
    air["deviation"] = deviation_at_rest(air["position"][:, 1] - level, air["volume"], water, gravity)
    return air


def air_round(polygon: np.ndarray, region: np.ndarray, water: Water, gravity: float) -> np.ndarray:
    """As `air_above`, of the air that fills a polygon apart from the `region` (k, 2) m of the water.

    Its pressure is that outside at the region's top.
    """
    whole = replace(water, start="packed")
    level, top = float(region[:, 1].max()), float(polygon[:, 1].max())
    packing = packed(polygon, top, whole, [region])
    air = particles(len(packing.points))
    air["position"], air["volume"], air["gas"] = packing.points, packing.volume, True
    air["deviation"] = deviation_at_rest(air["position"][:, 1] - level, air["volume"], water, gravity)
    return air


def with_air(of_water: np.ndarray, of_air: np.ndarray) -> np.ndarray:
    """The particles (n,) of both phases, those of water first."""
    return np.concatenate([of_water, of_air])
