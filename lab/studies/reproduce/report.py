"""The report: an overview, and for each experiment the source's statement, our result, a figure and a picture."""

from collections.abc import Mapping, Sequence
from datetime import date
from pathlib import Path

import matplotlib

from lab.base.errors import LabError
from lab.measures.value import LEVEL
from lab.preset.accuracy import LEVELS
from lab.recording import open_recording
from lab.report.kept import Made, processor
from lab.report.page import on_page, render, save_figure
from lab.report.plots import STYLE
from lab.studies.reproduce.cached import CachedResult, asked, read_cached, write_cached
from lab.studies.reproduce.claims import reports
from lab.studies.reproduce.estimates import Verdict
from lab.studies.reproduce.experiment import Experiment, Kind, Row
from lab.studies.reproduce.runs import Outcome, outcomes

PICTURE = (640, 360)  # pixels
LOUD = {Verdict.AGREES: "agrees", Verdict.DIFFERS: "**differs**", Verdict.CANNOT_TELL: "cannot tell", None: ""}
QUICK = "The quick report: fewer and smaller beds, faster tilts, draft accuracy; each section says what is lost."


def write_report(
    name: str, experiments: Mapping[str, Experiment], ended: Mapping[str, Mapping[str, Path]], out: Path, quick: bool
) -> Path:
    """Write NAME.md (quick: NAME-quick.md) from the experiments whose runs have ended and the kept findings of others.

    ended: the folders of the batches of each. Beside the page are its pictures, and NAME.json with the findings.
    """
    out.mkdir(parents=True, exist_ok=True)
    kept = read_cached(kept_file(name, out, quick), experiments, quick)
    for one, folders in ended.items():
        found = {key: outcomes(folder) for key, folder in folders.items()}
        if all(found.values()):
            files = out / f"{page_name(name, quick)}-{one}"
            kept[one] = _finding(files, experiments[one], found, command_of(name, quick), quick)
    findings = {one: kept[one] for one in experiments if one in kept}
    write_cached(kept_file(name, out, quick), findings)
    return write_page(name, experiments, findings, out, quick)


def write_page(
    name: str, experiments: Mapping[str, Experiment], findings: Mapping[str, CachedResult], out: Path, quick: bool
) -> Path:
    """Write the page from findings, those that differ most first; returns its file."""
    told = sorted(findings, key=lambda one: _badness(findings[one].rows), reverse=True)
    missing = [one for one in experiments if one not in findings]
    rows = [row for finding in findings.values() for row in finding.rows]
    files = [one.figure for one in findings.values()] + [one.picture for one in findings.values()]
    less = reports()[name].less.replace("{draft}", LEVELS["draft"].error)
    return render(
        out / f"{page_name(name, quick)}.md",
        "reproduce.md.j2",
        title=reports()[name].title,
        command=command_of(name, quick),
        date=date.today(),
        counts=_counts(rows),
        kinds=[[kind, *_counts([row for row in rows if row.kind == kind])] for kind in Kind],
        source=reports()[name].source,
        level=f"{100.0 * LEVEL:g}",
        limits=QUICK if quick else less,
        quick=quick,
        **on_page(files, f"{page_name(name, quick)}-{reports()[name].shown}.png"),
        overview=[_overview(experiments[one], findings.get(one), quick) for one in (*told, *missing)],
        sections=[(experiments[one], findings[one], _cells(findings[one].rows)) for one in told],
    )


def page_name(report: str, quick: bool) -> str:
    """Name of a report's page, and of the files beside it."""
    return f"{report}-quick" if quick else report


def kept_file(report: str, out: Path, quick: bool) -> Path:
    """The file with the kept findings."""
    return out / f"{page_name(report, quick)}.json"


def command_of(report: str, quick: bool) -> str:
    """The command that makes a report."""
    return f"reproduce {report}{' --quick' if quick else ''}"


def _finding(
    files: Path, experiment: Experiment, found: Mapping[str, list[Outcome]], command: str, quick: bool
) -> CachedResult:
    """What the outcomes tell; its figure and picture are saved by names that begin with `files`."""
    with matplotlib.rc_context(STYLE):
        told = experiment.report(found)
    runs = [one for batch in found.values() for one in batch]
    return CachedResult(
        asked=asked(experiment.batches(quick)),
        rows=tuple(told.rows),
        stopped=tuple((one.folder.name, one.status) for one in runs if one.status != "complete"),
        grain_steps=sum(one.cost["grain_steps"] for one in runs),
        wall_s=sum(one.cost["wall_s"] for one in runs),
        figure="" if told.figure is None else save_figure(files.with_name(f"{files.name}.png"), told.figure).name,
        picture=_picture(files.with_name(f"{files.name}-picture.png"), experiment, found),
        table=told.table,
        made=_made(runs, command),
    )


def _made(runs: Sequence[Outcome], command: str) -> Made:
    """What made the latest of the runs; the processor is the one that tells of them."""
    with open_recording(runs[-1].folder) as recording:
        return Made(recording.version, recording.created[:10], processor(), f"cargolab {command}")


def _counts(rows: Sequence[Row]) -> list[int]:
    """How many verdicts there are of each kind."""
    return [sum(row.verdict is verdict for row in rows) for verdict in Verdict]


def _badness(rows: Sequence[Row]) -> tuple[int, int]:
    """How many statements differ, and of how many the beds cannot tell."""
    _, differ, open_ones = _counts(rows)
    return differ, open_ones


def _overview(experiment: Experiment, finding: CachedResult | None, quick: bool) -> list[object]:
    """The line of an experiment."""
    if finding is None:
        why = "not run" if experiment.batches(quick) else "not among the quick ones"
        return [experiment.title, experiment.section, why, *[""] * (len(Verdict) + 1)]
    counts = _counts(finding.rows)
    cost = f"{finding.grain_steps:.2g}", f"{finding.wall_s:.0f} s"
    return [experiment.title, experiment.section, *(counts if any(counts) else ["–"] * len(counts)), *cost]


def _cells(rows: Sequence[Row]) -> list[list[str]]:
    """The cells of a section's table."""
    return [
        [row.quantity, row.source, row.ours, row.apart, row.tolerance, row.kind or "", LOUD[row.verdict]]
        for row in rows
    ]


def _picture(path: Path, experiment: Experiment, found: Mapping[str, list[Outcome]]) -> str:
    """The name of the picture's file; "" where a run was stopped before its first."""
    from lab.paint.video import poster  # slow to load

    batch, fraction = experiment.shown
    point, outcomes = experiment.point, found[batch]
    if isinstance(point, str):
        point = next(k for k, one in enumerate(outcomes) if point in map(str, one.setting.values()))
    folder = outcomes[point].folder
    try:
        poster(folder, path, fraction=fraction, width=PICTURE[0], height=PICTURE[1], world=0)
    except LabError:
        return ""
    return path.name
