"""Pages of results: Markdown made by Jinja2 templates, with tables and figures beside it.

The templates are in the folder `templates`. A page is made from results and never typed: verify, reproduce and the
hard cases have a template of their own and keep their results as JSON; other benches add block by block to a `Page`.
"""

import platform
import re
from collections.abc import Sequence
from datetime import date
from functools import cache
from pathlib import Path

import matplotlib
from jinja2 import Environment, FileSystemLoader, StrictUndefined
from matplotlib.figure import Figure

from lab import __version__
from lab.base.text import one_line
from lab.recording import versions
from lab.report.plots import STYLE
from solvers.machine.runtime import available_cores

TEMPLATES = Path(__file__).with_name("templates")


class Page:
    """NAME.md in a folder, made if missing, and its figures NAME-FIGURE.png; `write` leaves it on the disk.

    `command` is what makes it; by default the bench of that name.
    """

    def __init__(self, folder: Path | str, name: str, title: str, command: str | None = None) -> None:
        self.folder, self.name, self.title = Path(folder), name, title
        self.folder.mkdir(parents=True, exist_ok=True)
        self.made = f"Made by `cargolab {command or f'bench {name}'}` on {date.today()}, on {machine()}."
        self._blocks: list[dict[str, object]] = []

    def section(self, title: str) -> None:
        """Begin a section."""
        self._blocks.append({"section": title})

    def say(self, text: str) -> None:
        """Add a paragraph."""
        self._blocks.append({"text": " ".join(text.split())})

    def table(self, header: Sequence[str], rows: Sequence[Sequence[object]]) -> None:
        """Add a table; numbers are written with three digits unless they come as text."""
        self._blocks.append({"header": header, "rows": rows})

    def figure(self, name: str, figure: Figure, caption: str) -> Path:
        """Save a figure beside the page and show it there."""
        path = save_figure(self.folder / f"{self.name}-{name}.png", figure)
        self._blocks.append({"file": path.name, "caption": caption})
        return path

    def write(self) -> Path:
        """Write the page; returns its file."""
        path = self.folder / f"{self.name}.md"
        return render(path, "page.md.j2", title=self.title, made=self.made, blocks=self._blocks)


def render(path: Path, template: str, **data: object) -> Path:
    """Write a page by one of the templates; returns its file. Raises jinja2's UndefinedError for data it lacks."""
    text = _environment().get_template(template).render(data)
    path.write_text(re.sub(r"\n{3,}", "\n\n", text).strip() + "\n", encoding="utf-8")
    return path


def save_figure(path: Path, figure: Figure) -> Path:
    """Save a figure in the style of the lab; returns its file."""
    with matplotlib.rc_context(STYLE):
        figure.savefig(path, dpi=130)
    return path


def machine() -> str:
    """What computes, in words."""
    found = versions()
    cores = available_cores()
    system = f"Cargo Shift Lab {__version__}, Python {found['python']}, Taichi {found.get('taichi', '?')}"
    return f"{cores} core{'s' if cores > 1 else ''} of {processor()} ({system})"


def processor() -> str:
    """The processor by its maker's name."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.machine()


@cache
def _environment() -> Environment:
    found = Environment(
        loader=FileSystemLoader(TEMPLATES), undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    found.filters["cell"] = _cell
    found.filters["line"] = lambda text: " ".join(str(text).split())
    return found


def _cell(value: object) -> str:
    if isinstance(value, float):
        return f"{value:.3g}"
    return one_line(value).replace("|", "\\|").replace("<", "&lt;")
