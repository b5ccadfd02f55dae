"""A suite of cases that pass or fail, as verify and the map of step limits: run, printed, kept as JSON, told on a page.

The page has tables by section, in each the cases that fail first, and a figure of all errors.
"""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, fields
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.figure import Figure
from rich.console import Console
from rich.table import Table

from lab.report.page import on_page, render, save_figure
from lab.report.plots import BLUE, GREY, STYLE, VERMILION, canvas
from lab.studies.case import Case, Line, Outcome
from lab.studies.engine import Kept, choose, word

HEADER = ("quantity", "here", "reference", "from", "error", "tolerance", "because of", "")
SMALLEST, LARGEST = 1e-6, 1e6  # shares of the tolerance; what lies beyond is drawn there


@dataclass(frozen=True)
class Suite:
    """Cases under the name of the command that runs them, whose last word names the files unless `file` does.

    `about` stands above them on the page, `texts` under the headings of sections; of its figures the page shows that
    named `shown`.
    """

    command: str
    title: str
    cases: Sequence[Case]
    about: str
    texts: Mapping[str, str] = field(default_factory=dict)
    file: str = ""
    shown: str = "errors"

    @property
    def name(self) -> str:
        """Of the results NAME.json, the page NAME.md and the figures NAME-FIGURE.png."""
        return self.file or self.command.split()[-1]

    def run(
        self, names: Sequence[str], out: Path | str, fast: bool, page_only: bool = False, aside: bool = False
    ) -> bool:
        """Run the cases that begin with any of `names`, or without names all that are not kept; whether all passed.

        They are printed, kept in `out` and written on the page. With `fast` only what takes seconds; `page_only`:
        nothing is run; `aside`: prints on stderr. A case that fails or breaks does not stop the others. Raises LabError
        for a name that no case begins with.
        """
        chosen, console = {case.name: case for case in self.select(names, fast)}, Console(highlight=False, stderr=aside)
        kept = self._kept(out, fast)
        for name in kept.missing([] if page_only else chosen, anew=bool(names)):
            outcome = carried_out(chosen[name], fast)
            show(outcome, console)
            kept.keep(name, self.record(outcome, Path(out)))
        shown = kept.shown([case.name for case in self.cases])
        page = self.write_page(shown, Path(out))
        done = [name for name in chosen if name in shown]
        bad = [name for name in done if not shown[name]["passed"]]
        console.print(f"failed: {', '.join(bad)}" if bad else f"all {len(done)} cases passed", soft_wrap=True)
        console.print(str(page), soft_wrap=True)
        return not bad

    def kept(self, names: Sequence[str], out: Path | str, fast: bool) -> dict[str, dict]:
        """What is kept in `out` of the cases that `run` chooses, by name."""
        return self._kept(out, fast).shown([case.name for case in self.select(names, fast)])

    def _kept(self, out: Path | str, fast: bool) -> Kept:
        return Kept(Path(out) / f"{self.name}.json", self.command, {"fast": fast})

    def select(self, names: Sequence[str], fast: bool) -> list[Case]:
        """The cases that begin with any of `names`, all where there are none; with `fast` the quick ones.

        Raises LabError for a name that no such case begins with.
        """
        possible = {case.name: case for case in self.cases if case.quick or not fast}
        return [possible[name] for name in choose(names, possible, "fast case" if fast else "case")]

    def record(self, outcome: Outcome, folder: Path) -> dict[str, object]:
        """A case that has run as the JSON file has it; its figures are saved in the folder."""
        case, found = outcome.case, outcome.found
        files = [save_figure(folder / f"{self.name}-{one.name}.png", one.figure).name for one in found.pictures]
        pictures = zip(files, found.pictures, strict=True)
        return {
            "section": case.section,
            "title": case.title,
            "passed": outcome.passed,
            "fault": outcome.fault,
            "notes": found.notes,
            "tables": [asdict(one) for one in found.tables],
            "pictures": [{"file": file, "caption": one.caption} for file, one in pictures],
            "lines": [asdict(line) | {"error": line.error, "passed": bool(line.passed)} for line in found.lines],
        }

    def write_page(self, records: Mapping[str, Mapping], folder: Path) -> Path:
        """Write the page from the records of cases by name; returns its file."""
        lines = [line for one in records.values() for line in one["lines"]]
        cases = [
            one | {"name": name, "lines": [cells(_line(row)) for row in one["lines"]]} for name, one in records.items()
        ]
        sections: dict[str, list] = {}
        for case in cases:
            sections.setdefault(case["section"], []).append(case)
        with matplotlib.rc_context(STYLE):
            errors = save_figure(folder / f"{self.name}-errors.png", errors_figure(records)).name if lines else ""
        files = [errors, *(picture["file"] for one in cases for picture in one["pictures"])]
        return render(
            folder / f"{self.name}.md",
            "suite.md.j2",
            title=self.title,
            command=self.command,
            **on_page(files, f"{self.name}-{self.shown}.png"),
            about=self.about,
            texts=self.texts,
            within=sum(line["passed"] for line in lines),
            lines=len(lines),
            cases=cases,
            bad=[case["name"] for case in cases if not case["passed"]],
            errors=errors,
            header=HEADER,
            sections=[(name, sorted(group, key=lambda case: case["passed"])) for name, group in sections.items()],
        )


