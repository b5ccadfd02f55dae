"""How a recording is laid out in its HDF5 file: by the quantities that it holds.

A table is a group of data sets that grow together, a row a time; beside it, in `checks`, lies a checksum of every row.
"""

from collections.abc import Iterable, Mapping

import h5py
import numpy as np

from lab.base.trust import attribute_words
from solvers.grains import quantities as grains
from solvers.machine.quantity import OWNERS, Quantity
from solvers.ship import quantities as ship
from solvers.tank import quantities as tank

# Beside what a Recording reads, attributes for who opens the file alone: `pose_is_of`, the point of pose and pose_rate;
# of a ship `ship_axis` and `ship_axis_in_tank`, y, z (m) of her axis in the hull's and in the tank's axes, and
# `sway_and_heave_are_of` in words.
FORMAT = "cargo-shift-lab 3"
FILE_NAME = "recording.h5"

TIME = Quantity("time", "s", label="time", per="run")
WAVES = Quantity(
    "waves",
    "m, rad/s, 1/m",
    ("height", "frequency", "wave_number"),
    "waves under a hand: amplitude or significant height; frequency and wave number of regular ones; NaN where fixed",
    per="run",
)
# What a hand did in `cargolab view`: which control (see `lab.view.panel.controls`) it set to which value, and when.
STEERING = (
    TIME,
    Quantity("name", "", label="control that a hand set", per="run"),
    Quantity("value", "", label="value that it was set to, SI", per="run"),
)
KINDS = {"name": "S32"}  # of numbers, where it is not that of `kind_of`
CHECKS = "checks"  # the group of the checksums
STANDING = "rows"  # attribute there: how many rows of the table were written by the last flush
COLUMNS = "columns"  # attribute there: the data sets whose checksums stand in each row

CHUNK_BYTES = 2**19  # about what one reads of a data set at a time
CHUNK_ROWS = 1024
PATIENCE, A_MOMENT = 100, 0.02  # how often, and every how many s, a file is tried that another process has open

Rows = Mapping[str, tuple[tuple[int, ...], str]]  # shape of a row and kind of number, by name


def series_of(afloat: bool) -> tuple[Quantity, ...]:
    """What the series of a run hold, of a ship more."""
    return (TIME, *tank.SERIES, *grains.SERIES, *(ship.SERIES if afloat else ()))


def frames_of(swell: bool = False) -> tuple[Quantity, ...]:
    """What the picture frames of a run hold; swell: whether a hand steers the waves."""
    return (TIME, *tank.FRAMES, *((WAVES,) if swell else ()), *grains.FRAMES)


def tables_of(afloat: bool, steered: bool) -> dict[str, tuple[Quantity, ...]]:
    """The quantities of each table of a run, in a ship or not, under a hand or not."""
    tables = {"series": series_of(afloat), "frames": frames_of(afloat and steered)}
    return tables | ({"steering": STEERING} if steered else {})


def kind_of(quantity: Quantity) -> str:
    """The kind of number that is stored of a quantity: 32 bits of what each grain has."""
    return KINDS.get(quantity.name, "<f4" if quantity.per == "grain" else "<f8")


def rows_of(quantities: Iterable[Quantity], sizes: Mapping[str, int]) -> dict[str, tuple[tuple[int, ...], str]]:
    """Shape of a row and kind of number of every data set; sizes: how many worlds, grains, parts there are."""
    return {
        quantity.name: ((*(sizes[owner] for owner in OWNERS[quantity.per]), *quantity.shape), kind_of(quantity))
        for quantity in quantities
    }


def create_tables(file: h5py.File, tables: Mapping[str, Iterable[Quantity]], sizes: Mapping[str, int]) -> None:
    """Empty tables of quantities, with their checksums."""
    for name, quantities in tables.items():
        group = file.create_group(name)
        for quantity, (shape, kind) in zip(quantities, rows_of(quantities, sizes).values(), strict=True):
            _describe(_create(group, quantity.name, shape, kind, CHUNK_ROWS), quantity)
        checks = _create(file.require_group(CHECKS), name, (len(quantities),), "<u4", CHUNK_ROWS // 4)
        checks.attrs[COLUMNS] = np.array([quantity.name for quantity in quantities], dtype="S")
        checks.attrs[STANDING] = 0


def _create(group: h5py.Group, name: str, shape: tuple[int, ...], kind: str, most: int) -> h5py.Dataset:
    """An empty data set with such rows, which can grow, at most so many of them a chunk."""
    rows = max(1, min(most, CHUNK_BYTES // max(1, row_bytes(shape, kind))))
    chunk = (rows, *(max(1, size) for size in shape))
    room = (None, *(size or None for size in shape))  # HDF5 wants chunks no larger than the data set may become
    return group.create_dataset(name, (0, *shape), kind, maxshape=room, chunks=chunk)


def _describe(data: h5py.Dataset, quantity: Quantity) -> None:
    """Say in a data set's attributes what it is."""
    data.attrs["units"] = fixed_text(quantity.unit)
    data.attrs["long_name"] = fixed_text(quantity.label)
    data.attrs["components"] = np.array(quantity.components, dtype="S")
    data.attrs["axes"] = np.array(quantity.axes, dtype="S")
    data.attrs["mean_over_sample"] = quantity.mean
    data.attrs["plot"] = quantity.plot
    if quantity.never is not None:
        data.attrs["never"] = quantity.never
    for axis, name in enumerate(quantity.axes):
        data.dims[axis].label = name


def described(data: h5py.Dataset) -> Quantity:
    """The quantity that a data set says it is. Raises ValueError, KeyError or Useless where it says nothing sound."""
    axes, components = tuple(attribute_words(data, "axes")), tuple(attribute_words(data, "components"))
    owners = axes[1:-1] if components else axes[1:]
    (unit,), (label,) = attribute_words(data, "units"), attribute_words(data, "long_name")
    mean, plot = (bool(data.attrs[name]) for name in ("mean_over_sample", "plot"))
    never = float(data.attrs["never"]) if "never" in data.attrs else None
    per = next((per for per, names in OWNERS.items() if names == owners), None)
    found = Quantity(data.name.rpartition("/")[2], unit, components, label, mean, per or "", never, plot)
    if per is None or axes != found.axes or len(found.units) != found.width:
        raise ValueError(f"{data.name[1:]} is not what the lab writes there")
    return found


def store(file: h5py.File, name: str, values: np.ndarray) -> None:
    """Keep an array that does not change, with HDF5's own checksums."""
    values = np.asarray(values)
    if not values.size:
        file[name] = values
        return
    rows = max(1, min(len(values), CHUNK_BYTES // row_bytes(values.shape[1:], values.dtype)))
    file.create_dataset(name, data=values, chunks=(rows, *values.shape[1:]), fletcher32=True)


def fixed_text(text: str) -> np.ndarray:
    """A text as it is stored: HDF5 has checksums of what has a size of its own, not of strings of any length."""
    content = text.encode()
    return np.array(content, h5py.string_dtype(length=max(1, len(content))))


def row_bytes(shape: tuple[int, ...], kind: str | np.dtype) -> int:
    """Memory of one row."""
    return int(np.prod(shape, dtype=int)) * np.dtype(kind).itemsize


def sentence(error: BaseException) -> str:
    """The first line of what an exception says, or its name."""
    if isinstance(error, KeyboardInterrupt):
        return "interrupted by the user"
    return (str(error).strip().splitlines() or [type(error).__name__])[0]
