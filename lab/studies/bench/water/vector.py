"""What share of a core's vector peak the two passes over pairs reach, with operations counted by hand from the source.

Counted for the defaults without shifting, one phase, no periodic axes: sums, differences, products and largest values
are one operation each, roots and divisions one each. The kernels work on LANES particles of a block at once, against
one neighbour of the block after the other: many of these are too far from some of the lanes, which compute with zeros.
"""

import os
import time
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from lab.report.page import Page
from lab.studies.bench.aside import Aside
from lab.studies.bench.water.cases import gentle
from lab.studies.bench.water.workers import Worker
from solvers.fluid.state import LANES

# Operations of a listed neighbour and one lane, in each pass.
COUNTS = {
    # Δy, Δz 2, their squares' sum 3, root, t 3, V t³ 3
    "where they are and the kernel's slope, `Forces` and `Continuity` each": (2 * 12, 2),
    # Pressures 2, nearing 2, its product 3, π 2, along 2, loss 2, V ∇W 2, push 4, gradient 5, matrix 6
    "`Forces.push_block`": (30, 1),
    # Nearing 2, opening 5, excess 2, gradients 2 + 4, sum 2
    "`Continuity.expand_block`": (17, 0),
}
OPERATIONS = sum(simple + slow for simple, slow in COUNTS.values())
ROWS, FEW, TURNS, WALL, PASS = 100, 20, 5, 1.0, 0.06
SIZE, TIMES = 768, 10  # rows of the matrices; products
FMA_PIPES = 2  # as most processors with AVX-512 are said to have
FREQUENCY = Path("/proc/cpuinfo")


def study(page: Page, work: Path, fast: bool) -> None:
    """Add the section to the page."""
    found = measured(FEW if fast else ROWS)
    most, clock = peak(), clock_rate()
    lanes, pairs, seconds = found["lanes"], found["pairs"], found["seconds"]
    executed, useful = (1e-9 * OPERATIONS * count / seconds for count in (lanes, pairs))
    page.section("Share of the vector peak")
    page.say(f"""The gentle pool with {ROWS} rows on one core, mixed precision, whole steps with lists and walls. Of
        {lanes:.0f} lanes a particle that its block's lists name, {pairs:.0f} are within reach; each is gone through
        twice. Peak: what a product of matrices with 32 bits reaches on one core, by the library that NumPy has.""")
    header = ["per listed neighbour and lane", "operations", "roots and divisions"]
    page.table(header, [[where, str(simple), str(slow)] for where, (simple, slow) in COUNTS.items()])
    rows = [
        ["ns a particle-step", f"{1e9 * seconds:.0f}", ""],
        ["executed, Gflop/s", executed, f"{executed / most:.0%}"],
        ["within reach, Gflop/s", useful, f"{useful / most:.0%}"],
        ["product of matrices, Gflop/s", most, "100%"],
    ]
    if clock:
        nominal = FMA_PIPES * LANES * 2.0 * 1e-9 * clock
        name = f"{FMA_PIPES} × {LANES} fused multiply-adds at the {1e-9 * clock:.2f} GHz that the system names, Gflop/s"
        rows.append([name, nominal, f"{nominal / most:.0%}"])
        rows.append(["executed, of these", "", f"{executed / nominal:.0%}"])
    page.table(["", "measured", "share of the peak"], rows)


def measured(rows: int) -> Mapping[str, float]:
    """Lanes that the lists name and neighbours within reach, a particle; seconds of a particle-step, the median."""
    case = gentle(rows)
    worker = Worker(case)
    try:
        runs = [worker.run(PASS, WALL) for _ in range(TURNS)]
        listed = worker.listed()
        place = worker.frames([PASS])[0].position
    finally:
        worker.close()
    reach = 4.0 * case.spacing
    tree = cKDTree(place)
    return {
        "lanes": LANES * listed / case.count,
        "pairs": tree.count_neighbors(tree, reach) / case.count,
        "seconds": float(np.median([run.busy_s / (run.steps * run.particles) for run in runs])),
    }


def peak() -> float:
    """Gflop/s of one core in a product of 32-bit matrices."""
    before = os.environ.get("OPENBLAS_NUM_THREADS")
    os.environ["OPENBLAS_NUM_THREADS"] = "1"  # of a process that is begun now
    try:
        aside = Aside(_Product)
    finally:
        os.environ.pop("OPENBLAS_NUM_THREADS")
        if before is not None:
            os.environ["OPENBLAS_NUM_THREADS"] = before
    try:
        return max(aside.ask("rate") for _ in range(TURNS))
    finally:
        aside.close()


def clock_rate() -> float:
    """The clock (Hz) that the system names; 0 where it names none."""
    if not FREQUENCY.is_file():
        return 0.0
    named = [line.split(":")[1] for line in FREQUENCY.read_text().splitlines() if line.startswith("cpu MHz")]
    return 1e6 * float(named[0]) if named else 0.0


class _Product:
    """Products of two matrices in a process of their own."""

    def __init__(self) -> None:
        self.one = np.random.default_rng(1).random((SIZE, SIZE), dtype=np.float32)

    def rate(self) -> float:
        begun = time.process_time()
        for _ in range(TIMES):
            self.one @ self.one
        return 2e-9 * TIMES * SIZE**3 / (time.process_time() - begun)