def carried_out(case: Case, fast: bool) -> Outcome:
    """Run a case and return its outcome; an exception counts as one."""
    try:
        with matplotlib.rc_context(STYLE):  # figures are drawn as the lab's are
            return Outcome(case, case.check(fast))
    except Exception as error:
        return Outcome(case, fault=f"{type(error).__name__}: {error}")


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


def _line(row: Mapping) -> Line:
    """The line that a row of verify.json tells of."""
    known = {field.name: row.get(field.name, field.default) for field in fields(Line)}
    value, reference = (float("nan") if row[name] is None else row[name] for name in ("value", "reference"))
    return Line(**known | {"value": value, "reference": reference})


def cells(line: Line) -> tuple[str, ...]:
    """A line as the texts of HEADER's columns."""
    unit = f" {line.unit}" if line.unit else ""
    error = _share(line.error) if line.relative else f"{line.error:.2g}{unit}"
    tolerance = _share(line.tolerance) if line.relative else f"{line.tolerance:.2g}{unit}"
    verdict = word(line.passed)
    least = "at least " if line.at_least else ""
    numbers = (f"{line.value:.6g}{unit}", f"{least}{line.reference:.6g}{unit}")
    return line.quantity, *numbers, line.source, error, tolerance, line.reason, verdict


def _share(value: float) -> str:
    """A relative error: in per cent where that reads well."""
    return f"{100.0 * value:.2g} %" if abs(value) >= 1e-5 or value == 0.0 else f"{value:.1e}"


def _share_of_allowed(line: Line) -> float:
    """The error in units of the tolerance, as it is drawn; where nothing is allowed an error is the largest."""
    if not line.tolerance:
        return LARGEST if line.error else SMALLEST
    return min(max(abs(line.error) / line.tolerance, SMALLEST), LARGEST)


def errors_figure(records: Mapping[str, Mapping]) -> Figure:
    """Each line's error in units of its tolerance on a logarithmic axis, a row a case."""
    shown = {name: [_line(row) for row in one["lines"]] for name, one in records.items() if one["lines"]}
    figure, axes = canvas((6.4, 0.9 + 0.21 * len(shown)))
    for row, lines in enumerate(shown.values()):
        shares = [_share_of_allowed(line) for line in lines]
        colours = [BLUE if line.passed else VERMILION for line in lines]
        axes.scatter(shares, np.full(len(shares), row), s=14, c=colours, alpha=0.7, linewidths=0)
    axes.axvline(1.0, color=GREY, lw=1.0)
    axes.set_xscale("log")
    axes.set_xlim(0.6 * SMALLEST, max(3.0, 1.5 * axes.get_xlim()[1]))
    axes.set_yticks(range(len(shown)), list(shown))
    axes.set_ylim(len(shown) - 0.5, -0.5)
    axes.set_xlabel(f"error, in units of what is allowed (less than {SMALLEST:g} is drawn there)")
    return figure
