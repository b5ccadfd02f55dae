"""Particle-steps and simulated seconds a second, of the lab and of its peers, on one core and on two."""

from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path

import numpy as np

from lab.report.page import Page
from lab.studies.bench.peers import dualsphysics
from lab.studies.bench.peers.pool import PoolRun
from lab.studies.bench.speed.workers import ratio
from lab.studies.bench.water.cases import Case, dam, gentle
from lab.studies.bench.water.motion import moving
from lab.studies.bench.water.workers import Worker

OURS = {"the lab": {}, "the lab, fourtakas": {"diffusion": "fourtakas"}}
WALL = 3.0  # s of a turn of ours
STEPS = 5e6  # particle-steps of a turn of a peer on a core
Timing = Callable[[], PoolRun]


def study(page: Page, work: Path, fast: bool) -> None:
    """Add the section to the page."""
    turns = 2 if fast else 6
    page.section("Speed")
    if dualsphysics.available() is None:
        page.say(f"{dualsphysics.NAME} is not installed here: the comparison with it is left out.")
        return
    page.say("""The gentle pool is a tank of 2 m by 1 m of water with a standing wave of 20 mm, the violent one a column
        twice as wide as high that has collapsed, run up the far wall and falls back (t √(g/H) from 6 on); each run
        starts from the same particles. h = 2 Δx for all, Wendland's kernel, α = 0.01, δ = 0.1, the same speed of sound;
        each with its own default step. The lab: mixed precision, its defaults, and with the diffusion of Fourtakas et
        al., as the peer's. DualSPHysics: Verlet's scheme, one layer of boundary particles.""")
    found = {}
    for threads in (1, 2):
        for name, case in {"gentle, 100 rows": gentle(100), "violent, 50 rows": moving(work, dam(50))}.items():
            print(f"water: {name}, {threads} threads", flush=True)
            found[name, threads] = compared(case, threads, turns)
    _tell(page, found)


def compared(case: Case, threads: int, turns: int) -> dict[str, list[PoolRun]]:
    """Runs of each code on a case, in turn, after a turn to warm up."""
    workers = {name: Worker(case, threads, **how) for name, how in OURS.items()}
    try:
        seconds = STEPS * threads / case.count * dualsphysics.COURANT * 2.0 * case.spacing / case.sound_speed
        pool = case.pool(seconds, seconds, threads)
        timings: dict[str, Timing] = {dualsphysics.NAME: partial(dualsphysics.run_dualsphysics, pool)}
        timings |= {name: partial(worker.run, seconds, WALL) for name, worker in workers.items()}
        rows = [{name: timing() for name, timing in timings.items()} for _ in range(turns + 1)]
    finally:
        for worker in workers.values():
            worker.close()
    return {name: [row[name] for row in rows[1:]] for name in timings}


def numbers(runs: list[PoolRun], threads: int) -> Mapping[str, np.ndarray]:
    """What is told of runs (turns,): particle-steps, steps and simulated seconds a second, on one core of its time."""
    spent = np.array([run.busy_s if threads == 1 else run.loop_s for run in runs])
    steps, seconds = np.array([run.steps for run in runs]), np.array([run.seconds for run in runs])
    return {
        "particle_steps": steps * runs[0].particles / spent,
        "steps": steps / spent,
        "seconds": seconds / spent,
        "wall": np.array([run.particle_steps_per_s for run in runs]),
    }


def _tell(page: Page, found: Mapping[tuple[str, int], Mapping[str, list[PoolRun]]]) -> None:
    header = ["pool", "cores", "code", "M", "steps/s", "simulated s/s", "times as fast: particle-steps", "simulated s"]
    rows = []
    for (name, threads), runs in found.items():
        told = {code: numbers(of_code, threads) for code, of_code in runs.items()}
        theirs = told[dualsphysics.NAME]
        for code, own in told.items():
            against = ["", ""]
            if own is not theirs:
                against = [ratio(own[key], theirs[key]) for key in ("particle_steps", "seconds")]
            medians = [float(np.median(own[key])) for key in ("particle_steps", "steps", "seconds")]
            rows.append([name, str(threads), code, medians[0] / 1e6, medians[1], medians[2], *against])
    page.table(header, rows)
    page.table(
        ["pool", "cores", "code", "M of wall time, each turn"],
        [
            [name, str(threads), code, ", ".join(f"{run.particle_steps_per_s / 1e6:.2f}" for run in of_code)]
            for (name, threads), runs in found.items()
            for code, of_code in runs.items()
        ],
    )
