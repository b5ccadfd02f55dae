"""cargolab bench gpu: the same bed on GPUs and on the CPU, compared in results and in speed."""

from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from functools import partial
from multiprocessing import get_context
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from lab.base.errors import LabError
from lab.report.page import Page
from lab.report.plots import BELOW, BLUE, GREEN, VERMILION
from lab.studies.bench.devices import Device, device
from lab.studies.bench.speed.beds import DIAMETER, Bed, usual_bed
from lab.studies.bench.speed.drawing import draw_with_range
from lab.studies.bench.speed.workers import Speeds, Worker, compared, millions
from lab.studies.engine import Bench
from solvers.machine import runtime
from solvers.machine.errors import BadState, Unavailable
from solvers.motion import Sway
from solvers.simulation import Simulation

ARCHES = {"cuda": ("f64", "mixed", "f32"), "vulkan": ("f32",)}
COLOURS = {"f64": BLUE, "mixed": GREEN, "f32": VERMILION}
COUNT, TRIED = 2000, 500  # grains of the bed that worlds are made of, and of the bed that is swayed
COPIES = (5, 50, 500, 2000)  # side by side in one world, and worlds in a batch
SWAY, TIME = Sway(0.015, 3.0), 0.02  # m, Hz; s
ROUNDINGS = 10.0  # times what another order of sums changes on the processor, or than a place's last digit
ONE, BATCH = SHAPES = "one world", f"worlds of {COUNT} grains"


def study(page: Page, work: Path, fast: bool, arch: str) -> None:
    """Add the section on one kind of device to the page."""
    precisions = ARCHES[arch]
    page.section(arch.upper() if arch == "cuda" else arch.capitalize())
    found, why_not = there(arch, precisions[-1])
    if found is None:
        page.say(f"Unmeasured: {why_not}")
        return
    page.say(f"Device: {found.name}{', which is software on the processor' if found.software else ''}.")
    if found.software and not fast:
        page.say("Unmeasured: software is no graphics processor; `cargolab bench gpu --fast` tries it on small beds.")
        return
    try:
        _correctness(page, work, arch, precisions)
        _speed(page, work, arch, precisions, COPIES[:1] if fast else COPIES, 3 if fast else 7)
    except LabError as error:
        page.say(f"It broke off: {error}")


def there(arch: str, precision: str) -> tuple[Device | None, str]:
    """The device of an arch, or none and the reason in a sentence."""
    try:
        runtime.choose_arch(arch, precision)
    except Unavailable as error:
        return None, str(error)
    found = device(arch)
    return found, "" if found else f"the driver of {arch} tells of no device."


def _correctness(page: Page, work: Path, arch: str, precisions: tuple[str, ...]) -> None:
    bed = usual_bed(work, TRIED)
    rows = []
    for precision in precisions:
        print(f"gpu: {arch}, {precision}, correctness", flush=True)
        expected = places_of("cpu", bed, precision, "per-grain")
        reordered = farthest(places_of("cpu", bed, precision, "per-world"), expected)
        error = farthest(places_of(arch, bed, precision, "per-grain"), expected)
        tolerance = ROUNDINGS * max(reordered, last_digit(precision, bed))
        verdict = "pass" if error <= tolerance else "fail"
        rows.append([precision, f"{error:.1e}", f"{reordered:.1e}", f"{tolerance:.1e}", verdict])
    page.say(f"""A bed of {TRIED} grains swayed by {1e3 * SWAY.amplitude:g} mm at {SWAY.frequency:g} Hz for {TIME:g} s
        without soft start, against the processor with the same schedule and precision: largest distance of a grain, in
        diameters. The tolerance is rounding: {ROUNDINGS:g} times what another order of sums (schedule per-world) does
        on the processor, or the last digit of a place if that is more.""")
    page.table(["precision", "error (d)", "another order of sums (d)", "tolerance (d)", "verdict"], rows)


def places_of(arch: str, bed: Bed, precision: str, schedule: str) -> np.ndarray:
    """Places (n, 2) m of the swayed bed at the end, worked out in a process of its own. Raises LabError."""
    with ProcessPoolExecutor(1, get_context("spawn")) as pool:
        try:
            return pool.submit(swayed, arch, bed, precision, schedule).result()
        except BrokenProcessPool:
            raise LabError(f"the process that ran on {arch} was lost.") from None
        except (BadState, Unavailable) as error:
            raise LabError(str(error)) from None


def swayed(arch: str, bed: Bed, precision: str, schedule: str) -> np.ndarray:
    """Places (n, 2) m of the swayed bed at the end."""
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


def _speed(page: Page, work: Path, arch: str, precisions: tuple[str, ...], copies: tuple[int, ...], turns: int) -> None:
    bed = usual_bed(work, COUNT)
    page.say(f"""Grain-steps a second: {COUNT} settled grains and as many copies side by side in one world as it takes,
        or as many worlds of them. At the ends of the longest, 32 bits resolve
        {1e6 * DIAMETER * last_digit("f32", bed.times(copies[-1])):.2g} µm only: that is for speed, not for physics.""")
    found: dict[tuple[str, int], Speeds] = {(shape, number): {} for shape in SHAPES for number in copies}
    for (shape, number), speeds in found.items():
        print(f"gpu: {arch}, {number * COUNT} grains, {shape}", flush=True)
        for precision in precisions:  # one at a time, since the device may hold no more
            try:
                speeds |= compared({precision: partial(worker, bed, number, shape, arch, precision)}, turns, 0.3)
            except LabError as error:
                page.say(f"{number * COUNT:,} grains, {shape}, {precision}: {error}")
    page.table(
        ["grains", "in", *(f"M, {precision}" for precision in precisions)],
        [
            [f"{n * COUNT:,}", shape, *(millions(v[p]) if p in v else "–" for p in precisions)]
            for (shape, n), v in found.items()
        ],
    )
    page.figure(arch, plotted(found), f"Grain-steps a second on {arch} against the number of grains")


def worker(bed: Bed, number: int, shape: str, arch: str, precision: str) -> Worker:
    """So many copies of a bed on a device, in one world or in one each."""
    how = {"arch": arch, "precision": precision, "schedule": "per-grain"}
    return Worker(bed.times(number), **how) if shape == ONE else Worker(bed, worlds=number, **how)


def plotted(found: dict[tuple[str, int], Speeds]) -> Figure:
    """Medians with their ranges against the number of grains, a panel a shape."""
    figure = Figure(figsize=(6.4, 3.0), layout="constrained")
    for axes, shape in zip(figure.subplots(1, len(SHAPES), sharey=True), SHAPES, strict=True):
        for precision, colour in COLOURS.items():
            done = {n * COUNT: v[precision] for (of, n), v in found.items() if of == shape and precision in v}
            if done:
                draw_with_range(axes, list(done), list(done.values()), colour, precision)
        axes.set(title=shape, xscale="log", yscale="log", xlabel="grains")
    handles, labels = figure.axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc=BELOW, ncols=len(COLOURS))
    figure.axes[0].set_ylabel("million grain-steps a second")
    return figure


ABOUT = """Schedule per-grain: every grain on its own, a launch a step. M stands for a million grain-steps a second,
medians of several runs."""
BENCH = Bench("gpu", "Graphics processors", {arch: partial(study, arch=arch) for arch in ARCHES}, ABOUT)
