"""Continue an interrupted run, sweep or calibration."""

from pathlib import Path

from lab.runs.runner import Result, resume_run
from lab.sweeps.calibrate import resume_calibration
from lab.sweeps.calibration_report import Calibration
from lab.sweeps.grid import FILE_NAME as SWEEP
from lab.sweeps.request import FILE_NAME as CALIBRATION
from lab.sweeps.sweep import SweepResult, resume_sweep


def resume_any(folder: Path | str, *, video: bool = True, quiet: bool = False) -> Result | SweepResult | Calibration:
    """Continue the run, sweep or calibration in a folder to its end; returns its result.

    Raises as `resume_run`, `resume_sweep` and `calibrate`.
    """
    if (Path(folder) / CALIBRATION).exists():
        return resume_calibration(folder, quiet=quiet)
    finish = resume_sweep if (Path(folder) / SWEEP).exists() else resume_run
    return finish(folder, video=video, quiet=quiet)
