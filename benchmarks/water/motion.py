"""The collapsed column in full motion, kept: what the lab makes of it, for the starts of the timed runs."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from benchmarks.remembered import remembered
from benchmarks.water.cases import DENSITY, GRAVITY, HIGH, Case
from benchmarks.water.workers import Worker

LATER = 6.0  # t √(g/H): the water has run up the far wall and falls back


def moving(work: Path, column: Case) -> Case:
    """The case that a column of `cases.dam` is at LATER, from the folder `work`, where it is kept."""
    found = remembered(work / f"moving-{column.count}.npz", "water: a column collapses", lambda: _moved(column))
    return replace(column, drops=found["drops"])


def _moved(column: Case) -> dict[str, np.ndarray]:
    worker = Worker(column)
    frame = worker.frames([LATER * np.sqrt(HIGH / GRAVITY)])[0]
    worker.close()
    drops = column.drops.copy()
    mass = (1.0 + drops["deviation"]) * drops["volume"]
    drops["position"], drops["velocity"] = frame.position, frame.velocity
    drops["deviation"] = frame.pressure / (DENSITY * column.sound_speed**2)
    drops["volume"] = mass / (1.0 + drops["deviation"])
    return {"drops": drops}
