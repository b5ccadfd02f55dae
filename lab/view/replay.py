"""Run a manually steered experiment again from its recording: the same bits on the same machine."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from lab.base.errors import LabError, Unusable
from lab.base.lock import only_one
from lab.base.progress import Progress
from lab.base.trust import BEYOND
from lab.base.turn import in_turn
from lab.recording import open_recording
from lab.runs.runner import Result, free_folder, recorded_preset, report
from lab.view.live import Live
from lab.view.panel.controls import ALTERS, CONTROLS, MOVES, offered

LARGEST = 1e3  # SI: upper bound on the value of any control


@in_turn
def replay(
    path: Path | str, out: Path | str | None = None, *, video: bool = True, plots: bool = True, quiet: bool = False
) -> Result:
    """Run a recording of `cargolab view` again (default: in a folder beside it), and report it as a run.

    Raises LabError if it is not a recording of `cargolab view`.
    """
    with open_recording(path) as recording:
        done, loaded = recording.steering, recorded_preset(recording)
        series = recording.series["time"]
        pieces = max(0, len(series) - 1)
    if done is None:
        raise LabError(f"{path} was not steered by a user: run its preset, {loaded.name}, again.")
    if not _possible(done, series, offered(loaded.resolved)):
        raise Unusable(f"{path}: its steering is not possible with the controls: replay another recording.")
    home = Path(path) if Path(path).is_dir() else Path(path).parent
    folder = Path(out) if out is not None else free_folder(home.with_name(f"{home.name}-replay"))
    begun = [float(series[k]) for k in range(pieces)]
    with Progress(quiet) as progress:
        with only_one(folder), Live(loaded, folder, progress) as live:
            progress.start("replaying", float(series[-1]) if pieces else None)
            for time in begun:
                while done and done[0][0] <= time + 0.5 * live.simulation.dt:
                    _, name, value = done.pop(0)
                    live.set(name, value)
                live.advance()
                progress.reach(live.time)
            progress.finish()
            live.close()
        return report(folder, progress, video=video, plots=plots)


def _possible(done: Sequence[tuple[float, str, float]], series: np.ndarray, own: Mapping[str, float]) -> bool:
    """Whether the recorded actions `done` are possible with the controls offered (`own`: their preset values)."""
    times = np.array([time for time, *_ in done])
    if not np.isfinite(series).all() or np.any(np.diff(series) <= 0.0) or np.abs(series).max(initial=0.0) > BEYOND:
        return False
    if not np.isfinite(times).all() or np.any(np.diff(times) < 0.0):
        return False
    return all(name in own and _settable(name, value, own[name]) for _, name, value in done)


def _settable(name: str, value: float, own: float) -> bool:
    control = CONTROLS[name]
    if control.kind == ALTERS:
        return min(control.low, own) <= value <= max(control.high, own)
    return control.kind == MOVES and abs(value) <= LARGEST
