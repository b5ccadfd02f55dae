"""Side by side with LIGGGHTS and LAMMPS: simulated seconds a wall second at an equal error of the restitution.

Each code takes the longest step that holds the error, found by measurement: pairs of grains meet head-on, their
contacts beginning at moments spread over a step, and rebound with a speed that is compared with that at FINEST steps a
collision. So each code is compared with the limit of its own law.
"""

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np

from lab.base.errors import LabError
from lab.preset.accuracy import LEVELS
from lab.report.page import Page
from lab.studies.bench.peers import lammps, liggghts
from lab.studies.bench.peers.peer import Task
from lab.studies.bench.speed import processors
from lab.studies.bench.speed.beds import ACETATE, DIAMETER, HEIGHT, SCALE, Bed, usual_bed
from lab.studies.bench.speed.workers import Speeds, Worker, in_turn, ratio, workers
from solvers.motion import Tilt
from solvers.simulation import Simulation

RUNS = {liggghts: liggghts.run_liggghts, lammps: lammps.run_lammps}
LAB = "the lab"
SAME = "the lab's at standard"  # what all codes' steps are set by where they are equal
LEVEL_OF = {0.01: "draft", 0.001: "standard"}  # error of the restitution, the largest over the moments of onset
SPEED, PAIRS = 0.3, 24  # m/s; meeting pairs, each beginning 1/PAIRS of a step later than the one before
STEPS = 8, 10, 12, 15, 19, 24, 30, 38, 48, 60, 75, 95, 120, 150, 190, 240, 300, 380, 480  # a collision, of those tried
FINEST = 3000
LEAN = np.radians(45.0)  # of the tank in which a bed flows
LONGEST_STRIDE = 2  # of the lab's steps while grains are slow, as in its runs
GRAINS = replace(ACETATE, restitution_speed=SPEED)
OURS = {"material": GRAINS, "schedule": "per-world"}
SOFT = replace(GRAINS, young=GRAINS.young * SCALE)  # as a peer is told the material


def study(page: Page, work: Path, fast: bool) -> None:
    """Add the section to the page."""
    codes = colliders()
    page.section("Beside other codes at equal error")
    if len(codes) == 1:
        page.say("No other code is installed here: the comparison is left out.")
        return
    count, turns, grain_steps, course = (500, 2, 2e5, 0.01) if fast else (2000, 5, 1e7, 0.2)
    print("equal error: steps", flush=True)
    taken = steps_taken(codes)
    page.say(f"""Simulated seconds a wall second, one core, 64 bits, {count} grains of 3 mm, {SCALE:g} of the material's
        stiffness, springs with history. All codes take the same step; or each the longest of the tried steps at which,
        and at all shorter ones, the restitution (0.6 at {SPEED:g} m/s) errs by no more than the error named: the
        largest over {PAIRS} moments of onset within a step, against the same code at {FINEST} steps a collision. There
        the lab takes no longer steps than it derives for such collisions at the levels draft (1 %) and standard
        (0.1 %), although this collision would allow them; while grains are slow, they are up to {LONGEST_STRIDE} times
        as long, as in its runs. In flow the tank leans by {np.degrees(LEAN):g} deg, and the settled bed runs to its
        side for {course:g} s, each turn anew.""")
    bed = usual_bed(work, count)
    rows, found = [], []
    for rule, dts in taken.items():
        stretch = 1 if rule == SAME else LONGEST_STRIDE
        for where, speeds in (
            ("at rest", at_rest(bed, dts, turns, grain_steps, stretch=stretch)),
            ("in flow", in_flow(bed, dts, turns, course, stretch=stretch)),
        ):
            for name, values in speeds.items():
                share, dt = f"{duration() / dts[name]:.0f}", f"{1e6 * dts[name]:.2f}"
                times = "" if name == LAB else ratio(speeds[LAB], values)
                rows.append([rule, where, name, share, dt, f"{np.median(values):.3g}", times])
                if name != LAB:
                    found.append(kept_ratio(name, rule, where, speeds[LAB] / values))
    page.table(
        ["step by", "bed", "code", "steps a collision", "step (µs)", "simulated s a wall s", "lab: times as fast"], rows
    )
    if not fast:  # too few turns to be kept
        processors.keep(page.folder, found)


def steps_taken(codes: Mapping[str, Callable]) -> dict[str, dict[str, float]]:
    """The step (s) of each code, by the rule that it follows from."""
    found = {SAME: dict.fromkeys(codes, derived_step("standard"))}
    for error, level in LEVEL_OF.items():
        longest = {name: longest_step(code, error) for name, code in codes.items()}
        found[f"{100.0 * error:g} % of restitution"] = longest | {LAB: min(longest[LAB], derived_step(level))}
    return found


def kept_ratio(code: str, rule: str, where: str, ratios: np.ndarray) -> processors.Ratio:
    """What is kept of a comparison."""
    unit = processors.GRAIN_STEPS if rule == SAME else f"simulated seconds at {rule}"
    least, most, median = (float(f"{pick(ratios):.3g}") for pick in (np.min, np.max, np.median))
    return processors.Ratio(code, *processors.SPRINGS, where, unit, least, most, median)


def duration() -> float:
    """Time (s) that two of the grains touch as they meet at SPEED, losses aside (Hertz; Timoshenko & Goodier 1951)."""
    mass = 0.5 * SOFT.density * np.pi / 6.0 * DIAMETER**3
    young = SOFT.young / (2.0 * (1.0 - SOFT.poisson**2))
    return 2.87 * (mass**2 / (0.25 * DIAMETER * young**2 * SPEED)) ** 0.2


