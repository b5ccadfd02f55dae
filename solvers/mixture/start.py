"""Water laid into a bed of grains, at rest."""

from dataclasses import dataclass

import numpy as np

from solvers.fluid.given import Water, particles
from solvers.fluid.kernels import KERNELS
from solvers.fluid.start.rest import hydrostatic_deviation
from solvers.machine.errors import Unavailable
from solvers.mixture.bed import pores
from solvers.mixture.given import Mixture
from solvers.tank.outline import inside

FINE = 0.25  # of a smoothing length: the grid on which the porosity is found


@dataclass(frozen=True)
class PorosityMap:
    """Porosity on a grid: `porosity` (n_y, n_z) at the places `y` (n_y,) and `z` (n_z,) m, `within` the tank."""

    y: np.ndarray
    z: np.ndarray
    porosity: np.ndarray
    within: np.ndarray

    @property
    def cell(self) -> tuple[float, float]:
        """Sides (m) of a cell."""
        return float(self.y[1] - self.y[0]), float(self.z[1] - self.z[0])

    def row(self, height: float) -> tuple[np.ndarray, float]:
        """The width of water (m) in each cell of the row at a height (m), and that of the tank there."""
        k = int(np.clip(np.rint((height - self.z[0]) / self.cell[1]), 0, len(self.z) - 1))
        width = np.where(self.within[:, k], self.cell[0], 0.0)
        return width * self.porosity[:, k], float(width.sum())

    def area_below(self, level: float) -> float:
        """The area of water (m²) in the tank up to a level (m)."""
        step = self.cell[1]
        share = np.clip((level - self.z) / step + 0.5, 0.0, 1.0)
        return float(self.cell[0] * step * (np.where(self.within, self.porosity, 0.0) * share).sum())


def porosity_map(position: np.ndarray, area: np.ndarray, outline: np.ndarray, water: Water) -> PorosityMap:
    """The porosity that grains at `position` (n, 2) m with these areas (n,) m² make in a tank, as water sees it.

    The grains' areas are put into cells and smeared by the water's kernel, as `Porosity` does without a grid.
    """
    low, high = outline.min(axis=0), outline.max(axis=0)
    number = np.maximum(2, np.ceil((high - low) / (FINE * water.length)).astype(int))
    edges = [np.linspace(low[a], high[a], number[a] + 1) for a in range(2)]
    y, z = (0.5 * (edge[1:] + edge[:-1]) for edge in edges)
    solid, *_ = np.histogram2d(*np.clip(position, low, high).T, bins=edges, weights=area)
    within = inside(np.stack(np.meshgrid(y, z, indexing="ij"), axis=-1).reshape(-1, 2), outline).reshape(solid.shape)
    size = y[1] - y[0], z[1] - z[0]
    smear = _smear(within.shape, size, water)
    crowd = smear(solid) / (size[0] * size[1])
    return PorosityMap(y, z, np.clip(1.0 - crowd / np.maximum(smear(within.astype(float)), 1e-6), 0.05, 1.0), within)


def _smear(shape: tuple[int, ...], size: tuple[float, float], water: Water):
    """A function that smears values on a grid of cells of this size (m) by the kernel."""
    beyond = (
        0 if axis in water.periodic else int(np.ceil(water.reach / s)) + 1 for axis, s in zip("yz", size, strict=True)
    )
    whole = tuple(n + 2 * more for n, more in zip(shape, beyond, strict=True))
    off = [s * np.minimum(np.arange(n), n - np.arange(n)) for n, s in zip(whole, size, strict=True)]
    distance = np.hypot(off[0][:, None], off[1][None])
    kernel = np.where(
        distance < water.reach, KERNELS[water.kernel].printed(np.minimum(distance, water.reach), water.length), 0.0
    )
    transform = np.fft.rfft2(kernel / kernel.sum())

    def smear(values: np.ndarray) -> np.ndarray:
        return np.fft.irfft2(np.fft.rfft2(values, whole) * transform, whole)[: shape[0], : shape[1]]

    return smear


