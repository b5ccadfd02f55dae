"""Speed against error: spacings, precisions, kernels and diffusions of the lab on one small wave."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from lab.report.page import Page
from lab.report.plots import BLUE, GREY, canvas
from lab.studies.bench.water.accuracy import FRAMES, STILL
from lab.studies.bench.water.cases import frequency, gentle
from lab.studies.bench.water.errors import pressure_error, wave_errors
from lab.studies.bench.water.speed import PASS
from lab.studies.bench.water.workers import Worker

ROWS, FEW = (20, 40, 60), (10, 15)  # of the spacings; the others at the middle one
WALL = 1.0  # s of a timing
WAYS = {
    "the defaults": {},
    "f64": {"precision": "f64"},
    "f32": {"precision": "f32"},
    "Wendland C4": {"kernel": "wendland-c4"},
    "h = 1.7 Δx": {"smoothing": 1.7},
    "Fourtakas": {"diffusion": "fourtakas"},
    "Molteni": {"diffusion": "molteni"},
    "no diffusion": {"diffusion": "none"},
}
HEADER = (
    *("way", "layers", "M", "simulated s/s", "frequency, %", "loss in a period, %", "pressure at rest, %"),
    "on the front",
)


def study(page: Page, work: Path, fast: bool) -> None:
    """Add the section to the page."""
    rows = FEW if fast else ROWS
    middle = rows[len(rows) // 2]
    asked = [("the defaults", count) for count in rows] + [(way, middle) for way in list(WAYS)[1 : 3 if fast else None]]
    page.section("Speed against error")
    page.say("""The small wave on one core: millions of particle-steps and simulated seconds in a second of the
        processor's time, errors as above. On the front is what no other way beats in both simulated seconds and the
        error of frequency.""")
    found = {}
    for way, count in asked:
        print(f"water: {way}, {count} layers", flush=True)
        found[way, count] = _measured(count, WAYS[way])
    best = front([(one["seconds"], abs(one["frequency"])) for one in found.values()])
    names = "particle_steps", "seconds", "frequency", "loss", "pressure"
    table = [
        [way, str(count), *(float(one[name]) for name in names), "yes" if on else ""]
        for ((way, count), one), on in zip(found.items(), best, strict=True)
    ]
    page.table(HEADER, table)
    page.figure("front", figure(found, best), "Error of the wave's frequency against speed; filled: on the front.")


def _measured(rows: int, how: Mapping[str, object]) -> dict[str, float]:
    """Speed and errors of one way of computing the wave."""
    worker = Worker(gentle(rows), **how)
    try:
        run = worker.run(PASS, WALL)
        wave = wave_errors(worker.frames(np.linspace(0.0, 2.0 * np.pi / frequency(), FRAMES + 1)))
    finally:
        worker.close()
    still = Worker(gentle(rows, steep=0.0), **how)
    try:
        rest = still.frames([STILL])[0]
    finally:
        still.close()
    return {
        "particle_steps": run.steps * run.particles / run.busy_s / 1e6,
        "seconds": run.seconds / run.busy_s,
        "frequency": 1e2 * wave[0],
        "loss": 1e2 * wave[1],
        "pressure": 1e2 * pressure_error(rest),
    }


def front(points: list[tuple[float, float]]) -> list[bool]:
    """Which of the points (speed, error) no other one equals or beats in both and beats in one."""
    return [
        not any(s >= speed and e <= error and (s, e) != (speed, error) for s, e in points) for speed, error in points
    ]


def figure(found: Mapping[tuple[str, int], Mapping[str, float]], best: list[bool]) -> Figure:
    """Errors against simulated seconds a second, by their names."""
    drawn, axes = canvas((6.4, 3.6))
    for ((way, count), one), on in zip(found.items(), best, strict=True):
        x, y = one["seconds"], max(abs(one["frequency"]), 0.02)
        axes.loglog(x, y, "o", color=BLUE if on else GREY, mfc=BLUE if on else "white")
        axes.annotate(f"{way}, {count}", (x, y), xytext=(4, 3), textcoords="offset points", fontsize=7)
    axes.set(xlabel="simulated seconds in a second of one core", ylabel="error of the frequency (%)")
    return drawn
