"""What a particle costs in tanks from five thousand to two million particles: time and memory."""

from pathlib import Path

import numpy as np

from benchmarks.water.cases import gentle
from benchmarks.water.workers import Worker
from lab.report.page import Page

ROWS, FEW = (50, 100, 224, 500, 1000), (10, 20)  # layers: 5 000 to 2 000 000 particles
AHEAD, STEPS, UPDATES = 6, 8, 4e6  # steps before the timing, of a timing at least, and particle-steps of it


def study(page: Page, work: Path, fast: bool) -> None:
    """Add the section to the page."""
    page.section("Cost of a particle")
    page.say("""The small wave on one core, mixed precision, with lists that are rebuilt as the water asks: time of the
        processor for a step of a particle, and memory of the solver's arrays, whose lengths are powers of two so that
        tanks share compiled kernels.""")
    table, costs = [], []
    for rows in FEW if fast else ROWS:
        case = gentle(rows)
        print(f"water: {case.count} particles", flush=True)
        worker = Worker(case, ahead=AHEAD)
        try:
            steps = max(STEPS, round(UPDATES / case.count))
            run = worker.run(steps * worker.step(), 0.0)
            memory = worker.memory()
        finally:
            worker.close()
        costs.append(1e9 * run.busy_s / (run.steps * run.particles))
        table.append([f"{case.count:,}", costs[-1], memory / case.count, memory / 2**20])
    page.table(["particles", "ns a particle-step", "bytes a particle", "MiB"], table)
    spread = float(np.max(costs) / np.min(costs) - 1.0)
    page.say(f"The dearest particle costs {1e2 * spread:.0f} % more than the cheapest.")
