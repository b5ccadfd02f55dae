"""The levels of accuracy: what each sets, what it costs, and what comes of it."""

from pathlib import Path

from lab.accuracy import LEVELS
from lab.bench.accuracy.beds import SWAY, SWAYED, TILT, TILTED, Point, plus_minus, sweep
from lab.bench.accuracy.stiffness import KEY as SCALE
from lab.bench.accuracy.stiffness import SCALES
from lab.page import Page

KEY = "run.accuracy"


def study(page: Page, work: Path, fast: bool) -> None:
    """Add the section to the page."""
    levels = [name for name in LEVELS if name != "reference"]
    tilted = _points(TILTED, TILT, levels, work / "levels-tilt", fast)
    swayed = _points(SWAYED, SWAY, levels, work / "levels-sway", fast)
    if not fast:  # the reference is the stiffest of the study of stiffness
        tilted.append(sweep(TILTED, {SCALE: list(SCALES)}, TILT, work / "stiffness-tilt", fast)[-1])
    page.section("Levels of accuracy")
    page.say("""What `accuracy` says in a preset. Cost is the number of grain-steps of the tilt, relative to the first;
        the sway is not run at the full stiffness. Mean ± half the 95 % confidence interval of the mean.""")
    rows = []
    for name, point, sway in zip(LEVELS, tilted, [*swayed, None], strict=False):
        response = plus_minus(sway, "response_amplitude", 3) if sway else "–"
        level = LEVELS[name]
        rows.append(
            [
                name,
                f"{level.stiffness_scale:g}",
                f"{level.longer_steps:g}",
                level.error,
                plus_minus(point, "critical_angle"),
                response,
                f"{point.steps / tilted[0].steps:.1f}",
            ]
        )
    header = [
        "level",
        "stiffness scale",
        "step (derived = 1)",
        "stands for",
        "critical angle (deg)",
        "sway (mm)",
        "cost",
    ]
    page.table(header, rows)


def _points(preset: str, overrides: dict, levels: list[str], folder: Path, fast: bool) -> list[Point]:
    by_level = {key: value for key, value in overrides.items() if key not in (SCALE, KEY)}
    return sweep(preset, {KEY: levels}, by_level, folder, fast)
