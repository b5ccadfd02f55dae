"""Film a run in a second process, which gets ready while the run is set up and paints while the figures are drawn.

Before a run computes, it has one thread, so that the second process has a core for getting ready.

No picture can be painted before the run has ended: the ends of the colour scale, the place of the camera and the axes
of the plot follow from the whole run.
"""

import os
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from queue import SimpleQueue

from lab.base.errors import LabError
from lab.paint.process import Heard, Painter


def second_process(cores: int) -> "AbstractContextManager[Beside | None]":
    """A process that films a run; None where it would have no core of its own, or the system no room for it."""
    if cores < 2:
        return nullcontext()
    try:
        return Beside(cores)
    except (OSError, RuntimeError):  # a limit on processes or threads
        return nullcontext()


def cores_here() -> int:
    """Cores this process may use, for those that do not have Taichi yet."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


class Beside:
    """A context manager that holds the second process; cores: of its painting. Raises as `Painter`."""

    def __init__(self, cores: int) -> None:
        self._heard: Heard = SimpleQueue()
        self._painter = Painter(self._heard, cores, silent=True)

    def __enter__(self) -> "Beside":
        return self

    def __exit__(self, *_: object) -> None:
        self._painter.stop()

    def begin(self, folder: Path) -> None:
        """Let it film the recording in a folder."""
        self._painter.paint({"path": str(folder)})

    def finish(self, progress: Callable[[int, int], None]) -> Path | None:
        """Wait for the video; None if the process was ended. Raises LabError if there can be no video."""
        while (answer := self._heard.get()[1]) is not None:
            if "made" in answer:
                return Path(answer["made"])
            if "failed" in answer:
                raise LabError(answer["failed"])
            progress(answer["done"], answer["of"])
        return None
