"""netCDF: the recording as it is, with named axes, units and labels, for all worlds and in the tank's axes.

Groups: `series` and `frames` as `Recording.labelled` has them, `grains` and `tank` with what does not change. It is
netCDF 4, which is HDF5, written by xarray with h5netcdf.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from lab.base.errors import LabError

if TYPE_CHECKING:
    from lab.recording import Recording

ENGINES = "h5netcdf", "netCDF4"


def write_netcdf(recording: Recording, every: int, world: int | None, path: Path, reach: Callable[[int], None]) -> None:
    """Write series, every so many frames, and what stays the same; of all worlds or of one."""
    engine = next((name for name in ENGINES if find_spec(name)), None)
    if engine is None:
        raise LabError("to netcdf needs the library h5netcdf: pip install 'cargo-shift-lab[export]'.")
    import xarray  # slow to load

    tree = {"series": recording.labelled(), "frames": recording.labelled(slice(0, None, every))}
    tree |= {"grains": _grains(recording), "tank": _tank(recording)}
    if world is not None:
        tree = {name: one.isel(world=[world]) if "world" in one.dims else one for name, one in tree.items()}
    about = {"title": recording.name, "status": recording.status, "created": recording.created}
    about |= {"source": f"cargo-shift-lab {recording.version}", "axes": "y, z, x of the tank; pose is in the earth's"}
    found = xarray.DataTree.from_dict({name: _plain(one) for name, one in tree.items()})
    found.attrs = about
    found.to_netcdf(path, engine=engine.lower())
    reach(1)


def _grains(recording: Recording) -> object:
    import xarray

    sizes = {
        "grain": ("radius", recording.radius, "m"),
        "water_particle": ("water_volume", recording.volume, recording_volume(recording)),
        "air_particle": ("air_volume", recording.air_volume, recording_volume(recording)),
        "point": ("bulk_volume", recording.bulk_volume, recording_volume(recording)),
    }
    found = {
        name: (("world", owner), values, {"units": unit})
        for owner, (name, values, unit) in sizes.items()
        if values.size
    }
    if recording.radius.size:
        found["kind"] = ("world", "grain"), recording.kind.astype(np.int32), {"units": "1"}
    return xarray.Dataset(found, {"world": np.arange(recording.worlds)})


def recording_volume(recording: Recording) -> str:
    """The unit of particles' volumes: areas in the plane."""
    return "m^3" if recording.content.axes > 2 else "m^2"


def _tank(recording: Recording) -> object:
    import xarray

    found = {"outline": (("corner", "axis"), recording.outline, {"units": "m"})}
    if len(recording.fixed):
        found["fixed"] = ("fixed_grain", "fixed_component"), recording.fixed, {"units": "m"}
    for name, line in recording.parts.items():
        found[f"part_{name}"] = (f"corner_of_{name}", "axis"), line, {"units": "m"}
    return xarray.Dataset(found, {"axis": ["y", "z"]}, {"open_edges": list(recording.open_edges)})


def _plain(dataset: object) -> object:
    """The data set with attributes that netCDF can hold: no truth values."""
    for values in dataset.variables.values():
        values.attrs = {key: int(one) if isinstance(one, bool | np.bool_) else one for key, one in values.attrs.items()}
    return dataset
