"""Repeats needed for a given confidence, from how much beds differ."""

from pathlib import Path

import numpy as np
from scipy.special import stdtrit

from benchmarks.accuracy.beds import SWAY, SWAYED, TILT, TILTED, sweep
from lab.report.page import Page

BEDS = 24
WANTED = {"critical_angle": (2.0, 1.0, 0.5), "response_amplitude": (0.2, 0.1, 0.05)}  # half widths: deg, mm
UNITS = {"critical_angle": "deg", "response_amplitude": "mm"}


def study(page: Page, work: Path, fast: bool) -> None:
    """Add the section to the page."""
    page.section("Repeats")
    page.say(f"""How far beds that differ in nothing but their seed scatter, over {BEDS} of them (tilt, sway as above,
        "draft"), and how many it takes until half the 95 % confidence interval of their mean is as small as
        wanted (Student's t).""")
    rows = []
    for name, preset, overrides in (
        ("critical_angle", TILTED, TILT),
        ("response_amplitude", SWAYED, SWAY),
    ):
        asked = {**overrides, "run.accuracy": "draft", "run.repeats": BEDS // 2}
        points = sweep(preset, {"run.seed": [1, 1 + BEDS // 2]}, asked, work / f"repeats-{name}", fast)
        values = np.concatenate([p.worlds[name] for p in points])
        spread, unit = float(np.std(values, ddof=1)), UNITS[name]
        needed = [f"{half:g} {unit}: {beds_for(spread, half)}" for half in WANTED[name]]
        rows.append([name.replace("_", " "), f"{values.mean():.3g} {unit}", f"{spread:.2g} {unit}", "; ".join(needed)])
    page.table(["measure", "mean", "standard deviation of one bed", "beds for half an interval of"], rows)


def beds_for(spread: float, half: float) -> int:
    """The fewest beds, scattering by `spread`, whose mean has a 95 % interval that reaches `half` to either side."""
    count = 2
    while stdtrit(count - 1, 0.975) * spread / np.sqrt(count) > half:
        count += 1
    return count
