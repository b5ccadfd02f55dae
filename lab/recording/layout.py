"""The layout of a recording in its HDF5 file, which follows from the quantities that it holds.

A table is a group of data sets that grow together, one row at a time. The group `checks` holds a checksum of every row.
"""

from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

import h5py
import numpy as np

from lab.base.trust import attribute_words
from lab.preset.kept.content import MATTERS, Content, parted
from lab.recording import older
from lab.recording.outlines import GROUP as SHAPES
from solvers.bulk import quantities as bulk
from solvers.fluid import quantities as water
from solvers.fluid.inflow import quantities as inflow
from solvers.fluid.phases import quantities as air
from solvers.grains import quantities as grains
from solvers.machine.quantity import OWNERS, PLANE, Quantity
from solvers.mixture import quantities as mixture
from solvers.ship import quantities as ship
from solvers.tank import quantities as tank

if TYPE_CHECKING:
    from lab.preset.schema import Preset

# Some attributes are not read by `Recording`; they inform people who open the file with other programs: `pose_is_of`,
# the reference point of pose and pose_rate; for a ship `ship_axis` and `ship_axis_in_tank`, y, z (m) of the roll axis
# in the hull's and in the tank's frame, and `sway_and_heave_are_of`, the point whose sway and heave are reported.
FORMAT = "cargo-shift-lab 4"
FILE_NAME = "recording.h5"

TIME = Quantity("time", "s", label="time", per="run")
WAVES = Quantity(
    "waves",
    "m, rad/s, 1/m",
    ("height", "frequency", "wave_number"),
    "steered waves: amplitude or significant height; frequency and wave number of regular ones; NaN where fixed",
    per="run",
)
# What the user did in `cargolab view`: the control (see `lab.view.panel.controls`), its new value, and the time.
STEERING = (
    TIME,
    Quantity("name", "", label="control that the user set", per="run"),
    Quantity("value", "", label="value that it was set to, SI", per="run"),
)
DTYPES = {"name": "S32"}  # of the quantities for which the default of `dtype_of` does not apply
PARTICLES = "grain", "water_particle", "air_particle", "point"
CHECKS = "checks"  # the group of the checksums
FLUSHED_ROWS = "rows"  # its attribute with the number of rows of the table at the last flush
COLUMNS = "columns"  # its attribute with the names of the data sets, in the order of the checksums in a row

# What each matter is recorded by
OF_MATTERS = {"grains": grains, "water": water, "air": air, "bulk": bulk}
TABLES = "series", "frames", "steering"
PARTS = "tank/parts"
GROUPS = ("preset", *OF_MATTERS, "tank", SHAPES, *TABLES, CHECKS)  # all that is read of a file, and checked before

# Arbitrary but distinct sizes, to compare shapes
SIZES = dict(zip(OWNERS, (1, 2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43), strict=True))
LONGEST_LABEL = 500  # letters
CHUNK_BYTES = 2**19  # approximate size of a chunk
CHUNK_ROWS = 1024
ATTEMPTS, RETRY_DELAY = 100, 0.02  # attempts to open a file that another process has open, and the pause (s) between


def series_of(
    afloat: bool,
    matters: Collection[str] = MATTERS,
    axled: bool = False,
    floating: bool = False,
    leaking: bool = False,
    in_space: bool = False,
    parted: bool = False,
) -> tuple[Quantity, ...]:
    """The quantities in the series of a run with these matters.

    afloat: with those of a ship; axled: of an axle; floating: of bodies that float; leaking: of water that enters;
    in_space: of the faces of a tank in space; parted: of parts in the tank.
    """
    of_matters = (quantity for name in matters for quantity in OF_MATTERS[name].SERIES)
    entering = (*ship.OF_INFLOW, *inflow.SERIES), leaking
    further = (
        (tank.OF_FACES, in_space),
        (tank.OF_PARTS, parted),
        (ship.SERIES, afloat),
        (tank.OF_AXLE, axled),
        (tank.OF_BODIES, floating),
        entering,
    )
    return (TIME, *tank.SERIES, *of_matters, *(quantity for all_of, there in further if there for quantity in all_of))


