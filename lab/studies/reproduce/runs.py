"""The runs of an experiment: run once, continued if cut short, and read again."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

from lab.measures.value import Value
from lab.preset.find import load
from lab.recording import FILE_NAME, Recording, open_recording
from lab.runs.belongs import check_asked
from lab.runs.runner import resume_run, run_preset
from lab.sweeps.cluster import Errand
from lab.sweeps.grid import FILE_NAME as SWEEP
from lab.sweeps.grid import read_sweep
from lab.sweeps.sweep import errands as sweep_errands
from lab.sweeps.sweep import point_folder, run_sweep, state_of
from solvers.machine.errors import BadState


@dataclass(frozen=True)
class Batch:
    """Runs of a preset with `changes` by dotted keys, one for each point of the grid of `axes` (see
    `lab.sweeps.sweep`)."""

    preset: str
    changes: Mapping[str, object] = field(default_factory=dict)
    axes: Mapping[str, Sequence] = field(default_factory=dict)


@dataclass(frozen=True)
class Outcome:
    """A finished run: the values of its grid's keys, its folder and measures, and its cost."""

    setting: Mapping[str, object]
    folder: Path
    status: str
    measures: Mapping[str, Value]
    cost: Mapping[str, float] = field(repr=False)

    def __getitem__(self, name: str) -> Value | None:
        return self.measures.get(name)

    @cached_property
    def recording(self) -> Recording:
        """The recording: `series`, `frames`, `radius` …"""
        return open_recording(self.folder)


def errands(batch: Batch, folder: Path) -> list[Errand]:
    """The launches of a batch that have not been begun and can run on a cluster. Raises LabError."""
    if batch.axes:
        return sweep_errands(batch.preset, batch.axes, batch.changes, folder)
    if (folder / FILE_NAME).exists():
        return []
    return [Errand({folder: load(batch.preset, batch.changes)})]


def carry_out(batch: Batch, folder: Path, quiet: bool, by: str = "this experiment") -> None:
    """Run what has not been run yet; `by`: who asks. If the watch stops a bed, only its run ends. Raises LabError."""
    if batch.axes:
        run_sweep(batch.preset, batch.axes, batch.changes, folder, video=False, quiet=quiet)
        return
    try:
        if not (folder / FILE_NAME).exists():
            run_preset(batch.preset, batch.changes, folder, video=False, plots=False, quiet=quiet)
            return
        check_asked(folder, load(batch.preset, batch.changes).resolved, by)
        if state_of(folder) != "done":
            resume_run(folder, video=False, plots=False, quiet=quiet)
    except BadState:  # the recording and the report say so
        pass


def outcomes(folder: Path) -> list[Outcome]:
    """The runs of a batch in the order of its grid; empty unless all are done."""
    if (folder / SWEEP).exists():
        settings = read_sweep(folder).settings
        runs = [(setting, point_folder(folder, k)) for k, setting in enumerate(settings)]
    else:
        runs = [({}, folder)]
    found = [_outcome(setting, where) for setting, where in runs]
    return found if all(found) else []


def _outcome(setting: Mapping[str, object], folder: Path) -> Outcome | None:
    try:
        data = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    measures = {key: Value.from_json(found) for key, found in data["measures"].items()}
    return Outcome(setting, folder, data["status"], measures, data["cost"])
