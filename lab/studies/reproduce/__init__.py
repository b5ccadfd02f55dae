"""cargolab reproduce: run the experiments of the source and compare them with what the source states.

What the source claims is in the folder `lab/studies/claims`. The runs of an experiment are kept in a folder of their
own and are not repeated; a run that was cut short is continued.
"""

from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path

from lab.base.data import FOLDER, data_file
from lab.base.errors import LabError
from lab.base.lock import only_one
from lab.base.progress import Progress
from lab.studies.engine import choose
from lab.studies.reproduce.cached import read_cached
from lab.studies.reproduce.claims import experiments
from lab.studies.reproduce.experiment import Experiment
from lab.studies.reproduce.report import kept_file, write_page, write_report
from lab.studies.reproduce.runs import Batch, errands
from lab.studies.reproduce.workers import carry_out_all
from lab.sweeps.cluster import fetch


def reproduce(
    report: str,
    names: Sequence[str],
    out: Path | str,
    quick: bool,
    quiet: bool = False,
    cluster: str | None = None,
    page_only: bool = False,
) -> Path:
    """Run a report's experiments of these `names`, or whose names begin so, or all, and write the report.

    Without names, an experiment that is in the report already is not run again, even if its runs have been removed.
    cluster: the address of a scheduler whose workers first run all that has not been begun. The report is rewritten
    after each experiment; `page_only`: nothing is run. Returns its file. Raises LabError, one sentence, and
    KeyboardInterrupt; finished runs stay.
    """
    known = experiments(report)
    chosen = choose(names, known, "experiment")
    chosen = [name for name in chosen if _can_run(known[name], name, quick, names)]
    out, work = Path(out), Path(out) / ("quick" if quick else "full")
    folders = places(known, work, quick)
    told = read_cached(kept_file(report, out, quick), known, quick)
    if page_only:
        return write_page(report, known, told, out, quick)
    removed = [name for name in told if not any(folder.exists() for folder in folders[name].values())]
    if not names:
        chosen = [name for name in chosen if name not in removed]
    batches = {folders[name][key]: batch for name in chosen for key, batch in known[name].batches(quick).items()}
    if cluster:
        _run_there(batches, cluster, quiet)
    page = write_report(report, known, {}, out, quick)
    left = {name: set(folders[name].values()) for name in chosen}
    for folder in carry_out_all(batches, Progress(quiet)):
        ended = [name for name, missing in left.items() if missing == {folder}]
        left = {name: missing - {folder} for name, missing in left.items()}
        if ended:
            page = write_report(report, known, {name: folders[name] for name in ended}, out, quick)
    return page


def _can_run(one: Experiment, name: str, quick: bool, asked: Sequence[str]) -> bool:
    """Whether an experiment has such runs and the measured series that it needs. Raises LabError for one asked for."""
    if not one.batches(quick):
        if name in asked:
            raise LabError(f"{name}: has no quick runs; leave out --quick.")
        return False
    if not one.needs or data_file(one.needs):
        return True
    if asked:
        raise LabError(f"{name}: needs {one.needs}; set {FOLDER} to the folder of measured series that has it.")
    return False


def places(known: Mapping[str, Experiment], work: Path, quick: bool) -> dict[str, dict[str, Path]]:
    """The folders of the batches of each experiment, by name; a batch that two experiments share is run once."""
    taken: list[tuple[Batch, Path]] = []
    folders = {}
    for name, experiment in known.items():
        folders[name] = {}
        for key, batch in experiment.batches(quick).items():
            place = next((there for other, there in taken if other == batch), work / name / key)
            taken.append((batch, place))
            folders[name][key] = place
    return folders


def _run_there(batches: Mapping[Path, Batch], cluster: str, quiet: bool) -> None:
    """Run all batches on the cluster at once, so that its workers need not wait for one another."""
    with Progress(quiet) as progress, ExitStack() as held:
        for folder in batches:
            held.enter_context(only_one(folder))
        fetch([errand for folder, batch in batches.items() for errand in errands(batch, folder)], cluster, progress)
