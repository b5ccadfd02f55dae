"""Progress messages: a bar with the remaining time in a terminal or a notebook.

Elsewhere there is a line a stage and one every half minute.
"""

import sys
import time
from threading import Timer
from typing import TYPE_CHECKING

from rich.console import Console
from rich.progress import BarColumn, TaskProgressColumn, TextColumn, TimeElapsedColumn, TimeRemainingColumn
from rich.progress import Progress as Bar

from lab.base.caches import lacking
from lab.base.costs import Costs
from lab.base.notebook.cell import Cell, in_notebook
from lab.base.text import one_line

if TYPE_CHECKING:
    from solvers.simulation import Simulation


EVERY = 30.0  # s between two lines of a stage where there is no terminal
SOON = 5.0  # s after which a stage that has not told anything is excused
COMPILES = "kernels that are new are compiled first, which may take minutes"


class Progress:
    """The stages of one run, one after the other, or of many runs below an overall bar; silent if `quiet`."""

    def __init__(self, quiet: bool):
        self.console = Console(stderr=True, quiet=quiet, highlight=False, markup=False, emoji=False)
        self.cell = Cell() if in_notebook() and not quiet else None
        on_terminal = sys.stderr.isatty() and not quiet and self.cell is None
        self.live = on_terminal or self.cell is not None
        columns = (
            TextColumn("{task.description:<9}"),
            BarColumn(),
            TaskProgressColumn(),
            TimeElapsedColumn(),
            TextColumn("left"),
            TimeRemainingColumn(),
        )
        self.bar = Bar(*columns, console=self.console, disable=not on_terminal, speed_estimate_period=600.0)
        self.task, self.total, self.cost = None, None, 0.0
        self.stage, self.begun_stage, self.told = "", 0.0, 0.0
        self.waiting: Timer | None = None
        self.whole, self.done = None, 0.0
        self.warnings: list[str] = []
        self.notes: list[str] = []
        self.costs = Costs()

    def __enter__(self) -> "Progress":
        self.bar.start()
        if slower := lacking():
            self.say(f"note: {slower}")
        return self

    def __exit__(self, *_) -> None:
        self._heard()
        self.bar.stop()
        self._draw(at_once=True)

    def begin_whole(self, name: str, total: float, done: float) -> None:
        """Start an overall bar of size `total`, of which `done` is done; later stages add their `cost` to it."""
        self.whole = self.bar.add_task(name, total=total, completed=done)
        self.whole_total, self.done, self.begun, self.since = total, done, done, time.monotonic()

    def time_left(self) -> str:
        """The remaining time of the overall bar at the rate so far, as a text; empty at the beginning."""
        if self.done == self.begun:
            return ""
        pace = (time.monotonic() - self.since) / (self.done - self.begun)
        seconds = pace * (self.whole_total - self.done)
        return f"about {seconds:.0f} s left" if seconds < 90 else f"about {seconds / 60:.0f} min left"

    def start(self, stage: str, total: float | None, cost: float = 0.0) -> None:
        """Begin a stage that ends at `total`, in any unit, and adds `cost` to the overall bar."""
        again = stage == self.stage
        self.stage, self.begun_stage, self.told = stage, time.monotonic(), time.monotonic()
        if not (self.live or again):
            self.say(f"{stage} …")
            self._excuse(f"{stage}: {COMPILES}")
        if self.cell is not None:
            self._remove_ended()
        self.task, self.total, self.cost = self.bar.add_task(stage, total=total), total, cost
        self._draw(at_once=True)

    def reach(self, done: float) -> None:
        """Update the bar: `done` of the stage's total. In a log a line says so every half minute."""
        self._heard()
        self.bar.update(self.task, completed=done)
        if not self.live and self.total and time.monotonic() - self.told >= EVERY:
            self.told = time.monotonic()
            self.say(f"{self.stage}: {100 * done / self.total:.0f} % after {_span(self.told - self.begun_stage)}")
        if self.whole is not None and self.total:
            self.bar.update(self.whole, completed=self.done + self.cost * min(done / self.total, 1.0))
        self._draw()

    def _excuse(self, sentence: str) -> None:
        """Say a sentence unless the stage tells something soon."""
        self._heard()
        self.waiting = Timer(SOON, self.say, (sentence,))
        self.waiting.daemon = True
        self.waiting.start()

    def _heard(self) -> None:
        if self.waiting is not None:
            self.waiting.cancel()
            self.waiting = None

    def watch(self, simulation: "Simulation") -> None:
        """Show beds as they come to rest; does nothing here, the live window overrides it."""

    def count_one(self, sentence: str) -> None:
        """Count one more unit of the overall bar as done."""
        self.done += 1.0
        self.bar.update(self.whole, completed=self.done)
        left = self.time_left() if self.done < self.whole_total else ""
        self.say(f"{sentence} ({self.done:.0f} of {self.whole_total:.0f}{left and f', {left}'})")

    def count(self, done: int, total: int) -> None:
        """Update a stage whose total was not known at its start."""
        self.bar.update(self.task, completed=done, total=total)
        self._draw()

    def finish(self) -> None:
        """End the stage, possibly before its total."""
        self._heard()
        if self.whole is not None:
            self.done += self.cost
            self.bar.update(self.whole, completed=self.done)
            self.bar.remove_task(self.task)
        elif self.live:
            task = next(one for one in self.bar.tasks if one.id == self.task)
            self.bar.update(self.task, completed=task.total)
        self._draw()

    def warn(self, sentence: str) -> None:
        """Print a warning now and keep it for the summary."""
        self.warnings.append(sentence)
        self._keep(f"note: {sentence}")

    def note(self, sentence: str) -> None:
        """Print and keep a sentence on how the run was made that does not put its numbers in doubt."""
        self.notes.append(sentence)
        self._keep(f"note: {sentence}")

    def say(self, sentence: str) -> None:
        """Print one line; in a notebook, in the place of the last."""
        if self.cell is not None:
            self.cell.say(one_line(sentence))
            self._draw(at_once=True)
            return
        self.console.print(one_line(sentence), soft_wrap=True)

    def _keep(self, sentence: str) -> None:
        """Print one line, which in a notebook stays."""
        if self.cell is None:
            self.say(sentence)
            return
        self.cell.note(one_line(sentence))
        self._draw(at_once=True)

    def _remove_ended(self) -> None:
        """Leave one bar a stage: those before have ended."""
        for task in [one for one in self.bar.tasks if one.id != self.whole]:
            self.bar.remove_task(task.id)

    def _draw(self, at_once: bool = False) -> None:
        """Show the bars in a notebook."""
        if self.cell is not None:
            self.cell.draw(self.bar.tasks, at_once)


def _span(seconds: float) -> str:
    return f"{seconds:.0f} s" if seconds < 90.0 else f"{seconds / 60.0:.0f} min"
