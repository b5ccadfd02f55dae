"""Speed against error: spacings, precisions, kernels, diffusions and schemes of the lab on one small wave."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullLocator, StrMethodFormatter

from benchmarks.remembered import remembered
from benchmarks.water.accuracy import FRAMES, STILL
from benchmarks.water.cases import frequency, gentle
from benchmarks.water.errors import pressure_error, wave_errors
from benchmarks.water.speed import PASS
from benchmarks.water.workers import Worker
from lab.preset.sections.water.schemes import SCHEMES
from lab.report.page import Page
from lab.report.plots import BLUE, GREY, canvas

ROWS, FEW = (20, 40, 80), (10, 15)  # of the spacings; the others at the middle one
WALL, TURNS = 0.5, 3  # s of a timing, and how many of each
AHEAD = 40  # steps before the timing
OF_SCHEME = ("smoothing", "state", "diffusion", "delta", "viscosity", "alpha")


def _scheme(name: str) -> dict[str, object]:
    """The models of a named scheme; that with a speed of sound in m/s takes the lab's, in √(gH)."""
    models = asdict(SCHEMES[name])
    return {key: models[key] for key in OF_SCHEME} | {"mach": models["mach"]}


WAYS = {
    "the defaults": {},
    "f64": {"precision": "f64"},
    "f32": {"precision": "f32"},
    "Wendland C4": {"kernel": "wendland-c4"},
    "h = 1.7 Δx": {"smoothing": 1.7},
    "Fourtakas": {"diffusion": "fourtakas"},
    "Molteni": {"diffusion": "molteni"},
    "no diffusion": {"diffusion": "none"},
    "twice the sound": {"mach": 20.0},
    **{name: _scheme(name) for name in ("as_P", "as_K", "as_F")},
}
HEADER = (
    *("way", "layers", "M", "simulated s/s", "frequency, %", "loss in a period, %", "pressure at rest, %"),
    "on the front",
)
ERRORS = {"frequency": "error of the\nfrequency (%)", "loss": "loss of height\nin a period (%)"}
LEAST = 0.02  # % that is drawn
GAP = 0.066  # of the panel's height, between two labels


