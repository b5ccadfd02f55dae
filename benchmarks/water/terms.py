"""What each model of the water costs: a step with it beside one without, in turn, on one core."""

from pathlib import Path

import numpy as np

from benchmarks.water.cases import gentle
from benchmarks.water.workers import Worker
from lab.report.page import Page

ROWS, TURNS = 50, 5
PASS, WALL = 0.05, 1.0  # s, of a run and of a turn
# Each beside the lab's defaults: Antuono's diffusion, artificial viscosity, walls that water slides on, no shifts.
WAYS: dict[str, dict[str, object]] = {
    "the lab's defaults": {},
    "no diffusion of density": {"diffusion": "none"},
    "diffusion after Molteni & Colagrossi": {"diffusion": "molteni"},
    "diffusion after Fourtakas et al.": {"diffusion": "fourtakas"},
    "no viscosity": {"alpha": 0.0},
    "walls that water sticks to": {"slip": False},
    "shifts with their momentum": {"shifting": "delta-plus-momentum", "speed": 3.0},
}


def study(page: Page, work: Path, fast: bool) -> None:
    """Add the section to the page."""
    page.section("Terms")
    page.say(f"""The gentle pool with {ROWS} rows on one core, in mixed precision: nanoseconds of the processor a
        particle and step, the median of the turns with their range, and over that of the lab's defaults in the same
        turn.""")
    case, turns = gentle(ROWS), 2 if fast else TURNS
    workers = {name: Worker(case, **how) for name, how in WAYS.items()}
    try:
        for worker in workers.values():
            worker.run(PASS, PASS)
        spent = {name: [] for name in workers}
        for _ in range(turns):
            for name, worker in workers.items():
                run = worker.run(PASS, WALL)
                spent[name].append(1e9 * run.busy_s / (run.steps * run.particles))
    finally:
        for worker in workers.values():
            worker.close()
    base, rows = np.array(next(iter(spent.values()))), []
    for name, turn in spent.items():
        own = np.array(turn)
        over = own / base
        told = f"{np.median(own):.0f} ({own.min():.0f} to {own.max():.0f})"
        rows.append([name, told, f"{np.median(over):.2f} ({over.min():.2f} to {over.max():.2f})"])
    page.table(["water", "ns a particle-step", "over the defaults"], rows)
