"""What a picture needs to know of the water in a recording besides its particles: their volume, and the gauges."""

from dataclasses import dataclass, field

import numpy as np

from lab.preset.kept.content import parted
from lab.preset.schema import Preset
from solvers.fluid.given import Gauge, Level


@dataclass(frozen=True)
class Pool:
    """volume (W, n): of the particles, m³, in the plane m²; gauges of pressure and of depth, by name; air: as volume;
    flows: whether it flows at first; porous: whether it is between grains; level: height (m) of its surface as it
    starts, None where that follows from its amount; density (kg/m³); gravity (m/s²); axes of the scene."""

    volume: np.ndarray
    gauges: dict[str, Gauge]
    levels: dict[str, Level]
    air: np.ndarray = field(default_factory=lambda: np.zeros((1, 0)))
    flows: bool = False
    porous: bool = False
    level: float | None = None
    density: float = 1000.0
    gravity: float = 9.81
    axes: int = 2
    tabled: bool = False

    @classmethod
    def of(cls, preset: Preset, volume: np.ndarray, air: np.ndarray) -> "Pool | None":
        """The water of a preset with the volumes (W, n) m² of its particles, and of air's; None without water."""
        if preset.water is None:
            return None
        water, (gauges, levels, _) = preset.liquid, parted(preset.gauges)
        of_gauges = dict(zip(gauges, water.gauges, strict=True)), dict(zip(levels, water.levels, strict=True))
        level = float(preset.pools[0].level) if preset.water.depth is not None else None
        weight = level, preset.water.density, preset.run.gravity, preset.axes
        porous = preset.wet or preset.soaks
        return cls(volume, *of_gauges, air, preset.water.flow is not None, porous, *weight, preset.wet)

    @property
    def spacing(self) -> float:
        """Mean distance of the particles (m)."""
        return float(self.volume.mean() ** (1.0 / self.axes))
