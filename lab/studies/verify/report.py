"""The results of a verification as JSON, and the page from them: tables by section, and figures."""

from collections.abc import Mapping
from dataclasses import asdict, fields
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.figure import Figure
from rich.console import Console
from rich.table import Table

from lab.report.page import render, save_figure
from lab.report.plots import BLUE, GREY, STYLE, VERMILION
from lab.studies.engine import word
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


def record(outcome: Outcome, folder: Path) -> dict[str, object]:
    """A case that has run as verify.json has it; its figures are saved in the folder."""
    case, found = outcome.case, outcome.found
    pictures = [(save_figure(folder / f"{NAME}-{one.name}.png", one.figure), one.caption) for one in found.pictures]
    return {
        "section": case.section,
        "title": case.title,
        "passed": outcome.passed,
        "fault": outcome.fault,
        "notes": found.notes,
        "tables": [asdict(one) for one in found.tables],
        "pictures": [{"file": path.name, "caption": caption} for path, caption in pictures],
        "lines": [asdict(line) | {"error": line.error, "passed": bool(line.passed)} for line in found.lines],
    }


def write_page(records: Mapping[str, Mapping], folder: Path) -> Path:
    """Write verify.md from the records of cases by name, in a section those that fail first; returns its file."""
    lines = [line for one in records.values() for line in one["lines"]]
    cases = [
        one | {"name": name, "lines": [cells(_line(row)) for row in one["lines"]]} for name, one in records.items()
    ]
    sections: dict[str, list] = {}
    for case in cases:
        sections.setdefault(case["section"], []).append(case)
    with matplotlib.rc_context(STYLE):
        errors = save_figure(folder / f"{NAME}-errors.png", errors_figure(records)).name if lines else ""
    return render(
        folder / f"{NAME}.md",
        "verify.md.j2",
        within=sum(line["passed"] for line in lines),
        lines=len(lines),
        cases=cases,
        bad=[case["name"] for case in cases if not case["passed"]],
        errors=errors,
        header=HEADER,
        sections=[(name, sorted(group, key=lambda case: case["passed"])) for name, group in sections.items()],
    )


def _line(row: Mapping) -> Line:
    """The line that a row of verify.json tells of."""
    known = {field.name: row[field.name] for field in fields(Line)}
    value, reference = (float("nan") if row[name] is None else row[name] for name in ("value", "reference"))
    return Line(**known | {"value": value, "reference": reference})


def cells(line: Line) -> tuple[str, ...]:
    """A line as the texts of HEADER's columns."""
    unit = f" {line.unit}" if line.unit else ""
    error = _share(line.error) if line.relative else f"{line.error:.2g}{unit}"
    tolerance = _share(line.tolerance) if line.relative else f"{line.tolerance:.2g}{unit}"
    verdict = word(line.passed)
    numbers = (f"{line.value:.6g}{unit}", f"{line.reference:.6g}{unit}")
    return line.quantity, *numbers, line.source, error, tolerance, line.reason, verdict


def _share(value: float) -> str:
    """A relative error: in per cent where that reads well."""
    return f"{100.0 * value:.2g} %" if abs(value) >= 1e-5 or value == 0.0 else f"{value:.1e}"


def errors_figure(records: Mapping[str, Mapping]) -> Figure:
    """Each line's error in units of its tolerance on a logarithmic axis, a row a case."""
    shown = {name: [_line(row) for row in one["lines"]] for name, one in records.items() if one["lines"]}
    figure = Figure(figsize=(6.4, 0.9 + 0.21 * len(shown)), layout="constrained")
    axes = figure.subplots()
    for row, lines in enumerate(shown.values()):
        shares = [max(abs(line.error) / line.tolerance, SMALLEST) for line in lines]
        colours = [BLUE if line.passed else VERMILION for line in lines]
        axes.scatter(shares, np.full(len(shares), row), s=14, c=colours, alpha=0.7, linewidths=0)
    axes.axvline(1.0, color=GREY, lw=1.0)
    axes.set_xscale("log")
    axes.set_xlim(0.6 * SMALLEST, max(3.0, 1.5 * axes.get_xlim()[1]))
    axes.set_yticks(range(len(shown)), list(shown))
    axes.set_ylim(len(shown) - 0.5, -0.5)
    axes.set_xlabel(f"error, in units of what is allowed (less than {SMALLEST:g} is drawn there)")
    return figure
