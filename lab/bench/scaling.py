"""What a grain costs in worlds of any size, and what a second core gives: python -m lab.bench.scaling.

One bed of a thousand touching grains is settled and set side by side as often as it takes, so that all worlds have the
same contacts a grain; the force between two touching copies is that of the walls that stood there, nearly. Times are
medians of several runs in turn; only their ratios mean something on a shared machine.
"""

import statistics
import time
from collections.abc import Iterator

import numpy as np

from solvers.filling import start_positions
from solvers.materials import Material
from solvers.runtime import available_cores
from solvers.scene import Scene
from solvers.simulation import Simulation

COUNT, DIAMETER, WIDTH = 1000, 3e-3, 96e-3  # of the bed that is copied, m
HEIGHT = 0.2  # m
SIZES = (1, 2, 5, 10, 100, 1000)  # thousands of grains
TURNS = 5
GRAIN_STEPS = 6e6  # of one timing
ACETATE = Material(density=1319.0, young=3.2e9, poisson=0.28, friction=0.25, restitution=0.6)


def tank(width: float) -> np.ndarray:
    """Outline (4, 2) m of a tank."""
    half = width / 2
    return np.array([[-half, 0.0], [half, 0.0], [half, HEIGHT], [-half, HEIGHT]])


def settled_bed() -> tuple[np.ndarray, np.ndarray]:
    """Radii (n,) and settled positions (n, 2), m, of the bed that is copied, in spatial order."""
    random = np.random.default_rng(1)
    radius = 0.5 * DIAMETER * (1.0 + 0.1 * random.uniform(-1.0, 1.0, COUNT))
    scene = Scene(radius, tank(WIDTH), ACETATE, ACETATE, stiffness_scale=1e-3)
    run = Simulation(scene, start_positions(radius, tank(WIDTH), random)[None])
    run.settle(1e-5, 2.0)
    place = run.snapshot()["position"][0]
    run.close()
    order = np.lexsort((place[:, 1], np.floor(place[:, 0] / DIAMETER)))
    return radius[order], place[order]


def copies(bed: tuple[np.ndarray, np.ndarray], number: int, schedule: str, threads: int) -> Simulation:
    """So many copies of the bed side by side in one tank."""
    radius, place = bed
    shifts = WIDTH * (np.arange(number) - 0.5 * (number - 1))
    position = np.concatenate([place + np.array([shift, 0.0]) for shift in shifts])
    outline = tank(WIDTH * number)
    scene = Scene(np.tile(radius, number), outline, ACETATE, ACETATE, stiffness_scale=1e-3, schedule=schedule)
    return Simulation(scene, position[None], threads)


def speed(run: Simulation) -> float:
    """Grain-steps a second of one timing."""
    steps = max(10, int(GRAIN_STEPS / run.scene.radius.size))
    begun = time.perf_counter()
    run.advance(steps)
    return steps * run.scene.radius.size / (time.perf_counter() - begun)


def measure() -> Iterator[tuple[int, float, float]]:
    """Grains, grain-steps a second on one core, and how many times as many in bands on all cores."""
    bed, cores = settled_bed(), available_cores()
    for number in SIZES:
        one, bands = [], []
        for schedule, threads, found in (("per-world", 1, one), ("per-band", cores, bands)):
            run = copies(bed, number, schedule, threads)
            run.advance(20)
            found += [speed(run) for _ in range(TURNS)]
            run.close()
        yield number * COUNT, statistics.median(one), statistics.median(bands) / statistics.median(one)


def main() -> None:
    """Print the table."""
    print("| grains | million grain-steps a second, one core | times as fast in bands on all cores |\n|---|---|---|")
    for grains, alone, gain in measure():
        print(f"| {grains} | {alone / 1e6:.1f} | {gain:.2f} |", flush=True)


if __name__ == "__main__":
    main()
