"""What the colour of water shows.

A new one takes a function from beds to `Colouring`, a line in FIELDS, and its name in the colours of the presets.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from lab.paint.colours import SAMPLED_FRAMES, Colouring, round_up, spread, table
from lab.paint.space.stance import lengths
from lab.paint.water.vorticity import vorticity
from solvers.mixture.bed import depth_up_to

if TYPE_CHECKING:
    from lab.paint.footage import Bed

COVERED = 99.5  # % of the values of all frames lie above the lower end of a scale, and so many below the upper one
LEAST = 0.05  # of the highest pressure: less suction than that is not given a part of the scale
MOST_OF_A_FRAME = 20_000  # particles of a frame that are looked at for the scale
FEW = 15  # frames for the scale of what takes time to compute


def pressure(beds: Sequence[Bed]) -> Colouring:
    """Pressure over that of the air, from zero, or from the largest suction if there is some."""
    low, high = ends(beds, lambda bed, frame: bed.drops("water_pressure", frame))
    high = round_up(max(high, 1.0))
    low = -round_up(-low) if low < -LEAST * high else 0.0
    factor, unit = (1e-6, "MPa") if high >= 1e6 else (1e-3, "kPa") if high >= 1e3 else (1.0, "Pa")

    def values(bed: Bed, frame: int) -> np.ndarray:
        return factor * bed.drops("water_pressure", frame)

    return Colouring(f"pressure ({unit})", factor * low, factor * high, table("viridis", low=0.15), values)


def speed(beds: Sequence[Bed]) -> Colouring:
    """|u| relative to the tank."""

    def speeds(bed: Bed, frame: int) -> np.ndarray:
        return lengths(bed.drops("water_velocity", frame))

    top = round_up(max(ends(beds, speeds)[1], beds[0].footage.water.spacing))
    factor, unit = (1.0, "m/s") if top >= 1.0 else (1e3, "mm/s")

    def values(bed: Bed, frame: int) -> np.ndarray:
        return factor * speeds(bed, frame)

    return Colouring(f"speed in the tank ({unit})", 0.0, factor * top, table("viridis"), values)


def turning(beds: Sequence[Bed]) -> Colouring:
    """Vorticity relative to the tank, red counter-clockwise and blue clockwise."""

    def values(bed: Bed, frame: int) -> np.ndarray:
        return vorticity(bed.water_position(frame), bed.drops("water_velocity", frame), bed.footage.water.spacing)

    top = round_up(max(ends(beds, lambda bed, frame: np.abs(values(bed, frame)), FEW)[1], 1e-2))
    return Colouring("vorticity in the tank (1/s)", -top, top, table("coolwarm", low=0.02), values)


def excess(beds: Sequence[Bed]) -> Colouring:
    """What the pressure is over that of water at rest with the same mean surface, level in the earth's axes."""

    def values(bed: Bed, frame: int) -> np.ndarray:
        return bed.drops("water_pressure", frame) - at_rest(bed, frame)

    low, high = ends(beds, values)
    top = round_up(max(-low, high, 1.0))
    factor, unit = (1e-3, "kPa") if top >= 1e3 else (1.0, "Pa")

    def shown(bed: Bed, frame: int) -> np.ndarray:
        return factor * values(bed, frame)

    return Colouring(f"pressure over rest ({unit})", -factor * top, factor * top, table("coolwarm", low=0.02), shown)


def at_rest(bed: Bed, frame: float) -> np.ndarray:
    """The hydrostatic pressure (n,), Pa, at the places of the water: ρ g (h_w − h), above the surface 0.

    h = y sin φ + z cos φ is the height over the earth at the tank's roll φ, and h_w that of the mean surface in the
    middle of the tank.
    """
    pool, outline = bed.footage.water, bed.footage.outline
    place, roll = bed.water_position(frame), float(bed.pose[round(float(frame)), 2])
    middle = 0.5 * float(outline[:, 0].min() + outline[:, 0].max())
    over = (mean_level(bed, frame) - place[:, 1]) * np.cos(roll) + (middle - place[:, 0]) * np.sin(roll)
    return pool.density * pool.gravity * np.maximum(over, 0.0)


def mean_level(bed: Bed, frame: float) -> float:
    """The mean height (m) of the water's surface in the tank's axes: below it lies Σ V/ε, water and grains together."""
    pool, outline = bed.footage.water, bed.footage.outline
    found = depth_up_to(outline, _taken(bed, frame)) + float(outline[:, 1].min())
    if pool.level is None:
        return found
    return found + pool.level - depth_up_to(outline, _taken(bed, 0)) - float(outline[:, 1].min())


def _taken(bed: Bed, frame: float) -> float:
    """The area (m²) that the water of a bed takes up with the grains in it."""
    volume = bed.footage.water.volume[bed.world]
    return float(np.sum(volume / _porosity(bed, frame) if bed.footage.water.porous else volume))


def _porosity(bed: Bed, frame: float) -> np.ndarray:
    """The share of the room about each particle that is water."""
    place = bed.drops("water_position", frame)
    return bed.drops("water_porosity", frame) if bed.footage.water.porous else np.ones(len(place))


def porosity(beds: Sequence[Bed]) -> Colouring:
    """The share of the room about each particle that is water, from the densest bed to clear water."""
    low = np.floor(10.0 * min(ends(beds, _porosity)[0], 0.9)) / 10.0
    return Colouring("porosity", float(low), 1.0, table("cividis"), _porosity)


FIELDS: dict[str, Callable[[Sequence[Bed]], Colouring]] = {
    "pressure": pressure,
    "speed": speed,
    "vorticity": turning,
    "particles": speed,
    "excess-pressure": excess,
}
OF_WET: dict[str, Callable[[Sequence[Bed]], Colouring]] = {"porosity": porosity}  # of water between grains
SEEN_THROUGH = ("vorticity", "excess-pressure", *OF_WET)  # fields for which grains in water are painted small


def field(name: str, beds: Sequence[Bed]) -> Colouring | None:
    """The colours of water by this name, one scale for all beds; None for water that looks like water."""
    known = FIELDS | OF_WET
    return known[name](beds) if name in known else None


def ends(
    beds: Sequence[Bed], values: Callable[[Bed, int], np.ndarray], frames: int = SAMPLED_FRAMES
) -> tuple[float, float]:
    """The ends of a scale on which nearly all values of all sampled frames lie; 0 and 0 if no water is left.

    All frames count together, so that an impact, which one frame shows, does not leave the others without colours.
    """
    samples = (values(bed, frame) for bed, frame in spread(beds, frames))
    found = np.concatenate([sample[:: 1 + len(sample) // MOST_OF_A_FRAME] for sample in samples])
    found = found[np.isfinite(found)]
    low, high = np.percentile(found, [100.0 - COVERED, COVERED]) if len(found) else (0.0, 0.0)
    return float(low), float(high)
