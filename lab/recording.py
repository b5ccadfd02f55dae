"""What a run leaves behind: one HDF5 file, written as the run goes on and readable at any moment.

The file is written in HDF5's single-writer/multiple-reader mode (SWMR): every flush leaves a whole
file behind, so a run that is killed, or that still goes on, can be read up to its last flush. Other
programs must ask for that mode too: `h5py.File(path, "r", swmr=True)`.
"""

import json
import os
import platform
import shutil
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from datetime import datetime
from importlib import metadata
from pathlib import Path

import h5py
import numpy as np

from lab.errors import LabError

FORMAT = "cargo-shift-lab 1"
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
}
GRAIN_FRAMES = {"position": (2,), "velocity": (2,), "angle": (), "spin": ()}
WORLD_FRAMES = {"pose": (3,)}

CHUNK_BYTES = 2**19  # about what one reads of a data set at a time
CHUNK_ROWS = 1024
BUFFER_BYTES = 2**25  # kept in memory at most before it is written
SPARE_BYTES = 2**23  # room that must stay free on the disk: HDF5 cannot even close a file on a full one
PACKAGES = ("cargo-shift-lab", "taichi", "numpy", "scipy", "h5py")


class Recorder:
    """Writes the recording of a run; a context manager that closes it with the right status.

    folder: where recording.h5 is made, created if missing; preset: its name; given: its TOML text;
    resolved: all its values in SI; radius (W, n) m; outline (m, 2) m; step: the time step, s;
    machine: what ran it (added to what is found out here); flush_every: wall-clock seconds between
    writings. The runner keeps `wall_s` and `grain_steps` up to date; every flush writes them.
    Raises LabError when the folder cannot be written, is full, or already holds a recording.
    """

    def __init__(
        self,
        folder: Path | str,
        *,
        preset: str,
        given: str,
        resolved: Mapping,
        radius: np.ndarray,
        outline: np.ndarray,
        step: float,
        machine: Mapping | None = None,
        flush_every: float = 2.0,
    ) -> None:
        self.folder = Path(folder)
        self.path = self.folder / FILE_NAME
        self.wall_s, self.grain_steps = 0.0, 0
        radius = np.asarray(radius, dtype=float)
        worlds, count = radius.shape
        shapes = _table_shapes(worlds, count)
        self._tables = {name: _Table(shapes[name]) for name in shapes}
        self._flush_every, self._flushed = flush_every, time.monotonic()
        with self._writing():
            self.folder.mkdir(parents=True, exist_ok=True)
            self._check_room(0)
            self._file = h5py.File(self.path, "x", libver="latest")
        with self._writing():
            self._write_head(preset, given, resolved, step, machine or {})
            self._file["grains/radius"] = radius
            self._file["tank/outline"] = np.asarray(outline, dtype=float)
            for name, table in self._tables.items():
                table.create(self._file.create_group(name))
            self._file.swmr_mode = True

    def sample(self, values: Mapping[str, object]) -> None:
        """Add a row to the series: "time" (s) and every name of SERIES, (W, *shape) each."""
        self._add("series", values)

    def frame(self, values: Mapping[str, object]) -> None:
        """Add a picture frame: "time" (s), "pose" (W, 3) and GRAIN_FRAMES, (W, n, *shape) each."""
        self._add("frames", values)

    def flush(self) -> None:
        """Write what has been added so far. Raises LabError when the folder is full or lost."""
        pending = sum(table.pending_bytes for table in self._tables.values())
        with self._writing():
            self._check_room(pending)
            for table in self._tables.values():
                table.write()
            self._file.attrs.modify("wall_s", float(self.wall_s))
            self._file.attrs.modify("grain_steps", int(self.grain_steps))
            self._file.flush()
        self._flushed = time.monotonic()

    def close(self, status: str = "complete") -> None:
        """Write the rest and the status, "complete" or "stopped: <sentence>"; once is enough."""
        if not self._file:
            return
        try:
            self.flush()
        finally:
            with self._writing():
                self._file.attrs.modify("status", status)
                self._file.close()

    def __enter__(self) -> "Recorder":
        return self

    def __exit__(self, kind: type | None, error: BaseException | None, trace: object) -> None:
        if error is None:
            self.close()
            return
        with suppress(LabError):  # what stopped the run is the news
            self.close(f"stopped: {_sentence(error)}")

    def _add(self, name: str, values: Mapping[str, object]) -> None:
        self._tables[name].add(values)
        pending = sum(table.pending_bytes for table in self._tables.values())
        if pending > BUFFER_BYTES or time.monotonic() - self._flushed > self._flush_every:
            self.flush()

    def _write_head(self, preset: str, given: str, resolved: Mapping, step: float, machine: Mapping) -> None:
        attributes = {
            "format": FORMAT,
            "preset": preset,
            "status": "running",
            "created": datetime.now().astimezone().isoformat(timespec="seconds"),
            "versions": json.dumps(_versions()),
            "machine": json.dumps({**_machine(), **machine}),
            "step": float(step),
            "wall_s": 0.0,
            "grain_steps": 0,
        }
        self._file.attrs.update(attributes)
        self._file["preset/given"] = given
        self._file["preset/resolved"] = json.dumps(resolved)

    def _check_room(self, pending: int) -> None:
        free = shutil.disk_usage(self.folder).free
        if free < pending + SPARE_BYTES:
            raise LabError(
                f"The disk of {self.folder} is full ({free / 2**20:.0f} MiB free): "
                "make room there or choose another folder."
            )

    @contextmanager
    def _writing(self) -> Iterator[None]:
        """Turn what the system or HDF5 says against writing into one sentence."""
        try:
            yield
        except FileExistsError as error:
            raise LabError(f"{self.folder} already holds a recording or is a file: choose another folder.") from error
        except (OSError, RuntimeError) as error:
            reason = os.strerror(error.errno) if getattr(error, "errno", None) else _sentence(error)
            raise LabError(f"{self.folder} cannot be written ({reason}): choose another folder.") from error


