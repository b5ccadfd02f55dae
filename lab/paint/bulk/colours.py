"""What the colour of bulk shows.

A new one takes a function from beds to `Colouring`, a line in FIELDS, and its name in OF_BULK of the presets.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from lab.paint.colours import EMBERS, Colouring, ramp, round_up, table
from lab.paint.space.stance import lengths
from lab.paint.water.colours import ends

if TYPE_CHECKING:
    from lab.paint.footage import Bed

# From earth at rest to a bright red where it slides; lightness falls, and saturation rises
SLIDING = (214, 204, 186), (226, 184, 128), (222, 128, 62), (178, 34, 34)
LEAST_SPEED = 1e-3  # m/s at the end of a scale
LEAST_STRAIN = 1e-2


def sliding(beds: Sequence[Bed]) -> Colouring:
    """The mobilised friction: the share of the bed's friction that is called on; where it slides, all."""
    return Colouring(
        "mobilised friction",
        0.0,
        1.0,
        ramp(SLIDING),
        lambda bed, frame: np.minimum(bed.drops("bulk_friction", frame), 1.0),
    )


def pressure(beds: Sequence[Bed]) -> Colouring:
    """The pressure in the bed."""
    high = round_up(max(ends(beds, lambda bed, frame: bed.drops("bulk_pressure", frame))[1], 1.0))
    factor, unit = (1e-6, "MPa") if high >= 1e6 else (1e-3, "kPa") if high >= 1e3 else (1.0, "Pa")

    def values(bed: Bed, frame: int) -> np.ndarray:
        return factor * bed.drops("bulk_pressure", frame)

    return Colouring(f"pressure ({unit})", 0.0, factor * high, table("viridis", low=0.15), values)


def speed(beds: Sequence[Bed]) -> Colouring:
    """|v| relative to the tank."""

    def speeds(bed: Bed, frame: int) -> np.ndarray:
        return lengths(bed.drops("bulk_velocity", frame))

    top = round_up(max(ends(beds, speeds)[1], LEAST_SPEED))
    factor, unit = (1.0, "m/s") if top >= 1.0 else (1e3, "mm/s")

    def values(bed: Bed, frame: int) -> np.ndarray:
        return factor * speeds(bed, frame)

    return Colouring(f"speed in the tank ({unit})", 0.0, factor * top, ramp(EMBERS), values)


def strain(beds: Sequence[Bed]) -> Colouring:
    """The plastic shear strain since the start: how far the bed has been sheared, and how deep it slides."""

    def strained(bed: Bed, frame: int) -> np.ndarray:
        return bed.drops("bulk_strain", frame)

    top = round_up(max(ends(beds, strained)[1], LEAST_STRAIN))
    return Colouring("shear strain so far", 0.0, top, table("magma_r", low=0.02), strained)


FIELDS: dict[str, Callable[[Sequence[Bed]], Colouring]] = {
    "sliding": sliding,
    "speed": speed,
    "pressure": pressure,
    "strain": strain,
}
