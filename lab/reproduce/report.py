"""The report: an overview, and of each experiment what the source states, what we get, a figure and a picture."""

from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path

import matplotlib

from lab.accuracy import LEVELS
from lab.errors import LabError
from lab.page import Page
from lab.plots import STYLE
from lab.reproduce.experiment import Experiment, Told
from lab.reproduce.runs import Outcome, outcomes

PICTURE = (640, 360)  # pixels
TITLES = {
    "granular": "The granular experiments of the source, reproduced",
    "shapes": "The source's experiments with irregular grains, reproduced",
    "ship": "The source's ships with loose cargo, reproduced",
}
VERDICTS = {True: "yes", False: "**no**", None: ""}


def write_report(name: str, experiments: Mapping[str, Experiment], work: Path, out: Path, quick: bool) -> Path:
    """Write NAME.md (quick: NAME-quick.md) and its pictures about all experiments whose runs are done."""
    command = f"reproduce {name}{' --quick' if quick else ''}"
    page = Page(out, f"{name}-quick" if quick else name, TITLES[name], command)
    done = {}
    for one, experiment in experiments.items():
        found = {key: outcomes(work / one / key) for key in experiment.batches(quick)}
        if all(found.values()):
            done[one] = found
    with matplotlib.rc_context(STYLE):
        told = {one: experiments[one].tell(found) for one, found in done.items()}
        _overview(page, experiments, told, done, quick)
        for one, found in done.items():
            _section(page, experiments[one], told[one], found, quick)
    return page.write()


def _overview(
    page: Page, experiments: Mapping[str, Experiment], told: Mapping[str, Told], done: Mapping, quick: bool
) -> None:
    page.say("""The source is Spandonidis (2016), doctoral thesis, NTUA. Its numbers are compared as numbers,
        ± the standard deviation over beds that differ in nothing but their seed; what it gives in words or curves is
        compared as a trend.""")
    if quick:
        page.say(
            "The quick report: fewer and smaller beds, faster tilts, draft accuracy; each section says what is lost."
        )
    else:
        page.say(f"""Beds are run at draft accuracy ({LEVELS["draft"].error}) and mostly tilted at 3 deg/s where the
            source has 0.15 to 3, often four where it has 12: within the scatter of beds neither shows (`cargolab bench
            accuracy`).""")
    rows = []
    for name, experiment in experiments.items():
        if name not in told:
            rows.append([experiment.title, experiment.section, "not run", "", ""])
            continue
        judged = [row.agrees for row in told[name].rows if row.agrees is not None]
        spent = sum(o.cost["wall_s"] for found in done[name].values() for o in found)
        rows.append(
            [
                experiment.title,
                experiment.section,
                f"{sum(judged)} of {len(judged)}",
                _work(done[name]),
                f"{spent:.0f} s",
            ]
        )
    page.table(["experiment", "section", "statements that agree", "grain-steps", "time here"], rows)


def _section(page: Page, experiment: Experiment, told: Told, found: Mapping[str, list[Outcome]], quick: bool) -> None:
    page.section(experiment.title)
    page.say(f"Source ({experiment.section}): {experiment.states}")
    if quick:
        page.say(f"Quick: {experiment.lost}")
    page.table(
        ["quantity", "source", "here", "difference", "agrees"],
        [[r.quantity, r.source, r.ours, r.difference, VERDICTS[r.agrees]] for r in told.rows],
    )
    if told.remark:
        page.say(told.remark)
    stopped = [o for batch in found.values() for o in batch if o.status != "complete"]
    for outcome in stopped:
        page.say(f"**Not complete** ({outcome.folder.name}): {outcome.status}")
    if told.figure is not None:
        page.figure(experiment.name, told.figure, experiment.title)
    batch, fraction = experiment.shown
    _picture(page, found[batch][0], experiment, fraction)


def _picture(page: Page, outcome: Outcome, experiment: Experiment, fraction: float) -> None:
    from lab.paint.video import poster  # slow to load

    path = page.folder / f"{page.name}-{experiment.name}-picture.png"
    with suppress(LabError):  # a run that was stopped before its first picture
        poster(outcome.folder, path, fraction=fraction, width=PICTURE[0], height=PICTURE[1], world=0)
        page.show(path, f"{experiment.title}: a picture")


def _work(found: Mapping[str, list[Outcome]]) -> str:
    return f"{sum(o.cost['grain_steps'] for batch in found.values() for o in batch):.2g}"
