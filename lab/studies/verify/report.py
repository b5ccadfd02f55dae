"""The results of a verification as JSON, and the page from them: tables by section, and figures."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.figure import Figure
from rich.console import Console
from rich.table import Table

from lab.report.kept import Made, machine, write
from lab.report.page import render, save_figure
from lab.report.plots import BLUE, GREY, STYLE, VERMILION
from lab.studies.verify.case import Line, Outcome

NAME = "verify"
HEADER = ("quantity", "here", "reference", "from", "error", "tolerance", "because of", "")
SMALLEST = 1e-6  # share of the tolerance; smaller errors are drawn there


def show(outcome: Outcome, console: Console) -> None:
    """Print the lines of a case that has run."""
    table = Table(title=outcome.case.title, title_justify="left", title_style="bold", box=None, pad_edge=False)
    for name in (*HEADER[:3], *HEADER[4:6], HEADER[-1]):
        table.add_column(name, justify="left" if name in ("quantity", "") else "right")
    for line in outcome.found.lines:
        quantity, value, reference, _, error, tolerance, _, verdict = cells(line)
        table.add_row(quantity, value, reference, error, tolerance, verdict, style=None if line.passed else "red")
    console.print(table)
    if outcome.fault:
        console.print(f"stopped: {outcome.fault}", style="red", markup=False)
    console.print()


def write_report(outcomes: Sequence[Outcome], folder: Path | str) -> Path:
    """Write verify.json, and from it verify.md with its figures; returns the page's file."""
    folder = Path(folder)
    errors = ""
    if any(outcome.found.lines for outcome in outcomes):
        with matplotlib.rc_context(STYLE):
            errors = save_figure(folder / f"{NAME}-errors.png", errors_figure(outcomes)).name
    data = _as_json(outcomes, [_case(outcome, folder) for outcome in outcomes])
    write(folder / f"{NAME}.json", data)
    return write_page(data, folder, errors)


def write_page(data: Mapping, folder: Path, errors: str) -> Path:
    """Write the page from what verify.json holds, in a section the cases that fail first; `errors`: their figure."""
    lines = {case["name"]: [row for row in data["lines"] if row["case"] == case["name"]] for case in data["cases"]}
    cases = [case | {"lines": [cells(_line(row)) for row in lines[case["name"]]]} for case in data["cases"]]
    sections: dict[str, list] = {}
    for case in cases:
        sections.setdefault(case["section"], []).append(case)
    bad = [case["name"] for case in cases if not case["passed"]]
    return render(
        folder / f"{NAME}.md",
        "verify.md.j2",
        said=f"Made by `{data['made']['command']}` on {data['made']['date']}, on {data['machine']}.",
        within=sum(row["passed"] for row in data["lines"]),
        lines=len(data["lines"]),
        cases=cases,
        bad=bad,
        errors=errors,
        header=HEADER,
        sections=[(name, sorted(group, key=lambda case: case["passed"])) for name, group in sections.items()],
    )


def _case(outcome: Outcome, folder: Path) -> dict:
    """A case and what it found besides its lines; its figures are saved."""
    case, found = outcome.case, outcome.found
    pictures = [(save_figure(folder / f"{NAME}-{one.name}.png", one.figure), one.caption) for one in found.pictures]
    return {
        "name": case.name,
        "section": case.section,
        "title": case.title,
        "passed": outcome.passed,
        "fault": outcome.fault,
        "notes": list(found.notes),
        "tables": [{"header": list(one.header), "rows": [list(row) for row in one.rows]} for one in found.tables],
        "pictures": [{"file": path.name, "caption": caption} for path, caption in pictures],
    }


def _line(row: Mapping) -> Line:
    """The line that a row of verify.json tells of."""
    words = {name: row[name] for name in ("quantity", "source", "tolerance", "reason", "unit", "relative")}
    value, reference = (float("nan") if row[name] is None else row[name] for name in ("value", "reference"))
    return Line(value=value, reference=reference, **words)


def cells(line: Line) -> tuple[str, ...]:
    """A line as the texts of HEADER's columns."""
    unit = f" {line.unit}" if line.unit else ""
    error = _share(line.error) if line.relative else f"{line.error:.2g}{unit}"
    tolerance = _share(line.tolerance) if line.relative else f"{line.tolerance:.2g}{unit}"
    verdict = "pass" if line.passed else "FAIL"
    numbers = (f"{line.value:.6g}{unit}", f"{line.reference:.6g}{unit}")
    return line.quantity, *numbers, line.source, error, tolerance, line.reason, verdict


def _share(value: float) -> str:
    """A relative error: in per cent where that reads well."""
    return f"{100.0 * value:.2g} %" if abs(value) >= 1e-5 or value == 0.0 else f"{value:.1e}"


def errors_figure(outcomes: Sequence[Outcome]) -> Figure:
    """Each line's error in units of its tolerance on a logarithmic axis, a row a case."""
    shown = [outcome for outcome in outcomes if outcome.found.lines]
    figure = Figure(figsize=(6.4, 0.9 + 0.21 * len(shown)), layout="constrained")
    axes = figure.subplots()
    for row, outcome in enumerate(shown):
        shares = [max(abs(line.error) / line.tolerance, SMALLEST) for line in outcome.found.lines]
        colours = [BLUE if line.passed else VERMILION for line in outcome.found.lines]
        axes.scatter(shares, np.full(len(shares), row), s=14, c=colours, alpha=0.7, linewidths=0)
    axes.axvline(1.0, color=GREY, lw=1.0)
    axes.set_xscale("log")
    axes.set_xlim(0.6 * SMALLEST, max(3.0, 1.5 * axes.get_xlim()[1]))
    axes.set_yticks(range(len(shown)), [outcome.case.name for outcome in shown])
    axes.set_ylim(len(shown) - 0.5, -0.5)
    axes.set_xlabel(f"error, in units of what is allowed (less than {SMALLEST:g} is drawn there)")
    return figure


def _as_json(outcomes: Sequence[Outcome], cases: Sequence[Mapping]) -> dict:
    return {
        "passed": all(outcome.passed for outcome in outcomes),
        "machine": machine(),
        "made": asdict(Made.now("verify")),
        "faults": {outcome.case.name: outcome.fault for outcome in outcomes if outcome.fault},
        "cases": cases,
        "lines": [_row(outcome, line) for outcome in outcomes for line in outcome.found.lines],
    }


def _row(outcome: Outcome, line: Line) -> dict:
    """A line as verify.json has it."""
    return {
        "case": outcome.case.name,
        "section": outcome.case.section,
        "quantity": line.quantity,
        "unit": line.unit,
        "source": line.source,
        **{name: getattr(line, name) for name in ("value", "reference", "error", "tolerance")},
        "relative": line.relative,
        "reason": line.reason,
        "passed": bool(line.passed),
    }
