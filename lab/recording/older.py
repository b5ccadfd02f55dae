"""Recordings of format 2, which can still be read: their numbers are where they are now, but nothing says so.

They have no checksums, and texts of any length. What lacks in those of early versions is as if it had never happened.
"""

from collections.abc import Iterable

import h5py

from lab.recording.layout import WAVES
from solvers.machine.quantity import Quantity

FORMAT = "cargo-shift-lab 2"


def is_older(form: str) -> bool:
    """Whether a file says that it is of this format."""
    return form == FORMAT


def renamed(preset: dict) -> dict:
    """A recorded preset by the keys of today: the thickness of the cargo was the ship's."""
    sheet = (preset.get("ship") or {}).pop("sheet", None)
    return preset | {"tank": preset["tank"] | {"thickness": sheet}} if sheet else preset


def quantities(group: h5py.Group, known: Iterable[Quantity]) -> dict[str, Quantity]:
    """The quantities of a table by name. Raises KeyError where one is missing for which nothing stands."""
    found = {quantity.name: quantity for quantity in known if quantity != WAVES or WAVES.name in group}
    for name, quantity in found.items():
        if name not in group and quantity.never is None:
            raise KeyError(f"{group.name[1:]}/{name} is missing")
    return found
