"""A free cylinder that sinks from the surface beside computations: Fekken (2004), Moyo & Greenhow (2000).

Lengths are in its radius R, times in √(R/g).
"""

import numpy as np
from matplotlib.figure import Figure

from lab.report.plots import BELOW, BLUE, GREEN, VERMILION, canvas
from lab.studies.reproduce.experiment import Found
from lab.studies.reproduce.figures import SIZE
from lab.studies.reproduce.runs import Outcome
from lab.studies.reproduce.water.measured import drawn

COLOURS = BLUE, VERMILION, GREEN
SOURCES = {"displacement_fekken2004": "volume of fluid", "displacement_moyo_greenhow2000": "boundary elements"}


def sunk(one: Outcome) -> tuple[np.ndarray, np.ndarray]:
    """Times and how far it sinks, down negative."""
    preset, series = one.recording.preset, one.recording.series
    radius = 0.5 * float(np.ptp(np.array(preset.parts["cylinder"].points)[:, 0]))
    height = series["body_place"][:, 0, 0, 1]
    return series["time"] / np.sqrt(radius / preset.run.gravity), (height - height[0]) / radius


def sunk_at(one: Outcome, when: float) -> float:
    """How far it has sunk then; NaN after the end."""
    time, way = sunk(one)
    return float(np.interp(when, time, way)) if time[-1] >= when - 0.01 else np.nan


NUMBERS = {"sunk": ("1", sunk_at)}


def figure(found: Found) -> Figure:
    """How it sinks, and by the sources."""
    drawing, axes = canvas(SIZE)
    for (label, outcomes), colour in zip(found.items(), COLOURS, strict=False):
        time, way = sunk(outcomes[0])
        axes.plot(time, way, color=colour, lw=1.2, label=label)
    for (name, words), mark in zip(SOURCES.items(), ("o", "^"), strict=True):
        if (read := drawn(axes, f"sinking_cylinder/{name}.csv")) is not None:
            axes.plot(read[0], read[1], mark, ms=3, color="black", mfc="none", label=words)
    axes.set(xlabel="t √(g/R)", ylabel="displacement (R)", xlim=(0.0, 3.1), ylim=(-1.5, 0.05))
    drawing.legend(loc=BELOW, ncols=3)
    return drawing
