"""The claims of a source as data: TOML files in the folder `lab/studies/claims`, one `[[experiment]]` after the other.

An experiment names its runs, each a preset with changes and perhaps a grid, in full and quick, and its rows, each a
number that is told or held against what the source states (see `lab.studies.reproduce.compare`). What needs code has a
name in `lab.studies.reproduce.registry`.
"""

import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Literal

from pydantic import BaseModel, ConfigDict, Field

from lab.studies.reproduce import registry
from lab.studies.reproduce.columns import Column, table
from lab.studies.reproduce.compare import ALL, LAST, Claim, rows
from lab.studies.reproduce.experiment import Experiment, Found, Kind, ReportSection, Tolerance, all_against
from lab.studies.reproduce.runs import Batch

FOLDER = Path(__file__).parents[1] / "claims"
Setting = dict[str, object]


class Strict(BaseModel):
    """A table in which a word that is not known is an error."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class Settings(Strict):
    """Changes that runs share by `like`: of all, of the full report and of the quick one."""

    all: Setting = {}
    full: Setting = {}
    quick: Setting = {}


class Run(Strict):
    """Runs of a preset with changes by dotted keys, one for each point of the grid `axes`.

    `full` and `quick` are changes of one report, `quick_axes` and `quick_preset` the grid and preset of the quick one
    where they differ, `only` the report that has these runs.
    """

    preset: str
    quick_preset: str = ""
    like: str = ""
    changes: Setting = {}
    full: Setting = {}
    quick: Setting = {}
    axes: dict[str, list] = {}
    quick_axes: dict[str, list] | None = None
    only: Literal["", "full", "quick"] = ""

    def batch(self, shared: Settings, quick: bool) -> Batch:
        """The batch of the quick or of the full report."""
        less, own = (shared.quick, self.quick) if quick else (shared.full, self.full)
        axes = self.quick_axes if quick and self.quick_axes is not None else self.axes
        preset = (quick and self.quick_preset) or self.preset
        return Batch(preset, {**shared.all, **less, **self.changes, **own}, axes)


class Shown(Strict):
    """The run that is pictured, at a share of its duration, and the point of its grid: its number, or a value there."""

    run: str
    at: float
    point: int | str = -1


class Stated(Strict):
    """An experiment of the source as a file tells it; `Experiment` says what its words are.

    `runs_of` names the experiment whose runs it looks at, too. `figure` names a function of `registry.FIGURES` by `by`,
    with its arguments; `columns` are those of a table of runs of water, or the name of
    columns that experiments share; `report` is one of `registry.SECTIONS`, which gives
    rows, figure and table. `needs` is the measured series without which it cannot be run (`lab.base.data`). `kind` is
    that of all rows that have none of their own.
    """

    name: str
    title: str
    section: str
    states: str
    lost: str
    shown: Shown
    why: str = ""
    question: str = ""
    runs: dict[str, Run] = {}
    runs_of: str = ""
    rows: list[dict] = []
    columns: list[Column] | str = []
    figure: dict[str, object] = {}
    report: str = ""
    needs: str = ""
    kind: Kind | None = None


class Source(Strict):
    """A file of claims: what runs share, the columns and tolerances by name, the experiments."""

    settings: dict[str, Settings] = {}
    columns: dict[str, list[Column]] = {}
    tolerance: dict[str, Tolerance] = {}
    experiment: list[Stated] = Field(min_length=1)


class Report(Strict):
    """A report: its title, its files of claims in their order, how its full runs differ from the source's own,
    the experiment whose figure its page shows, and what its source is."""

    title: str
    files: list[str]
    less: str
    shown: str
    source: str = "The source is Spandonidis (2016), doctoral thesis, NTUA."


@cache
def reports() -> dict[str, Report]:
    """The reports by name."""
    table = tomllib.loads((FOLDER / "reports.toml").read_text(encoding="utf-8"))
    return {name: Report.model_validate(one) for name, one in table.items()}


@cache
def experiments(report: str) -> dict[str, Experiment]:
    """The experiments of a report by name, in the order of its files."""
    found: dict[str, Experiment] = {}
    for name in reports()[report].files:
        found |= read((FOLDER / f"{name}.toml").read_text(encoding="utf-8"))
    return found


def read(text: str) -> dict[str, Experiment]:
    """The experiments of a file of claims by name. Raises ValueError for a bad one, before anything is run."""
    source = Source.model_validate(tomllib.loads(text))
    runs = {one.name: one.runs for one in source.experiment}
    return {one.name: _experiment(one, runs.get(one.runs_of or one.name, {}), source) for one in source.experiment}


def _experiment(stated: Stated, runs: Mapping[str, Run], source: Source) -> Experiment:
    claims = [Claim.model_validate(one) for raw in stated.rows for one in spread(raw)]
    _check(stated, claims, runs, source)
    columns = source.columns[stated.columns] if isinstance(stated.columns, str) else stated.columns

    def batches(quick: bool) -> dict[str, Batch]:
        other = "full" if quick else "quick"
        return {
            name: one.batch(source.settings[one.like] if one.like else Settings(), quick)
            for name, one in runs.items()
            if one.only != other
        }

    def report(found: Found) -> ReportSection:
        if stated.report:
            told = registry.SECTIONS[stated.report](found)
            return replace(told, rows=all_against(told.rows, stated.kind))
        draw = {key: value for key, value in stated.figure.items() if key != "by"}
        figure = registry.FIGURES[stated.figure["by"]](found, **draw) if stated.figure else None
        further = table(columns, found) if columns else ()
        return ReportSection(all_against(rows(claims, found, source.tolerance), stated.kind), figure, further)

    told = "name", "title", "section", "states", "lost", "why", "question", "needs"
    words = {name: getattr(stated, name) for name in told}
    shown = stated.shown.run, stated.shown.at
    return Experiment(batches=batches, report=report, shown=shown, point=stated.shown.point, **words)


def _check(stated: Stated, claims: Sequence[Claim], runs: Mapping[str, Run], source: Source) -> None:
    """Raise ValueError where a name is of nothing: a run, a setting, a tolerance, a function."""
    asked = [one for claim in claims for one in ([claim.runs] if isinstance(claim.runs, str) else claim.runs)]
    names = {
        "run": ([*asked, stated.shown.run], {*runs, ALL, LAST}),
        "point": ([stated.shown.point] if isinstance(stated.shown.point, str) else [], _points(runs)),
        "setting": ([run.like for run in runs.values()], source.settings),
        "set of columns": ([stated.columns] if isinstance(stated.columns, str) else [], source.columns),
        "tolerance": ([claim.within for claim in claims], source.tolerance),
        "function of rows": ([claim.by for claim in claims], registry.ROWS),
        "figure": ([stated.figure.get("by", "")], registry.FIGURES),
        "function": ([stated.report], registry.SECTIONS),
    }
    for what, (used, known) in names.items():
        if missing := {*filter(None, used)} - {*known}:
            raise ValueError(f"{stated.name}: there is no {what} {', '.join(sorted(missing))}")
    if bare := [one.says for one in claims if one.compare != "told" and one.judged and not (one.kind or stated.kind)]:
        raise ValueError(f"{stated.name}: {bare[0]}: say by `kind` what it is held against")


def _points(runs: Mapping[str, Run]) -> set[str]:
    """The values of grids that full and quick runs have in common."""
    grids = [(one.axes, one.axes if one.quick_axes is None else one.quick_axes) for one in runs.values()]
    pairs = [(full[axis], quick[axis]) for full, quick in grids for axis in full if axis in quick]
    return {value for full, quick in pairs for value in {*map(str, full)} & {*map(str, quick)}}


def spread(raw: Mapping[str, object]) -> Iterator[dict]:
    """A row, or one for each word of its list `each`, in place of "{each}"; `rows` within it are repeated together.

    A table among the fields gives each word a value of its own, and none to those it leaves out.
    """
    rest = {key: value for key, value in raw.items() if key not in ("each", "rows")}
    for item in raw.get("each", [None]):
        for row in raw.get("rows", [rest]):
            found = row if item is None else {key: _said(value, item, row) for key, value in row.items()}
            found = {key: value for key, value in found.items() if value is not None}
            yield from spread(found) if "rows" in raw else [found]


def _said(value: object, item: str, row: Mapping[str, object]) -> object:
    if isinstance(value, str):
        return value.replace("{each}", item)
    if isinstance(value, list):
        return [_said(one, item, row) for one in value]
    return value.get(item) if isinstance(value, dict) and "each" not in row else value
