"""The air over water in pictures: its pressure in colours, where the water is not."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from lab.paint.colours import Colouring, round_up, table
from lab.paint.painter import Camera
from lab.paint.water.colours import ends
from lab.paint.water.grid import Grid
from lab.paint.water.surface import Paints, paint_surface

if TYPE_CHECKING:
    from lab.paint.footage import Bed

BY_ITSELF = "air"  # the colour by which water looks like water, and air shows its pressure
DEEP = 0.9  # the water's level from which on no air is painted: beside a wall both would be mixed with it
PAPER = (255, 255, 255)  # of the line round the air, which is none


def pressure_of_air(beds: Sequence[Bed]) -> Colouring:
    """Pressure of the air over that outside, red above and blue below."""

    def pressures(bed: Bed, frame: int) -> np.ndarray:
        return bed.drops("air_pressure", frame)

    top = round_up(max(*np.abs(ends(beds, pressures)), 1e-3))
    factor, unit = (1e-3, "kPa") if top >= 1e3 else (1.0, "Pa")

    def values(bed: Bed, frame: int) -> np.ndarray:
        return factor * pressures(bed, frame)

    return Colouring(f"pressure of the air ({unit})", -factor * top, factor * top, table("coolwarm", low=0.02), values)


def colouring_of_air(name: str, beds: Sequence[Bed], of_water: Colouring | None) -> Colouring | None:
    """The colours of air beside water that is painted by this name; None where air is left out."""
    airy = [bed for bed in beds if bed.footage.water.air.size]
    if not airy:
        return None
    if name == "pressure":  # on the water's scale
        factor = {"MPa": 1e-6, "kPa": 1e-3, "Pa": 1.0}[of_water.label.partition("(")[2].rstrip(")")]
        return replace(of_water, values=lambda bed, frame: factor * bed.drops("air_pressure", frame))
    return pressure_of_air(airy) if name == BY_ITSELF else None


def paint_air(
    picture: np.ndarray, camera: Camera, grid: Grid, bed: Bed, frame: int, colouring: Colouring, under: tuple
) -> None:
    """Paint a bed's air over a picture, in place, also under the water's surface; water is painted over it."""
    place, wet = bed.drops("air_position", frame), bed.water_position(frame)
    there, drops = np.isfinite(place).all(axis=1), np.isfinite(wet).all(axis=1)
    pool = bed.footage.water
    volume, of_water = pool.air[bed.world][there], pool.volume[bed.world][drops]
    share = np.clip(np.nan_to_num(colouring.shares(bed, frame)[there]), 0.0, 1.0)
    sums = grid.sums(place[there], volume)
    tones = grid.sums(place[there], volume * share)
    tone = np.divide(tones, sums, out=np.zeros_like(sums), where=sums > 0.0)
    water = grid.sums(wet[drops], of_water)
    here = (sums + water > 0.0) & (grid.level(water) < DEEP)
    paints = Paints(colouring.table, PAPER, PAPER, PAPER, under, 0.0, 0.0, False)
    paint_surface(picture, camera, grid, here.astype(float), tone, paints)
