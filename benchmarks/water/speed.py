"""Particle-steps and simulated seconds a second, of the lab and of its peers, on one core and on two."""

from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path

import numpy as np

from benchmarks.peers import dualsphysics, pysph
from benchmarks.peers.pool import PoolRun
from benchmarks.speed.workers import ratio
from benchmarks.water.cases import Case, dam, gentle
from benchmarks.water.motion import moving
from benchmarks.water.workers import Worker
from lab.report.page import Page

OURS = {"the lab": {}, "the lab, fourtakas": {"diffusion": "fourtakas"}}
WALL, PASS = 1.0, 0.06  # s of a turn of ours, and of one run from the start
RUNS = {dualsphysics: dualsphysics.run_dualsphysics, pysph: pysph.run_pysph}
STEPS = {dualsphysics: 2e6, pysph: 3e5}  # particle-steps of a turn on a core
RATIOS = {
    "particle_steps": "particle-steps, so a step against a step, however long each is",
    "seconds": "simulated seconds, so the same tank for the same physical time, each code with its own step",
}
Timing = Callable[[], PoolRun]


def study(page: Page, work: Path, fast: bool) -> None:
    """Add the section to the page."""
    turns = 2 if fast else 5
    page.section("Speed")
    for peer in RUNS:
        if peer.available() is None:
            page.say(f"{peer.NAME} is not installed here: the comparison with it is left out.")
    page.say("""The gentle pool is a tank of 2 m by 1 m of water with a standing wave of 20 mm, the violent one a column
        twice as wide as high that has collapsed, run up the far wall and falls back (t √(g/H) from 6 on); each run
        starts from the same particles. h = 2 Δx for all, Wendland's kernel, α = 0.01, δ = 0.1, the same speed of sound;
        each with its own default step. The lab: mixed precision, its defaults, and with the diffusion of Fourtakas et
        al. DualSPHysics: Verlet's scheme, Fourtakas' diffusion, one layer of boundary particles; PySPH: δ-SPH with
        Antuono's diffusion.""")
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
        timings: dict[str, Timing] = {}
        for peer, run in RUNS.items():
            if peer.available() is not None:
                steps = STEPS[peer] * threads / case.count
                seconds = steps * peer.COURANT * 2.0 * case.spacing / case.sound_speed
                timings[peer.NAME] = partial(run, case.pool(seconds, seconds, threads))
        timings |= {name: partial(worker.run, PASS, WALL) for name, worker in workers.items()}
        rows = [_turn(timings) for _ in range(turns + 1)]
    finally:
        for worker in workers.values():
            worker.close()
    return {name: [row[name] for row in rows[1:]] for name in timings}


def _turn(timings: Mapping[str, Timing]) -> dict[str, PoolRun]:
    """A run of each code, told at once: a turn takes its time."""
    found = {name: timing() for name, timing in timings.items()}
    for name, run in found.items():
        spent = f"{run.loop_s:.2f} s, of the processor {run.busy_s:.2f} s, {run.seconds:.4f} s simulated"
        print(f"  {name}: {run.steps} steps of {run.particles} particles, {spent}", flush=True)
    return found


def numbers(runs: list[PoolRun], threads: int) -> Mapping[str, np.ndarray]:
    """What is told of runs (turns,): particle-steps, steps and simulated seconds a second, on one core of its time."""
    spent = np.array([run.busy_s if threads == 1 else run.loop_s for run in runs])
    steps, seconds = np.array([run.steps for run in runs]), np.array([run.seconds for run in runs])
    return {
        "particle_steps": steps * runs[0].particles / spent,
        "steps": steps / spent,
        "seconds": seconds / spent,
    }


def _tell(page: Page, found: Mapping[tuple[str, int], Mapping[str, list[PoolRun]]]) -> None:
    speeds, against = [], {key: [] for key in RATIOS}
    for (name, threads), runs in found.items():
        told = {code: numbers(of_code, threads) for code, of_code in runs.items()}
        for code, own in told.items():
            medians = [float(np.median(own[key])) for key in ("particle_steps", "steps", "seconds")]
            turns = ", ".join(f"{speed / 1e6:.2f}" for speed in own["particle_steps"])
            speeds.append([name, str(threads), code, medians[0] / 1e6, *medians[1:], turns])
            for key, rows in against.items():
                if code not in OURS:
                    rows.append([name, str(threads), code, *(ratio(told[one][key], own[key]) for one in OURS)])
    page.table(["pool", "cores", "code", "M", "steps/s", "simulated s/s", "M in each turn"], speeds)
    for key, rows in against.items():
        page.say(f"How many times as fast as the other code, in {RATIOS[key]}:")
        page.table(["pool", "cores", "against", *(f"{one}, in {key.replace('_', '-')}" for one in OURS)], rows)
