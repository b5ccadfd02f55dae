"""How wet a bed is: its moisture, its saturation and the level of its water, each from any one of them.

A bed is taken to fill SETTLED of the plane from the floor on. With the solid share φ = 1 − ε of its volume,
the water's mass m_w = M/(1 − M) m_g for the moisture M, and S = V_w/V_pores for the saturation S, which counts the
whole bed. Water that more than fills the pores stands on the bed; less fills them from the floor up to a water table.
"""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from lab.base.errors import LabError
from lab.preset.sections.grains import Grains
from lab.preset.sections.materials import Kind
from lab.preset.sections.tank import Tank
from lab.preset.sections.water.section import Water
from lab.preset.units import show
from solvers.grains.bed.filling import count_for_depth
from solvers.grains.bed.sizes import Sizes
from solvers.grains.materials import Material
from solvers.mixture.bed import area_up_to, depth_up_to

SETTLED = 0.858  # share of the plane that equal discs fill when they have settled: 0.852 to 0.861 in presets/wet
SHARES = "moisture", "saturation"  # keys that say how much water there is; the level follows
RADII = 2.0  # kernel's radii: the least depth of water that follows from a share


class Poured(Protocol):
    """The sections of a preset that the state of a wet bed follows from."""

    tank: Tank
    grains: Grains | None
    material: Material | None
    kinds: dict[str, Kind]
    others: dict
    sizes: Sizes
    water: Water | None
    thickness: float


@dataclass(frozen=True)
class State:
    """A wet bed at rest: `moisture` and `saturation` (shares), `porosity`, the depth of the `bed`, and the water's
    `level`, both m over the tank's lowest point; `dry` and `whole`: its density without and with its own water, kg/m³.
    """

    moisture: float
    saturation: float
    porosity: float
    bed: float
    level: float
    dry: float
    whole: float

    @property
    def free(self) -> float:
        """Depth (m) of the water over the bed; 0 where it is not full."""
        return max(0.0, self.level - self.bed)


def share_of(water: Water) -> tuple[str, float] | None:
    """The key that says how much water there is, and its share; None where a depth or a region says it."""
    given = ((name, getattr(water, name)) for name in SHARES)
    return next(((name, value) for name, value in given if value is not None), None)


def grains_in(preset: Poured) -> tuple[float, float, float]:
    """Area (m²) of the grains' discs in the plane, their volume in it (m², over the slab's thickness), mean density."""
    listed, corners = preset.grains.listed, np.array(preset.tank.corners)
    density = preset.material.density
    if listed:
        square, cube = float((4.0 * listed.radius**2).sum()), float((8.0 * listed.radius**3).sum())
    else:
        count = preset.grains.count or count_for_depth(preset.grains.depth, corners, preset.sizes)
        square, cube = count * preset.sizes.mean_square, count * preset.sizes.mean_cube
    if not listed:
        rest = 1.0 - sum(kind.share for kind in preset.kinds.values())
        shares = [(name, kind.share) for name, kind in preset.kinds.items()]
        density = rest * density + sum(share * preset.others[name].material.density for name, share in shares)
    return 0.25 * np.pi * square, np.pi / 6.0 * cube / preset.thickness, density


def state(preset: Poured) -> State | None:
    """The state of a preset's wet bed as it is expected; None where it is not said how much water there is."""
    if preset.water is None or preset.grains is None or preset.material is None:
        return None
    area, solid, density = grains_in(preset)
    bulk, heavy, corners = area / SETTLED, density / preset.water.density, np.array(preset.tank.corners)
    share = share_of(preset.water)
    if share is not None:
        name, value = share
        wet = value / (1.0 - value) * heavy * solid if name == "moisture" else value * (bulk - solid)
    elif preset.water.depth is not None:
        reached = area_up_to(corners, preset.water.depth)
        wet = reached - solid if reached > bulk else reached * (1.0 - solid / bulk)
    else:
        return None
    return _state(wet, bulk, solid, density, preset.water.density, corners)


def _state(wet: float, bulk: float, solid: float, density: float, water: float, corners: np.ndarray) -> State:
    """The state of water of the area `wet` (m²) in a bed of the areas `bulk` and `solid`; densities in kg/m³."""
    pores = bulk - solid
    level = depth_up_to(corners, wet + solid if wet > pores else wet * bulk / pores)
    held, dry = min(wet, pores), solid * density / bulk
    return State(
        moisture=wet * water / (wet * water + solid * density),
        saturation=wet / pores,
        porosity=pores / bulk,
        bed=depth_up_to(corners, bulk),
        level=level,
        dry=dry,
        whole=dry + held * water / bulk,
    )


def check_share(preset: Poured, reach: float) -> None:
    """Raise LabError for a share of water that the tank cannot hold, or that is finer than the water.

    `reach`: the radius (m) of the water's kernel.
    """
    name, value = share_of(preset.water)
    found, height = state(preset), preset.tank.extent[1]
    if found.level >= height:
        high, tall = show(found.level, "m"), show(height, "m")
        raise LabError(
            f"water.{name}: with {_told(value)} the water would stand {high} high in a tank of {tall}; take less, "
            "or a higher tank."
        )
    least = RADII * reach
    if found.level < least:
        area, solid, density = grains_in(preset)
        corners = np.array(preset.tank.corners)
        bulk, reached = area / SETTLED, area_up_to(corners, least)
        wet = reached - solid if reached > bulk else reached * (1.0 - solid / bulk)
        fits = _state(wet, bulk, solid, density, preset.water.density, corners)
        raise LabError(
            f"water.{name}: {_told(value)} fills the bed up to {show(found.level, 'm')}, less than two kernel radii, "
            f"{show(least, 'm')}; take at least {_told(_up(getattr(fits, name)))}, or a smaller water.spacing."
        )


def _up(share: float) -> float:
    """A share rounded up to a tenth of a per cent."""
    return np.ceil(1e3 * share - 1e-6) / 1e3


def _told(share: float) -> str:
    """A share in per cent."""
    return f"{100.0 * share:.4g} %"