def frames_of(
    steered_sea: bool = False, matters: Collection[str] = MATTERS, wet: bool = False, floating_in_space: bool = False
) -> tuple[Quantity, ...]:
    """The quantities in the picture frames of a run.

    `steered_sea`: with the waves, because the user steers them; `wet`: with those of water between grains;
    `floating_in_space`: with all angles of bodies.
    """
    of_matters = (quantity for name in matters for quantity in OF_MATTERS[name].FRAMES)
    of_tank = *tank.FRAMES, *(tank.FRAMES_OF_BODIES_IN_SPACE if floating_in_space else ())
    return (TIME, *of_tank, *((WAVES,) if steered_sea else ()), *of_matters, *(mixture.FRAMES if wet else ()))


def tables_of(preset: "Preset | Content", steered: bool) -> dict[str, tuple[Quantity, ...]]:
    """The quantities of each table of a preset's run; `steered`: by the user in `cargolab view`."""
    afloat, matters, names = bool(preset.ship), preset.matters, names_of(preset)
    more = bool(preset.axle), bool(preset.bodies), bool(preset.inflow), preset.axes > PLANE, bool(preset.parts)
    whole = series_of(afloat, matters, *more)
    series = tuple(quantity for quantity in whole if quantity.per == "part" or names.get(quantity.per, True))
    in_space = bool(preset.bodies) and preset.axes > PLANE
    frames = frames_of(afloat and steered, matters, preset.wet or preset.soaks, in_space)
    tables = {"series": series, "frames": frames}
    if preset.axes > PLANE:
        tables = {name: tuple(one.within(preset.axes) for one in those) for name, those in tables.items()}
    return tables | ({"steering": STEERING} if steered else {})


def names_of(preset: "Preset | Content", parts: Iterable[str] = ()) -> dict[str, list[str]]:
    """The names of a preset's gauges, faces, parts, bodies, rooms and openings, by the owners of their quantities.

    They are in the order of the columns of these quantities.
    """
    pressure, level, force = parted(preset.gauges)
    gauges = {"gauge": [*pressure], "level": [*level], "edge": [*force]}
    of_hulls = {"room": [*preset.rooms], "opening": [*preset.openings], "inlet": [*preset.inflow]}
    return gauges | {"face": [*preset.faces]} | {"part": [*parts], "body": [*preset.bodies]} | of_hulls


def sizes_of(
    names: Mapping[str, Sequence[str]],
    radius: np.ndarray,
    volume: np.ndarray | None,
    air: np.ndarray | None = None,
    bulk: np.ndarray | None = None,
) -> dict[str, int]:
    """How many worlds, grains, particles of water and air, points, parts and gauges there are, by owners."""
    worlds, count = radius.shape
    water, gas, points = (0 if volumes is None else volumes.shape[1] for volumes in (volume, air, bulk))
    named = {owner: len(those) for owner, those in names.items()}
    return {"world": worlds, "grain": count, "water_particle": water, "air_particle": gas, "point": points, **named}


def dtype_of(quantity: Quantity) -> str:
    """The data type in which a quantity is stored: 32 bits for values per particle, 64 bits for all others."""
    return DTYPES.get(quantity.name, "<f4" if quantity.per in PARTICLES else "<f8")


def rows_of(quantities: Iterable[Quantity], sizes: Mapping[str, int]) -> dict[str, tuple[tuple[int, ...], str]]:
    """Row shape and data type of every data set, by name; sizes: numbers of worlds, grains, parts …, by owner."""
    return {
        quantity.name: ((*(sizes[owner] for owner in OWNERS[quantity.per]), *quantity.shape), dtype_of(quantity))
        for quantity in quantities
    }


