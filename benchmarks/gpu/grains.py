"""The same bed of grains on a graphics processor and on the processor: its places, and grain-steps a second."""

from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from functools import partial
from itertools import product
from multiprocessing import get_context
from pathlib import Path

import numpy as np

from benchmarks.gpu.drawing import plotted
from benchmarks.gpu.turns import BESIDE, Sizes, at_once, heading
from benchmarks.speed.beds import DIAMETER, Bed, bed_of_spheres, usual_bed
from benchmarks.speed.workers import Worker, millions
from lab.base.errors import LabError
from lab.report.page import Page
from solvers.machine.errors import BadState, Unavailable
from solvers.machine.runtime import available_cores
from solvers.motion import Sway
from solvers.simulation import Simulation

COUNT, TRIED = 2000, 500  # grains of the bed that worlds are made of, and of the bed that is swayed
COPIES = (1, 5, 50, 500)  # side by side in one world, and worlds in a batch
SWAY, TIME = Sway(0.015, 3.0), 0.02  # m, Hz; s
WALL = 0.3  # s of a turn
ROUNDINGS = 10.0  # times what another order of sums changes on the processor, or than a place's last digit
ONE, BATCH = SHAPES = "one world", f"worlds of {COUNT} grains"


@dataclass(frozen=True)
class OnDevices:
    """Beds of grains on devices: how a settled bed of so many is had, from the folder that keeps it, and their name."""

    bed: Callable[[Path, int], Bed]
    noun: str

    def correctness(self, page: Page, work: Path, arch: str, precisions: tuple[str, ...]) -> None:
        """Tell how far from the processor's places grains of a device end."""
        bed = self.bed(work, TRIED)
        print(f"gpu: {arch}, correctness of {self.noun}", flush=True)
        ways = ("cpu", "per-grain"), ("cpu", "per-world"), (arch, "per-grain")
        asked = list(product(precisions, ways))
        places = at_once(lambda precision, way: places_of(way[0], bed, precision, way[1]), asked)
        ends, rows = dict(zip(asked, places, strict=True)), []
        for precision in precisions:
            expected, reordered, found = (ends[precision, way] for way in ways)
            reordered, error = farthest(reordered, expected), farthest(found, expected)
            tolerance = ROUNDINGS * max(reordered, last_digit(precision, bed))
            verdict = "pass" if error <= tolerance else "fail"
            rows.append([precision, f"{error:.1e}", f"{reordered:.1e}", f"{tolerance:.1e}", verdict])
        page.say(f"""{self.noun.capitalize()}: a bed of {TRIED} swayed by {1e3 * SWAY.amplitude:g} mm at
            {SWAY.frequency:g} Hz for {TIME:g} s without soft start, against the processor with the same schedule and
            precision: largest distance of a grain, in diameters. The tolerance is rounding: {ROUNDINGS:g} times what
            another order of sums (schedule per-world) does on the processor, or the last digit of a place if that is
            more.""")
        page.table(["precision", "error (d)", "another order of sums (d)", "tolerance (d)", "verdict"], rows)

    def speed(self, page: Page, work: Path, arch: str, precisions: tuple[str, ...], fast: bool) -> None:
        """Tell grain-steps a second of a device by number of grains."""
        copies, turns = (COPIES[:2], 3) if fast else (COPIES, 7)
        bed = self.bed(work, COUNT)
        page.say(f"""{self.noun.capitalize()}: grain-steps a second. {COUNT} settled grains and as many copies side by
            side in one world as it takes, or as many worlds of them. At the ends of the longest, 32 bits resolve
            {1e6 * DIAMETER * last_digit("f32", bed.times(copies[-1])):.2g} µm only: that is for speed, not for
            physics.""")
        names, sizes, found = (*precisions, BESIDE), Sizes(work, f"{arch}-{self.noun}", fast), {}
        for shape, number in product(SHAPES, copies):
            makers = {name: partial(worker, bed, number, shape, arch, name) for name in names}
            size = f"{arch}, {number * COUNT} {self.noun}, {shape}"
            timings, faults = sizes.timed(size, makers, lambda made: made.speed(WALL), turns)
            found[shape, number] = {name: np.array(speeds) for name, speeds in timings.items()}
            for name, why in faults.items():
                page.say(f"{number * COUNT:,} {self.noun}, {shape}, {name}: {why}")
        page.table(
            [self.noun, "in", *(f"M, {heading(name)}" for name in names)],
            [
                [f"{n * COUNT:,}", shape, *(millions(v[name]) if name in v else "–" for name in names)]
                for (shape, n), v in found.items()
            ],
        )
        drawn = {(shape, number * COUNT): speeds for (shape, number), speeds in found.items()}
        page.figure(
            f"{arch}-{self.noun}",
            plotted(drawn, "grain"),
            f"Grain-steps a second on {arch} against the number of {self.noun}",
        )


DISCS, SPHERES = OnDevices(usual_bed, "grains"), OnDevices(bed_of_spheres, "spheres")


def places_of(arch: str, bed: Bed, precision: str, schedule: str) -> np.ndarray:
    """Places (n, axes) m of the swayed bed at the end, worked out in a process of its own. Raises LabError."""
    with ProcessPoolExecutor(1, get_context("spawn")) as pool:
        try:
            return pool.submit(swayed, arch, bed, precision, schedule).result()
        except BrokenProcessPool:
            raise LabError(f"the process that ran on {arch} was lost.") from None
        except (BadState, Unavailable) as error:
            raise LabError(str(error)) from None


def swayed(arch: str, bed: Bed, precision: str, schedule: str) -> np.ndarray:
    """Places (n, axes) m of the swayed bed at the end."""
    scene = bed.scene(precision=precision, schedule=schedule, motions=[(SWAY,)])
    run = Simulation(scene, bed.places(), threads=1, arch=arch)
    run.advance(round(TIME / run.dt))
    place = run.snapshot()["position"][0].astype(float)
    run.close()
    return place


def farthest(found: np.ndarray, expected: np.ndarray) -> float:
    """The largest distance (d) of a grain from where it is expected."""
    return float(np.linalg.norm(found - expected, axis=1).max() / DIAMETER)


def last_digit(precision: str, bed: Bed) -> float:
    """The last digit (d) of a place in the tank."""
    kind = np.float32 if precision == "f32" else np.float64
    return float(np.finfo(kind).eps * np.abs(bed.position).max() / DIAMETER)


def worker(bed: Bed, number: int, shape: str, arch: str, name: str) -> Worker:
    """So many copies of a bed in one world or in one each: on a device in the precision `name`, or BESIDE it."""
    how = {"arch": arch, "precision": name, "schedule": "per-grain"}
    if name == BESIDE:
        how = {"threads": available_cores(), "precision": "mixed"}
    return Worker(bed.times(number), **how) if shape == ONE else Worker(bed, worlds=number, **how)
