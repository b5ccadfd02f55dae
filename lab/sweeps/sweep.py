"""A sweep: one preset run over a grid of values of its keys; every point is an ordinary run in its own folder.

Points whose scenes can share a batch are simulated together; their recordings do not depend on that. An interrupted
sweep continues when it is requested again.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path

from lab.assembly.water import particles
from lab.base.errors import LabError, Unusable
from lab.base.files import named
from lab.base.lock import only_one
from lab.base.progress import Progress
from lab.base.turn import in_turn
from lab.recording import FILE_NAME as RECORDING
from lab.recording import open_recording
from lab.runs.batch import run_batch
from lab.runs.belongs import check_asked, check_belongs
from lab.runs.checkpoint import Checkpoint, read_checkpoint, remove_checkpoint
from lab.runs.run import Run, prepare
from lab.runs.runner import RENDERS, hint, report, reported
from lab.sweeps.cluster import Errand, fetch
from lab.sweeps.grid import FILE_NAME, Sweep, define_sweep, read_sweep
from lab.sweeps.point import Point
from lab.sweeps.report import in_words, write_report
from lab.sweeps.result import SweepResult, point_folder, table
from solvers.machine.runtime import available_cores, choose_arch

# Limits of a batch: enough worlds per core that none idles long at the end, and bounded numbers of grains and files.
WORLDS_A_CORE, MOST_GRAINS, MOST_RUNS = 8, 1_000_000, 100


def run_sweep(
    name: str | Path,
    axes: Mapping[str, str | Sequence],
    overrides: Mapping | None = None,
    out: Path | str | None = None,
    *,
    video: bool = True,
    plots: bool = True,
    quiet: bool = False,
    cluster: str | None = None,
) -> SweepResult:
    """Run a preset at every point of a grid (see `define_sweep`); write to a folder (default: renders/NAME-sweep).

    video: film the points side by side at the end; plots: draw the figures; cluster: the address of a scheduler whose
    workers run the points (see `lab.sweeps.cluster`). If the folder holds the same sweep, it is continued. Raises
    LabError, one sentence, and KeyboardInterrupt; finished points are kept.
    """
    sweep = define_sweep(name, axes, overrides)
    folder = named(out) if out is not None else RENDERS / f"{sweep.name}-sweep"
    return complete(sweep, folder, video, plots, quiet, cluster)


def errands(
    name: str | Path, axes: Mapping[str, str | Sequence], overrides: Mapping | None, folder: Path
) -> list[Errand]:
    """Begin a sweep (arguments as for `run_sweep`); returns the batches left for a cluster to run. Raises LabError.

    The caller has locked the folder.
    """
    sweep = define_sweep(name, axes, overrides)
    plan = list(_plan(sweep))
    _begin(sweep, folder)
    return _errands(sweep, folder, plan)


def resume_sweep(folder: Path | str, *, video: bool = True, plots: bool = True, quiet: bool = False) -> SweepResult:
    """Continue the sweep in a folder as it was requested. Raises as `run_sweep`."""
    return complete(read_sweep(Path(folder)), Path(folder), video, plots, quiet)


def open_sweep(folder: Path | str) -> SweepResult:
    """The sweep in a folder, finished or not, as far as it has run. Raises LabError."""
    folder = Path(folder)
    sweep = read_sweep(folder)
    points = [Point(setting, point_folder(folder, number)) for number, setting in enumerate(sweep.settings)]
    return SweepResult(folder, table(sweep.axes, points, folder), in_words(sweep.name, points, {}))


def _begin(sweep: Sweep, folder: Path) -> None:
    """Write the sweep to its folder, which the caller has locked.

    Raises LabError if it cannot be written, or holds another sweep, a run, or a point that was run with other values.
    """
    if (folder / FILE_NAME).exists():
        if differs := read_sweep(folder).differs_from(sweep):
            raise LabError(
                f"{folder} holds another sweep than the requested one ({differs}): choose another folder, or remove "
                "it to run anew."
            )
    elif (folder / RECORDING).exists():
        raise LabError(f"{folder} holds a recording: choose another folder.")
    for number, point in enumerate(sweep.points):
        check_asked(point_folder(folder, number), point.resolved, "this sweep")
    sweep.write(folder)


def _errands(sweep: Sweep, folder: Path, plan: Sequence[Sequence[int]]) -> list[Errand]:
    """The batches of points that have not been run, except an interrupted batch, which is finished on this machine."""
    kept = read_checkpoint(folder)
    begun = {folder / run for run in kept.runs} if kept else set()
    found = []
    for numbers in plan:
        places = {point_folder(folder, number): sweep.points[number] for number in numbers}
        if left := {at: point for at, point in places.items() if at not in begun and state_of(at) == "open"}:
            found.append(Errand(left))
    return found


@in_turn
def complete(
    sweep: Sweep, folder: Path, video: bool, plots: bool, quiet: bool, cluster: str | None = None
) -> SweepResult:
    """Run the points that are not done, on the cluster as far as possible, and summarise all points.

    Raises as `run_sweep`.
    """
    plan = list(_plan(sweep))  # reports an impossible point early
    folders = [point_folder(folder, number) for number in range(len(sweep.points))]
    with Progress(quiet) as progress, hint(folder, FILE_NAME), only_one(folder):
        _begin(sweep, folder)
        try:
            if cluster:
                fetch(_errands(sweep, folder, plan), cluster, progress)
            _SweepRunner(sweep, folder, folders, progress).go(plan)
        except KeyboardInterrupt:
            write_report(sweep.name, sweep.axes, sweep.settings, folder, folders, progress, video=False, plots=plots)
            raise
        rows, text = write_report(
            sweep.name, sweep.axes, sweep.settings, folder, folders, progress, video=video, plots=plots
        )
    return SweepResult(folder, rows, text)


class _SweepRunner:
    """Runs the points of a sweep batch by batch."""

    def __init__(self, sweep: Sweep, folder: Path, folders: Sequence[Path], progress: Progress) -> None:
        self.sweep, self.folder, self.folders, self.progress = sweep, folder, folders, progress

    def go(self, plan: Sequence[Sequence[int]]) -> None:
        """Run and report every point that is not done, an interrupted batch first."""
        kept = self._kept()
        cost = [self.sweep.cost(number) for number in range(len(self.folders))]
        self._report(number for number, folder in enumerate(self.folders) if state_of(folder) == "recorded")
        done = {number for number, folder in enumerate(self.folders) if state_of(folder) == "done"}
        self.progress.begin_whole("sweep", sum(cost), sum(cost[number] for number in done))
        if kept and not all(state_of(self.folder / run) == "done" for run in kept.runs):
            numbers = [self.folders.index(self.folder / run) for run in kept.runs]
            self._launch(numbers, kept)
            done.update(numbers)
        for numbers in plan:
            if left := [number for number in numbers if number not in done]:
                self._launch(left, None)
        remove_checkpoint(self.folder)

    def _kept(self) -> Checkpoint | None:
        """The checkpoint of the interrupted batch, None if there is none. Raises Unusable if it is of other runs."""
        kept = read_checkpoint(self.folder)
        if kept and not {self.folder / run for run in kept.runs} <= set(self.folders):
            raise Unusable(f"{self.folder}: its checkpoint is of other runs: sweep again in another folder.")
        return kept

    def _launch(self, numbers: Sequence[int], kept: Checkpoint | None) -> None:
        left = self.progress.time_left()
        self.progress.say(f"points {_named(numbers)} of 0 to {len(self.folders) - 1}{left and f', {left}'} …")
        runs = []
        for number in numbers:
            runs.append(prepare(self.sweep.points[number], self.folders[number]))
        worlds = sum(run.scene.worlds for run in runs)
        for run in runs:
            if (run.folder / RECORDING).exists():
                check_belongs(run)
            else:
                run.make_recording(device=run.device(worlds))
        run_batch(runs, self.folder, self.progress, kept)
        self._report(numbers)

    def _report(self, numbers: Iterable[int]) -> None:
        for number in numbers:
            report(self.folders[number], self.progress, video=False, plots=False)
        self.progress.warnings.clear()
        self.progress.notes.clear()


def _named(numbers: Sequence[int]) -> str:
    """Numbers as text, such as "0 to 5, 8, 10 to 12"."""
    groups: list[list[int]] = []
    for number in numbers:
        if groups and number == groups[-1][-1] + 1:
            groups[-1].append(number)
        else:
            groups.append([number])
    return ", ".join(str(group[0]) if len(group) == 1 else f"{group[0]} to {group[-1]}" for group in groups)


def state_of(folder: Path) -> str:
    """State of the run in a folder: "done", "recorded" but without its summary, or "open"."""
    if not (folder / RECORDING).exists():
        return "open"
    with open_recording(folder) as recording:
        ended = recording.complete or recording.status.startswith("stopped: world")
        return "open" if not ended else "done" if reported(recording) else "recorded"


def _plan(sweep: Sweep) -> Iterator[list[int]]:
    """Group the numbers of the points into batches that they can share. Raises LabError as `prepare`."""
    begun: dict[tuple, dict[int, int]] = {}  # batches that are not full yet: worlds by number of the point
    for number, point in enumerate(sweep.points):
        run = prepare(point, Path())
        if not run.can_share:
            yield [number]
            continue
        worlds, count = run.scene.worlds, particles(run.scene)
        group = begun.setdefault(run.shared, {})
        if group and (sum(group.values()) + worlds > _most_worlds(run, count) or len(group) == MOST_RUNS):
            yield list(group)
            group.clear()
        group[number] = worlds
    yield from map(list, begun.values())


def _most_worlds(run: Run, count: int) -> int:
    """How many worlds of `count` particles a batch may have."""
    settings = run.loaded.resolved.run
    bound = MOST_GRAINS // max(1, count)
    if choose_arch(settings.arch, settings.precision) != "cpu":
        return bound
    return min(bound, WORLDS_A_CORE * (settings.threads or available_cores()))
