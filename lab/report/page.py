"""Pages of results: Markdown made by Jinja2 templates, with tables and figures beside it.

The templates are in the folder `templates`. A page is made from results that are kept as JSON, and never typed:
verify, reproduce and the hard cases have a template of their own; other benches add block by block to a `Page`.
"""

import re
from collections.abc import Sequence
from dataclasses import asdict
from functools import cache
from pathlib import Path

import matplotlib
from jinja2 import Environment, FileSystemLoader, StrictUndefined
from matplotlib.figure import Figure

from lab.base.text import one_line
from lab.report.kept import Made, machine, plain, write
from lab.report.plots import STYLE

TEMPLATES = Path(__file__).with_name("templates")


class Page:
    """The page of a bench: its results in NAME.json, NAME.md and figures NAME-FIGURE.png, in a folder made if missing.

    `write` leaves them on the disk.
    """

    def __init__(self, folder: Path | str, name: str, title: str) -> None:
        self.folder, self.name, self.title = Path(folder), name, title
        self.made, self.machine = Made.now(f"bench {name}"), machine()
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
        """Write the results and the page from them; returns its file."""
        words = {"title": self.title, "machine": self.machine}
        data = plain({**words, "made": asdict(self.made), "blocks": self._blocks})
        write(self.folder / f"{self.name}.json", data)
        return render(self.folder / f"{self.name}.md", "page.md.j2", **data)


def render(path: Path, template: str, **data: object) -> Path:
    """Write a page by one of the templates; returns its file. Raises jinja2's UndefinedError for data it lacks."""
    path.parent.mkdir(parents=True, exist_ok=True)
    text = _environment().get_template(template).render(data)
    path.write_text(re.sub(r"\n{3,}", "\n\n", text).strip() + "\n", encoding="utf-8")
    return path


def save_figure(path: Path, figure: Figure) -> Path:
    """Save a figure in the style of the lab; returns its file."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with matplotlib.rc_context(STYLE):
        figure.savefig(path, dpi=130)
    return path


@cache
def _environment() -> Environment:
    found = Environment(
        loader=FileSystemLoader(TEMPLATES), undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    found.filters["cell"] = _cell
    found.filters["line"] = lambda text: " ".join(str(text).split())
    return found


def _cell(value: object) -> str:
    if value is None:
        return "none"
    if isinstance(value, float):
        return f"{value:.3g}"
    return one_line(value).replace("|", "\\|").replace("<", "&lt;")
