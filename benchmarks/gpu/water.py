"""The same pool of water on a graphics processor and on the processor: its course, its errors, and its speed."""

from collections.abc import Mapping
from functools import partial
from pathlib import Path

import numpy as np

from benchmarks.gpu.drawing import plotted
from benchmarks.gpu.turns import BESIDE, Sizes, at_once, heading
from benchmarks.water.accuracy import followed_here, resting, waving
from benchmarks.water.cases import DEPTH, GRAVITY, Case, gentle
from benchmarks.water.workers import Worker
from lab.report.page import Page
from solvers.machine.runtime import available_cores

ROWS, FEW = 25, 10  # of the pool that is compared; of it in haste
STEPS = 100  # of the course that is compared
NEIGHBOURS = 50  # within 2 h = 4 spacings
PULLED = 7.0 / 3.0  # ∫ |∇W| dA of Wendland's C2 kernel in the plane, in 1/h
SHARE = 0.1  # of the processor's error, that of its particles: rounding must not be seen beside that
SIZES = (22, 50, 100, 224, 500, 1000)  # rows of one pool
BATCHED, BATCHES = 50, (4, 40, 400)  # rows of pools side by side, and how many
UPDATES, LEAST, WALL, TURNS = 4e6, 40, 0.3, 5  # particle-steps, steps and s of a turn at least
ONE, BATCH = "one pool", "pools side by side"
SPEEDS = {"particle_steps": "M", "seconds": "simulated s/s"}
Timed = dict[str, Mapping[str, np.ndarray]]  # by precision, or BESIDE


def correctness(page: Page, work: Path, arch: str, precisions: tuple[str, ...], rows: int = ROWS) -> None:
    """Tell whether water on a device is the processor's in 64 bits."""
    print(f"gpu: {arch}, correctness of water", flush=True)
    ways = [("cpu", rows, "f64", "auto"), *((arch, rows, precision, "per-grain") for precision in precisions)]
    expected, *founds = at_once(numbers_of, ways)
    table = []
    for precision, found in zip(precisions, founds, strict=True):
        table += compared(found, expected, precision, gentle(rows))
    page.say(f"""Water: a pool of 2 m by 1 m with {rows} rows of particles, particle by particle, against whole worlds
        on the processor in 64 bits. Places: the farthest that a particle is off after {STEPS} steps of a standing wave
        of 20 mm, in spacings. Momentum: what weight and load on the tank leave unexplained of its change in these
        steps, of the weight. Both may err by rounding: half a last digit of a place in each half step, and of each of
        the {NEIGHBOURS} terms of a sum of forces, all with one sign. Pressure at rest (root mean square error over
        ρ g H), frequency and loss of height of the wave in a period (beside linear theory) are the errors of the
        particles: they may differ from the processor's by {SHARE:g} of its own.""")
    page.table(["precision", "what", "device", "processor", "may differ by", "verdict"], table)


def numbers_of(arch: str, rows: int, precision: str, schedule: str) -> dict[str, np.ndarray]:
    """What is compared, of one way to run the pool. Raises LabError."""
    how = {"arch": arch, "precision": precision, "schedule": schedule}
    case = gentle(rows)
    worker = Worker(case, ahead=1, **how)
    try:
        step, missed = worker.step(), worker.unbalanced(STEPS)
        place = worker.frames([STEPS * step])[0].position
    finally:
        worker.close()
    follow = partial(followed_here, **how)
    pressure, _ = resting(follow, rows)
    rate, loss = waving(follow, rows)
    found = {"place": place, "step": step, "momentum": missed, "pressure": pressure, "rate": rate, "loss": loss}
    return {name: np.asarray(value, dtype=float) for name, value in found.items()}


def compared(
    found: Mapping[str, np.ndarray], expected: Mapping[str, np.ndarray], precision: str, case: Case
) -> list[list[str]]:
    """The rows of one precision: what is compared, both numbers, by what they may differ, and the verdict."""
    of_place, of_force = rounding(precision, case, float(expected["step"]))
    off = float(np.linalg.norm(found["place"] - expected["place"], axis=1).max() / case.spacing)
    lines = [
        ("places, spacings", off, 0.0, of_place),
        ("momentum, of the weight", float(found["momentum"]), 0.0, of_force),
    ]
    for name, words in {
        "pressure": "pressure at rest, %",
        "rate": "frequency, %",
        "loss": "loss in a period, %",
    }.items():
        lines.append((words, float(found[name]), float(expected[name]), SHARE * abs(float(expected[name]))))
    return [
        [
            precision,
            words,
            f"{one:.3g}",
            f"{other:.3g}",
            f"{allowed:.2g}",
            "pass" if abs(one - other) <= allowed else "fail",
        ]
        for words, one, other, allowed in lines
    ]


