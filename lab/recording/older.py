"""Support for reading recordings of formats 2 and 3.

In format 3 some data sets and axes had other names; such a recording keeps them, also while its run goes on. In format
2 data sets have the present names and shapes, but no attributes that describe them, no checksums, and strings of
variable length; those that early versions did not write are replaced by the quantity's value `never`.
"""

from collections.abc import Iterable, Mapping

import h5py

from solvers.machine.quantity import Quantity

FORMATS = WITHOUT_CHECKS, WITH_OTHER_NAMES = "cargo-shift-lab 2", "cargo-shift-lab 3"
RENAMED = {  # data sets and axes of format 3, and their present names
    "water_place": "water_position",
    "air_place": "air_position",
    "water_excess": "water_density_deviation",
    "air_excess": "air_density_deviation",
    "water_held": "water_wall_energy",
    "drop": "water_particle",
    "puff": "air_particle",
}
ADDED = {
    "part_turn",
    "face_force",
    "part_load",
}  # data sets that recordings of earlier versions may not have, and go on without


def present(name: str) -> str:
    """The present name of a data set or an axis."""
    return RENAMED.get(name, name)


def stored(group: Mapping[str, object]) -> dict[str, str]:
    """The names that the data sets of a group have in its file, by their present names."""
    return {present(name): name for name in group}


def quantities(group: h5py.Group, known: Iterable[Quantity]) -> dict[str, Quantity]:
    """The quantities of a table of format 2 by name. Raises KeyError if one without a value `never` is missing."""
    found = {quantity.name: quantity for quantity in known if quantity.name != "waves" or "waves" in group}
    for name, quantity in found.items():
        if name not in group and quantity.never is None:
            raise KeyError(f"{group.name[1:]}/{name} is missing")
    return found
