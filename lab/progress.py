"""Progress for people: a bar with the time left where there is a terminal, a line a stage where there is none."""

import sys

from rich.console import Console
from rich.progress import BarColumn, TaskProgressColumn, TextColumn, TimeElapsedColumn, TimeRemainingColumn
from rich.progress import Progress as Bar


class Progress:
    """Stages of a run, one after the other; silent when `quiet`."""

    def __init__(self, quiet: bool):
        self.console = Console(stderr=True, quiet=quiet, highlight=False)
        self.live = sys.stderr.isatty() and not quiet
        columns = (
            TextColumn("{task.description:<9}"),
            BarColumn(),
            TaskProgressColumn(),
            TimeElapsedColumn(),
            TextColumn("left"),
            TimeRemainingColumn(),
        )
        self.bar = Bar(*columns, console=self.console, disable=not self.live)
        self.task = None
        self.warnings: list[str] = []

    def __enter__(self) -> "Progress":
        self.bar.start()
        return self

    def __exit__(self, *_) -> None:
        self.bar.stop()

    def start(self, stage: str, total: float | None) -> None:
        """Begin a stage that ends at `total`, in any unit."""
        if not self.live:
            self.console.print(f"{stage} …")
        self.task = self.bar.add_task(stage, total=total)

    def reach(self, done: float) -> None:
        """Say how far the stage is."""
        self.bar.update(self.task, completed=done)

    def count(self, done: int, total: int) -> None:
        """Say how far a stage is whose total was not known at its start."""
        self.bar.update(self.task, completed=done, total=total)

    def finish(self) -> None:
        """The stage is done, maybe before its total."""
        task = self.bar.tasks[self.task] if self.live else None
        if task is not None:
            self.bar.update(self.task, completed=task.total)

    def warn(self, sentence: str) -> None:
        """A sentence a person should read, now and in the summary."""
        self.warnings.append(sentence)
        self.console.print(f"note: {sentence}", soft_wrap=True)
