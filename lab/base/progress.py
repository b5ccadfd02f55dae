"""Progress for people: a bar with the time left where there is a terminal, a line a stage where there is none."""

import sys
import time
from typing import TYPE_CHECKING

from rich.console import Console
from rich.progress import BarColumn, TaskProgressColumn, TextColumn, TimeElapsedColumn, TimeRemainingColumn
from rich.progress import Progress as Bar

from lab.base.caches import lacking
from lab.base.text import one_line

if TYPE_CHECKING:
    from solvers.simulation import Simulation


class Progress:
    """Stages of a run, one after the other; silent when `quiet`. Of a whole of many runs the stages come and go."""

    def __init__(self, quiet: bool):
        self.console = Console(stderr=True, quiet=quiet, highlight=False, markup=False, emoji=False)
        self.live = sys.stderr.isatty() and not quiet
        columns = (
            TextColumn("{task.description:<9}"),
            BarColumn(),
            TaskProgressColumn(),
            TimeElapsedColumn(),
            TextColumn("left"),
            TimeRemainingColumn(),
        )
        self.bar = Bar(*columns, console=self.console, disable=not self.live, speed_estimate_period=600.0)
        self.task, self.total, self.worth = None, None, 0.0
        self.whole, self.done = None, 0.0
        self.warnings: list[str] = []
        self.notes: list[str] = []

    def __enter__(self) -> "Progress":
        self.bar.start()
        if slower := lacking():
            self.say(f"note: {slower}")
        return self

    def __exit__(self, *_) -> None:
        self.bar.stop()

    def begin_whole(self, name: str, total: float, done: float) -> None:
        """Count stages that follow towards a whole, of which so much is done, by what each is worth of its `total`."""
        self.whole = self.bar.add_task(name, total=total, completed=done)
        self.whole_total, self.done, self.begun, self.since = total, done, done, time.monotonic()

    def time_left(self) -> str:
        """How long the rest of the whole takes at the pace so far, in words; empty at its beginning."""
        if self.done == self.begun:
            return ""
        pace = (time.monotonic() - self.since) / (self.done - self.begun)
        seconds = pace * (self.whole_total - self.done)
        return f"about {seconds:.0f} s left" if seconds < 90 else f"about {seconds / 60:.0f} min left"

    def start(self, stage: str, total: float | None, worth: float = 0.0) -> None:
        """Begin a stage that ends at `total`, in any unit, and is worth so much of the whole."""
        if not self.live:
            self.say(f"{stage} …")
        self.task, self.total, self.worth = self.bar.add_task(stage, total=total), total, worth

    def reach(self, done: float) -> None:
        """Say how far the stage is."""
        self.bar.update(self.task, completed=done)
        if self.whole is not None and self.total:
            self.bar.update(self.whole, completed=self.done + self.worth * min(done / self.total, 1.0))

    def watch(self, simulation: "Simulation") -> None:
        """Look at the beds that come to rest; there is nobody here who does."""

    def count_one(self, sentence: str) -> None:
        """One more of the whole is done, of which each is worth 1."""
        self.done += 1.0
        self.bar.update(self.whole, completed=self.done)
        left = self.time_left() if self.done < self.whole_total else ""
        self.say(f"{sentence} ({self.done:.0f} of {self.whole_total:.0f}{left and f', {left}'})")

    def count(self, done: int, total: int) -> None:
        """Say how far a stage is whose total was not known at its start."""
        self.bar.update(self.task, completed=done, total=total)

    def finish(self) -> None:
        """The stage is done, maybe before its total."""
        if self.whole is not None:
            self.done += self.worth
            self.bar.update(self.whole, completed=self.done)
            self.bar.remove_task(self.task)
        elif self.live:
            self.bar.update(self.task, completed=self.bar.tasks[self.task].total)

    def warn(self, sentence: str) -> None:
        """A sentence a person should read, now and in the summary."""
        self.warnings.append(sentence)
        self.say(f"note: {sentence}")

    def note(self, sentence: str) -> None:
        """A sentence on how the run was made, which takes nothing from its numbers."""
        self.notes.append(sentence)
        self.say(f"note: {sentence}")

    def say(self, sentence: str) -> None:
        """A line for whoever watches."""
        self.console.print(one_line(sentence), soft_wrap=True)
