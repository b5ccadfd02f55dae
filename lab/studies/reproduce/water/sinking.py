"""A cylinder that sinks from the surface beside computations: Fekken (2004), Moyo & Greenhow (2000).

Lengths are in its radius R, times in √(R/g). It is moved by a table; how far it would have gone by the force of the
water and its weight is the second integral of F/m − g.
"""

import numpy as np
from matplotlib.figure import Figure

from lab.report.plots import BELOW, BLUE, GREEN, VERMILION, canvas
from lab.studies.reproduce.experiment import Found
from lab.studies.reproduce.figures import SIZE
from lab.studies.reproduce.runs import Outcome
from lab.studies.reproduce.water.measured import drawn

DENSER = 1.2  # than water
COLOURS = BLUE, VERMILION, GREEN
SOURCES = {"displacement_fekken2004": "volume of fluid", "displacement_moyo_greenhow2000": "boundary elements"}


def sunk(one: Outcome) -> tuple[np.ndarray, np.ndarray]:
    """Times and how far it sinks, down negative, by the forces on it."""
    preset, series = one.recording.preset, one.recording.series
    radius = 0.5 * float(np.ptp(np.array(preset.parts["cylinder"].points)[:, 0]))
    mass = DENSER * preset.water.density * np.pi * radius**2 * preset.thickness
    force, step = series["part_force"][1:, 0, 0, 1], np.diff(series["time"])  # means between samples
    speed = np.concatenate([[0.0], np.cumsum((force / mass - preset.run.gravity) * step)])
    way = np.concatenate([[0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1]) * step)])
    return series["time"] / np.sqrt(radius / preset.run.gravity), way / radius


def table(one: Outcome, time: np.ndarray) -> np.ndarray:
    """How far the table moves it at times."""
    preset = one.recording.preset
    radius = 0.5 * float(np.ptp(np.array(preset.parts["cylinder"].points)[:, 0]))
    curve = preset.parts["cylinder"].history.history.motions["heave"].curve
    return curve(time * np.sqrt(radius / preset.run.gravity)) / radius


def sunk_at(one: Outcome, when: float) -> float:
    """How far it has sunk by the forces on it; NaN after the end."""
    time, way = sunk(one)
    return float(np.interp(when, time, way)) if time[-1] >= when - 0.01 else np.nan


def apart_at(one: Outcome, when: float) -> float:
    """How far forces and table are apart then."""
    return sunk_at(one, when) - float(table(one, np.array([when]))[0])


NUMBERS = {"sunk": ("1", sunk_at), "sunk_apart": ("1", apart_at)}


def figure(found: Found) -> Figure:
    """How it sinks by forces and by the table, and by the sources."""
    drawing, axes = canvas(SIZE)
    for (label, outcomes), colour in zip(found.items(), COLOURS, strict=False):
        time, way = sunk(outcomes[0])
        axes.plot(time, way, color=colour, lw=1.2, label=f"by forces, {label}")
        axes.plot(time, table(outcomes[0], time), color=colour, lw=1.0, ls=":", label=f"table, {label}")
    for (name, words), mark in zip(SOURCES.items(), ("o", "^"), strict=True):
        if (read := drawn(axes, f"sinking_cylinder/{name}.csv")) is not None:
            axes.plot(read[0], read[1], mark, ms=3, color="black", mfc="none", label=words)
    axes.set(xlabel="t √(g/R)", ylabel="displacement (R)", xlim=(0.0, 3.1), ylim=(-1.5, 0.05))
    drawing.legend(loc=BELOW, ncols=3)
    return drawing