def create_tables(
    file: h5py.File,
    tables: Mapping[str, Iterable[Quantity]],
    names: Mapping[str, Sequence[str]],
    *particles: np.ndarray | None,
) -> None:
    """Create empty tables of these quantities, and their checksums; `names` and `particles` as of `sizes_of`."""
    sizes = sizes_of(names, *particles)
    for name, quantities in tables.items():
        group = file.create_group(name)
        for quantity, (shape, dtype) in zip(quantities, rows_of(quantities, sizes).values(), strict=True):
            data = _create(group, quantity.name, shape, dtype, CHUNK_ROWS)
            _describe(data, quantity)
            if names.get(quantity.per):
                data.attrs["names"] = np.array([name.encode() for name in names[quantity.per]])
        checks = _create(file.require_group(CHECKS), name, (len(quantities),), "<u4", CHUNK_ROWS // 4)
        checks.attrs[COLUMNS] = np.array([quantity.name for quantity in quantities], dtype="S")
        checks.attrs[FLUSHED_ROWS] = 0


def _create(group: h5py.Group, name: str, shape: tuple[int, ...], dtype: str, most: int) -> h5py.Dataset:
    """Create an empty, extensible data set of rows of this shape, with at most `most` rows per chunk."""
    rows = max(1, min(most, CHUNK_BYTES // max(1, row_bytes(shape, dtype))))
    chunk = (rows, *(max(1, size) for size in shape))
    largest = (None, *(size or None for size in shape))  # HDF5 requires chunks no larger than the maximal shape
    return group.create_dataset(name, (0, *shape), dtype, maxshape=largest, chunks=chunk)


def _describe(data: h5py.Dataset, quantity: Quantity) -> None:
    """Store the unit, label, axes and other properties of a quantity in the attributes of its data set."""
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
    """The quantity that a data set's attributes describe. Raises ValueError, KeyError or Unusable if invalid."""
    axes = tuple(map(older.present, attribute_words(data, "axes")))
    components = tuple(attribute_words(data, "components"))
    owners = axes[1:-1] if components else axes[1:]
    (unit,), (label,) = attribute_words(data, "units"), attribute_words(data, "long_name")
    mean, plot = (bool(data.attrs[name]) for name in ("mean_over_sample", "plot"))
    never = float(data.attrs["never"]) if "never" in data.attrs else None
    per = next((per for per, names in OWNERS.items() if names == owners), None)
    if max(map(len, (unit, label, *components)), default=0) > LONGEST_LABEL:
        raise ValueError(f"{data.name[1:]} has a longer label than the lab writes")
    name = older.present(data.name.rpartition("/")[2])
    found = Quantity(name, unit, components, label, mean, per or "", never, plot)
    if per is None or axes != found.axes or len(found.units) != found.width:
        raise ValueError(f"{data.name[1:]} is not what the lab writes there")
    return found


def quantities_of(group: h5py.Group, known: tuple[Quantity, ...]) -> dict[str, Quantity]:
    """The quantities of a table by name as the file describes them, including any that this version does not know.

    Raises ValueError or KeyError if a known one is missing or has another shape or data type.
    """
    found, stored = {}, older.stored(group)
    known = tuple(quantity for quantity in known if quantity.name in stored or quantity.name not in older.ADDED)
    for name in (*(quantity.name for quantity in known), *stored):
        if name not in found:
            found[name] = described(group[stored.get(name, name)])
    for quantity in known:
        if rows_of([quantity], SIZES) != rows_of([found[quantity.name]], SIZES):
            raise ValueError(f"{group.name[1:]}/{quantity.name} is not what the lab writes there")
    return found


def store(file: h5py.File, name: str, values: np.ndarray) -> None:
    """Store an array that does not grow, with HDF5's own checksums."""
    values = np.asarray(values)
    if not values.size:
        file[name] = values
        return
    rows = max(1, min(len(values), CHUNK_BYTES // row_bytes(values.shape[1:], values.dtype)))
    file.create_dataset(name, data=values, chunks=(rows, *values.shape[1:]), fletcher32=True)


def fixed_text(text: str) -> np.ndarray:
    """A text as a string of fixed length: HDF5 does not checksum strings of variable length."""
    content = text.encode()
    return np.array(content, h5py.string_dtype(length=max(1, len(content))))


def row_bytes(shape: tuple[int, ...], dtype: str | np.dtype) -> int:
    """Size of one row in bytes."""
    return int(np.prod(shape, dtype=int)) * np.dtype(dtype).itemsize


def sentence(error: BaseException) -> str:
    """The first line of an exception's message, or its type if it has none."""
    if isinstance(error, KeyboardInterrupt):
        return "interrupted by the user"
    return (str(error).strip().splitlines() or [type(error).__name__])[0]
