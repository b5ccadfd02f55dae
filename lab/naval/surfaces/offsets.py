"""The offsets of a hull that was cut from a surface, in their own axes: from her aft perpendicular and base line."""

from pathlib import Path

import numpy as np

from lab.assembly.lines.offsets import from_offsets, rows_of, text_of
from lab.base.errors import LabError
from lab.base.files import write_text
from lab.naval.surfaces.read import AGREE
from solvers.ship.naval.form import Form


def write_offsets(form: Form, folder: Path) -> str:
    """Write offsets.csv into a folder; returns a sentence on it, empty if there is nothing to say.

    Raises LabError when it cannot be written.
    """
    path, aft, base = folder / "offsets.csv", form.ends[0], form.base
    rows = [(x - aft, z - base, half) for x, z, half in rows_of(form)]
    if not _same(form, rows):
        return "offsets.csv was not written: half-breadths from the keel up do not tell this hull's shape."
    try:
        write_text(path, text_of(rows))
    except OSError as error:
        raise LabError(f"{path} cannot be written ({error.strerror}): choose another folder.") from error
    if not (aft or base):
        return ""
    return f"offsets.csv is from her aft perpendicular (x {aft:.6g} m) and her base line (z {base:.6g} m)."


def _same(form: Form, rows: list[tuple[float, float, float]]) -> bool:
    """Whether offsets give a hull's volume again, as they do if her sides are alike and do not fall back."""
    try:
        again = from_offsets(*np.array(rows).T)
    except LabError:
        return False
    return abs(again.volume / form.volume - 1.0) <= AGREE
