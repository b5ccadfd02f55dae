"""The page of the bench: hard cases, longer steps, and the map of the limit with its figure."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import matplotlib
from matplotlib.figure import Figure

from lab.preset.accuracy import FURTHEST, LEVELS
from lab.report.page import render, save_figure
from lab.report.plots import BELOW, BLUE, GREEN, GREY, STYLE, VERMILION
from lab.studies.bench.stability.case import DEEPEST, IMPACTS
from lab.studies.bench.stability.limit_map import DAMPINGS, DISTURBED, FINE, GROWTH, SPEED, STEPS, WIDEST
from lab.studies.bench.stability.pushed import RIPPLE
from lab.studies.engine import word

DRAFT = LEVELS["draft"].longer_steps
TICKS = (0.5, 1, 2, 5, 10, 20, 50)  # derived steps
COLOURS = {"verlet": BLUE, "symplectic-euler": GREEN, "gear": VERMILION}
HARD = ("case", "grains", "time (s)", "step (µs)", "largest overlap (radii)", "energy error", "verdict")
CHECKS = ("compared", "reference", "error", "tolerance", "why so much", "verdict")
PUSHED = ("case", "times the limit", "step (µs)", "tolerance", "energy error", "outcome", "what it was", "verdict")
MARKS = dict(zip(DAMPINGS, ("o", "s", "D"), strict=True))


def write_page(folder: Path, cases: Mapping[str, Mapping], parts: Mapping[str, Mapping]) -> Path:
    """Write the page from the records of cases and of parts of the map, by name, worst first; returns its file."""
    cases = dict(sorted(cases.items(), key=lambda one: _held(one[1])))
    maps = [row for part in parts.values() for row in part["rows"]]
    with matplotlib.rc_context(STYLE):
        figure = save_figure(folder / "stability-limits.png", limit_figure(maps)).name if maps else ""
    return render(
        folder / "stability.md",
        "stability.md.j2",
        results=[*cases.values(), *parts.values()],
        parts=parts,
        counts=_count(cases, maps),
        cases=cases,
        hard_header=HARD,
        hard_rows=[_hard(name, record) for name, record in cases.items()],
        check_header=CHECKS,
        check_rows={name: [_check(one) for one in record["checks"]] for name, record in cases.items()},
        pushed_header=PUSHED,
        pushed_rows=[_pushed(name, row) for name, record in cases.items() for row in record["pushed"]],
        figure=figure,
        deepest=f"{100 * DEEPEST:g}",
        impacts=f"{IMPACTS:g}",
        furthest=f"{FURTHEST:g}",
        ripple=f"{100 * RIPPLE:g}",
        **_map(maps),
    )


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


def _hard(name: str, record: Mapping) -> tuple:
    numbers = record["time"], 1e6 * record["step"], _shown(record["overlap"]), _shown(record["energy"])
    return name, record["grains"], *numbers, word(_held(record))


def _check(check: Mapping) -> tuple:
    error = _shown(check["error"])
    return check["what"], check["reference"], error, check["tolerance"], check["why"], word(check["passed"])


def _pushed(name: str, row: Mapping) -> tuple:
    energy = "" if row["energy"] is None else _shown(row["energy"])
    tolerance = f"{100 * row['tolerance']:g} %" if row["tolerance"] else ""
    numbers = f"{row['factor']:g}", 1e6 * row["step"], tolerance, energy
    return name, *numbers, row["outcome"], row["said"], word(row["passed"])


def _map(maps: Sequence[Mapping]) -> dict[str, object]:
    """What the page says of the map: a table of ratios, a row a law, and the limits that eigenvalues give."""
    columns = list(dict.fromkeys((row["integrator"], row["damping"]) for row in maps))
    ratios = {(_laws(row), row["integrator"], row["damping"]): row["ratio"] for row in maps}
    laws = list(dict.fromkeys(_laws(row) for row in maps))
    exact = [row for row in maps if row["exact"]]
    said = {"speed": SPEED, "disturbed": DISTURBED, "growth": GROWTH, "steps": STEPS, "widest": WIDEST}
    return {
        "map": {name: f"{number:g}" for name, number in said.items()} | {"fine": f"{100 * (FINE - 1):.0f}"},
        "map_header": ("law", *(f"{integrator}, {damping}" for integrator, damping in columns)),
        "map_rows": [(law, *(_ratio(ratios.get((law, *column))) for column in columns)) for law in laws],
        "exact_rows": [
            (row["normal"], row["integrator"], row["error"], row["tolerance"], word(row["exact_passed"]))
            for row in exact
        ],
    }


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