def rounding(precision: str, case: Case, step: float) -> tuple[float, float]:
    """What rounding may do in STEPS steps: to a place, in spacings, and to momentum, of the weight.

    A place is rounded in both halves of a step. The forces on a particle, without their signs, add up to
    ∫ 2 p/ρ |∇W| dA = 2 g d PULLED/h at a depth d, at most 2 g H PULLED/h and half of it in the mean; each sum has as
    many roundings as terms. Nothing that magnifies differences is counted: the course is gentle.
    """
    of_place, of_force = (float(np.finfo(kind).eps) for kind in KINDS[precision])
    pushed = 0.5 * NEIGHBOURS * of_force * PULLED * DEPTH / (2.0 * case.spacing)  # of g, in the mean over depths
    drifted = GRAVITY * pushed * (STEPS * step) ** 2  # m, ½ a t² of the deepest
    rounded = STEPS * of_place * float(np.abs(case.drops["position"]).max())
    return (rounded + drifted) / case.spacing, pushed


KINDS = {"f64": (np.float64, np.float64), "mixed": (np.float64, np.float32), "f32": (np.float32, np.float32)}


def speed(page: Page, work: Path, arch: str, precisions: tuple[str, ...], fast: bool) -> None:
    """Tell particle-steps and simulated seconds a second of a device: ever finer pools, and pools side by side."""
    sizes = [(ONE, rows, 1) for rows in SIZES] + [(BATCH, BATCHED, worlds) for worlds in BATCHES]
    if fast:
        sizes = [(ONE, FEW, 1), (BATCH, FEW, BATCHES[0])]
    found: dict[tuple[str, int], Timed] = {}
    names, kept = (*precisions, BESIDE), Sizes(work, f"{arch}-water", fast)
    for shape, rows, worlds in sizes:
        case = gentle(rows)
        makers = {name: partial(worker, case, worlds, arch, name) for name in names}
        count = worlds * case.count
        a_turn = partial(stepped, max(LEAST, round(UPDATES / count)))
        timings, faults = kept.timed(f"{arch}, {count} particles, {shape}", makers, a_turn, 2 if fast else TURNS)
        found[shape, count] = {
            name: dict(zip(SPEEDS, np.array(turns).T, strict=True)) for name, turns in timings.items()
        }
        for name, why in faults.items():
            page.say(f"{count:,} particles, {shape}, {name}: {why}")
    page.say(f"""Water: the same pool with ever smaller particles, and pools of {FEW if fast else BATCHED} rows side by
        side, with lists that are made anew as the water asks. Simulated seconds are those of all pools together.""")
    heads = [f"{words}, {heading(name)}" for name in names for words in SPEEDS.values()]
    page.table(["particles", "in", *heads], [[f"{n:,}", shape, *_cells(v, names)] for (shape, n), v in found.items()])
    drawn = {size: {name: one["particle_steps"] for name, one in v.items()} for size, v in found.items()}
    page.figure(f"{arch}-water", plotted(drawn, "particle"), f"Particle-steps a second on {arch}")


def worker(case: Case, worlds: int, arch: str, name: str) -> Worker:
    """So many pools side by side: on a device in the precision `name`, or on the processor BESIDE it."""
    how = {"arch": arch, "precision": name, "schedule": "per-grain"}
    if name == BESIDE:
        how = {"threads": available_cores(), "precision": "mixed"}
    return Worker(case, ahead=LEAST, worlds=worlds, **how)


def stepped(steps: int, made: Worker) -> list[float]:
    """Particle-steps and simulated seconds of all pools together, a second, in a turn of at least so many steps."""
    run = made.run(steps * made.step(), WALL)
    return [run.steps * run.particles / run.loop_s, made.worlds * run.seconds / run.loop_s]


def _cells(timings: Timed, names: tuple[str, ...]) -> list[float | str]:
    """Medians of both speeds of each name."""
    cells: list[float | str] = []
    for name in names:
        for kind in SPEEDS:
            scale = 1e-6 if kind == "particle_steps" else 1.0
            cells.append(scale * float(np.median(timings[name][kind])) if name in timings else "–")
    return cells
