"""Cost of precision, schedule and law on one bed."""

from collections.abc import Mapping
from functools import partial
from pathlib import Path

from benchmarks.speed.beds import Bed, usual_bed
from benchmarks.speed.workers import Worker, compared, millions, ratio
from lab.report.page import Page
from solvers.machine.runtime import available_cores

PRECISIONS = ("f64", "mixed", "f32")
SCHEDULES = ("per-world", "per-band", "per-grain")
TANGENTIAL = ("haff-werner", "mindlin")
ROLLING = ("none", "constant-torque", "elastic-plastic")


def study(page: Page, work: Path, fast: bool) -> None:
    """Add the section to the page."""
    count, turns, seconds = (500, 3, 0.1) if fast else (2000, 7, 0.4)
    bed, cores = usual_bed(work, count), available_cores()
    threads = {"per-world": 1, "per-band": cores, "per-grain": cores}
    page.section("Precision, schedule and law")
    page.say(f"""One world of {count} grains. A world runs on one core, its bands and its grains on {cores}; grains on
        their own are a schedule for graphics processors. Mixed keeps places in 64 bits and the rest in 32.""")
    ways = {
        (precision, schedule): {"threads": threads[schedule], "precision": precision, "schedule": schedule}
        for precision in PRECISIONS
        for schedule in SCHEDULES
    }
    _compare(page, bed, ("precision", "schedule"), ways, turns, seconds)
    laws = {
        (tangential, rolling): {"schedule": "per-world", "tangential": tangential, "rolling": rolling}
        for tangential in TANGENTIAL
        for rolling in ROLLING
    }
    page.say("Laws, on one core in 64 bits:")
    _compare(page, bed, ("friction", "rolling resistance"), laws, turns, seconds)


def _compare(page: Page, bed: Bed, kinds: tuple[str, str], ways: Mapping, turns: int, seconds: float) -> None:
    """Time workers made in these ways, and add a table with their ratios to the first."""
    print(f"choices: {' and '.join(kinds)}", flush=True)
    found = compared({name: partial(Worker, bed, **how) for name, how in ways.items()}, turns, seconds)
    usual = next(iter(found))
    page.table(
        [*kinds, "M", f"ratio to {', '.join(usual)}"],
        [[*name, millions(speeds), ratio(speeds, found[usual])] for name, speeds in found.items()],
    )
