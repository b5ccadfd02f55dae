"""How far a wet bed sinks, and how dense it becomes.

settlement: sinking of its surface, the mean over columns of the highest grain that touches others (`wet_bed`), from the
first frame to the steady part (`steady_part`); where there is none, to the last frame. Positive downwards.
settlement_mean: sinking of twice its centre of mass, the depth of an even bed (`wet_bed`): 2 (z_c(0) − z_c) in a
rectangular tank. Heaping at a wall raises both.
bed_porosity_start, bed_porosity_end: ε = 1 − V_s/V(H) of that depth, at the first frame and over the same time.
Error: standard error of the means of blocks of the steady part; at the last frame none, since places have no noise.
"""

from collections.abc import Mapping

import numpy as np

from lab.measures.drawing import BLUE, GREY, VERMILION, Sheet, band, level
from lab.measures.steady import averaged, steady_part
from lab.measures.value import Value, over_worlds
from lab.measures.wet_bed import WetBed, is_wet, wet_bed
from lab.recording import Recording

OF = "grains"


def applies(recording: Recording) -> bool:
    """Grains and water share the tank."""
    return is_wet(recording)


def measure(recording: Recording) -> dict[str, Value]:
    """settlement, settlement_mean (mm), bed_porosity_start and bed_porosity_end (1)."""
    bed = wet_bed(recording)
    surface, mean = sinking(bed)
    return {
        "settlement": at_end(bed, surface, "mm"),
        "settlement_mean": at_end(bed, mean, "mm"),
        "bed_porosity_start": over_worlds(bed.porosity[0], "1"),
        "bed_porosity_end": at_end(bed, bed.porosity, "1"),
    }


def sinking(bed: WetBed) -> tuple[np.ndarray, np.ndarray]:
    """How far the surface and the depth of an even bed have sunk (F, W), mm."""
    surface = np.nanmean(bed.tops, axis=2)
    return 1e3 * (surface[0] - surface), 1e3 * (bed.depth[0] - bed.depth)


def at_end(bed: WetBed, values: np.ndarray, unit: str) -> Value:
    """The mean of values (F, W) over the steady part with its block error, or the last ones."""
    steady = steady_part(bed.recording, bed.time)
    return averaged(values, steady, unit) if steady else over_worlds(values[-1], unit, note="at the last frame")


def draw(sheet: Sheet, recording: Recording, values: Mapping[str, Value]) -> None:
    """The sinking of the bed in time."""
    bed = wet_bed(recording)
    surface, mean = sinking(bed)
    ((axes,),) = sheet.panels()
    band(axes, bed.time, surface, BLUE, "surface")
    band(axes, bed.time, mean, VERMILION, "depth by the centre of mass")
    level(sheet, axes, values.get("settlement"), "settlement of the surface", GREY, (bed.time[0], bed.time[-1]))
    axes.invert_yaxis()
    axes.set_xlim(bed.time[0], bed.time[-1])
    axes.set_xlabel("time (s)")
    axes.set_ylabel("settlement (mm),\ndownwards")


FIGURES = {"settlement": draw}
