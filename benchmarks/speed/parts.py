"""Where the time of a step goes, and how close the force loop is to the limits of the core."""

import time
from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from benchmarks.speed.beds import Bed, usual_bed
from benchmarks.speed.counts import GRAIN, PAIR, REAL, total
from benchmarks.speed.kernels import MULTIPLY_ADDS, Limits, Parts
from benchmarks.speed.workers import in_turn
from lab.report.page import Page
from lab.report.plots import BLUE, GREY, VERMILION, canvas
from solvers.machine import runtime
from solvers.motion import Sway
from solvers.simulation import Simulation

STEP = "whole step"
LITTLE = 1e-6  # of a step
WHOLE = ("pair_forces", "wall_forces", "move")  # what a step at rest is made of
PIECES = ("gather", "laws", "scatter")  # what the pair forces are made of
NUMBERS = 15  # reals a grain has
SWAY = Sway(0.1, 1.5)  # m, Hz: what the flowing bed is swayed by
UNDER_WAY = 0.15  # s, after which it flows
GLANCE = 10  # steps from one look at whether the lists are new to the next
SMALL, LARGE = 1024, 2**24  # elements: in the innermost cache; in main memory
CACHE = Path("/sys/devices/system/cpu/cpu0/cache")


@dataclass(frozen=True)
class AtRest:
    """A bed at rest: listed pairs and touching contacts, and the seconds that parts of its step take, by name."""

    grains: int
    pairs: int
    touching: int
    seconds: Mapping[str, float]

    @property
    def bytes(self) -> int:
        """Memory that a step works on."""
        return self.pairs * total(PAIR, "").bytes + self.grains * NUMBERS * REAL


@dataclass(frozen=True)
class InFlow:
    """A flowing bed: seconds that a step and that building the lists takes, steps from one building to the next."""

    step: float
    build: float
    between: float


def study(page: Page, work: Path, fast: bool) -> None:
    """Add the section to the page."""
    count, turns, seconds = (500, 3, 0.02) if fast else (2000, 15, 0.1)
    bed = usual_bed(work, count)
    print("parts: at rest", flush=True)
    rest = at_rest(bed, turns, seconds)
    print("parts: in flow", flush=True)
    flow = in_flow(bed, 0.02 if fast else 0.35)
    print("parts: limits", flush=True)
    most = limits(rest.bytes, turns, seconds)
    page.section("Parts of a step")
    page.say(f"""One core, 64 bits, a settled world of {count} grains, friction with history; {rest.pairs / count:.2f}
        listed pairs a grain, {rest.touching / count:.2f} of them touching, walls included. Each part is timed alone,
        many times over on one state. What is left is the clock, the look whether the lists are old, and what the parts
        gain or lose by each other's company.""")
    _whole(page, rest)
    _pieces(page, rest)
    _lists(page, flow)
    _counts(page, rest)
    _limits(page, rest, most)


def _whole(page: Page, rest: AtRest) -> None:
    step = rest.seconds[STEP]
    rows = [[name.replace("_", " "), rest.seconds[name]] for name in WHOLE]
    rows.append(["the rest", step - sum(value for _, value in rows)])
    page.table(
        ["part of a step at rest", "ns a grain", "share"],
        [[name, f"{1e9 * s / rest.grains:.2f}", f"{s / step:.1%}"] for name, s in [*rows, [STEP, step]]],
    )


def _pieces(page: Page, rest: AtRest) -> None:
    whole = rest.seconds["pair_forces"]
    page.table(
        ["of the pair forces, alone", "ns a pair", "over the whole"],
        [
            [name, f"{1e9 * s / rest.pairs:.2f}", f"{s / whole:.1%}"]
            for name, s in [*((name, rest.seconds[name]) for name in PIECES), ("whole", whole)]
        ],
    )


def _lists(page: Page, flow: InFlow) -> None:
    page.say(f"""At rest lists are never built anew. In a bed swayed by {1e3 * SWAY.amplitude:g} mm at
        {SWAY.frequency:g} Hz they are every {flow.between:.0f} steps; building them of the candidates takes as long as
        {flow.build / flow.step:.1f} steps, {flow.build / (flow.between * flow.step):.1%} of the time.""")


