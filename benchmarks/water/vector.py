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

from benchmarks.aside import Aside
from benchmarks.water.cases import gentle
from benchmarks.water.workers import Worker
from lab.report.page import Page
from solvers.fluid import state
from solvers.machine.quantity import PLANE

LANES = state.LANES[PLANE]

# Operations of a listed neighbour and one lane, in each pass.
COUNTS = {
    # Δy, Δz 2, their squares' sum 3, root, t 3, V t³ 3
    "where they are and the kernel's slope, `Forces` and `Continuity` each": (2 * 11, 2),
    # Pressures 2, push 4, nearing 2, its product 3, π 2, loss 2, drag 4, V ∇W 2, its sum 2, gradient 5, matrix 6
    "`Forces.pass_block`": (34, 1),
    # Nearing 2, opening 5, deviation 2, gradients 2 + 4, sum 2
    "`Continuity.pass_block`": (17, 0),
}
OPERATIONS = sum(simple + slow for simple, slow in COUNTS.values())
ROWS, FEW, TURNS, WALL, PASS = 100, 20, 5, 1.0, 0.06
SIZE, TIMES = 768, 10  # rows of the matrices; products


def study(page: Page, work: Path, fast: bool) -> None:
    """Add the section to the page."""
    rows = FEW if fast else ROWS
    found, most = measured(rows), peak()
    lanes, pairs, seconds = found["lanes"], found["pairs"], found["seconds"]
    computed, useful = (1e-9 * OPERATIONS * count / seconds for count in (lanes, pairs))
    page.section("Share of the vector peak")
    page.say(f"""The gentle pool with {rows} rows on one core, mixed precision, whole steps with lists and walls.
        Particles are computed in blocks of {LANES}, each lane of a vector one of them, against every neighbour that
        the block lists: {lanes:.0f} a particle, of which {pairs:.0f} are within its reach; the others are computed,
        too, and give nothing. Both passes go through all of them. The peak is what a product of matrices with 32 bits
        reaches on the same core, in NumPy's library: its operations are multiplications with an addition, two at once,
        while few of those of water come in such pairs, and roots and divisions take longer than is counted here.""")
    header = ["per listed neighbour and lane", "operations", "roots and divisions"]
    page.table(header, [[where, str(simple), str(slow)] for where, (simple, slow) in COUNTS.items()])
    table = [
        ["ns a particle-step", f"{1e9 * seconds:.0f}", ""],
        ["computed, Gflop/s", computed, f"{computed / most:.0%}"],
        ["of it within reach, Gflop/s", useful, f"{useful / most:.0%}"],
        ["product of matrices, Gflop/s", most, "100%"],
    ]
    page.table(["", "measured", "share of the peak"], table)


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


class _Product:
    """Products of two matrices in a process of their own."""

    def __init__(self) -> None:
        self.one = np.random.default_rng(1).random((SIZE, SIZE), dtype=np.float32)

    def rate(self) -> float:
        begun = time.process_time()
        for _ in range(TIMES):
            self.one @ self.one
        return 2e-9 * TIMES * SIZE**3 / (time.process_time() - begun)
