"""A hull from a table of offsets: station, z and half_breadth in m.

Stations are x forward from the aft perpendicular, z is from the keel; the rows of a station go from the keel up. Both
sides are alike; a deck joins them at a station's last row. Between rows the hull is straight, or fair (`fairing`).
"""

import csv
from collections.abc import Iterator, Sequence
from io import StringIO
from pathlib import Path

import numpy as np

from lab.assembly.lines.fairing import fair
from lab.assembly.lines.offset_tables import offsets_of
from lab.base.errors import LabError
from lab.preset.tables import read_table
from solvers.machine.errors import Unavailable
from solvers.ship.naval.form import Form
from solvers.ship.section import ROUNDING, Section

COLUMNS = "station", "z", "half_breadth"
FLAT = 1e-9  # of a section's size: corners this close to the lowest are as low
LONGEST, BROADEST, DEEPEST = 600.0, 75.0, 150.0  # m: no ship is longer, to a side broader, or deeper
THIN = 1e-6  # of a station's size: its half-breadth where it has none between two parts, as above a bulb


def read_offsets(path: Path, curved: bool = False) -> Form:
    """The hull of a file of offsets, with fair curves between them if `curved`. Raises LabError, one sentence."""
    return from_offsets(*offsets_of(path), name=path.name, curved=curved)


def is_plain(path: Path) -> bool:
    """Whether a file is in the form in which presets take it (`ship.offsets`)."""
    try:
        read_table(str(path), COLUMNS)
    except LabError:
        return False
    return True


def from_offsets(
    station: np.ndarray, z: np.ndarray, half: np.ndarray, name: str = "the offsets", curved: bool = False
) -> Form:
    """The hull of columns of offsets (m). Raises LabError for those that bound no hull."""
    if (half < 0.0).any():
        row = int(np.argmax(half < 0.0)) + 1
        raise LabError(f"{name}: row {row} has a half_breadth below 0; give the distance from the middle line.")
    _check_size(station, z, half, name)
    places, sections = [], []
    for x in sorted(set(station.tolist())):
        rows = station == x
        places.append(x)
        sections.append(_section(z[rows], half[rows], f"{name}: station {x:g} m", curved))
    try:
        return Form(np.array(places), tuple(sections))
    except Unavailable as error:
        raise LabError(f"{name}: {error}") from None


def _check_size(station: np.ndarray, z: np.ndarray, half: np.ndarray, name: str) -> None:
    """Raise LabError for the size of no ship: lengths that are not in metres, stations by their numbers."""
    reach, breadth = float(np.ptp(station)), float(half.max(initial=0.0))
    for what, size, most in (
        ("stations reach over", reach, LONGEST),
        ("half-breadths go up to", breadth, BROADEST),
        ("heights reach over", float(np.ptp(z)), DEEPEST),
    ):
        if size > most:
            raise LabError(f"{name}: its {what} {size:g} m, more than any ship's; give all lengths in m, not in mm.")
    if reach < 2.0 * breadth and len(set(station.tolist())) > 2:
        raise LabError(
            f"{name}: its stations reach over {reach:g} m, and she is {2.0 * breadth:g} m broad; give each station's "
            "place in m, not its number."
        )


def _section(z: np.ndarray, half: np.ndarray, where: str, curved: bool) -> Section | None:
    """One station's section; None where it has no area."""
    if len(z) > 1 and (np.diff(z) < 0.0).any():
        raise LabError(f"{where} crosses itself: a row lies lower than the one before; list the rows from the keel up.")
    if not half.any() or np.ptp(z) == 0.0:
        return None
    wet = np.flatnonzero(half)
    there = slice(max(wet[0] - 1, 0), wet[-1] + 2)  # on the middle line only the points next to her
    z, half = z[there], half[there]
    if curved:
        z, half = fair(z, half)
    between = (half == 0.0) & (np.arange(len(half)) > 0) & (np.arange(len(half)) < len(half) - 1)
    half = np.where(between, THIN * max(float(half.max()), float(np.ptp(z))), half)
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
    """The offsets of a hull that is alike on both sides: station, z, half-breadth of the corners to starboard.

    A station without an area is told by one row of no breadth.
    """
    keel = min(float(section.outline[:, 1].min()) for section in form.sections if section is not None)
    for x, section in zip(form.x, form.sections, strict=True):
        if section is None:
            yield float(x), keel, 0.0
            continue
        size = ROUNDING * section.size
        corners = section.outline[section.outline[:, 0] >= -size]
        lowest = np.flatnonzero(corners[:, 1] <= corners[:, 1].min() + FLAT * section.size)
        low = int(lowest[np.argmin(corners[lowest, 0])])  # where her bottom is flat, in the middle
        for y, height in np.roll(corners, -low, axis=0):
            yield float(x), float(height), max(0.0, float(y))


def text_of(rows: Sequence[tuple[float, float, float]]) -> str:
    """Offsets as CSV."""
    out = StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(COLUMNS)
    writer.writerows([f"{value:.6g}" for value in row] for row in rows)
    return out.getvalue()
