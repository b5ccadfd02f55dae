"""The page of the bench: hard cases, longer steps, and the map of the limit with its figure."""

from collections.abc import Mapping, Sequence

import matplotlib
from matplotlib.figure import Figure

from lab.preset.accuracy import FURTHEST, LEVELS
from lab.report.page import Page
from lab.report.plots import BELOW, BLUE, GREEN, GREY, STYLE, VERMILION
from lab.studies.bench.stability.case import DEEPEST, IMPACTS
from lab.studies.bench.stability.limit_map import DAMPINGS, DISTURBED, FINE, GROWTH, SPEED, STEPS, WIDEST
from lab.studies.bench.stability.pushed import RIPPLE

DRAFT = LEVELS["draft"].longer_steps
TICKS = (0.5, 1, 2, 5, 10, 20, 50)  # derived steps
COLOURS = {"verlet": BLUE, "symplectic-euler": GREEN, "gear": VERMILION}
MARKS = dict(zip(DAMPINGS, ("o", "s", "D"), strict=True))


def word(passed: bool) -> str:
    """The word for a verdict."""
    return "pass" if passed else "FAIL"


def write_page(page: Page, cases: Mapping[str, Mapping], maps: Sequence[Mapping]) -> None:
    """Write what the records of cases, by name, and the rows of the map hold."""
    page.say(_count(cases, maps))
    if cases:
        _hard(page, cases)
        _asked(page, cases)
    if any(record["pushed"] for record in cases.values()):
        _pushed(page, cases)
    if maps:
        _map(page, maps)
    page.write()


def _count(cases: Mapping[str, Mapping], maps: Sequence[Mapping]) -> str:
    pushed = [row for record in cases.values() for row in record["pushed"]]
    parts = (
        (sum(_held(record) for record in cases.values()), len(cases), "hard cases pass at the automatic step"),
        (
            sum(row["passed"] for row in pushed),
            len(pushed),
            "longer steps are still right, stopped by the watch or refused by the app",
        ),
        (sum(row["passed"] for row in maps), len(maps), "derived steps are stable"),
        (
            sum(row["ratio"] >= DRAFT for row in maps),
            len(maps),
            f"are so at the {DRAFT:g}-fold step of draft accuracy, too",
        ),
    )
    return "; ".join(f"{good} of {number} {what}" for good, number, what in parts if number) + "."


def _held(record: Mapping) -> bool:
    return all(check["passed"] for check in record["checks"])


def _hard(page: Page, cases: Mapping[str, Mapping]) -> None:
    page.section("Hard cases at the automatic step")
    page.say(
        "At the step that the lab derives and, where nothing else is said, at full stiffness. Each is to run to its "
        "end: nobody escapes and no number is not one. Overlaps, the largest at any look, count in radii of the "
        f"smallest grain and are to stay below {100 * DEEPEST:g} % and below {IMPACTS:g} times Hertz's estimate of the "
        "hardest impact (of the largest grain upon the smallest at the highest credible speed) or of the weight. The "
        "energy error is the largest rise of the energy (kinetic, rotational, potential and elastic, in the earth's "
        "frame), less the work of the tank's motion, above any earlier value, as a share of the energy at the start."
    )
    header = ("case", "grains", "time (s)", "step (µs)", "largest overlap (radii)", "energy error", "verdict")
    rows = []
    for name, record in cases.items():
        numbers = record["time"], 1e6 * record["step"], _shown(record["overlap"]), _shown(record["energy"])
        rows.append((name, record["grains"], *numbers, word(_held(record))))
    page.table(header, rows)


def _asked(page: Page, cases: Mapping[str, Mapping]) -> None:
    page.section("What is asked of each")
    for name, record in cases.items():
        page.say(f"**{name}**: {record['says']}")
        header = ("compared", "reference", "error", "tolerance", "why so much", "verdict")
        page.table(
            header,
            [
                (c["what"], c["reference"], _shown(c["error"]), c["tolerance"], c["why"], word(c["passed"]))
                for c in record["checks"]
            ],
        )


