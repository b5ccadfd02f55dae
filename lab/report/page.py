"""Pages of results: Markdown made by Jinja2 templates, with tables and figures beside it.

The templates are in the folder `templates`. A page is made from results that are kept as JSON, and never typed:
verify, reproduce and the map of step limits have a template of their own; the studies of other benches add block by
block to a `Page`. One figure stands on a page, which names the files of the others: so one picture is kept with it.
"""

import re
from collections.abc import Iterable, Sequence
from functools import cache
from io import BytesIO
from pathlib import Path

import matplotlib
from jinja2 import Environment, FileSystemLoader, StrictUndefined, select_autoescape
from matplotlib.figure import Figure
from PIL import Image

from lab.base.files import replacing, write_text
from lab.base.text import one_line, printable
from lab.report.plots import STYLE

# Of a program that did not run a page says so. What it wrote is for those who run it; the JSON beside the page has it.
STOPPED = re.compile(r"^That could not be run here: (?P<name>[^:]+) stopped: .+$", re.DOTALL)
NOT_MEASURED = r"Not measured: \g<name> did not run here. What it wrote is in the JSON file beside this page."
COLOURS_LEFT = 64  # in a figure
TEMPLATES = Path(__file__).with_name("templates")


class Page:
    """What a study has to show: blocks of text, tables and figures, which are files NAME-FIGURE.png of a folder."""

    def __init__(self, folder: Path | str, name: str) -> None:
        self.folder, self.name = Path(folder), name
        self.blocks: list[dict[str, object]] = []

    def section(self, title: str) -> None:
        """Begin a section."""
        self.blocks.append({"section": title})

    def say(self, text: str) -> None:
        """Add a paragraph."""
        self.blocks.append({"text": " ".join(text.split())})

    def table(self, header: Sequence[str], rows: Sequence[Sequence[object]]) -> None:
        """Add a table; numbers are written with three digits unless they come as text."""
        self.blocks.append({"header": header, "rows": rows})

    def figure(self, name: str, figure: Figure, caption: str) -> Path:
        """Save a figure in the folder, made if missing, and show it."""
        path = save_figure(self.folder / f"{self.name}-{name}.png", figure)
        self.blocks.append({"file": path.name, "caption": caption})
        return path


def render(path: Path, template: str, **data: object) -> Path:
    """Write a page by one of the templates; returns its file. Raises jinja2's UndefinedError for data it lacks."""
    path.parent.mkdir(parents=True, exist_ok=True)
    text = _environment().get_template(template).render(data)
    write_text(path, re.sub(r"\n{3,}", "\n\n", text).strip() + "\n")
    return path


def render_text(template: str, **data: object) -> str:
    """A page by one of the templates as text. Raises jinja2's UndefinedError for data it lacks."""
    return _environment().get_template(template).render(data)


def table(header: Sequence[str], rows: Sequence[Sequence[object]]) -> str:
    """A table in Markdown."""
    return _environment().get_template("macros.md.j2").module.table(header, rows).strip()


def save_figure(path: Path, figure: Figure) -> Path:
    """Save a figure in the style of the lab, with 64 colours, a quarter of the bytes; returns its file."""
    path.parent.mkdir(parents=True, exist_ok=True)
    drawn = BytesIO()
    with matplotlib.rc_context(STYLE):
        figure.savefig(drawn, format="png", dpi=130)
    with Image.open(drawn) as image:
        lean = image.convert("RGB").quantize(COLOURS_LEFT)
    with replacing(path) as part:
        lean.save(part, "PNG", optimize=True)
    return path


def on_page(files: Iterable[str], wanted: str) -> dict[str, object]:
    """For a template: the file of the figure that is `shown`, the wanted one or else the first; are there `more`?"""
    known = [name for name in files if name]
    return {"shown": wanted if wanted in known else next(iter(known), ""), "more": len(known) > 1}


@cache
def _environment() -> Environment:
    found = Environment(
        loader=FileSystemLoader(TEMPLATES),
        autoescape=select_autoescape(("html.j2",)),
        undefined=StrictUndefined,
        finalize=_shown,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    found.filters["cell"] = _cell
    found.filters["paragraph"] = lambda text: STOPPED.sub(NOT_MEASURED, text)
    found.filters["line"] = lambda text: " ".join(str(text).split())
    return found


def _shown(value: object) -> object:
    """A value as a template writes it: in texts, which may be a stranger's, ? stands for what cannot be printed."""
    return printable(value) if type(value) is str else value


def _cell(value: object) -> str:
    if value is None:
        return "none"
    if isinstance(value, float):
        return f"{value:.3g}"
    return one_line(value).replace("|", "\\|").replace("<", "&lt;")
