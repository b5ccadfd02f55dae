"""Speed against error of water under air, beside water alone: the standing waves of `cargolab verify water`."""

import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from benchmarks.remembered import remembered
from lab.report.page import Page
from lab.studies.verify.water import waves
from lab.studies.verify.water.phases.interface import Between
from lab.studies.verify.water.scenes import Swing
from solvers.scene import Scene
from solvers.simulation import Simulation

LAYERS, FEW = (10, 20, 40), (5, 10)
AHEAD, LENGTH, TURNS = 40, 200, 3  # steps before a timing and of one, and how many of each
UNDER_AIR = Between(1.2)
# Each with the scene of so many layers, the oscillation that was found, and the growth rate (1/s) of viscous theory.
WAYS: dict[str, tuple[Callable[[int], Scene], Callable[[int], Swing], Callable[[], complex]]] = {
    "water alone": (waves.made, lambda rows: waves.waved(rows).swing, waves.viscous),
    "under air": (UNDER_AIR.made, UNDER_AIR.waved, lambda: UNDER_AIR.viscous),
}
HEADER = ("wave", "layers", "particles", "step, ms", "M", "simulated s/s", "rate, %", "decay over theory's")


def study(page: Page, work: Path, fast: bool) -> None:
    """Add the section to the page."""
    layers = FEW if fast else LAYERS
    page.section("Beside air")
    page.say("""The standing wave of `cargolab verify water-wave` in water alone, and that of `water-air-wave` under
        as much air of equal speed of sound, 1.2 kg/m³: errors of rate and decay over eight periods beside linear
        theory with viscosity, and on one core millions of particle-steps and simulated seconds in a second of the
        processor's time, the median of three, in turn.""")
    found = {(way, rows): errors(way, rows, work) for way in WAYS for rows in layers}
    for rows in layers:
        speeds = timed([WAYS[way][0](rows) for way in WAYS])
        for way, speed in zip(WAYS, speeds, strict=True):
            found[way, rows] |= speed
    columns = "particles", "step", "particle_steps", "seconds", "rate", "decay"
    table = [[way, str(rows), *(one[column] for column in columns)] for (way, rows), one in found.items()]
    page.table(HEADER, table)


def errors(way: str, rows: int, work: Path) -> dict[str, float | str]:
    """Error of the rate (%), and the decay over that of theory; those of each run are kept in a folder."""

    def run() -> dict[str, float]:
        swing, exact = WAYS[way][1](rows), WAYS[way][2]()
        return {"rate": 1e2 * (swing.rate / exact.imag - 1.0), "decay": -swing.decay / exact.real}

    kept = work / f"air-{list(WAYS).index(way)}-{rows}.npz"
    return {name: float(value) for name, value in remembered(kept, f"water: {way}, {rows} layers", run).items()}


def timed(scenes: list[Scene]) -> list[dict[str, float | str]]:
    """Of each scene its particles, and millions of particle-steps and simulated seconds in one of the processor."""
    runs = [Simulation(scene, threads=1, arch="cpu") for scene in scenes]
    spent: list[list[float]] = [[] for _ in runs]
    try:
        for run in runs:
            run.advance(AHEAD)
        for _ in range(TURNS):
            for run, told in zip(runs, spent, strict=True):
                before = time.process_time()
                run.advance(LENGTH)
                told.append(time.process_time() - before)
        return [
            {
                "particles": str(run.scene.particles),
                "step": 1e3 * run.dt,
                "particle_steps": LENGTH * run.scene.particles / np.median(told) / 1e6,
                "seconds": LENGTH * run.dt / np.median(told),
            }
            for run, told in zip(runs, spent, strict=True)
        ]
    finally:
        for run in runs:
            run.close()
