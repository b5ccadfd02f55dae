"""An experiment that was steered by hand, run again from its recording: the same bits on the same machine."""

from pathlib import Path

from lab.errors import LabError
from lab.lock import only_one
from lab.progress import Progress
from lab.recording import open_recording
from lab.runner import Result, free_folder, recorded_preset, report
from lab.view.live import Live


def replay(path: Path | str, out: Path | str | None = None, *, video: bool = True, quiet: bool = False) -> Result:
    """Run a recording of `cargolab view` again (default: in a folder beside it), and sum it up as a run.

    Raises LabError where it is none.
    """
    with open_recording(path) as recording:
        done, loaded = recording.steering, recorded_preset(recording)
        series = recording.series["time"]
        pieces = len(series) - 1
    if done is None:
        raise LabError(f"{path} was not steered by hand: run its preset, {loaded.name}, again.")
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
        return report(folder, progress, video=video)
