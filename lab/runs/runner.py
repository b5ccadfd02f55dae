"""Run an experiment to its end (settle, simulate, record, measure, plot, film, summarise), or continue one."""

import json
import shlex
from collections.abc import Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager, nullcontext
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

from lab.base.errors import LabError, Unusable
from lab.base.files import named
from lab.base.lock import only_one
from lab.base.progress import Progress
from lab.base.turn import in_turn
from lab.measures import measure_all
from lab.measures.value import Measures, Value
from lab.paint.beside import Beside, second_process
from lab.plugins.loading import local
from lab.preset.find import LoadedPreset, load
from lab.preset.recorded import checked
from lab.recording import FILE_NAME, Recording, open_recording, versions
from lab.report.notebook import WithPictures, of_run
from lab.report.summary import status_of, terminal_summary, write_summary
from lab.runs.batch import run_batch
from lab.runs.belongs import check_belongs
from lab.runs.checkpoint import FILE_NAME as CHECKPOINT
from lab.runs.checkpoint import Checkpoint, read_checkpoint, remove_checkpoint
from lab.runs.run import Run, prepare
from solvers.machine.runtime import available_cores

RENDERS = Path("renders")


@dataclass(repr=False)
class Result(WithPictures):
    """The result of a run: its folder, its measures by name, and the arrays of its recording."""

    folder: Path
    measures: dict[str, Value]
    summary_text: str = field(repr=False)

    def __repr__(self) -> str:
        return f"<Result in {self.folder}>\n{self.measures!r}"

    def _repr_html_(self) -> str:
        recording = self.recording
        facts = f"{recording.name}: {status_of(recording)}; {self.folder}"
        return of_run(recording.preset.title, facts, Measures(self.measures)._repr_html_(), self.folder)

    @cached_property
    def recording(self) -> Recording:
        """The recording: `series`, `frames`, `radius`, `outline` … as arrays."""
        return open_recording(self.folder)


@in_turn
def run_preset(
    name: str | Path,
    overrides: Mapping | None = None,
    out: Path | str | None = None,
    *,
    video: bool = True,
    plots: bool = True,
    quiet: bool = False,
    beside: Beside | None = None,
) -> Result:
    """Run a preset and write recording, plots, video and summary to a folder (default: renders/NAME).

    beside: a second process that films it, if one has been started already.
    Raises LabError for errors that the user can correct, BadState if the watch stopped the run, and KeyboardInterrupt;
    the recording so far is kept, with its summary and the checkpoint for `resume_run`.
    """
    loaded = load(name, overrides)
    folder = named(out) if out is not None else free_folder(RENDERS / loaded.name)
    with Progress(quiet) as progress, hint(folder), _second_process(video, beside) as beside:
        with progress.costs.of("settle"):
            run = prepare(loaded, folder)
        progress.say(f"{loaded.name}: {loaded.resolved.title}")  # little of it can be refused now; the rest takes long
        with only_one(folder):
            run.make_recording()
            return _complete(run, None, progress, plots, video, beside)


@in_turn
def resume_run(folder: Path | str, *, video: bool = True, plots: bool = True, quiet: bool = False) -> Result:
    """Continue a run that was killed, interrupted or stopped, from its checkpoint, with the same bits.

    The preset is the one in the recording. If only the results are missing, only they are made. Raises as `run_preset`
    does, and LabError if there is nothing to continue.
    """
    folder = Path(folder)
    with open_recording(folder) as recording:
        loaded, complete = recorded_preset(recording), recording.complete
        if not complete:
            check_untouched(recording)
        rows, changed = recording.series.rows, recording.versions != versions()
        told = complete and reported(recording)
    if told:
        raise LabError(f"{folder} is complete: there is nothing to resume.")
    with Progress(quiet) as progress, hint(folder), only_one(folder):
        if complete:
            remove_checkpoint(folder)
            return report(folder, progress, video=video, plots=plots, costs=True)
        kept = read_checkpoint(folder)
        if kept is None and rows:
            raise LabError(f"{folder} has no checkpoint to resume from: start the run again, in another folder.")
        if changed:
            progress.warn("The run was begun with other versions of the lab or its libraries than it continues with.")
        with _second_process(video) as beside:
            with progress.costs.of("settle"):
                run = prepare(loaded, folder)
            check_belongs(run)
            return _complete(run, kept, progress, plots, video, beside)


