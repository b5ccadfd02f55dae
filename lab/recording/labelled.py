"""The arrays of a recording as xarray data sets, with named axes, units and labels."""

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import xarray


def labelled(recording, frames: slice | None = None) -> "xarray.Dataset":
    """The series of a recording, or the given frames (see `Recording.labelled`)."""
    import xarray  # imported here because it loads slowly and few callers need it

    table = recording.series if frames is None else recording.frames
    rows = slice(None) if frames is None else frames
    found, coordinates = {}, {}
    for name, quantity in table.quantities.items():
        about = {"units": quantity.unit, "long_name": quantity.label, "mean_over_sample": quantity.mean}
        values = xarray.Variable(quantity.axes, table[name][rows], about)
        if name == "time":
            coordinates[name] = values
            continue
        found[name] = values
        if quantity.components:
            coordinates[quantity.dimension] = list(quantity.components)
    for owner, names in recording.names.items():
        if owner not in found and any(owner in values.dims for values in found.values()):
            coordinates[owner] = names
    coordinates["world"] = np.arange(recording.worlds)
    about = {"preset": recording.name, "created": recording.created, "status": recording.status}
    return xarray.Dataset(found, coordinates, about)
