"""The levels of accuracy: settings, cost and results of each; and the reasons for the defaults, which are words."""

from pathlib import Path

from benchmarks.accuracy.beds import SWAY, SWAYED, TILT, TILTED, Point, mean_and_interval, sweep
from benchmarks.accuracy.stiffness import KEY as SCALE
from lab.preset.accuracy import LEVELS
from lab.report.page import Page

KEY = "run.accuracy"
FEW = 6  # beds at the full stiffness
REASONS = {
    "integrator: Verlet": """At the derived step it errs as little in a collision as any scheme here, and less than
        Gear's in a shaken bed: contacts that open and close in mid-step hold a scheme of the fifth order to the first,
        and two steps of it cost three of Verlet's. The source's scheme is not worth it.""",
    "step: derived from 0.1 % in the restitution": """Twice the step errs four times as much; beds differ among each
        other by far more than either, which is why draft takes longer steps.""",
    "stiffness: a hundredth of the material's": """The softest scale whose angles and responses cannot be told from
        those of the full stiffness; the cost grows with the power 0.4 of it, 2.5 times a decade.""",
    "precision: 64 bits": """Mixed follows 64 bits until chaos takes over and gains little on a processor. 32 bits are
        off from the start, and at the full stiffness their beds never come quite to rest; the angles agree within the
        scatter of beds all the same. Both are meant for graphics processors.""",
    "tangential law: the preset's": """The source's presets have the source's law, Haff and Werner's, which creeps
        under a lasting load, as the section on creep shows. Mindlin's with history costs the same and stands still:
        take it where a bed is to rest.""",
    "skin: 0.05 to 0.3 diameters": """Wider for faster grains, as the cost of building lists asks; the forces are the
        same.""",
    "repeats": "By the interval you need: see the section on repeats. One bed says little: a few degrees either way.",
}


def study(page: Page, work: Path, fast: bool) -> None:
    """Add the section to the page."""
    levels = [name for name in LEVELS if name != "reference"]
    tilted = _points(TILTED, TILT, levels, work / "levels-tilt", fast)
    swayed = _points(SWAYED, SWAY, levels, work / "levels-sway", fast)
    if not fast:  # by itself, since it takes far longer than the others
        few = {**_by_level(TILT), KEY: "reference", "run.repeats": FEW}
        tilted += sweep(TILTED, {}, few, work / "levels-reference", fast)
    page.section("Levels of accuracy")
    page.say(f"""What `accuracy` says in a preset. Cost is the number of grain-steps of the tilt, relative to the first;
        the sway is not run at the full stiffness. Means of the beds with their [95 % intervals]; of the reference there
        are {FEW}, of the others {TILT["run.repeats"]} tilted and {SWAY["run.repeats"]} swayed.""")
    rows = []
    for name, point, sway in zip(LEVELS, tilted, [*swayed, None], strict=False):
        response = mean_and_interval(sway, "response_amplitude", 3) if sway else "–"
        level = LEVELS[name]
        rows.append(
            [
                name,
                f"{level.stiffness_scale:g}",
                f"{level.longer_steps:g}",
                level.error,
                mean_and_interval(point, "critical_angle"),
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


def study_defaults(page: Page, work: Path, fast: bool) -> None:
    """Add what follows from the other sections for the defaults; nothing is computed."""
    page.section("Why the defaults are what they are")
    page.table(["default", "because"], [[name, " ".join(reason.split())] for name, reason in REASONS.items()])


def _points(preset: str, overrides: dict, levels: list[str], folder: Path, fast: bool) -> list[Point]:
    return sweep(preset, {KEY: levels}, _by_level(overrides), folder, fast)


def _by_level(overrides: dict) -> dict:
    """Overrides without those that a level stands for."""
    return {key: value for key, value in overrides.items() if key not in (SCALE, KEY)}
