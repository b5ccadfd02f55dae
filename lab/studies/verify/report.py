"""The page of a verification: tables by section, figures, and the same lines as JSON for machines."""

import json
from collections.abc import Sequence
from itertools import groupby
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.figure import Figure
from rich.console import Console
from rich.table import Table

from lab.recording import versions
from lab.report.page import Page, machine
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
    """Write verify.md with its figures and verify.json; returns the page's file."""
    page = Page(
        folder, NAME, "The physics against closed forms, independent integrations and published numbers", "verify"
    )
    lines = [line for outcome in outcomes for line in outcome.found.lines]
    page.say(_verdict(outcomes, lines))
    if lines:
        with matplotlib.rc_context(STYLE):
            page.figure("errors", errors_figure(outcomes), "Errors in units of what is allowed, by case")
    for section, group in groupby(outcomes, lambda outcome: outcome.case.section):
        page.section(section)
        for outcome in group:
            _write_case(page, outcome)
    text = json.dumps(_as_json(outcomes), indent=1, ensure_ascii=False, allow_nan=False)
    (Path(folder) / f"{NAME}.json").write_text(text + "\n", encoding="utf-8")
    return page.write()


def _write_case(page: Page, outcome: Outcome) -> None:
    page.say(f"**{outcome.case.title}** (`{outcome.case.name}`)")
    for note in outcome.found.notes:
        page.say(note)
    if outcome.fault:
        page.say(f"**Stopped:** {outcome.fault}")
    for table in outcome.found.tables:
        page.table(table.header, table.rows)
    if outcome.found.lines:
        page.table(HEADER, [cells(line) for line in outcome.found.lines])
    for picture in outcome.found.pictures:
        page.figure(picture.name, picture.figure, picture.caption)


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


def _verdict(outcomes: Sequence[Outcome], lines: Sequence[Line]) -> str:
    bad = [outcome.case.name for outcome in outcomes if not outcome.passed]
    within = sum(line.passed for line in lines)
    text = f"{within} of {len(lines)} lines in {len(outcomes)} cases are within their tolerances."
    if bad:
        text += f" **Failed: {', '.join(bad)}.**"
    return text + (
        " The references do not use the solver. A tolerance, to either side, is what the physics and the scheme at its"
        " step allow, not what came out."
    )


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


def _as_json(outcomes: Sequence[Outcome]) -> dict:
    rows = [_row(outcome, line) for outcome in outcomes for line in outcome.found.lines]
    faults = {outcome.case.name: outcome.fault for outcome in outcomes if outcome.fault}
    passed = all(outcome.passed for outcome in outcomes)
    return {"passed": passed, "machine": machine(), "versions": versions(), "faults": faults, "lines": rows}


def _row(outcome: Outcome, line: Line) -> dict:
    """A line with plain numbers; what is not finite is null, as JSON has no word for it."""
    numbers = {name: getattr(line, name) for name in ("value", "reference", "error", "tolerance")}
    return {
        "case": outcome.case.name,
        "section": outcome.case.section,
        "quantity": line.quantity,
        "unit": line.unit,
        "source": line.source,
        **{name: float(number) if np.isfinite(number) else None for name, number in numbers.items()},
        "relative": line.relative,
        "reason": line.reason,
        "passed": bool(line.passed),
    }
