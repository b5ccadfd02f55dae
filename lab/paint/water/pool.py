"""What a picture needs to know of the water in a recording besides its particles: their volume, and the gauges."""

from dataclasses import dataclass

import numpy as np

from lab.recording import Recording
from solvers.fluid.given import Gauge, Level


@dataclass(frozen=True)
class Pool:
    """volume (W, n): of the particles in the plane, m²; gauges of pressure and of depth, by name."""

    volume: np.ndarray
    gauges: dict[str, Gauge]
    levels: dict[str, Level]

    @property
    def spacing(self) -> float:
        """Mean distance of the particles (m)."""
        return float(np.sqrt(self.volume.mean()))


def numbered(gauges: tuple[Gauge, ...], levels: tuple[Level, ...]) -> tuple[dict[str, Gauge], dict[str, Level]]:
    """Gauges without names, numbered from one: P1, P2 … of pressure and L1, L2 … of depth."""
    return (
        {f"P{k}": gauge for k, gauge in enumerate(gauges, start=1)},
        {f"L{k}": level for k, level in enumerate(levels, start=1)},
    )


def pool_of(recording: Recording) -> Pool | None:
    """The water of a recording; None without water."""
    if "water" not in recording.preset.matters:
        return None
    raise NotImplementedError
