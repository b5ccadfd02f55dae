"""Continue an interrupted run, sweep or calibration."""

from pathlib import Path
from typing import TYPE_CHECKING

from lab.recording import open_recording
from lab.sweeps.request import FILE_NAME as CALIBRATION
from lab.sweeps.request import SWEEP

if TYPE_CHECKING:
    from lab.runs.runner import Result
    from lab.sweeps.calibration_report import Calibration
    from lab.sweeps.result import SweepResult


def resume_any(
    folder: Path | str, *, video: bool = True, plots: bool = True, quiet: bool = False
) -> "Result | SweepResult | Calibration":
    """Continue the run, sweep or calibration in a folder to its end; returns its result.

    Raises as `resume_run`, `resume_sweep` and `calibrate`.
    """
    if (Path(folder) / CALIBRATION).exists():
        from lab.sweeps.calibrate import resume_calibration  # Matplotlib is slow to import

        return resume_calibration(folder, quiet=quiet)
    if (Path(folder) / SWEEP).exists():
        from lab.sweeps.sweep import resume_sweep

        return resume_sweep(folder, video=video, plots=plots, quiet=quiet)
    open_recording(folder).close()  # before the slow imports, so that another folder is refused at once
    from lab.runs.runner import resume_run

    return resume_run(folder, video=video, plots=plots, quiet=quiet)