def _counts(page: Page, rest: AtRest) -> None:
    page.say("""Counted from the source (`benchmarks/speed/counts.py` says how): what a listed pair and a grain
    cost, and
        a grain with its pairs.""")
    rows = [(c, "pair") for c in PAIR] + [(total(PAIR, "**sum**"), "pair")]
    rows += [(c, "grain") for c in GRAIN] + [(total(GRAIN, "**sum**"), "grain")]
    header = ["where", "per", "simple operations", "roots and divisions", "bytes"]
    table = [[c.where, per, c.simple, c.slow, c.bytes] for c, per in rows]
    a_grain = per_grain(rest)
    page.table(header, [*table, ["**step**", "grain", *(f"{value:.0f}" for value in a_grain)]])


def per_grain(rest: AtRest) -> tuple[float, float, float]:
    """Simple operations, roots and divisions, and bytes of a grain with its pairs in a step."""
    pair, grain, pairs = total(PAIR, ""), total(GRAIN, ""), rest.pairs / rest.grains
    return tuple(pairs * getattr(pair, name) + getattr(grain, name) for name in ("simple", "slow", "bytes"))


def _limits(page: Page, rest: AtRest, most: Mapping[str, float]) -> None:
    step, bounds = 1e9 * rest.seconds[STEP] / rest.grains, bounds_of(rest, most)
    page.say(f"""What this core does at most, and how long a grain-step would take if that alone held it up; a
        multiplication with its addition counts as two operations, so the first bound is for arithmetic that is nothing
        but those. A step works on {rest.bytes / 1024:.0f} KiB; {caches()}.""")
    page.table(
        ["limit", "measured", "ns a grain-step", "share of the whole step"],
        [
            ["multiply and add", f"{most['simple'] / 1e9:.1f} Gflop/s", *_bound(bounds["simple"], step)],
            ["root or division", f"{1e9 / most['slow']:.2f} ns each", *_bound(bounds["slow"], step)],
            ["bytes, as many as a step works on", f"{most['near'] / 1e9:.0f} GB/s", *_bound(bounds["near"], step)],
            ["bytes, main memory", f"{most['far'] / 1e9:.0f} GB/s", *_bound(bounds["far"], step)],
        ],
    )
    alone = {name: 1e9 * rest.seconds[name] / rest.pairs for name in PIECES}
    moved = (alone["gather"] + alone["scatter"]) / sum(alone.values())
    page.say(f"""So a step takes {step / bounds["simple"]:.1f} times as long as its arithmetic at the core's peak,
        {step / bounds["slow"]:.1f} times as long as its roots and divisions, {step / bounds["near"]:.1f} times as long
        as its bytes from where they fit. The laws are SIMD code on a block of pairs at a time, {alone["laws"]:.1f} ns a
        pair; but the grains' numbers are read lane by lane from wherever the two grains stand
        ({alone["gather"]:.1f} ns a pair with the geometry), and forces are added up there lane by lane
        ({alone["scatter"]:.1f} ns), a sum waiting for the one before it where both are the same grain's. This
        scalar reading and adding, which counts as no arithmetic and moves no new bytes, is {moved:.0%} of what the
        pieces take alone.""")
    page.figure("parts", plotted(rest, bounds), "Time of a grain-step by part, and the least that each limit allows")


def _bound(least: float, step: float) -> tuple[str, str]:
    return f"{least:.2f}", f"{least / step:.0%}"


def bounds_of(rest: AtRest, most: Mapping[str, float]) -> dict[str, float]:
    """The least time (ns) of a grain-step by each limit."""
    simple, slow, size = per_grain(rest)
    work = {"simple": simple, "slow": slow, "near": size, "far": size}
    return {name: 1e9 * amount / most[name] for name, amount in work.items()}


def at_rest(bed: Bed, turns: int, seconds: float) -> AtRest:
    """Time the parts of a step of a bed at rest."""
    run = Simulation(bed.scene(schedule="per-world"), bed.places(), threads=1, arch="cpu")
    run.advance(1000)
    touching = int(run.observe()["contacts"][0])
    pairs = int(run.grains.lists.pairs.length.to_numpy()[0])
    parts = Parts(run)
    # Forces are means over a step, so theirs is little; grains are not to move.
    steps = dict.fromkeys((*WHOLE, *PIECES), LITTLE * run.dt) | {"move": 0.0}
    kernels = {name: partial(getattr(parts, name), step=step) for name, step in steps.items()}
    timings = {name: repeated(do, seconds) for name, do in {STEP: run.advance, **kernels}.items()}
    found = in_turn(timings, turns)
    run.close()
    return AtRest(bed.count, pairs, touching, {name: float(np.median(s)) for name, s in found.items()})


