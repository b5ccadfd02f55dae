"""One output of a notebook that is written anew as a run goes on."""

import sys
import time
from collections.abc import Iterable

from lab.base.notebook.html import text

EVERY = 0.2  # s between two drawings


def in_notebook() -> bool:
    """Whether this process is the kernel of a notebook, which shows pages and has no terminal."""
    python = sys.modules.get("IPython")
    shell = python.get_ipython() if python is not None and hasattr(python, "get_ipython") else None
    return shell is not None and hasattr(shell, "kernel")


class Cell:
    """What is said of a run in a notebook: the last sentence, a bar for each task of a rich `Progress`, and notes."""

    def __init__(self) -> None:
        self._handle, self._drawn, self._said = None, 0.0, ""
        self._notes: list[str] = []

    def say(self, sentence: str) -> None:
        """Put a sentence in the place of the last one."""
        self._said = sentence

    def note(self, sentence: str) -> None:
        """Add a sentence that stays."""
        self._notes.append(sentence)

    def draw(self, tasks: Iterable, at_once: bool = False) -> None:
        """Show the present state of these tasks of rich, unless it was shown just now."""
        now = time.monotonic()
        if not at_once and now - self._drawn < EVERY:
            return
        self._drawn = now
        page = _page(self._said, tasks, self._notes)
        if self._handle is None:
            from IPython.display import display  # there is one in a notebook's kernel

            self._handle = display(_Html(page), display_id=True)
        else:
            self._handle.update(_Html(page))


class _Html:
    """A piece of a page, as a notebook shows it."""

    def __init__(self, page: str) -> None:
        self._page = page

    def _repr_html_(self) -> str:
        return self._page

    def __repr__(self) -> str:
        return "progress of a run"


def _page(said: str, tasks: Iterable, notes: Iterable[str]) -> str:
    bars = "".join(_bar(task) for task in tasks)
    told = "".join(f"<div>{text(note)}</div>" for note in notes)
    return f"<div>{text(said)}</div><table>{bars}</table>{told}"


def _bar(task) -> str:
    """A row of one task: its name, how far it is and how long it will take."""
    share = f' value="{task.percentage / 100.0:.3f}"' if task.total else ""
    left = f"{task.percentage:.0f} %" if task.total else ""
    if task.time_remaining:
        left += f", {task.time_remaining:.0f} s left"
    return f"<tr><td>{text(task.description)}</td><td><progress{share}></progress></td><td>{text(left)}</td></tr>"
