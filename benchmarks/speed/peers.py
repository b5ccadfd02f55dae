"""Side by side with LIGGGHTS and LAMMPS: the same settled bed, stiffness, step and contact law, runs in turn."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path

from benchmarks.peers import lammps, liggghts
from benchmarks.peers.peer import Task
from benchmarks.speed import processors
from benchmarks.speed.beds import ACETATE, HEIGHT, SCALE, Bed, usual_bed
from benchmarks.speed.workers import Speeds, Worker, in_turn, millions, ratio, workers
from lab.base.errors import LabError
from lab.report.page import Page

COPIES = 100  # of the bed, of the large world
RUNS = {liggghts: liggghts.run_liggghts, lammps: lammps.run_lammps}
STYLES = {"history": "history", "no_history": "no history"}
LAWS = {"mindlin": "history (Mindlin)", "haff-werner": "Haff–Werner"}
OURS = "the lab, {}"
GRAIN_STEPS = 1e7  # of one run of a peer
PROCESSES = 2
SOFT = replace(ACETATE, young=ACETATE.young * SCALE)  # as a peer is told the material

Timing = Callable[[], float]


def study(page: Page, work: Path, fast: bool) -> None:
    """Add the section to the page."""
    count, turns, seconds, work_of_one = (500, 3, 0.1, 1e6) if fast else (2000, 5, 0.4, GRAIN_STEPS)
    page.section("Beside other codes")
    page.say("By processor, also of earlier measurements and of others: [speed-peers.md](speed-peers.md).")
    missing = [peer.NAME for peer in RUNS if peer.available() is None]
    for name in missing:
        page.say(f"{name} is not installed here: the comparison with it is left out.")
    if len(missing) == len(RUNS):
        return
    bed = usual_bed(work, count)
    page.say(f"""One core, a settled world of {count} grains, {SCALE:g} of the material's stiffness, our automatic step
        for every code, 64 bits. A peer starts each run from the settled places; its time is the loop time it prints,
        without set-up. With history its law is Hertz's with Mindlin's tangential spring, as ours; without, Hertz's in
        LIGGGHTS and a linear spring in LAMMPS with a tangential dashpot under Coulomb's limit, as Haff and Werner's.
        Decks and choices for speed: `benchmarks/peers/`.""")
    print("peers: one core", flush=True)
    found = on_one_core(bed, turns, seconds, work_of_one)
    theirs = [name for name in found if not name.startswith(OURS.format(""))]
    ours = [name for name in found if name not in theirs]
    page.table(
        ["code", "M", *(f"{name}: times as fast" for name in ours)],
        [[name, millions(found[name]), *(ratio(found[own], found[name]) for own in ours)] for name in theirs]
        + [[name, millions(found[name]), *("" for _ in ours)] for name in ours],
    )
    if not fast:  # too few turns to be kept
        processors.keep(page.folder, processors.ratios_of(found, theirs, ours))
    if lammps.available() is not None:
        _on_two_cores(page, bed.times(10 if fast else COPIES), turns, seconds, work_of_one)


def on_one_core(bed: Bed, turns: int, seconds: float, grain_steps: float) -> Speeds:
    """Grain-steps a second (turns,) of each code with each law on one core, in turn."""
    made = {OURS.format(says): partial(Worker, bed, schedule="per-world", tangential=law) for law, says in LAWS.items()}
    with workers(made) as own:
        steps = max(1, round(grain_steps / bed.count))
        dt = next(iter(own.values())).dt
        timings: dict[str, Timing] = {}
        for peer, run in RUNS.items():
            if peer.available() is not None:
                for style, says in STYLES.items():
                    timings[f"{peer.NAME}, {says}"] = peer_timing(run, bed, dt, steps, tangential=style)
        timings |= {name: partial(worker.speed, seconds) for name, worker in own.items()}
        return in_turn(timings, turns)


def peer_timing(run: Callable, bed: Bed, dt: float, steps: int, **how: object) -> Timing:
    """A timing of a peer on a bed: grain-steps per second over `steps` steps of `dt` (s)."""
    task = Task(bed.position, bed.radius, bed.width, HEIGHT, SOFT, dt, steps, sample_every=steps, **how)
    return lambda: run(task).grain_steps_per_s


def _on_two_cores(page: Page, bed: Bed, turns: int, seconds: float, grain_steps: float) -> None:
    print("peers: two cores", flush=True)
    page.say(f"""Two cores, one world of {bed.count:,} grains, copies of that bed side by side, history: LAMMPS as
        {PROCESSES} MPI processes, ours in {PROCESSES} bands.""")
    name, ours = f"LAMMPS, {PROCESSES} processes", OURS.format(f"{PROCESSES} bands")
    with workers({ours: partial(Worker, bed, PROCESSES, schedule="per-band")}) as own:
        steps = max(1, round(grain_steps * PROCESSES / bed.count))
        theirs = peer_timing(lammps.run_lammps, bed, own[ours].dt, steps, processes=PROCESSES)
        try:
            found = in_turn({name: theirs, ours: partial(own[ours].speed, seconds)}, turns)
        except LabError as error:
            page.say(f"That could not be run here: {error}")
            return
    page.table(
        ["code", "M", f"{ours}: times as fast"],
        [[name, millions(found[name]), ratio(found[ours], found[name])], [ours, millions(found[ours]), ""]],
    )
