"""`cargolab stability`: the criteria of a preset's ship as a page, a figure and CSV files, without a simulation."""

import textwrap
from base64 import b64encode
from collections.abc import Callable, Sequence
from pathlib import Path

import matplotlib

from lab import __version__
from lab.assembly.scene import vessels
from lab.base.errors import LabError
from lab.base.files import write_text
from lab.measures.naval_levers import draw_levers
from lab.naval import sheet, tables
from lab.naval.condition import Condition, condition
from lab.preset.find import LoadedPreset
from lab.report.page import render_text, save_figure
from lab.report.plots import BELOW, STYLE, TITLE, canvas

RENDERS = Path("renders/stability")
ON_PAGE = {  # tables of the page; those of all levers are in CSV files alone
    "hydrostatics": "Hydrostatics",
    "cross-curves": "Cross curves, KN = GZ + KG sin(heel)",
    "hold": "The hold: level grain, and its volumetric moments with a surface of 15 and 25 deg",
}
HEEL = "Heel is positive starboard down (the lab's own roll: positive port side down)"
SIGNS = f"{HEEL}; z is from the keel."


def judge(loaded: LoadedPreset, out: Path | None = None) -> tuple[str, Path, dict[str, tables.Table]]:
    """Write page, figure and tables of a preset's ship to a folder; returns the text for the terminal, the folder
    and the tables by name.

    Raises LabError for a preset without a ship, or one that cannot be judged.
    """
    preset = loaded.resolved
    if preset.ship is None:
        raise LabError(f"{loaded.name} has no ship: `cargolab stability` judges presets with a table [ship].")
    folder = Path(out) if out is not None else RENDERS / loaded.name
    found = condition(preset, vessels(preset)[0])
    rows = sheet.rows(found)
    written = tables.all_of(found, rows)
    tables.write(written, folder)
    figure = save_axes(folder / "righting-levers.png", preset.title, lambda axes: draw_levers(axes, found))
    page = render_text(
        "stability.html.j2",
        title=preset.title,
        name=loaded.name,
        version=__version__,
        shown=sheet.shown,
        condition=sheet.facts(found),
        criteria=rows,
        notes=[*sheet.unjudged(found), SIGNS],
        figure=b64encode(figure.read_bytes()).decode("ascii"),
        tables=[(title, *written[name]) for name, title in ON_PAGE.items() if name in written],
        given=loaded.given_text,
    )
    _write(folder / "stability.html", page)
    return "\n".join([f"{preset.title}  ({loaded.name})", *described(found, rows)]), folder, written


def _write(path: Path, text: str) -> None:
    try:
        write_text(path, text)
    except OSError as error:
        raise LabError(f"{path.parent} cannot be written ({error.strerror}): choose another folder.") from error


def described(found: Condition, rows: list[sheet.Row]) -> list[str]:
    """Lines of text: the condition, the sheet of criteria, what was not judged."""
    facts = sheet.facts(found)
    width = max(len(name) for name, _ in facts)
    lines = [f"  {name:<{width}}  {text}" for name, text in facts]
    lines += ["", *aligned(rows), "", *sheet.unjudged(found), SIGNS]
    return lines


def aligned(rows: list[sheet.Row]) -> list[str]:
    """The sheet in columns of equal width."""
    cells = [("rule", "criterion", "required", "attained", "verdict", "")]
    for row in rows:
        one = row.criterion
        what = f"{one.what} ({row.shift})" if row.shift else one.what
        unit = "" if one.unit == "1" else f" {one.unit}"
        cells.append(
            (
                one.rule,
                what,
                f"{one.kind} {one.limit:.4g}{unit}",
                sheet.shown(one.attained, one.unit),
                one.verdict,
                one.note,
            )
        )
    widths = [max(len(line[k]) for line in cells) for k in range(len(cells[0]))]
    return [
        "  " + "  ".join(f"{cell:<{width}}" for cell, width in zip(line, widths, strict=True)).rstrip()
        for line in cells
    ]


def columns(table: tables.Table, names: Sequence[str]) -> list[str]:
    """Some columns of a table of numbers, set under each other."""
    header, lines = table
    at = [header.index(name) for name in names]
    cells = [[row[k] for k in at] for row in (header, *lines)]
    widths = [max(len(row[k]) for row in cells) for k in range(len(at))]
    return ["  " + "  ".join(f"{one:>{width}}" for one, width in zip(row, widths, strict=True)) for row in cells]


def save_axes(path: Path, title: str, draw: Callable) -> Path:
    """Save a figure of one panel that `draw` fills. Raises LabError when the file cannot be written."""
    with matplotlib.rc_context(STYLE):
        figure, axes = canvas((6.4, 4.6))
        draw(axes)
        axes.set_title(textwrap.fill(title, TITLE), parse_math=False)
        figure.legend(loc=BELOW, ncols=1)
        try:
            return save_figure(path, figure)
        except OSError as error:
            raise LabError(f"{path.parent} cannot be written ({error.strerror}): choose another folder.") from error