def in_flow(bed: Bed, duration: float) -> InFlow:
    """Sway a bed for `duration` (s) once it flows, and count how often its lists are built."""
    scene = bed.scene(schedule="per-world", motions=[(SWAY,)])
    run = Simulation(scene, bed.places(), threads=1, arch="cpu")
    run.advance(round(UNDER_WAY / run.dt))
    parts, built, taken, looks = Parts(run), set(), 0.0, round(duration / run.dt / GLANCE)
    for _ in range(looks):
        begun = time.perf_counter()
        run.advance(GLANCE)
        taken += time.perf_counter() - begun
        built.add(float(run.grains.lists.built_at.to_numpy()[0]))
    build = repeated(lambda n: parts.build(n, run.dt), 0.1)()
    run.close()
    return InFlow(taken / (looks * GLANCE), build, looks * GLANCE / len(built))


def limits(size: int, turns: int, seconds: float) -> dict[str, float]:
    """The most that one core does in a second: simple operations, slow ones, bytes of a memory of `size` and of a
    large one."""
    runtime.initialise(1, "cpu", "f64")
    near = max(SMALL, size // (3 * REAL))
    kernels = {name: Limits("f64", length) for name, length in (("small", SMALL), ("near", near), ("far", LARGE))}
    work = {
        "simple": (kernels["small"].multiply_add, 2 * MULTIPLY_ADDS * SMALL),
        "slow": (kernels["small"].root_and_divide, 2 * SMALL),
        "near": (kernels["near"].triad, 3 * REAL * near),
        "far": (kernels["far"].triad, 3 * REAL * LARGE),
    }
    found = in_turn({name: repeated(kernel, seconds) for name, (kernel, _) in work.items()}, turns)
    for kernel in kernels.values():
        kernel.close()
    return {name: amount / float(found[name].min()) for name, (_, amount) in work.items()}


def repeated(do, seconds: float):
    """A timing: the seconds per call, from repeating it by `do(times)` for about `seconds` seconds."""

    def once(times: int) -> float:
        begun = time.perf_counter()
        do(times)
        return (time.perf_counter() - begun) / times

    do(1)  # compiles
    times = 1
    while times * once(times) < 0.5 * seconds:  # calling it takes its time, which is not what is asked
        times *= 2
    return lambda: once(times)


def caches() -> str:
    """The sizes of the first core's data caches, in words."""
    found = []
    for index in sorted(CACHE.glob("index*")):
        try:
            level, kind, size = ((index / name).read_text().strip() for name in ("level", "type", "size"))
        except OSError:
            continue
        if kind != "Instruction":
            found.append(f"L{level} {size.removesuffix('K')} KiB")
    return f"the caches have {', '.join(found)}" if found else "the system does not tell the sizes of the caches"


def plotted(rest: AtRest, bounds: Mapping[str, float]) -> Figure:
    """Bars of ns a grain-step: the step by its parts, the pieces of the pair forces alone, the limits."""
    figure, axes = canvas((6.4, 3.2))
    names = {"simple": "limit: arithmetic", "slow": "limit: roots, divisions", "near": "limit: bytes, near"}
    names["far"] = "limit: bytes, main memory"
    rows = [(STEP, rest.seconds[STEP], BLUE)]
    rows += [(name.replace("_", " "), rest.seconds[name], BLUE) for name in WHOLE]
    rows += [(f"pair forces: {name}", rest.seconds[name], VERMILION) for name in PIECES]
    bars = [(name, 1e9 * s / rest.grains, colour) for name, s, colour in rows]
    bars += [(label, bounds[name], GREY) for name, label in names.items()]
    labels, values, colours = zip(*bars, strict=True)
    drawn = axes.barh(range(len(bars)), values, color=colours, height=0.65)
    axes.bar_label(drawn, fmt=" {:.1f}", fontsize=8)
    axes.set_yticks(range(len(bars)), labels)
    axes.invert_yaxis()
    axes.margins(x=0.1)
    axes.grid(axis="y", visible=False)
    axes.set_xlabel("ns a grain-step")
    return figure
