"""The report: an overview, and for each experiment the source's statement, our result, a figure and a picture."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import matplotlib

from lab.base.errors import LabError
from lab.measures.value import LEVEL
from lab.preset.accuracy import LEVELS
from lab.recording import open_recording
from lab.report.page import Page
from lab.report.plots import STYLE
from lab.studies.reproduce.claims import reports
from lab.studies.reproduce.estimates import Verdict
from lab.studies.reproduce.experiment import Experiment, Row
from lab.studies.reproduce.findings import Finding, asked, read_findings, write_findings
from lab.studies.reproduce.runs import Outcome, outcomes

PICTURE = (640, 360)  # pixels
LOUD = {Verdict.AGREES: "agrees", Verdict.DIFFERS: "**differs**", Verdict.CANNOT_TELL: "cannot tell", None: ""}
RUNS = "Each section says by which version of the lab its runs were made; times are of the machines that ran them."
RULE = f"""A verdict is of the {100.0 * LEVEL:g} % interval of the difference: *agrees* where all of it lies within the
    tolerance, *differs* where all of it lies outside, else *cannot tell*: more beds could (two one-sided tests,
    Schuirmann 1987; see `docs/numbers.md`)."""


def write_report(
    name: str, experiments: Mapping[str, Experiment], ended: Mapping[str, Mapping[str, Path]], out: Path, quick: bool
) -> Path:
    """Write NAME.md (quick: NAME-quick.md) from the experiments whose runs have ended and the kept findings of others.

    ended: the folders of the batches of each. Beside the page are its pictures, and NAME.json with the findings.
    """
    command = f"reproduce {name}{' --quick' if quick else ''}"
    page = Page(out, page_name(name, quick), reports()[name].title, command, RUNS)
    kept = read_findings(kept_file(name, out, quick), experiments, quick)
    for one, folders in ended.items():
        found = {key: outcomes(folder) for key, folder in folders.items()}
        if all(found.values()):
            kept[one] = _finding(page, experiments[one], found, quick)
    findings = {one: kept[one] for one in experiments if one in kept}
    _overview(page, name, experiments, findings, quick)
    for one, finding in findings.items():
        _section(page, experiments[one], finding, quick)
    write_findings(kept_file(name, out, quick), findings)
    return page.write()


def page_name(report: str, quick: bool) -> str:
    """Name of a report's page, and of the files beside it."""
    return f"{report}-quick" if quick else report


def kept_file(report: str, out: Path, quick: bool) -> Path:
    """The file with the kept findings."""
    return out / f"{page_name(report, quick)}.json"


def _finding(page: Page, experiment: Experiment, found: Mapping[str, list[Outcome]], quick: bool) -> Finding:
    with matplotlib.rc_context(STYLE):
        told = experiment.tell(found)
    runs = [one for batch in found.values() for one in batch]
    figure = "" if told.figure is None else page.save(experiment.name, told.figure).name
    return Finding(
        asked(experiment.batches(quick)),
        tuple(told.rows),
        tuple((one.folder.name, one.status) for one in runs if one.status != "complete"),
        sum(one.cost["grain_steps"] for one in runs),
        sum(one.cost["wall_s"] for one in runs),
        figure,
        _picture(page, experiment, found),
        told.table,
        _made(runs),
    )


def _made(runs: Sequence[Outcome]) -> str:
    """Version and date of the latest of the runs."""
    with open_recording(runs[-1].folder) as recording:
        return f"version {recording.versions.get('cargo-shift-lab', '?')}, {recording.created[:10]}"


def _overview(
    page: Page, name: str, experiments: Mapping[str, Experiment], findings: Mapping[str, Finding], quick: bool
) -> None:
    page.say(_counted([row for finding in findings.values() for row in finding.rows]))
    page.say(RULE)
    page.say("""The source is Spandonidis (2016), doctoral thesis, NTUA. Our numbers are means ± the standard
        deviation over beds, which differ in nothing but their seed; of one bed there is no ±. What the source gives in
        words or curves is compared as a trend.""")
    if quick:
        page.say(
            "The quick report: fewer and smaller beds, faster tilts, draft accuracy; each section says what is lost."
        )
    else:
        page.say(reports()[name].less.replace("{draft}", LEVELS["draft"].error))
    rows = []
    for one, experiment in experiments.items():
        if one not in findings:
            rows.append([experiment.title, experiment.section, "not run", *[""] * (len(Verdict) + 1)])
            continue
        finding = findings[one]
        counts = [sum(row.verdict is verdict for row in finding.rows) for verdict in Verdict]
        cost = f"{finding.grain_steps:.2g}", f"{finding.wall_s:.0f} s"
        rows.append([experiment.title, experiment.section, *(counts if any(counts) else ["–"] * len(counts)), *cost])
    page.table(["experiment", "section", *Verdict, "grain-steps", "time"], rows)


def _counted(rows: Sequence[Row]) -> str:
    """Text with the number of verdicts of each kind."""
    counts = {verdict: sum(row.verdict is verdict for row in rows) for verdict in Verdict}
    agree, differ, open_ones = (counts[verdict] for verdict in Verdict)
    return f"""**Of {sum(counts.values())} statements held against the source {agree} agree, {differ} differ, and of
        {open_ones} these beds cannot tell.**"""


def _section(page: Page, experiment: Experiment, finding: Finding, quick: bool) -> None:
    page.section(experiment.title)
    page.say(f"Source ({experiment.section}): {experiment.states}")
    page.say(f"Runs: {finding.made}.{f' Quick: {experiment.lost}' if quick else ''}")
    page.table(
        ["quantity", "source", "here", "difference, interval", "tolerance, and where from", "verdict"],
        [[r.quantity, r.source, r.ours, r.apart, r.tolerance, LOUD[r.verdict]] for r in finding.rows],
    )
    if experiment.why:
        page.say(experiment.why)
    if experiment.question:
        page.say(f"**Open question:** {experiment.question}")
    if finding.table:
        page.table(finding.table[0], finding.table[1:])
    for name, status in finding.stopped:
        page.say(f"**Not complete** ({name}): {status}")
    if finding.figure:
        page.show(page.folder / finding.figure, experiment.title)
    if finding.picture:
        page.show(page.folder / finding.picture, f"{experiment.title}: a picture")


def _picture(page: Page, experiment: Experiment, found: Mapping[str, list[Outcome]]) -> str:
    """The file of the picture; "" where a run was stopped before its first."""
    from lab.paint.video import poster  # slow to load

    batch, fraction = experiment.shown
    path = page.folder / f"{page.name}-{experiment.name}-picture.png"
    try:
        poster(
            found[batch][experiment.point].folder, path, fraction=fraction, width=PICTURE[0], height=PICTURE[1], world=0
        )
    except LabError:
        return ""
    return path.name
