"""What is asked of a bed, a slip, an angle, a rate, an amplitude, against step, stiffness and precision.

Each choice differs from USUAL in one thing. A difference is told with its interval (Welch 1947) and with what the beds
could have told, the half of that interval: an error that is smaller than this is not excluded.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from matplotlib.figure import Figure

from benchmarks.accuracy.beds import STIFF, SWAY, SWAYED, TILT, TILTED
from lab.assembly.scene import build
from lab.measures.value import Value
from lab.preset.find import load
from lab.report.numbers import interval, mean_within
from lab.report.page import Page
from lab.report.plots import BLUE
from lab.studies.reproduce.estimates import difference
from lab.studies.reproduce.runs import Batch, Outcome, carry_out, outcomes

SCALE, LEVEL, PRECISION = "contact.stiffness_scale", "run.accuracy", "run.precision"
BEDS = 12
USUAL = "derived steps"
FORCED = {"half the derived step": 0.5, "the derived step, never doubled": 1.0, "twice the derived step": 2.0}
CHOICES: dict[str, dict[str, object]] = {
    USUAL: {},
    "the steps of draft": {LEVEL: "draft"},
    **{name: {} for name in FORCED},
    "stiffness × 0.1": {SCALE: 1e-4},
    "stiffness × 10: standard": {SCALE: 1e-2},
    "stiffness × 100": {SCALE: 1e-1},
    "mixed precision": {PRECISION: "mixed"},
    "32 bits": {PRECISION: "f32"},
}


@dataclass(frozen=True)
class Question:
    """What is asked of a preset with some changes: measures by the words for them, and the choices to compare."""

    name: str
    preset: str
    changes: Mapping[str, object]
    measures: Mapping[str, str]
    choices: Sequence[str] = tuple(CHOICES)


QUESTIONS = (
    Question(
        "tilt",
        TILTED,
        {**TILT, "run.repeats": BEDS},
        {"first_slip_angle": "first slip (deg)", "critical_angle": "critical angle (deg)"},
    ),
    Question(
        "discharge",
        "funnel/discharge",
        {**STIFF, "grains.diameter": "6 mm", "grains.count": 300, "run.duration": "1.6 s", "run.repeats": BEDS},
        {"flow_rate": "discharge (grains/s)"},
    ),
    Question(
        "sway",
        SWAYED,
        {**SWAY, "run.duration": "3 s", "run.repeats": BEDS},
        {"response_amplitude": "sway (mm)"},
    ),
)
SHIP = Question(
    "ship",
    "ship/barge-roll",
    {**STIFF, "grains.diameter": "8 mm", "run.duration": "20 s", "run.repeats": BEDS},
    {"roll_amplitude": "roll amplitude (deg)", "roll_bias": "mean roll (deg)", "largest_roll": "largest roll (deg)"},
    (USUAL, "the steps of draft", "stiffness × 10: standard", "stiffness × 100"),
)
HASTY = {"run.repeats": 2, "grains.depth": "9 mm", LEVEL: "draft"}


def study(page: Page, work: Path, fast: bool) -> None:
    """Add the section to the page."""
    page.section("What is asked, and what it takes")
    page.say(f"""Beds of 3 mm acetate in a tank of 60 mm, tilted at 10 deg/s and swayed by 15 mm at 3 Hz, and 300 grains
        of 6 mm that run out of a funnel: {BEDS} beds a row. The first row has a thousandth of the material's stiffness,
        the derived step, twice that while grains are slow, and 64 bits; each other row differs from it in one thing.
        Differences are from the first row. In brackets: 95 % intervals. Cost: grain-steps, relative to the first
        row, steps that are doubled while grains are slow counted as two.""")
    for question in QUESTIONS[:1] if fast else QUESTIONS:
        report(page, question, work, fast)


def study_ship(page: Page, work: Path, fast: bool) -> None:
    """Add the section on a ship to the page."""
    page.section("What is asked of a ship, and what it takes")
    page.say(f"""A barge with loose cargo in regular beam waves of 10 mm, free to roll, as `{SHIP.preset}` has it, with
        grains of 8 mm for 3 mm and 20 s for 40 s: {BEDS} beds a row; the amplitude and the mean are those of the last
        ten periods, the largest roll that of the whole run. Rows, differences and cost are as above. The steps of a
        ship never double.""")
    report(page, SHIP, work, fast)


def report(page: Page, question: Question, work: Path, fast: bool) -> None:
    """Add a table for each measure of a question, and its figure."""
    chosen = question.choices[:2] if fast else question.choices
    found = {name: answered(question, name, work / "asked", fast) for name in chosen}
    for measure, words in question.measures.items():
        page.table([words, "mean", "difference", "cost"], rows(found, measure))
    page.figure(f"asked-{question.name}", plotted(found, question), f"The answers of the {question.name} by choice")


def answered(question: Question, choice: str, folder: Path, fast: bool = False) -> Outcome:
    """The beds of a question with a choice: run, continued or read."""
    changes = {**question.changes, **(HASTY if fast else {}), **CHOICES[choice]}
    if choice in FORCED:
        scene, _ = build(load(question.preset, {**changes, "run.repeats": 1}).resolved)
        step = 0.999 * FORCED[choice] * scene.longest_step(1.0)
        changes |= {"run.step": f"{step:.6g} s", "run.force_step": True}
    where = folder / f"{question.name}-{list(CHOICES).index(choice)}"
    print(f"asked: {question.name}, {choice}", flush=True)
    carry_out(Batch(question.preset, changes), where, quiet=True)
    return outcomes(where)[0]


def rows(found: Mapping[str, Outcome], measure: str) -> list[list[str]]:
    """A row a choice: mean and difference from USUAL with their intervals, and cost relative to it."""
    usual, made = found[USUAL], []
    for name, outcome in found.items():
        value, apart = outcome[measure], difference(outcome[measure], usual[measure])
        told = "" if name == USUAL or apart is None else f"{apart.value:+.3g} {interval(*apart.ends())}"
        cost = outcome.cost["grain_steps"] / usual.cost["grain_steps"]
        made.append([name, with_interval(value), told.removesuffix(" (95 %)"), f"{cost:.2f}"])
    return made


def with_interval(value: Value | None) -> str:
    """A mean over beds with its interval, and their number where some have none; "none" where no bed has one."""
    if value is None or value.value is None:
        return "none"
    few = f" ({value.n} of {len(value.worlds)} beds)" if value.n < len(value.worlds) else ""
    return mean_within(value.value, value.interval, 2) + few


def plotted(found: Mapping[str, Outcome], question: Question) -> Figure:
    """Means with their intervals, a row a choice, one panel a measure."""
    figure = Figure(figsize=(6.4, 2.8), layout="constrained")
    panels = figure.subplots(1, len(question.measures), sharey=True, squeeze=False)[0]
    names = list(reversed(found))
    for axes, (measure, words) in zip(panels, question.measures.items(), strict=True):
        for k, name in enumerate(names):
            value = found[name][measure]
            if value is not None and value.interval is not None:
                low, high = value.interval
                axes.errorbar(
                    value.value, k, xerr=[[value.value - low], [high - value.value]], fmt="o", color=BLUE, capsize=3
                )
        usual = found[USUAL][measure]
        if usual is not None and usual.value is not None:
            axes.axvline(usual.value, color="0.7", lw=0.8, zorder=0)
        axes.set(xlabel=words, yticks=range(len(names)), yticklabels=names)
    return figure
