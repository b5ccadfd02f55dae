"""Cost of precision, schedule and law on one bed."""

from pathlib import Path

from lab.report.page import Page
from lab.studies.bench.speed.beds import usual_bed
from lab.studies.bench.speed.workers import Worker, compared, millions, ratio
from solvers.machine.runtime import available_cores

PRECISIONS = ("f64", "mixed", "f32")
SCHEDULES = ("per-world", "per-band", "per-grain")
TANGENTIAL = ("haff-werner", "mindlin")
ROLLING = ("none", "constant-torque", "elastic-plastic")


def study(page: Page, work: Path, fast: bool) -> None:
    """Add the section to the page."""
    count, turns, seconds = (500, 3, 0.1) if fast else (2000, 9, 0.4)
    bed, cores = usual_bed(work, count), available_cores()
    threads = {"per-world": 1, "per-band": cores, "per-grain": cores}
    page.section("Precision, schedule and law")
    page.say(f"""One world of {count} grains. A world runs on one core, its bands and its grains on {cores}; grains on
        their own are a schedule for graphics processors. Mixed keeps places in 64 bits and the rest in 32.""")
    print("choices: precision and schedule", flush=True)
    made = {
        (precision, schedule): lambda p=precision, s=schedule: Worker(bed, threads[s], precision=p, schedule=s)
        for precision in PRECISIONS
        for schedule in SCHEDULES
    }
    found = compared(made, turns, seconds)
    usual = found[PRECISIONS[0], SCHEDULES[0]]
    page.table(
        ["precision", "schedule", "M", f"ratio to {PRECISIONS[0]}, {SCHEDULES[0]}"],
        [[*name, millions(speeds), ratio(speeds, usual)] for name, speeds in found.items()],
    )
    print("choices: laws", flush=True)
    made = {
        (tangential, rolling): lambda t=tangential, r=rolling: Worker(
            bed, schedule="per-world", tangential=t, rolling=r
        )
        for tangential in TANGENTIAL
        for rolling in ROLLING
    }
    found = compared(made, turns, seconds)
    usual = found[TANGENTIAL[0], ROLLING[0]]
    page.say("Laws, on one core in 64 bits:")
    page.table(
        ["friction", "rolling resistance", "M", f"ratio to {TANGENTIAL[0]}, {ROLLING[0]}"],
        [[*name, millions(speeds), ratio(speeds, usual)] for name, speeds in found.items()],
    )