def _pushed(page: Page, cases: Mapping[str, Mapping]) -> None:
    page.section("Longer steps than the derived one")
    page.say(
        "The same cases with the step forced to multiples of the derived limit. The app refuses more than "
        f"{FURTHEST:g} times the limit; what would come of it is shown all the same. Still right: the measure within "
        f"its tolerance of that at the automatic step, and no energy made beyond {100 * RIPPLE:g} % of the scale, the "
        "ripple of the scheme while grains touch. What is neither right nor stopped misleads, and fails. The height of "
        "a settled bed says little of its restitution; one-grain does."
    )
    header = ("case", "times the limit", "step (µs)", "tolerance", "energy error", "outcome", "what it was", "verdict")
    rows = []
    for name, record in cases.items():
        for row in record["pushed"]:
            energy = "" if row["energy"] is None else _shown(row["energy"])
            tolerance = f"{100 * row['tolerance']:g} %" if row["tolerance"] else ""
            numbers = f"{row['factor']:g}", 1e6 * row["step"], tolerance, energy
            rows.append((name, *numbers, row["outcome"], row["said"], word(row["passed"])))
    page.table(header, rows)


def _map(page: Page, maps: Sequence[Mapping]) -> None:
    page.section("Where steps do become unstable")
    page.say(
        "Six grains round a seventh in a hexagonal tank that squeezes them, so that every contact is as deep as the "
        f"impact at {SPEED:g} m/s that the derived step is meant for; μ is so large that nothing slides. Unstable: the "
        f"kinetic energy, spin included, of a disturbance of {DISTURBED:g} of that speed grows {GROWTH:g}-fold within "
        f"{STEPS} steps, or the watch stops the run. The longest stable step is bracketed to {100 * (FINE - 1):.0f} %, "
        "by bisection; the table says how many derived steps it is. 0: none that was tried, down to "
        f"1/{WIDEST:g} of the derived step, is stable. Below 1 the derived step itself is not. "
        "Friction laws are on top of hertz-viscoelastic."
    )
    columns = list(dict.fromkeys((row["integrator"], row["damping"]) for row in maps))
    ratios = {(_laws(row), row["integrator"], row["damping"]): row["ratio"] for row in maps}
    laws = list(dict.fromkeys(_laws(row) for row in maps))
    header = ("law", *(f"{integrator}, {damping}" for integrator, damping in columns))
    page.table(header, [(law, *(_ratio(ratios.get((law, *column))) for column in columns)) for law in laws])
    exact = [row for row in maps if row["exact"]]
    if exact:
        page.say("Without losses and friction the limit is 2/ω, ω the highest frequency of the packing (eigenvalues):")
        header = ("law", "integrator", "error of the limit", "tolerance", "verdict")
        page.table(
            header,
            [
                (row["normal"], row["integrator"], row["error"], row["tolerance"], word(row["exact_passed"]))
                for row in exact
            ],
        )
    with matplotlib.rc_context(STYLE):
        page.figure(
            "limits", limit_figure(maps), "Longest stable steps in derived steps, by law, integrator and damping"
        )


def limit_figure(maps: Sequence[Mapping]) -> Figure:
    """Ratios of true to derived limits: a row a law, a colour an integrator, a shape a damping."""
    laws = list(dict.fromkeys(_laws(row) for row in maps))
    positive = [row["ratio"] for row in maps if row["ratio"]]
    lowest = min([0.5, *(0.7 * ratio for ratio in positive)])
    figure = Figure(figsize=(6.4, 1.4 + 0.36 * len(laws)), layout="constrained")
    axes = figure.add_subplot()
    integrators = list(dict.fromkeys(row["integrator"] for row in maps))
    seen = set()
    for row in maps:
        shift = 0.22 * (integrators.index(row["integrator"]) - 0.5 * (len(integrators) - 1))
        label = f"{row['integrator']}, {row['damping']}"
        axes.plot(
            row["ratio"] or lowest,
            laws.index(_laws(row)) + shift,
            MARKS[row["damping"]] if row["ratio"] else "x",
            color=COLOURS[row["integrator"]],
            ms=5,
            mfc="none" if row["damping"] != DAMPINGS[0] else None,
            clip_on=False,
            label=None if label in seen or not row["ratio"] else label,
        )
        seen |= {label} if row["ratio"] else set()
    axes.axvline(1.0, color=GREY, lw=1.0, label="derived step")
    axes.set_xscale("log")
    axes.set_xlim(lowest, TICKS[-1])
    axes.set_xticks(TICKS, [f"{tick:g}" for tick in TICKS])
    axes.minorticks_off()
    axes.set_yticks(range(len(laws)), laws)
    axes.invert_yaxis()
    axes.set_xlabel("longest stable step (derived steps); ×: none is stable")
    figure.legend(loc=BELOW, ncols=max(1, len(integrators)))
    return figure


def _laws(row: Mapping) -> str:
    return row["normal"] if row["tangential"] == "none" else f"+ {row['tangential']}"


def _ratio(value: float | None) -> str:
    return "" if value is None else f"{value:.2g}"


def _shown(value: float | None) -> object:
    return "none" if value is None else float(value)