class _Table:
    """Data sets that grow together along their first axis, and the rows not yet written."""

    def __init__(self, shapes: Mapping[str, tuple[tuple[int, ...], str]]) -> None:
        self._shapes = shapes
        self._rows: dict[str, list[np.ndarray]] = {name: [] for name in shapes}
        self._datasets: dict[str, h5py.Dataset] = {}
        self._row_bytes = sum(_row_bytes(*shape) for shape in shapes.values())

    @property
    def pending_bytes(self) -> int:
        return len(self._rows["time"]) * self._row_bytes

    def create(self, group: h5py.Group) -> None:
        for name, (shape, kind) in self._shapes.items():
            rows = max(1, min(CHUNK_ROWS, CHUNK_BYTES // _row_bytes(shape, kind)))
            self._datasets[name] = group.create_dataset(
                name, (0, *shape), kind, maxshape=(None, *shape), chunks=(rows, *shape)
            )

    def add(self, values: Mapping[str, object]) -> None:
        if values.keys() != self._shapes.keys():
            raise ValueError(f"a row has {sorted(values)}, the table {sorted(self._shapes)}")
        row = {}
        for name, (shape, kind) in self._shapes.items():
            row[name] = np.array(values[name], dtype=kind)  # a copy: the caller may reuse its array
            if row[name].shape != shape:
                raise ValueError(f"{name} has the shape {row[name].shape}, the table {shape}")
        for name, value in row.items():
            self._rows[name].append(value)

    def write(self) -> None:
        count = len(self._rows["time"])
        if not count:
            return
        for name, dataset in self._datasets.items():
            written = len(dataset)
            dataset.resize(written + count, axis=0)
            dataset[written:] = np.stack(self._rows[name])
        for rows in self._rows.values():
            rows.clear()


class Recording:
    """A recording opened for reading: a context manager; arrays are read when they are asked for.

    path, folder; name: of the preset; given: its TOML text; preset: all its values in SI, nested as
    in the TOML; status, created, versions, machine, step (s), wall_s, grain_steps;
    radius (W, n) m; outline (m, 2) m.
    series: "time" (T,) s and the names of SERIES, whole arrays (T, W, ...).
    frames: "time" (F,) s and the names of GRAIN_FRAMES and WORLD_FRAMES, (F, W, ...), read from the
    file by indexing: `recording.frames["position"][-1]`.
    Both end where the shortest of their arrays ends. Raises LabError when the file is missing,
    foreign or damaged.
    """

    def __init__(self, path: Path | str) -> None:
        self.path = Path(path)
        if self.path.is_dir():
            self.path = self.path / FILE_NAME
        self.folder = self.path.parent
        self._file = _open(self.path)
        with _reading(self.path):
            attributes = dict(self._file.attrs)
            self.name, self.status = str(attributes["preset"]), str(attributes["status"])
            self.created = str(attributes["created"])
            self.versions = json.loads(attributes["versions"])
            self.machine = json.loads(attributes["machine"])
            self.step, self.wall_s = float(attributes["step"]), float(attributes["wall_s"])
            self.grain_steps = int(attributes["grain_steps"])
            self.given = self._file["preset/given"].asstr()[()]
            self.preset = json.loads(self._file["preset/resolved"].asstr()[()])
            self.radius, self.outline = (
                self._file["grains/radius"][:],
                self._file["tank/outline"][:],
            )
            shapes = _table_shapes(*self.radius.shape)
            self.series = Series(self._file["series"], shapes["series"], self.path)
            self.frames = Frames(self._file["frames"], shapes["frames"], self.path)

    @property
    def worlds(self) -> int:
        """W, the beds recorded side by side."""
        return len(self.radius)

    @property
    def mean_diameter(self) -> np.ndarray:
        """Mean grain diameter of each world (W,), m."""
        return 2.0 * self.radius.mean(axis=1)

    @property
    def complete(self) -> bool:
        """Whether the run came to its end."""
        return self.status == "complete"

    def close(self) -> None:
        """Close the file; what was not read before cannot be read any more."""
        self._file.close()

    def __enter__(self) -> "Recording":
        return self

    def __exit__(self, *error: object) -> None:
        self.close()


class Frames(Mapping):
    """The data sets of a group by name, each cut to the length that all of them have."""

    def __init__(self, group: h5py.Group, names: Mapping, path: Path) -> None:
        self._path = path
        self._columns = {name: group[name] for name in names}
        self._length = min(len(dataset) for dataset in self._columns.values())

    def __getitem__(self, name: str) -> "Column":
        return Column(self._columns[name], self._length, self._path)

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)


class Series(Frames):
    """As Frames, but whole arrays, read once and kept."""

    def __init__(self, group: h5py.Group, names: Mapping, path: Path) -> None:
        super().__init__(group, names, path)
        self._read: dict[str, np.ndarray] = {}

    def __getitem__(self, name: str) -> np.ndarray:
        if name not in self._read:
            self._read[name] = super().__getitem__(name)[:]
        return self._read[name]


class Column:
    """One data set, read by indexing its first axis with a number or a slice."""

    def __init__(self, dataset: h5py.Dataset, length: int, path: Path) -> None:
        self._dataset, self._path = dataset, path
        self.shape = (length, *dataset.shape[1:])

    def __len__(self) -> int:
        return self.shape[0]

    def __getitem__(self, index: int | slice) -> np.ndarray:
        whole = range(len(self))
        rows = slice(*index.indices(len(self))) if isinstance(index, slice) else whole[index]
        with _reading(self._path):
            return self._dataset[rows]


def open_recording(path: Path | str) -> Recording:
    """Open a recording, given as its file or its run's folder. Raises LabError (see Recording)."""
    return Recording(path)


def _open(path: Path) -> h5py.File:
    if not path.is_file():
        raise LabError(f"{path} does not exist: name a recording or the folder of a run.")
    try:
        file = _open_closed_or_live(path)
    except PermissionError as error:
        raise LabError(f"{path} may not be read: ask for the right to read it.") from error
    except OSError as error:
        raise LabError(f"{path} cannot be read as a recording: it is cut short or another kind of file.") from error
    form = file.attrs.get("format")
    if form == FORMAT:
        return file
    file.close()
    if str(form).startswith(FORMAT.split()[0]):
        raise LabError(f"{path} was written by another version ('{form}'): record the run again.")
    raise LabError(f"{path} is not a recording of this lab: name another file.")


def _open_closed_or_live(path: Path) -> h5py.File:
    """Open in SWMR mode only what was never closed: HDF5 rereads a damaged file for ever in it."""
    try:
        return h5py.File(path, "r")
    except OSError as error:
        if "already open for write" not in str(error):
            raise
        return h5py.File(path, "r", swmr=True)


@contextmanager
def _reading(path: Path) -> Iterator[None]:
    try:
        yield
    except (OSError, RuntimeError, KeyError, ValueError, TypeError) as error:
        raise LabError(f"{path} is damaged ({_sentence(error)}): record the run again.") from error


def _table_shapes(worlds: int, count: int) -> dict[str, dict[str, tuple[tuple[int, ...], str]]]:
    """Shape of a row and kind of number of every data set that grows."""
    time = {"time": ((), "f8")}
    return {
        "series": time | {name: ((worlds, *shape), "f8") for name, shape in SERIES.items()},
        "frames": time
        | {name: ((worlds, *shape), "f8") for name, shape in WORLD_FRAMES.items()}
        | {name: ((worlds, count, *shape), "f4") for name, shape in GRAIN_FRAMES.items()},
    }


def _row_bytes(shape: tuple[int, ...], kind: str) -> int:
    return int(np.prod(shape, dtype=int)) * np.dtype(kind).itemsize


def _versions() -> dict[str, str]:
    found = {"python": platform.python_version()}
    for package in PACKAGES:
        try:
            found[package] = metadata.version(package)
        except metadata.PackageNotFoundError:
            continue
    return found


def _machine() -> dict[str, object]:
    return {
        "system": platform.platform(),
        "processor": platform.processor() or platform.machine(),
        "cores": os.cpu_count(),
    }


def _sentence(error: BaseException) -> str:
    """The first line of what an exception says, or its name."""
    if isinstance(error, KeyboardInterrupt):
        return "interrupted by the user"
    return (str(error).strip().splitlines() or [type(error).__name__])[0]
