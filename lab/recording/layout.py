"""How a recording is laid out in its HDF5 file."""

from collections.abc import Mapping

import h5py
import numpy as np

# Beside what a Recording reads, attributes for who opens the file alone: `pose_is_of`, the point of pose and pose_rate;
# of a ship `ship_axis` and `ship_axis_in_tank`, y, z (m) of her axis in the hull's and in the tank's axes, and
# `sway_and_heave_are_of` in words.
FORMAT = "cargo-shift-lab 2"
FILE_NAME = "recording.h5"

# Shapes after the leading axes: (T, W, *shape) of a series, (F, W, n, *shape) of what each grain
# has, (F, W, *shape) of what each world has. One line more records one quantity more.
SERIES = {
    "pose": (3,),
    "pose_rate": (3,),
    "centre_of_mass": (2,),
    "kinetic": (),
    "rotational": (),
    "potential": (),
    "elastic": (),
    "contacts": (),
    "overlap": (),
    "spilled": (),
    "wall_force": (3,),
}
# Of a ship further: works (J/m) of waves, against radiation and viscosity, of the cargo; when (s) she capsized and
# flooded, or -1.
SHIP_SERIES = {"ship_works": (4,), "capsized": (), "flooded": ()}
ADDED = {"flooded": -1.0}  # series that recordings of earlier versions may lack, and what stands for them
GRAIN_FRAMES = {"position": (2,), "velocity": (2,), "angle": (), "spin": ()}
WORLD_FRAMES = {"pose": (3,)}  # and "part" (P, 2), the displacement of each moving part
# Waves under a hand: amplitude or significant height (m); frequency (rad/s) and wave number (1/m) of regular ones. NaN
# where a hand cannot change them.
WAVES = (3,)
# What a hand did in `cargolab view`: which control (see `lab.view.panel.controls`) it set to which value (SI), and
# when.
STEERING = {"time": ((), "f8"), "name": ((), "S32"), "value": ((), "f8")}

CHUNK_BYTES = 2**19  # about what one reads of a data set at a time
CHUNK_ROWS = 1024
PATIENCE, A_MOMENT = 100, 0.02  # how often, and every how many s, a file is tried that another process has open


def table_shapes(
    worlds: int, count: int, parts: int, afloat: bool = False, swell: bool = False
) -> dict[str, dict[str, tuple[tuple[int, ...], str]]]:
    """Shape of a row and kind of number of every data set that grows; swell: whether a hand steers the waves."""
    time, series = {"time": ((), "f8")}, SERIES | (SHIP_SERIES if afloat else {})
    return {
        "series": time | {name: ((worlds, *shape), "f8") for name, shape in series.items()},
        "frames": time
        | {name: ((worlds, *shape), "f8") for name, shape in WORLD_FRAMES.items()}
        | {"part": ((worlds, parts, 2), "f8")}
        | ({"waves": (WAVES, "f8")} if swell else {})
        | {name: ((worlds, count, *shape), "f4") for name, shape in GRAIN_FRAMES.items()},
    }


def create_table(group: h5py.Group, shapes: Mapping[str, tuple[tuple[int, ...], str]]) -> None:
    """Empty data sets with such rows, which can grow."""
    for name, (shape, kind) in shapes.items():
        rows = max(1, min(CHUNK_ROWS, CHUNK_BYTES // max(1, row_bytes(shape, kind))))
        chunk = (rows, *(max(1, size) for size in shape))
        room = (None, *(size or None for size in shape))  # HDF5 wants chunks no larger than the data set may become
        group.create_dataset(name, (0, *shape), kind, maxshape=room, chunks=chunk)


def row_bytes(shape: tuple[int, ...], kind: str) -> int:
    """Memory of one row."""
    return int(np.prod(shape, dtype=int)) * np.dtype(kind).itemsize


def sentence(error: BaseException) -> str:
    """The first line of what an exception says, or its name."""
    if isinstance(error, KeyboardInterrupt):
        return "interrupted by the user"
    return (str(error).strip().splitlines() or [type(error).__name__])[0]