def recorded_preset(recording: Recording) -> LoadedPreset:
    """The preset of a recording, ready to run again. Raises Unusable if it is not a valid one."""
    try:
        resolved = checked(recording.preset)
    except ValueError as error:
        raise Unusable(f"{recording.path} has no preset that this version can run: start the run again.") from error
    return LoadedPreset(recording.name, recording.given, resolved)


def check_untouched(recording: Recording) -> None:
    """Raise LabError for a recording of a run that the user has changed as it ran: no checkpoint keeps that."""
    if recording.steering:
        raise LabError(
            f"{recording.folder}: this run was changed while it ran, which no checkpoint keeps: begin it again."
        )


def report(
    folder: Path,
    progress: Progress,
    *,
    video: bool,
    plots: bool = True,
    costs: bool = False,
    beside: Beside | None = None,
) -> Result:
    """Measure, plot and film the recording, and write the summary; with the `costs` if all were of this run.

    beside: a second process that films meanwhile.
    """
    with open_recording(folder) as recording:
        if video and beside:
            beside.begin(folder)
        files = {"recording": recording.path}
        with progress.costs.of("measures"):
            measures = measure_all(recording)
        if plots:
            with progress.costs.of("plots"):
                from lab.report.plots import write_plots  # Matplotlib is slow to import

                files |= write_plots(recording, measures, folder)
        if video:
            with progress.costs.of("video"):
                files["video"] = _film(folder, progress, beside)
        spent = progress.costs.told() if costs else None
        write_summary(recording, measures, files, folder, progress.warnings, progress.notes, spent)
        return Result(folder, measures, terminal_summary(recording, measures, files, progress.warnings, spent))


def reported(recording: Recording) -> bool:
    """Whether the summary beside a recording is of it as it is now."""
    try:
        told = json.loads((recording.folder / "summary.json").read_text(encoding="utf-8"))
        created = told.get("created", recording.created)  # earlier versions did not write it
        return (told["status"], created) == (recording.status, recording.created)
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError):
        return False


@contextmanager
def hint(folder: Path, begun: str = FILE_NAME) -> Iterator[None]:
    """If the run is interrupted, add to the message how to continue it; the file `begun` shows that it had started."""
    resume = f"cargolab resume {shlex.quote(str(folder))}"
    try:
        yield
    except KeyboardInterrupt as error:
        if not (folder / begun).exists():
            raise KeyboardInterrupt("interrupted before the run began") from None
        raise KeyboardInterrupt(f"{str(error) or 'interrupted'}; continue with: {resume}") from None
    except LabError as error:
        if isinstance(error, Unusable) or not (folder / CHECKPOINT).exists():
            raise
        raise LabError(f"{str(error).removesuffix('.')}; continue with: {resume}") from error


def _complete(
    run: Run, kept: Checkpoint | None, progress: Progress, plots: bool, video: bool, beside: Beside | None
) -> Result:
    """Run, or continue, to the end and report."""
    try:
        stopped = run_batch([run], run.folder, progress, kept)
    except KeyboardInterrupt:
        report(run.folder, progress, video=False, plots=plots, costs=True)
        raise
    result = report(run.folder, progress, video=video and not stopped, plots=plots, costs=True, beside=beside)
    for error in stopped.values():
        raise error
    return result


def _second_process(video: bool, given: Beside | None = None) -> AbstractContextManager[Beside | None]:
    """The process that films a run: the given one, else a new one; None without a video, or on a single core."""
    wanted = video and given is None and not local()  # what a notebook defines, another process does not know
    return second_process(available_cores()) if wanted else nullcontext(given)


def _film(folder: Path, progress: Progress, beside: Beside | None) -> Path:
    progress.start("painting", None)
    path = beside and beside.finish(progress.count)
    if path is None:
        from lab.paint.video import render_recording

        path = render_recording(folder, progress=progress.count)
    progress.finish()
    return path


def free_folder(wanted: Path) -> Path:
    """`wanted`, or the first of wanted-2, wanted-3 … that holds no recording yet."""
    for number in range(1, 10_000):
        folder = wanted if number == 1 else wanted.with_name(f"{wanted.name}-{number}")
        if not (folder / FILE_NAME).exists():
            return folder
    raise LabError(f"{wanted.parent} is full of runs of {wanted.name}; remove some or give --out.")
