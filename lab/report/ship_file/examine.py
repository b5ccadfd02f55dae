"""`cargolab hull ship.toml`: the sheet of all loading conditions, tables, capacities and figures."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import fields
from pathlib import Path

from lab.base.errors import LabError
from lab.measures.naval_levers import draw_levers
from lab.naval import sheet, tables
from lab.naval.hull import GEOMETRY
from lab.naval.ship_file import sheets
from lab.naval.ship_file.imperial import imperial
from lab.naval.ship_file.ship import Condition, Ship, read_ship
from lab.naval.surfaces.offsets import write_offsets
from lab.naval.surfaces.selfcheck import self_check
from lab.report.hull import BRIEFLY, Asked, between_offsets
from lab.report.ship_file.further import Found, limits, strengths
from lab.report.stability import SIGNS, save_axes
from solvers.machine.errors import Unavailable

ASKED_FOR = (  # also with a ship file
    *("draught", "displacement", "trim", "step"),  # of the table of hydrostatics
    *("limiting_kg", "kg_trim", "strength"),
)
HERE = {  # where in the file the command's other options are
    "density": "water.density",
    "weights": "weights",
    "points": "openings",
    "holds": "holds",
    "grain": "conditions.NAME.cargo",
    "wind": "wind",
}
METHODS = {
    False: "levers with KG raised by the second moments of the free surfaces",
    True: "levers less the actual transfer of the liquids at each heel; GM fluid by second moments",
}


def examine(path: Path, folder: Path, asked: Asked, units: str) -> tuple[str, dict[str, tables.Table]]:
    """Write tables and figures of the ship of a file; returns the text to show, and the tables by name.

    `units`: metric or imperial. Raises LabError for a mistake in the file, or options that it replaces.
    """
    _check(asked)
    ship = read_ship(path)
    source = ship.source
    judged = {}
    for name, one in ship.conditions.items():
        with source.told(f"conditions.{name}"):
            judged[name] = sheet.rows(one)
    draughts = _draughts(ship, asked)
    written = _of_hull(ship, asked, draughts) | sheets.all_of(ship, judged)
    more: list[str] = []
    if (asked.strength or asked.limiting_kg) and not ship.conditions:
        raise LabError(f"{ship.name}: no condition is given; add [conditions.departure], by which she is loaded.")
    for lines, of_these in _further(ship, asked, draughts, folder):
        more, written = [*more, *lines], written | of_these
    side_by_side = sheets.attained(judged) if judged else None
    if units == "imperial":
        written = {name: imperial(table) for name, table in written.items()}
        side_by_side = imperial(side_by_side) if side_by_side else None
    _spare(source.path, folder, written)
    tables.write(written, folder)
    for name, one in ship.conditions.items():
        title = f"{ship.title}: {one.title or name}"
        save_axes(folder / f"{name}-righting-levers.png", title, lambda axes, one=one: draw_levers(axes, one))
    if ship.mesh is not None:
        write_offsets(ship.form, folder)
    return "\n".join([*_lines(ship, written, side_by_side, asked), *more]), written


def _further(ship: Ship, asked: Asked, draughts: list[float], folder: Path) -> Iterator[Found]:
    """Strength and limiting KG, where they are asked for. Raises LabError."""
    try:
        if asked.strength:
            yield strengths(ship, folder)
        if asked.limiting_kg:
            yield limits(ship, draughts, asked, folder)
    except Unavailable as error:
        raise LabError(f"{ship.name}: {error}") from None


def _draughts(ship: Ship, asked: Asked) -> list[float]:
    """The draughts (m) of the tables: those asked for, else round ones."""
    draughts = [ship.draught(draught, None, asked.trim) for draught in asked.draught]
    draughts += [ship.draught(None, displacement, asked.trim) for displacement in asked.displacement]
    return draughts or ship.draughts(asked.step, asked.trim).tolist()


def _of_hull(ship: Ship, asked: Asked, draughts: list[float]) -> dict[str, tables.Table]:
    """Hydrostatics and cross curves."""
    try:
        return {
            "hydrostatics": tables.hydrostatics(ship.form, ship.water, draughts, asked.trim),
            "cross-curves": tables.cross_curves(ship.form, ship.water, draughts),
        }
    except Unavailable as error:
        raise LabError(f"{ship.name}: {error}") from None


def _lines(ship: Ship, written: Mapping[str, tables.Table], criteria: tables.Table | None, asked: Asked) -> list[str]:
    """The text to show."""
    form, own = ship.form, ship.keys.hull
    lines = [f"{ship.title}: {ship.name}, {len(form.x)} stations, depth {form.depth:.4g} m"]
    lines += self_check(form, ship.mesh, own.stations)
    drawn = ship.source.path.parent / own.lines
    if ship.mesh is None and drawn.suffix.lower() not in GEOMETRY:
        lines.append(f"  {between_offsets(drawn, form, own.fair)}")
    header, rows = written["hydrostatics"]
    brief = [k for k, name in enumerate(header) if name.split(" ")[0] in {one.split(" ")[0] for one in BRIEFLY}]
    lines += ["", *laid(([header[k] for k in brief], [[row[k] for k in brief] for row in rows]), 0)]
    if criteria is None:
        return [*lines, "", "No condition is given: add [conditions.departure] and others.", "", SIGNS]
    lines += ["", *(f"  {name}: {one.title}" for name, one in ship.conditions.items() if one.title)]
    lines += ["", *laid(written["conditions"], 2), "", *laid(criteria, 5), *unjudged(ship)]
    by_transfer = next(iter(ship.conditions.values())).by_transfer
    return [*lines, "", f"Free surfaces: {METHODS[by_transfer]}. She trims freely at each heel.", SIGNS]


def laid(table: tables.Table, texts: int) -> list[str]:
    """A table as lines: the first columns, texts, to the left, the others to the right."""
    header, rows = table
    cells = [[str(cell) for cell in row] for row in (header, *rows)]
    widths = [max(len(row[k]) for row in cells) for k in range(len(header))]
    lines = []
    for row in cells:
        placed = zip(row, widths, [True] * texts + [False] * (len(row) - texts), strict=True)
        lines.append("  " + "  ".join(f"{one:<{wide}}" if left else f"{one:>{wide}}" for one, wide, left in placed))
    return [line.rstrip() for line in lines]


def unjudged(ship: Ship) -> list[str]:
    """What was not judged and why, a sentence each."""
    some: Sequence[Condition] = list(ship.conditions.values())
    lines = []
    if any(one.wind is None for one in some):
        lines.append("The weather criterion was not judged in each condition: give [wind].")
    if any(one.wind is not None and not one.metacentric_height > 0.0 for one in some):
        lines.append(sheet.NO_PERIOD)
    if not all(one.grain for one in some):
        lines.append("The Grain Code was judged only where a condition has grain in its cargo.")
    if any(one.flooding is None for one in some):
        lines.append("No opening limits her levers: give [openings.NAME].")
    lines.append("Voids under the hatches and decks of filled holds are not computed: give full, level or moment.")
    return ["", *lines]


def _check(asked: Asked) -> None:
    """Raise LabError for an option that a ship file says itself."""
    for one in fields(asked):
        if one.name not in ASKED_FOR and getattr(asked, one.name) != one.default:
            key = HERE.get(one.name, f"hull.{one.name}")
            raise LabError(f"--{one.name}: a ship file says that itself; leave it out and write {key} in the file.")
    if asked.kg_trim and not asked.limiting_kg:
        raise LabError("--kg-trim: is of --limiting-kg; give both.")
    if (asked.draught or asked.displacement) and asked.step:
        raise LabError("--step: is of a table at round draughts; leave it out, or --draught and --displacement.")


def _spare(path: Path, folder: Path, written: Mapping[str, tables.Table]) -> None:
    """Raise LabError if a table would be written beside the ship file, where her own tables lie."""
    if folder.resolve() == path.parent.resolve():
        raise LabError(f"--out: {folder} has the ship file; choose another folder.")
