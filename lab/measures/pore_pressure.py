"""The pressure of the water in a wet bed, over that of water at rest, against what the grains bear.

In a frame the excess pressure of a particle is p − ρ g_n (z_w − z), below the water's mean surface z_w (`wet_bed`),
with g_n = g cos φ and the tank's heave. It is averaged over the particles within BAND spacings of water from half the
depth of the settled bed, across the bed's width: a straight line through them, at the middle of the width, so that
what sway and roll press to one side cancels. The pore-pressure ratio is this mean over the buoyant effective stress
there, r_u = Δp/σ', σ' = (1 − ε)(ρ_s − ρ) g H/2 in the settled bed, of grains above a water table without buoyancy
(Seed & Lee 1966: at r_u = 1 the grains bear nothing). Of a bed that has settled, what Δp is in the first frame, at
rest, is taken off: the error of the particles, some 10 Pa there.

pore_pressure_ratio_peak: the largest in any frame; pore_pressure_peak: the same in Pa.
pore_pressure_ratio_lowest: the smallest, suction where the bed is sheared and dilates.
pore_pressure_ratio: its mean over the steady part (`steady_part`). Error: standard error of the means of blocks.
Water that is softer than the bed's skeleton bears too little: `cargolab explain` tells by how much.
"""

from collections.abc import Mapping

import numpy as np

from lab.measures.drawing import BLUE, GREY, VERMILION, Sheet, band, level
from lab.measures.steady import SHORT, averaged, steady_part
from lab.measures.value import Value, over_worlds
from lab.measures.wet_bed import WetBed, is_wet, wet_bed
from lab.recording import Recording

OF = "water"
BAND = 1.0  # spacings of free water
LEAST = 4  # particles of water in the band
DRY = "too little water at half the depth of the bed"


def applies(recording: Recording) -> bool:
    """Grains and water share the tank, with weight."""
    return is_wet(recording) and recording.preset.run.gravity > 0.0


def measure(recording: Recording) -> dict[str, Value]:
    """pore_pressure_peak (Pa), pore_pressure_ratio_peak, _lowest and pore_pressure_ratio (1)."""
    bed = wet_bed(recording)
    excess = excess_course(bed)
    ratio = excess / effective_stress(bed)
    steady, peak = steady_part(recording, bed.time), np.fmax.reduce(excess)
    mean = over_worlds(np.full(recording.worlds, np.nan), "1", missing=SHORT)
    return {
        "pore_pressure_peak": over_worlds(peak, "Pa", missing=DRY),
        "pore_pressure_ratio_peak": over_worlds(np.fmax.reduce(ratio), "1", missing=DRY),
        "pore_pressure_ratio_lowest": over_worlds(np.fmin.reduce(ratio), "1", missing=DRY),
        "pore_pressure_ratio": averaged(ratio, steady, "1", missing=DRY) if steady else mean,
    }


def excess_course(bed: WetBed) -> np.ndarray:
    """Mean excess pressure (F, W), Pa, at half the depth of the settled bed; NaN where there is too little water."""
    density, spacing = bed.recording.preset.water.density, bed.recording.preset.liquid.spacing
    half, found = 0.5 * bed.depth[0], np.full(bed.depth.shape, np.nan)
    for frame in range(len(bed.time)):
        place, pressure = bed.read("water_position", frame), bed.read("water_pressure", frame)
        for w in range(len(half)):
            high = place[w, :, 1] - bed.floor
            near = (np.abs(high - half[w]) <= BAND * spacing) & (high < bed.level[frame, w])
            if near.sum() >= LEAST:
                over = pressure[w, near] - density * bed.gravity[frame, w] * (bed.level[frame, w] - high[near])
                found[frame, w] = _at_middle(place[w, near, 0] - bed.middle, over)
    return found - found[0] if bed.recording.preset.run.settles else found


def _at_middle(across: np.ndarray, values: np.ndarray) -> float:
    """The value at 0 of the straight line through values (n,) at places `across` (n,) the width, m."""
    apart = across - across.mean()
    spread = float(apart @ apart)
    slope = float(apart @ values) / spread if spread > 0.0 else 0.0
    return float(values.mean() - slope * across.mean())


def effective_stress(bed: WetBed) -> np.ndarray:
    """Buoyant effective stress (W,), Pa, at half the depth of the settled bed."""
    preset, deep, level = bed.recording.preset, bed.depth[0], bed.level[0]
    density = bed.dry / bed.solids.sum(axis=1)
    soaked = np.clip(np.minimum(level, deep) - 0.5 * deep, 0.0, None)
    share = (1.0 - bed.porosity[0]) * preset.run.gravity
    return share * (density * (0.5 * deep - soaked) + (density - preset.water.density) * soaked)


def draw(sheet: Sheet, recording: Recording, values: Mapping[str, Value]) -> None:
    """The pore-pressure ratio at half the bed's depth in time."""
    bed = wet_bed(recording)
    ratio = excess_course(bed) / effective_stress(bed)
    if not np.isfinite(ratio).any():
        return
    ((axes,),) = sheet.panels()
    band(axes, bed.time, ratio, BLUE, "at half the depth of the bed, mean across its width")
    axes.axhline(0.0, color=GREY, lw=0.6)
    level(sheet, axes, values.get("pore_pressure_ratio_peak"), "peak", VERMILION, (bed.time[0], bed.time[-1]))
    steady = steady_part(recording, bed.time)
    if steady:
        span = bed.time[steady.rows.start], bed.time[-1]
        level(sheet, axes, values.get("pore_pressure_ratio"), "mean", GREY, span)
    axes.set_xlim(bed.time[0], bed.time[-1])
    axes.set_xlabel("time (s)")
    axes.set_ylabel("pore-pressure ratio\nΔp/σ'")


FIGURES = {"pore_pressure": draw}