def longest_step(rebounds: Callable[[float], np.ndarray], error: float) -> float:
    """The longest step (s) of those tried at which, and at all shorter ones, rebounds err by at most `error`.

    Raises LabError if they err by more at the shortest.
    """
    limit, found = float(np.mean(rebounds(duration() / FINEST))), 0.0
    for share in reversed(STEPS):
        if np.abs(rebounds(duration() / share) / limit - 1.0).max() > error:
            break
        found = duration() / share
    if not found:
        raise LabError(f"a code's restitution errs by more than {error:g} at {STEPS[-1]} steps a collision.")
    return found


def derived_step(level: str) -> float:
    """The step (s) that the lab derives at a level of accuracy for collisions at SPEED."""
    pair = Bed(np.full(2, 0.5 * DIAMETER), np.zeros((2, 2)), HEIGHT)
    scene = pair.scene(material=GRAINS, gravity=0.0, start_speed=SPEED)
    return scene.longest_step(LEVELS[level].longer_steps)


def colliders() -> dict[str, Callable[[float], np.ndarray]]:
    """How pairs rebound (PAIRS,), m/s, at a step (s) of each code that is installed."""
    found: dict[str, Callable[[float], np.ndarray]] = {LAB: rebounds_here}
    for peer, run in RUNS.items():
        if peer.available() is not None:
            found[peer.NAME] = partial(rebounds_there, run)
    return found


def meeting(dt: float) -> tuple[Bed, np.ndarray, int]:
    """Pairs in a row that meet at SPEED, their velocities (n, 2) m/s, and steps of dt (s) until they have parted."""
    apart = 4.0 * DIAMETER
    left = apart * (np.arange(PAIRS) - 0.5 * PAIRS)
    gap = SPEED * dt * (2.0 + np.arange(PAIRS) / PAIRS)
    position = np.full((PAIRS, 2, 2), 0.5 * HEIGHT)
    position[:, 0, 0], position[:, 1, 0] = left, left + DIAMETER + gap
    velocity = np.zeros((PAIRS, 2, 2))
    velocity[:, 0, 0] = SPEED
    bed = Bed(np.full(2 * PAIRS, 0.5 * DIAMETER), position.reshape(-1, 2), apart * (PAIRS + 2))
    return bed, velocity.reshape(-1, 2), round(4.0 * duration() / dt) + 10


def parted(velocity: np.ndarray) -> np.ndarray:
    """Speeds (PAIRS,) at which the pairs part, from the velocities (n, 2) of all grains, m/s."""
    pairs = velocity.reshape(PAIRS, 2, 2)[..., 0]
    return pairs[:, 1] - pairs[:, 0]


def rebounds_here(dt: float) -> np.ndarray:
    """The lab's rebounds."""
    bed, velocity, steps = meeting(dt)
    scene = bed.scene(material=GRAINS, gravity=0.0, step=dt, start_speed=SPEED)
    run = Simulation(scene, bed.places(), threads=1, arch="cpu")
    run.launch(velocity[None])
    run.advance(steps)
    found = parted(run.snapshot()["velocity"][0])
    run.close()
    return found


def rebounds_there(run: Callable, dt: float) -> np.ndarray:
    """A peer's rebounds."""
    bed, velocity, steps = meeting(dt)
    task = Task(bed.position, bed.radius, bed.width, HEIGHT, SOFT, dt, steps, velocity=velocity, gravity=0.0)
    return parted(run(task).velocity)


def at_rest(bed: Bed, dts: dict[str, float], turns: int, grain_steps: float, **how: object) -> Speeds:
    """Simulated seconds a wall second (turns,) of each code on the bed at rest, each at its step of `dts` (s).

    `how` goes to the lab's `Worker`.
    """
    timings = peers_on(bed, dts, lambda dt: round(grain_steps / bed.count))
    with workers({LAB: partial(Worker, bed, **OURS, step=dts[LAB], **how)}) as own:
        timings[LAB] = lambda: own[LAB].speed(0.5) * dts[LAB] / bed.count
        return in_turn(timings, turns)


def in_flow(bed: Bed, dts: dict[str, float], turns: int, course: float, **how: object) -> Speeds:
    """The same in a leaning tank, over the first `course` (s) from rest."""
    timings = peers_on(bed, dts, lambda dt: round(course / dt), tilt=LEAN)
    leaning = {"motions": [(Tilt(1.0, LEAN),)], "ended": True}
    with workers({LAB: partial(Worker, bed, **OURS, **leaning, step=dts[LAB], **how)}) as own:
        timings[LAB] = lambda: own[LAB].course(course) * dts[LAB] / bed.count
        return in_turn(timings, turns)


def peers_on(bed: Bed, dts: dict[str, float], steps: Callable[[float], int], **how: object) -> dict:
    """Timings of the peers that are installed, in simulated seconds a wall second."""

    def timing(run: Callable, dt: float) -> Callable[[], float]:
        many = max(1, steps(dt))
        task = Task(bed.position, bed.radius, bed.width, HEIGHT, SOFT, dt, many, sample_every=many, **how)
        return lambda: run(task).grain_steps_per_s * dt / bed.count

    return {peer.NAME: timing(run, dts[peer.NAME]) for peer, run in RUNS.items() if peer.NAME in dts}
