"""A page of results, Markdown with tables and figures beside it: what bench, verify and reproduce write."""

import platform
from collections.abc import Sequence
from datetime import date
from pathlib import Path

import matplotlib
from matplotlib.figure import Figure

from lab import __version__
from lab.base.text import one_line
from lab.recording import versions
from lab.report.plots import STYLE
from solvers.machine.runtime import available_cores


class Page:
    """NAME.md in a folder, made if missing, and its figures NAME-FIGURE.png; `write` leaves it on the disk.

    `command` is what makes it; by default the bench of that name. `runs` says of which runs it is, where these may have
    been made earlier and elsewhere; else the page names the machine.
    """

    def __init__(self, folder: Path | str, name: str, title: str, command: str | None = None, runs: str = "") -> None:
        self.folder, self.name = Path(folder), name
        self.folder.mkdir(parents=True, exist_ok=True)
        command = f"cargolab {command or f'bench {name}'}"
        made = f"Made by `{command}` on {date.today()}, on {machine()}."
        if runs:
            made = f"Written by `{command}` on {date.today()}. {runs}"
        self._blocks = [f"# {title}", made]

    def section(self, title: str) -> None:
        """Begin a section."""
        self._blocks.append(f"## {title}")

    def say(self, text: str) -> None:
        """Add a paragraph."""
        self._blocks.append(" ".join(text.split()))

    def table(self, header: Sequence[str], rows: Sequence[Sequence[object]]) -> None:
        """Add a table; numbers are written with three digits unless they come as text."""
        lines = [header, ["---"] * len(header), *rows]
        self._blocks.append("\n".join(f"| {' | '.join(_cell(cell) for cell in line)} |" for line in lines))

    def figure(self, name: str, figure: Figure, caption: str) -> Path:
        """Save a figure beside the page and show it there."""
        path = self.save(name, figure)
        self.show(path, caption)
        return path

    def save(self, name: str, figure: Figure) -> Path:
        """Save a figure beside the page."""
        path = self.folder / f"{self.name}-{name}.png"
        with matplotlib.rc_context(STYLE):
            figure.savefig(path, dpi=130)
        return path

    def show(self, path: Path, caption: str) -> None:
        """Show a picture that lies beside the page."""
        self._blocks.append(f"![{caption}]({path.name})")

    def write(self) -> Path:
        """Write the page; returns its file."""
        path = self.folder / f"{self.name}.md"
        path.write_text("\n\n".join(self._blocks) + "\n", encoding="utf-8")
        return path


def machine() -> str:
    """What computes, in words."""
    found = versions()
    cores = available_cores()
    system = f"Cargo Shift Lab {__version__}, Python {found['python']}, Taichi {found.get('taichi', '?')}"
    return f"{cores} core{'s' if cores > 1 else ''} of {_processor()} ({system})"


def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.machine()


def _cell(value: object) -> str:
    if isinstance(value, float):
        return f"{value:.3g}"
    return one_line(value).replace("|", "\\|").replace("<", "&lt;")
