"""A hull from a table of offsets: a CSV file of station, z and half_breadth in m.

Stations are x forward from the aft perpendicular, z is from the keel; the rows of a station go from the keel up. Both
sides are alike; a deck joins them at a station's last row.
"""

import csv
from collections.abc import Iterator, Sequence
from io import StringIO
from pathlib import Path

import numpy as np

from lab.base.errors import LabError
from lab.preset.tables import read_table
from solvers.machine.errors import Unavailable
from solvers.ship.naval.form import Form
from solvers.ship.section import ROUNDING, Section

COLUMNS = "station", "z", "half_breadth"
MOST = 100_000  # rows


def read_offsets(path: Path) -> Form:
    """The hull of a file of offsets. Raises LabError, one sentence with station and remedy."""
    columns = read_table(str(path), COLUMNS, (), "the hull", MOST)
    return from_offsets(*(columns[name] for name in COLUMNS), name=path.name)


def from_offsets(station: np.ndarray, z: np.ndarray, half: np.ndarray, name: str = "the offsets") -> Form:
    """The hull of columns of offsets (m). Raises LabError for those that bound no hull."""
    if (half < 0.0).any():
        row = int(np.argmax(half < 0.0)) + 1
        raise LabError(f"{name}: row {row} has a half_breadth below 0; give the distance from the middle line.")
    places, sections = [], []
    for x in sorted(set(station.tolist())):
        rows = station == x
        places.append(x)
        sections.append(_section(z[rows], half[rows], f"{name}: station {x:g} m"))
    try:
        return Form(np.array(places), tuple(sections))
    except Unavailable as error:
        raise LabError(f"{name}: {error}") from None


def _section(z: np.ndarray, half: np.ndarray, where: str) -> Section | None:
    """One station's section; None where it has no area."""
    if len(z) > 1 and (np.diff(z) < 0.0).any():
        raise LabError(f"{where} crosses itself: a row lies lower than the one before; list the rows from the keel up.")
    if not half.any() or np.ptp(z) == 0.0:
        return None
    starboard = np.column_stack([half, z])
    port = starboard[::-1] * [-1.0, 1.0]
    outline = np.concatenate([starboard, port])
    size = float(np.ptp(outline, axis=0).max())
    apart = np.hypot(*(outline - np.roll(outline, 1, axis=0)).T) > ROUNDING * size
    try:
        return Section(outline[apart])
    except Unavailable as error:
        raise LabError(f"{where}: {error}") from None


def rows_of(form: Form) -> Iterator[tuple[float, float, float]]:
    """The offsets of a hull that is alike on both sides: station, z, half-breadth of the corners to starboard."""
    for x, section in zip(form.x, form.sections, strict=True):
        if section is None:
            continue
        size = ROUNDING * section.size
        corners = section.outline[section.outline[:, 0] >= -size]
        low = int(np.argmin(corners[:, 1] - 1e-9 * corners[:, 0]))
        for y, height in np.roll(corners, -low, axis=0):
            yield float(x), float(height), max(0.0, float(y))


def text_of(rows: Sequence[tuple[float, float, float]]) -> str:
    """Offsets as CSV."""
    out = StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(COLUMNS)
    writer.writerows([f"{value:.6g}" for value in row] for row in rows)
    return out.getvalue()
