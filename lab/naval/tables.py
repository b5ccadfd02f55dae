"""Tables of the naval architect as CSV, in the columns and units that stability programs use."""

import csv
from collections.abc import Sequence
from io import StringIO
from math import isfinite
from pathlib import Path

import numpy as np

from lab.base.errors import LabError
from lab.base.files import write_text
from lab.naval.condition import Condition
from lab.naval.sheet import Judged, Row, arms, shown
from solvers.ship.naval.form import Form
from solvers.ship.naval.grain_code import ASSUMED
from solvers.ship.naval.holds import Hold
from solvers.ship.naval.upright import level_at
from solvers.ship.water import Water

KN_HEELS = (5.0, 10.0, 12.0, 15.0, 20.0, 30.0, 40.0, 50.0, 60.0)  # deg
LEVELS = 20  # rows of a hold's table
LEAST_DRAUGHTS, MOST_DRAUGHTS = 8, 1000  # rows of a table of hydrostatics

Table = tuple[Sequence[str], Sequence[Sequence[object]]]

HYDROSTATICS = {
    "T m": ("draught", 3),
    "volume m3": ("volume", 1),
    "displacement t": ("displacement", 1),
    "LCB m": ("lcb", 3),
    "KB m": ("kb", 3),
    "BM m": ("bm", 3),
    "KM m": ("km", 3),
    "BML m": ("bml", 2),
    "KML m": ("kml", 2),
    "TPC t/cm": ("tpc", 3),
    "MCT t m/cm": ("mct", 2),
    "LCF m": ("lcf", 3),
    "Aw m2": ("waterplane", 1),
    "wetted m2": ("wetted", 1),
    "Cb": ("block", 4),
    "Cm": ("midship", 4),
    "Cp": ("prismatic", 4),
    "Cw": ("plane", 4),
}


def criteria(rows: Sequence[Row]) -> Table:
    """The sheet of criteria."""
    header = "rule", "criterion", "shift", "required", "limit", "attained", "unit", "margin", "verdict", "note"
    lines = []
    for row in rows:
        one = row.criterion
        attained, margin = shown(one.attained, one.unit), shown(one.margin, one.unit)
        numbers = (f"{one.limit:.4g}", attained, one.unit, margin, row.verdict, one.note)
        lines.append((one.rule, one.what, row.shift, one.kind, *numbers))
    return header, lines


def levers(ship: Judged, lying=None) -> Table:
    """GZ and the heeling arms against heel to the side that she is judged on."""
    heel = ship.levers.heel[ship.levers.heel >= 0.0]
    columns = {f"heel to {ship.side} deg": np.degrees(heel), "GZ m": ship.levers.at(heel)}
    for name, arm in arms(ship, lying).items():
        columns[f"{name} arm m"] = arm(heel)
    lines = [(f"{turn:.1f}", *(f"{value:.4f}" for value in row)) for turn, *row in zip(*columns.values(), strict=True)]
    return tuple(columns), lines


def round_draughts(deepest: float, step: float | None = None) -> np.ndarray:
    """Draughts (m) at whole multiples of a step up to the deepest; by itself the step is 1, 2 or 5 of a decade.

    Then there are LEAST_DRAUGHTS of them or up to 2.5 times as many. Raises LabError for a step deeper than that.
    """
    if step is None:
        decade = 10.0 ** np.floor(np.log10(deepest / LEAST_DRAUGHTS))
        step = max(one * decade for one in (1.0, 2.0, 5.0) if one * decade <= deepest / LEAST_DRAUGHTS * (1.0 + 1e-9))
    count = int(deepest / step * (1.0 + 1e-9))
    if not 1 <= count <= MOST_DRAUGHTS:
        raise LabError(f"--step: {step:g} m gives {count} draughts up to {deepest:.4g} m; 1 to {MOST_DRAUGHTS} can be.")
    return np.round(step * np.arange(1, count + 1), 9)


def hydrostatics(form: Form, water: Water, draughts: Sequence[float], trim: float = 0.0) -> Table:
    """Hydrostatics at mean draughts (m), with a trim (m) by the stern."""
    lines = []
    for draught in draughts:
        found = form.afloat(level_at(form, float(draught), trim), water)
        lines.append(tuple(f"{getattr(found, name):.{digits}f}" for name, digits in HYDROSTATICS.values()))
    return tuple(HYDROSTATICS), lines


def cross_curves(form: Form, water: Water, draughts: Sequence[float]) -> Table:
    """KN = GZ + KG sin(heel) at the displacements of these draughts (m), the keel level."""
    lines = []
    for draught in draughts:
        displacement = form.hydrostatics(float(draught), water).displacement
        levers = form.cross_curves(displacement, water, np.radians(KN_HEELS))
        lines.append((f"{displacement:.1f}", *(f"{lever:.3f}" for lever in levers)))
    return ("displacement t", *(f"KN {heel:g} deg m" for heel in KN_HEELS)), lines


def hold(of: Hold) -> Table:
    """Level, volume, KG and volumetric moments of a hold, heights above the keel."""
    low, high = of.section.outline[:, 1].min(), of.section.outline[:, 1].max()
    levels = low + (high - low) * np.arange(1, LEVELS + 1) / LEVELS
    surfaces = tuple(ASSUMED[name].surface for name in ("filled", "partly-filled"))
    lines = [
        (f"{level:.3f}", f"{volume:.1f}", f"{centre:.3f}", *(f"{moment:.1f}" for moment in moments))
        for level, volume, centre, *moments in of.table(levels, surfaces)
    ]
    return ("level m", "volume m3", "KG m", "moment at 15 deg m4", "moment at 25 deg m4"), lines


def all_of(condition: Condition, rows: Sequence[Row], lying=None) -> dict[str, Table]:
    """Every table of a condition by the name of its file."""
    draughts = round_draughts(0.999 * condition.form.depth)
    found = {
        "criteria": criteria(rows),
        "righting-levers": levers(condition, lying),
        "hydrostatics": hydrostatics(condition.form, condition.water, draughts),
        "cross-curves": cross_curves(condition.form, condition.water, draughts),
    }
    if condition.hold is not None:
        found["hold"] = hold(condition.hold)
    for further in condition.stowed[1:]:
        found[f"hold-{further.name}"] = hold(further.hold)
    return found


def objects(table: Table) -> list[dict[str, object]]:
    """A table as JSON has it: its rows by the names of the columns, texts of numbers as numbers."""
    header, lines = table
    return [dict(zip(header, map(_plain, line), strict=True)) for line in lines]


def _plain(cell: object) -> object:
    try:
        number = float(cell)
    except (TypeError, ValueError):
        return cell
    return number if isfinite(number) else str(cell)


def text(table: Table) -> str:
    """A table as CSV."""
    out = StringIO()
    csv.writer(out, lineterminator="\n").writerows([table[0], *table[1]])
    return out.getvalue()


def write(tables: dict[str, Table], folder: Path) -> dict[str, Path]:
    """Write tables as NAME.csv into a folder; returns the files by name. Raises LabError when it cannot be written."""
    written = {}
    for name, table in tables.items():
        written[name] = folder / f"{name}.csv"
        try:
            folder.mkdir(parents=True, exist_ok=True)
            write_text(written[name], text(table))
        except OSError as error:
            raise LabError(f"{folder} cannot be written ({error.strerror}): choose another folder.") from error
    return written