def laid(bed: PorosityMap, count: int, amount: float, water: Water, gravity: float) -> np.ndarray:
    """So many particles (count,) of `solvers.fluid.given.particles` at rest in a bed, water of the area `amount` (m²).

    Each has as much water. They lie in rows from the floor on, as high and as far apart as the pores there are narrow:
    where grains leave the share ε, the spacing is Δx/√ε. Raises ValueError if the tank is too small.
    """
    own, floor, top = amount / count, bed.z[0] - 0.5 * bed.cell[1], bed.z[-1] + 0.5 * bed.cell[1]
    height, wanted = floor, []
    while sum(wanted) < count:
        widths, across = bed.row(height)
        if height >= top or not widths.sum() > 0.0:
            raise ValueError("the tank is too small for the water")
        thick = np.sqrt(own * across / widths.sum())
        wanted.append(widths.sum() * thick / own)
        height += thick
    if sum(wanted) - count > 0.5 * wanted[-1] and len(wanted) > 1:
        wanted.pop()
    found, done, height = particles(count), 0, floor
    for end in np.rint(np.cumsum(wanted) * count / sum(wanted)).astype(int):
        thick = (end - done) * own / bed.row(height)[0].sum()
        widths, _ = bed.row(height + 0.5 * thick)
        along = np.concatenate([[0.0], np.cumsum(widths)])
        edges = np.append(bed.y - 0.5 * bed.cell[0], bed.y[-1] + 0.5 * bed.cell[0])
        shares = (np.arange(end - done) + 0.5) / (end - done)
        found["position"][done:end, 0] = np.interp(shares * along[-1], along, edges)
        found["position"][done:end, 1] = height + 0.5 * thick
        height, done = height + thick, end
    found["deviation"] = hydrostatic_deviation(
        height - found["position"][:, 1], gravity, water.sound_speed, water.state
    )
    found["volume"] = own / (1.0 + found["deviation"])
    return found


def amount(
    mixture: Mixture, bed: PorosityMap, outline: np.ndarray, position: np.ndarray, solid: np.ndarray, given: float
) -> float:
    """The area (m²) of the water of a mixture in a tank, between grains at `position` (n, 2) m.

    `solid` (n,) m²: the areas that the grains take in the plane; `given` (m²): of the fluid's own particles.
    """
    if mixture.level is not None:
        return bed.area_below(mixture.level)
    return given if mixture.saturation is None else mixture.saturation * pores(outline, position, solid)


class Laying:
    """How the water of a scene (`solvers.scene.Scene`) is laid between its grains, wherever these are."""

    def __init__(self, scene):
        self.scene, self.tank = scene, scene.tanks[scene.hold]

    def particles(self, position: np.ndarray) -> np.ndarray:
        """The particles (W, n) of water between grains at `position` (W, n, 2) m; those that wait stay as they are.

        Raises Unavailable if the water does not fit in.
        """
        grains, fluid, gravity = self.scene.grains, self.scene.fluid, self.scene.gravity
        found, outline, mixture, there = [], self.tank.outline, self.scene.mixture, int(fluid.present.sum())
        if not there:
            return fluid.particles
        for places, radius, drops in zip(position, grains.radius, fluid.particles, strict=True):
            fixed = grains.fixed[:, [0, 1, -1]]
            whole, size = np.concatenate([places, fixed[:, :2]]), np.concatenate([radius, fixed[:, 2]])
            solid = 4.0 / 3.0 * np.pi * size**3 / self.tank.thickness
            bed = porosity_map(whole, solid, outline, fluid.water)
            wet = amount(mixture, bed, outline, whole, solid, drops["volume"][:there].sum())
            try:
                found.append(np.concatenate([laid(bed, there, wet, fluid.water, gravity), drops[there:]]))
            except ValueError as error:
                raise Unavailable(f"water: {error}; take less of it, or a larger tank.") from None
        return np.stack(found)