def study(page: Page, work: Path, fast: bool) -> None:
    """Add the section to the page."""
    rows = FEW if fast else ROWS
    middle = rows[len(rows) // 2]
    asked = [("the defaults", count) for count in rows] + [(way, middle) for way in list(WAYS)[1 : 3 if fast else None]]
    page.section("Speed against error")
    page.say("""The small wave on one core: millions of particle-steps and simulated seconds in a second of the
        processor's time, the median of three; errors as above. Viscosity takes its share of the height, in proportion
        to α, h and c0: of the defaults with 40 layers 1.6 % in a period. On the front is what no other way beats in
        both simulated seconds and the error of frequency, to three digits. Schemes are those of `water.scheme`, with
        their models, numbers and speeds of sound (as_K's is the lab's, since its own is of small tanks), and the lab's
        walls and steps.""")
    found = {(way, count): measured(way, count, work) for way, count in asked}
    best = front([(one["seconds"], float(f"{abs(one['frequency']):.3g}")) for one in found.values()])
    names = "particle_steps", "seconds", "frequency", "loss", "pressure"
    table = [
        [way, str(count), *(float(one[name]) for name in names), "yes" if on else ""]
        for ((way, count), one), on in zip(found.items(), best, strict=True)
    ]
    page.table(HEADER, table)
    page.figure("front", figure(found, best), "Speed against errors of the wave; filled: on the front of frequency.")


def measured(way: str, rows: int, work: Path) -> dict[str, float]:
    """Speed and errors of one way of computing the wave; the errors are kept."""
    kept = work / f"errors-{list(WAYS).index(way)}-{rows}.npz"
    errors = remembered(kept, f"water: errors of {way}, {rows} layers", lambda: errors_of(way, rows))
    return timed(way, rows) | {name: float(value) for name, value in errors.items()}


def errors_of(way: str, rows: int) -> dict[str, float]:
    """Errors (%) of one way: frequency of the wave, its loss of height in a period, pressure at rest."""
    how = dict(WAYS[way])
    mach = how.pop("mach", 10.0)
    wave = _followed(rows, mach, how, np.linspace(0.0, 2.0 * np.pi / frequency(), FRAMES + 1))
    rest = _followed(rows, mach, how, [STILL], steep=0.0)[-1]
    off, loss = wave_errors(wave)
    return {"frequency": 1e2 * off, "loss": 1e2 * loss, "pressure": 1e2 * pressure_error(rest)}


def _followed(rows: int, mach: float, how: Mapping, times: Sequence[float], **of_wave: float) -> list:
    case = gentle(rows, mach=mach, state=how.get("state", "linear"), **of_wave)
    worker = Worker(case, ahead=0, **how)
    try:
        return worker.frames(times)
    finally:
        worker.close()


def timed(way: str, rows: int) -> dict[str, float]:
    """Millions of particle-steps, and simulated seconds, in a second of the processor."""
    print(f"water: speed of {way}, {rows} layers", flush=True)
    how = dict(WAYS[way])
    worker = Worker(gentle(rows, mach=how.pop("mach", 10.0)), ahead=AHEAD, **how)
    try:
        runs = [worker.run(PASS, WALL) for _ in range(TURNS)]
    finally:
        worker.close()
    return {
        "particle_steps": float(np.median([run.steps * run.particles / run.busy_s / 1e6 for run in runs])),
        "seconds": float(np.median([run.seconds / run.busy_s for run in runs])),
    }


def front(points: list[tuple[float, float]]) -> list[bool]:
    """Which of the points (speed, error) no other one equals or beats in both and beats in one."""
    return [
        not any(s >= speed and e <= error and (s, e) != (speed, error) for s, e in points) for speed, error in points
    ]


def figure(found: Mapping[tuple[str, int], Mapping[str, float]], best: list[bool]) -> Figure:
    """Simulated seconds a second against both errors of the wave, a label at the right for each way."""
    drawn, panels = canvas((7.2, 4.2), 1, len(ERRORS), sharey=True)
    plain = StrMethodFormatter("{x:g}")
    for axes, (name, words) in zip(panels, ERRORS.items(), strict=True):
        for one, on in zip(found.values(), best, strict=True):
            x = max(abs(one[name]), LEAST)
            axes.loglog(x, one["seconds"], "o", ms=5, color=BLUE if on else GREY, mfc=BLUE if on else "white")
        axes.set(xlabel=words)
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
            axis.set_minor_locator(NullLocator())
            axis.set_major_formatter(plain)
    panels[0].set_ylabel("simulated seconds in a second of one core")
    last, name = panels[-1], list(ERRORS)[-1]
    low, high = np.log(last.get_ylim())
    heights = [(np.log(one["seconds"]) - low) / (high - low) for one in found.values()]
    for ((way, count), one), at in zip(found.items(), spread(heights, GAP), strict=True):
        point, line = (max(abs(one[name]), LEAST), one["seconds"]), {"arrowstyle": "-", "color": GREY, "lw": 0.5}
        place = {"xytext": (1.06, at), "textcoords": "axes fraction", "va": "center", "arrowprops": line}
        last.annotate(f"{way}, {count}", point, fontsize=7.5, annotation_clip=False, **place)
    return drawn


def spread(wanted: Sequence[float], gap: float) -> np.ndarray:
    """Heights in the order of the wanted ones and at least a gap apart, as near to them as that lets, from 0 to 1."""
    order, steps = np.argsort(wanted, kind="stable"), gap * np.arange(len(wanted))
    pools: list[list[float]] = []  # of neighbours that want to be nearer: they share a mean (Barlow et al. 1972)
    for height in np.array(wanted)[order] - steps:
        pools.append([height])
        while len(pools) > 1 and np.mean(pools[-2]) > np.mean(pools[-1]):
            pools[-2:] = [pools[-2] + pools[-1]]
    found = np.repeat([np.mean(pool) for pool in pools], [len(pool) for pool in pools]) + steps
    placed = np.empty(len(wanted))
    placed[order] = np.minimum(found, 1.0 - steps[::-1])
    return placed
