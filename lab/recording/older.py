"""Support for reading recordings of format 2.

Their data sets have the present names and shapes, but no attributes that describe them, no checksums, and strings of
variable length. Data sets that early versions did not write are replaced by the quantity's value `never`.
"""

from collections.abc import Iterable

import h5py

from lab.recording.layout import WAVES
from solvers.machine.quantity import Quantity

FORMAT = "cargo-shift-lab 2"


def is_older(form: str) -> bool:
    """Whether `form`, a file's format, is format 2."""
    return form == FORMAT


def quantities(group: h5py.Group, known: Iterable[Quantity]) -> dict[str, Quantity]:
    """The quantities of a table by name. Raises KeyError if one without a value for `never` is missing."""
    found = {quantity.name: quantity for quantity in known if quantity != WAVES or WAVES.name in group}
    for name, quantity in found.items():
        if name not in group and quantity.never is None:
            raise KeyError(f"{group.name[1:]}/{name} is missing")
    return found
