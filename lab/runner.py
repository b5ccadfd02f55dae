"""Runs an experiment: settle, move, record, measure, plot, paint, sum up."""

import json
import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np

from lab.errors import LabError
from lab.measures import measure_all
from lab.measures.value import Value
from lab.plots import write_plots
from lab.presets import LoadedPreset, load
from lab.progress import Progress
from lab.recording import Recorder, Recording, open_recording
from lab.scene import build
from lab.summary import terminal_summary, write_summary
from solvers.errors import BadState
from solvers.simulation import Simulation

RENDERS = Path("renders")


@dataclass
class Result:
    """What a run gives: its folder, its measures by name, and its recording's arrays."""

    folder: Path
    measures: dict[str, Value]
    summary_text: str = field(repr=False)

    @cached_property
    def recording(self) -> Recording:
        """The recording: `series`, `frames`, `radius`, `outline` … as arrays."""
        return open_recording(self.folder)


def run_preset(
    name: str | Path,
    overrides: Mapping | None = None,
    out: Path | str | None = None,
    *,
    video: bool = True,
    quiet: bool = False,
) -> Result:
    """Run a preset and leave recording, plots, video and summary in a folder (default: renders/NAME).

    Raises LabError for what a person can mend, BadState where the watch stopped the run; what was recorded until
    then stays, with its summary.
    """
    loaded = load(name, overrides)
    folder = Path(out) if out is not None else _free_folder(RENDERS / loaded.name)
    with Progress(quiet) as progress:
        try:
            simulate(loaded, folder, progress)
        except (BadState, KeyboardInterrupt):
            _report(folder, False, progress)
            raise
        return _report(folder, video, progress)


def simulate(loaded: LoadedPreset, folder: Path, progress: Progress) -> None:
    """Settle the grains, run the motion and record both series and frames."""
    preset = loaded.resolved
    scene, position = build(preset)
    with Recorder(
        folder,
        preset=loaded.name,
        given=loaded.given_text,
        resolved=json.loads(preset.model_dump_json()),
        radius=scene.radius,
        outline=scene.outline,
        step=scene.step,
    ) as recorder:
        simulation = Simulation(scene, position, preset.run.threads)
        try:
            _settle(simulation, preset, progress)
            _run(simulation, preset, recorder, progress)
        finally:
            simulation.close()


def _settle(simulation: Simulation, preset, progress: Progress) -> None:
    progress.start("settling", preset.run.settle_limit)
    rests = simulation.settle(preset.run.rest, preset.run.settle_limit, progress.reach)
    if not rests:
        limit = preset.run.settle_limit
        progress.warn(f"The grains still moved after {limit:g} s of settling; raise run.settle_limit or run.rest.")
    progress.finish()


def _run(simulation: Simulation, preset, recorder: Recorder, progress: Progress) -> None:
    steps = round(1.0 / (preset.record.series_rate * simulation.dt))
    samples = max(1, round(preset.run.duration * preset.record.series_rate))
    a_frame = max(1, round(preset.record.series_rate / preset.record.picture_rate))
    progress.start("running", preset.run.duration)
    begun = time.perf_counter()
    for k in range(samples + 1):
        if k:
            simulation.advance(steps)
        rows = simulation.observe()
        recorder.sample(_sample(simulation.time, rows))
        if k % a_frame == 0:
            recorder.frame({"time": simulation.time, "pose": _pose(rows), **simulation.snapshot()})
        recorder.wall_s = time.perf_counter() - begun
        recorder.grain_steps = simulation.grain_steps
        progress.reach(simulation.time)
    progress.finish()


def _pose(rows: Mapping[str, np.ndarray]) -> np.ndarray:
    return np.stack([rows["pose_y"], rows["pose_z"], rows["pose_angle"]], axis=-1)


def _sample(now: float, rows: Mapping[str, np.ndarray]) -> dict[str, object]:
    """The row of the series that an observation makes."""
    kept = ("kinetic", "rotational", "potential", "elastic", "contacts", "overlap")
    return {
        "time": now,
        "pose": _pose(rows),
        "pose_rate": np.stack([rows["rate_y"], rows["rate_z"], rows["rate_angle"]], axis=-1),
        "centre_of_mass": np.stack([rows["centre_y"], rows["centre_z"]], axis=-1),
        **{name: rows[name] for name in kept},
    }


def _report(folder: Path, video: bool, progress: Progress) -> Result:
    """Measure the recording, plot and paint it, and write the summary."""
    with open_recording(folder) as recording:
        measures = measure_all(recording)
        files = {"recording": recording.path, **write_plots(recording, measures, folder)}
        if video:
            files["video"] = _film(folder, progress)
        write_summary(recording, measures, files, folder, progress.warnings)
        return Result(folder, measures, terminal_summary(recording, measures, files, progress.warnings))


def _film(folder: Path, progress: Progress) -> Path:
    from lab.paint.video import render_recording

    progress.start("painting", None)
    path = render_recording(folder, progress=progress.count)
    progress.finish()
    return path


def _free_folder(wanted: Path) -> Path:
    """`wanted`, or the first of wanted-2, wanted-3 … that holds no recording yet."""
    for number in range(1, 10_000):
        folder = wanted if number == 1 else wanted.with_name(f"{wanted.name}-{number}")
        if not (folder / "recording.h5").exists():
            return folder
    raise LabError(f"{wanted.parent} is full of runs of {wanted.name}; remove some or give --out.")
