"""The same pool of water on a graphics processor and on the processor: its course, its errors, and its speed."""

from collections.abc import Mapping
from functools import partial
from pathlib import Path

import numpy as np

from lab.base.errors import LabError
from lab.report.page import Page
from lab.studies.bench.gpu.drawing import plotted
from lab.studies.bench.water.accuracy import followed_here, resting, waving
from lab.studies.bench.water.cases import DEPTH, GRAVITY, Case, gentle
from lab.studies.bench.water.workers import Worker

ROWS, FEW = 25, 10  # of the pool that is compared; of it in haste
STEPS = 100  # of the course that is compared
NEIGHBOURS = 50  # within 2 h = 4 spacings
PULLED = 7.0 / 3.0  # ∫ |∇W| dA of Wendland's C2 kernel in the plane, in 1/h
SHARE = 0.1  # of the processor's error, that of its particles: rounding must not be seen beside that
SIZES, BATCHES = (50, 100, 224, 500, 1000), (4, 40, 400)  # rows of one pool; pools of SIZES[0] rows
UPDATES, LEAST, WALL, TURNS = 4e6, 40, 0.3, 5  # particle-steps, steps and s of a turn at least
ONE, BATCH = "one pool", "pools side by side"
SPEEDS = {"particle_steps": "M", "seconds": "simulated s/s"}
Timed = dict[str, Mapping[str, np.ndarray]]  # by precision


def correctness(page: Page, work: Path, arch: str, precisions: tuple[str, ...], rows: int = ROWS) -> None:
    """Tell whether water on a device is the processor's in 64 bits."""
    expected = numbers_of("cpu", rows, "f64", "auto")
    table = []
    for precision in precisions:
        print(f"gpu: {arch}, {precision}, water", flush=True)
        found = numbers_of(arch, rows, precision, "per-grain")
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
    rounded = STEPS * of_place * float(np.abs(case.drops[:, :2]).max())
    return (rounded + drifted) / case.spacing, pushed


KINDS = {"f64": (np.float64, np.float64), "mixed": (np.float64, np.float32), "f32": (np.float32, np.float32)}


def speed(page: Page, work: Path, arch: str, precisions: tuple[str, ...], fast: bool) -> None:
    """Tell particle-steps and simulated seconds a second of a device: ever finer pools, and pools side by side."""
    sizes = [(ONE, rows, 1) for rows in SIZES] + [(BATCH, SIZES[0], worlds) for worlds in BATCHES]
    if fast:
        sizes = [(ONE, FEW, 1), (BATCH, FEW, BATCHES[0])]
    found: dict[tuple[str, int], Timed] = {}
    for shape, rows, worlds in sizes:
        case = gentle(rows)
        found[shape, worlds * case.count] = timed(page, case, worlds, arch, precisions, 2 if fast else TURNS)
    page.say(f"""Water: the same pool with ever smaller particles, and pools of {FEW if fast else SIZES[0]} rows side by
        side, with lists that are made anew as the water asks. Simulated seconds are those of all pools together.""")
    heads = [f"{words}, {precision}" for precision in precisions for words in SPEEDS.values()]
    page.table(
        ["particles", "in", *heads], [[f"{n:,}", shape, *_cells(v, precisions)] for (shape, n), v in found.items()]
    )
    drawn = {size: {precision: one["particle_steps"] for precision, one in v.items()} for size, v in found.items()}
    page.figure(f"{arch}-water", plotted(drawn, "particle"), f"Particle-steps a second on {arch}")


def timed(page: Page, case: Case, worlds: int, arch: str, precisions: tuple[str, ...], turns: int) -> Timed:
    """Particle-steps and simulated seconds a second (turns,) by precision; where one breaks off the page says so."""
    found: Timed = {}
    for precision in precisions:  # one at a time, since the device may hold no more
        print(f"gpu: {arch}, {precision}, {worlds * case.count} particles in {worlds}", flush=True)
        try:
            worker = Worker(case, ahead=LEAST, arch=arch, precision=precision, schedule="per-grain", worlds=worlds)
        except LabError as error:
            page.say(f"{worlds * case.count:,} particles in {worlds}, {precision}: {error}")
            continue
        try:
            steps = max(LEAST, round(UPDATES / (worlds * case.count)))
            runs = [worker.run(steps * worker.step(), WALL) for _ in range(turns)]
        finally:
            worker.close()
        found[precision] = {
            "particle_steps": np.array([run.steps * run.particles / run.loop_s for run in runs]),
            "seconds": np.array([worlds * run.seconds / run.loop_s for run in runs]),
        }
    return found


def _cells(by_precision: Timed, precisions: tuple[str, ...]) -> list[float | str]:
    """Medians of both speeds for each precision."""
    cells: list[float | str] = []
    for precision in precisions:
        for name in SPEEDS:
            known = by_precision.get(precision)
            scale = 1e-6 if name == "particle_steps" else 1.0
            cells.append("–" if known is None else scale * float(np.median(known[name])))
    return cells
