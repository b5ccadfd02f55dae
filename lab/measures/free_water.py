"""How much water stands over a wet bed, where its table is, and how far it heels the cargo.

free_water_start, free_water_end: mean depth of the water above the tops of the grains, at the first frame and over the
steady part (`steady_part`; else at the last frame): Σ of the particles' shares above the bed, over its width.
dewatering: their difference, the water that the bed has given off.
water_table_start, water_table_end: mean height of the water's surface over the floor, in the bed or over it, from
Σ a/ε (`wet_bed`).
water_shift: largest distance of the water's centre of mass from its first place across the tank.
free_water_lever: the lever at which that shift heels grains and water together, m_w |y_w − y_w(0)|/(m_w + m_g), the
heeling moment of the water over the weight of the cargo; largest of the run.
Error: standard error of the means of blocks of the steady part. At the first frame the water is as it was laid, in rows
of particles: its depth over the bed is right to a third of their spacing, not told here.
"""

from collections.abc import Mapping

import numpy as np

from lab.measures.drawing import BLUE, GREEN, VERMILION, Sheet, band, level
from lab.measures.settlement import at_end
from lab.measures.value import Value, over_worlds
from lab.measures.wet_bed import WetBed, is_wet, wet_bed
from lab.recording import Recording

OF = "water"


def applies(recording: Recording) -> bool:
    """Grains and water share the tank."""
    return is_wet(recording)


def measure(recording: Recording) -> dict[str, Value]:
    """free_water_start and _end, dewatering, water_table_start and _end, water_shift, free_water_lever (mm)."""
    bed, shift = wet_bed(recording), water_shift(recording)
    free, table, largest = 1e3 * bed.free, 1e3 * bed.level, np.abs(shift).max(axis=0)
    return {
        "free_water_start": over_worlds(free[0], "mm"),
        "free_water_end": at_end(bed, free, "mm"),
        "dewatering": at_end(bed, free - free[0], "mm"),
        "water_table_start": over_worlds(table[0], "mm"),
        "water_table_end": at_end(bed, table, "mm"),
        "water_shift": over_worlds(largest, "mm"),
        "free_water_lever": over_worlds(water_share(bed) * largest, "mm"),
    }


def water_shift(recording: Recording) -> np.ndarray:
    """How far (T, W), mm, the water's centre of mass has moved to starboard in the tank."""
    across = recording.series["water_centre"][..., 0]
    return 1e3 * (across - across[0])


def water_share(bed: WetBed) -> np.ndarray:
    """The water's share (W,) of the mass of both."""
    water = bed.water * bed.recording.preset.water.density
    return water / (water + bed.dry)


def draw(sheet: Sheet, recording: Recording, values: Mapping[str, Value]) -> None:
    """The water over the bed and its table above; below, the lever at which its shift heels the cargo."""
    bed = wet_bed(recording)
    (upper,), (lower,) = sheet.panels(heights=(3, 2))
    top = 1e3 * np.nanmean(bed.tops, axis=2) - 1e3 * bed.floor
    band(upper, bed.time, 1e3 * bed.level, BLUE, "mean surface of the water")
    band(upper, bed.time, top, VERMILION, "mean surface of the bed")
    upper.set_ylabel("height over\nthe floor (mm)")
    time = recording.series["time"]
    band(lower, time, water_share(bed) * water_shift(recording), GREEN, "lever of the water's shift")
    level(sheet, lower, values.get("free_water_lever"), "largest lever", GREEN, (time[0], time[-1]))
    lower.set_xlim(time[0], time[-1])
    lower.set_xlabel("time (s)")
    lower.set_ylabel("lever (mm),\nto starboard")


FIGURES = {"free_water": draw}
