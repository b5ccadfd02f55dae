"""What the codes make of the pools: pressure of water at rest, a small wave, the front of a column that collapses."""

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

import numpy as np

from benchmarks.peers import dualsphysics, pysph
from benchmarks.peers.pool import Frame
from benchmarks.remembered import remembered
from benchmarks.water.cases import GRAVITY, HIGH, Case, dam, frequency, gentle
from benchmarks.water.errors import front_speed, pressure_error, wave_errors
from benchmarks.water.speed import OURS
from benchmarks.water.workers import Worker
from lab.report.page import Page

ROWS, FEW = 25, 15
STILL, FRONT = 0.5, 2.6  # s at rest; t √(g/H) of the collapse
FRAMES = 16
KEPT, LOST = 0.99, "water lost"  # share of the particles that must be there in the end

Follow = Callable[[Case, float], Sequence[Frame]]


def study(page: Page, work: Path, fast: bool) -> None:
    """Add the section to the page."""
    rows = FEW if fast else ROWS
    codes: dict[str, Follow] = {name: partial(followed_here, **how) for name, how in OURS.items()}
    if dualsphysics.available() is not None:
        codes |= {f"{dualsphysics.NAME}, {walls}": partial(_theirs, walls=walls) for walls in ("dbc", "mdbc")}
    if pysph.available() is not None:
        codes[pysph.NAME] = _pysphs
    page.section("Errors")
    page.say(f"""{rows} rows of particles. At rest for {STILL:g} s from hydrostatic pressure: rms of the error of
        pressure over all particles, and their fastest, over ρ g H and √(gH). Standing wave of 20 mm for a period: its
        frequency against linear theory √(g k tanh kH), and its loss of height; α = 0.01 alone, a kinematic viscosity of
        α h c0/8, takes {1e2 * _viscous(gentle(rows)):.1f} % of it. Column that collapses: speed of its front,
        experiments 1.6 to 1.8 √(gH), and when it is near the far wall. Walls of DualSPHysics: dbc, one layer of its
        dynamic boundary particles; mdbc, its modified ones (English et al. 2022), as many layers as the kernel
        reaches, which PySPH has, too.""")
    table = []
    for name, follow in codes.items():
        print(f"water: errors of {name}", flush=True)
        table.append([name, *errors(follow, rows, work / f"accuracy-{list(codes).index(name)}")])
    header = ["code", "pressure at rest, %", "fastest at rest", "frequency, %", "loss in a period, %"]
    page.table([*header, "front / √(gH)", "at the wall, t √(g/H)"], table)


def errors(follow: Follow, rows: int, kept: Path) -> list[float | str]:
    """The numbers of a code, each pool's kept in a folder; LOST of a peer whose walls leak and that goes on without it.

    Raises LabError where a peer is not there.
    """
    told: list[float | str] = []
    for name, pool in POOLS.items():
        file = kept / f"{name}-{rows}.npz"
        found = remembered(file, f"water: {name}", lambda pool=pool: {"errors": np.array(pool(follow, rows))})["errors"]
        told += [LOST if np.isnan(value) else float(value) for value in found]
    return told


def resting(follow: Follow, rows: int) -> tuple[float, float]:
    """Error of the pressure at rest (%) and the fastest particle over √(gH)."""
    case = gentle(rows, steep=0.0)
    last = follow(case, STILL)[-1]
    if not _whole(case, last):
        return np.nan, np.nan
    fastest = np.linalg.norm(last.velocity, axis=1).max() / np.sqrt(GRAVITY)
    return 1e2 * pressure_error(last), float(fastest)


def waving(follow: Follow, rows: int) -> tuple[float, float]:
    """Error of the wave's frequency and its loss of height in a period, %."""
    case = gentle(rows)
    frames = follow(case, 2.0 * np.pi / frequency())
    off, loss = wave_errors(frames) if _whole(case, frames[-1]) else (np.nan, np.nan)
    return 1e2 * off, 1e2 * loss


def _breaking(follow: Follow, rows: int) -> tuple[float, float]:
    """Speed of the column's front and when it is near the wall."""
    case = dam(rows)
    frames = follow(case, FRONT * np.sqrt(HIGH / GRAVITY))
    return front_speed(case, frames) if _whole(case, frames[-1]) else (np.nan, np.nan)


def _whole(case: Case, frame: Frame) -> bool:
    """Whether a code still has its water."""
    return len(frame.position) > KEPT * case.count


POOLS = {"rest": resting, "wave": waving, "column": _breaking}


def _viscous(case: Case) -> float:
    """Share of the wave's height that its viscosity ν takes in a period T: 1 − exp(−2 ν k² T)."""
    viscosity, k = 0.01 * 2.0 * case.spacing * case.sound_speed / 8.0, np.pi / case.width
    return float(1.0 - np.exp(-2.0 * viscosity * k**2 * 2.0 * np.pi / frequency()))


def followed_here(case: Case, seconds: float, **how: object) -> list[Frame]:
    """What the lab makes of a case, FRAMES times and at the start; `how` goes to its worker."""
    worker = Worker(case, **how)
    try:
        return worker.frames(np.linspace(0.0, seconds, FRAMES + 1))
    finally:
        worker.close()


def _theirs(case: Case, seconds: float, walls: str) -> list[Frame]:
    return dualsphysics.run_dualsphysics(case.pool(seconds, seconds / FRAMES), walls=walls).frames


def _pysphs(case: Case, seconds: float) -> list[Frame]:
    return pysph.run_pysph(case.pool(seconds, seconds / FRAMES)).frames
