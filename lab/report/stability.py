"""`cargolab stability`: the criteria of a preset's ship in a table, a figure and CSV files, without a simulation."""

import textwrap
from collections.abc import Callable
from pathlib import Path

import matplotlib

from lab.assembly.scene import vessels
from lab.base.errors import LabError
from lab.measures.naval_levers import draw_levers
from lab.naval import sheet, tables
from lab.naval.condition import Condition, condition
from lab.preset.find import LoadedPreset
from lab.report.page import save_figure
from lab.report.plots import BELOW, STYLE, TITLE, canvas

RENDERS = Path("renders/stability")
HEEL = "Heel is positive starboard down (the lab's own roll: positive port side down)"
SIGNS = f"{HEEL}; z is from the keel."


def judge(loaded: LoadedPreset, out: Path | None = None) -> tuple[str, Path]:
    """Write figure and tables of a preset's ship to a folder; returns the text for the terminal and the folder.

    Raises LabError for a preset without a ship, or one that cannot be judged.
    """
    preset = loaded.resolved
    if preset.ship is None:
        raise LabError(f"{loaded.name} has no ship: `cargolab stability` judges presets with a table [ship].")
    folder = Path(out) if out is not None else RENDERS / loaded.name
    found = condition(preset, vessels(preset)[0])
    rows = sheet.rows(found)
    tables.write(tables.all_of(found, rows), folder)
    save_axes(folder / "righting-levers.png", preset.title, lambda axes: draw_levers(axes, found))
    return "\n".join([f"{preset.title}  ({loaded.name})", *described(found, rows)]), folder


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
