"""What a run leaves behind: one HDF5 file, written as the run goes on and readable at any moment.

`new_recording` makes the file, a `Recorder` adds to it, `mend_recording` readies what a dead run left for another
Recorder, and `open_recording` reads it. The file is written in HDF5's single-writer/multiple-reader mode (SWMR):
every flush leaves a whole file behind, so a run that is killed, or that still goes on, can be read up to its last
flush. Other programs must ask for that mode too: `h5py.File(path, "r", swmr=True)`.
"""

import errno
import json
import os
import platform
import shutil
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager, suppress
from datetime import datetime
from importlib import metadata
from pathlib import Path

import h5py
import numpy as np

from lab.errors import LabError

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
GRAIN_FRAMES = {"position": (2,), "velocity": (2,), "angle": (), "spin": ()}
WORLD_FRAMES = {"pose": (3,)}  # and "part" (P, 2), the displacement of each moving part

CHUNK_BYTES = 2**19  # about what one reads of a data set at a time
CHUNK_ROWS = 1024
BUFFER_BYTES = 2**25  # kept in memory at most before it is written
FLUSH_EVERY = 2.0  # s of wall-clock time between writings: what a run that is killed may lose
SPARE_BYTES = 2**22  # room kept beside that for a chunk of each data set, to close the file and to sum up the run
PATIENCE, A_MOMENT = 100, 0.02  # how often, and every how many s, a file is tried that another process has open
LONGEST_STATUS = 500  # bytes
FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
PACKAGES = ("cargo-shift-lab", "taichi", "numpy", "scipy", "h5py")


def new_recording(
    folder: Path | str,
    *,
    preset: str,
    given: str,
    resolved: Mapping,
    radius: np.ndarray,
    outline: np.ndarray,
    step: float,
    kind: np.ndarray | None = None,
    fixed: np.ndarray = (),
    open_edges: Sequence[int] = (),
    parts: Mapping[str, np.ndarray] | None = None,
    machine: Mapping | None = None,
) -> Path:
    """Make the recording of a run, without rows yet; returns its file.

    folder: where recording.h5 is made, created if missing; preset: its name; given: its TOML text;
    resolved: all its values in SI; radius (W, n) m; outline (m, 2) m; step: the time step, s;
    kind (W, n): numbers of the kinds of grains, 0 of the preset's material, or None;
    fixed (k, 3): y, z, radius m of grains that never move; open_edges: outline edges without a wall;
    parts: moving parts by name, polylines at rest (m, 2) m; machine: what runs it (added to what is
    found out here). The file appears under its name when it is whole, so that it is readable from then
    on. Raises LabError when the folder cannot be written, is full, or already holds a recording.
    """
    path = Path(folder) / FILE_NAME
    radius, parts = np.asarray(radius, dtype=float), parts or {}
    attributes = {
        "format": FORMAT,
        "preset": preset,
        "status": _status("running"),
        "created": datetime.now().astimezone().isoformat(timespec="seconds"),
        "versions": json.dumps(versions()),
        "machine": json.dumps({**_machine(), **(machine or {})}),
        "step": float(step),
        "wall_s": 0.0,
        "grain_steps": 0,
    }
    with _writing(path.parent):
        path.parent.mkdir(parents=True, exist_ok=True)
        if path.exists():
            raise FileExistsError(path)
        with h5py.File(_unfinished(path), "w", libver="latest") as file:
            _reserve(file, radius.nbytes + len(given) + SPARE_BYTES)
            file.attrs.update(attributes)
            file["preset/given"] = given
            file["preset/resolved"] = json.dumps(resolved)
            file["grains/radius"] = radius
            file["grains/kind"] = np.zeros(radius.shape, dtype="u1") if kind is None else np.asarray(kind, dtype="u1")
            file["tank/outline"] = np.asarray(outline, dtype=float)
            file["tank/fixed"] = np.asarray(fixed, dtype=float).reshape(-1, 3)
            file["tank/open_edges"] = np.asarray(open_edges, dtype=int)
            group = file.create_group("tank/parts", track_order=True)
            for name, line in parts.items():
                group[name] = np.asarray(line, dtype=float)
            for name, shapes in _table_shapes(*radius.shape, len(parts)).items():
                _create_table(file.create_group(name), shapes)
        _publish(path)
    return path


def mend_recording(folder: Path | str) -> Path:
    """Copy a recording that was killed or stopped into a sound one that a Recorder can go on with; returns its file.

    All whole rows are kept. The old file stays until the copy is on the disk. Raises LabError when it cannot be read
    or the folder not be written.
    """
    path = Path(folder) / FILE_NAME
    size = path.stat().st_size if path.is_file() else 0
    with (
        open_recording(path) as old,
        _writing(path.parent),
        h5py.File(_unfinished(path), "w", libver="latest") as new,
    ):
        _reserve(new, size + SPARE_BYTES)
        old.copy_into(new)
        new.attrs["status"] = _status("running")
    with _writing(path.parent):
        _publish(path)
    return path


class Recorder:
    """Adds rows to a recording; a context manager that closes it with the right status.

    folder: of the recording, which `new_recording` or `mend_recording` has made; samples, frames: rows of the series
    and of the frames that stand, those behind them are written over as they come again; flush_every: wall-clock
    seconds between writings, so what a killed run loses; buffer: bytes kept in memory at most. The runner keeps
    `wall_s` and `grain_steps` up to date; every flush writes them. Raises LabError when the folder cannot be written,
    or when fewer rows are there than should stand.
    """

    def __init__(
        self,
        folder: Path | str,
        *,
        samples: int = 0,
        frames: int = 0,
        flush_every: float = FLUSH_EVERY,
        buffer: int = BUFFER_BYTES,
    ) -> None:
        self.folder = Path(folder)
        self.path = self.folder / FILE_NAME
        self._flush_every, self._flushed, self._buffer = flush_every, time.monotonic(), buffer
        with self._writing():
            self._file = _open_for_adding(self.path)
            self.wall_s, self.grain_steps = float(self._file.attrs["wall_s"]), int(self._file.attrs["grain_steps"])
            standing = {"series": samples, "frames": frames}
            self._tables = {name: _Table(self._file[name], rows) for name, rows in standing.items()}
            self._spare = SPARE_BYTES + sum(table.chunk_bytes for table in self._tables.values())
            self._reserved = 0
            self._make_room()
        if any(table.short for table in self._tables.values()):
            self._file.close()
            raise LabError(f"{self.path} holds less than its checkpoint says: start the run anew.")

    def sample(self, values: Mapping[str, object]) -> None:
        """Add a row to the series: "time" (s) and every name of SERIES, (W, *shape) each."""
        self._add("series", values)

    def frame(self, values: Mapping[str, object]) -> None:
        """Add a picture frame: "time" (s), "pose" (W, 3), "part" (W, P, 2) m and GRAIN_FRAMES, (W, n, *shape) each."""
        self._add("frames", values)

    @property
    def rows(self) -> tuple[int, int]:
        """Rows of the series and of the frames so far."""
        return self._tables["series"].rows, self._tables["frames"].rows

    def flush(self) -> None:
        """Write what has been added so far. Raises LabError when the folder is full or lost."""
        with self._writing():
            self._make_room()
            for table in self._tables.values():
                table.write()
            self._file.attrs.modify("wall_s", float(self.wall_s))
            self._file.attrs.modify("grain_steps", int(self.grain_steps))
            self._file.flush()
        self._flushed = time.monotonic()

    def sync(self) -> None:
        """Flush, and have the system put it all on the disk, where a power cut leaves it."""
        self.flush()
        with self._writing():
            os.fsync(self._file.id.get_vfd_handle())

    def close(self, status: str = "complete") -> None:
        """Write the rest and the status, "complete" or "stopped: <sentence>"; once is enough."""
        if not self._file:
            return
        try:
            self.flush()
        finally:
            with self._writing():
                self._file.attrs.modify("status", _status(status))
                self._file.close()
                _give_back(self.path)

    def __enter__(self) -> "Recorder":
        return self

    def __exit__(self, kind: type | None, error: BaseException | None, trace: object) -> None:
        if error is None:
            self.close()
            return
        with suppress(LabError):  # what stopped the run is the news
            self.close(f"stopped: {_sentence(error)}")

    @property
    def _pending(self) -> int:
        return sum(table.pending_bytes for table in self._tables.values())

    def _make_room(self) -> None:
        """Reserve what the rows to be written need and, by then, closing the file.

        HDF5 can neither go on nor close a file once a writing has failed, so it must not come to that.
        """
        needed = self._file.id.get_filesize() + self._pending + self._spare
        if needed > self._reserved:
            _reserve(self._file, needed + self._spare)
            self._reserved = needed + self._spare

    def _add(self, name: str, values: Mapping[str, object]) -> None:
        self._tables[name].add(values)
        if self._pending > self._buffer or time.monotonic() - self._flushed > self._flush_every:
            self.flush()

    def _writing(self):
        return _writing(self.folder)


class _Table:
    """Data sets that grow together along their first axis, and the rows not yet written.

    The first `rows` rows of the data sets stand; `short` says whether there are so many.
    """

    def __init__(self, group: h5py.Group, rows: int) -> None:
        self._datasets: dict[str, h5py.Dataset] = {name: group[name] for name in group}
        self._rows: dict[str, list[np.ndarray]] = {name: [] for name in group}
        self._row_bytes = sum(_row_bytes(data.shape[1:], data.dtype) for data in self._datasets.values())
        self._written = rows
        self.chunk_bytes = sum(_row_bytes(data.chunks, data.dtype) for data in self._datasets.values())
        self.short = any(len(data) < rows for data in self._datasets.values())

    @property
    def rows(self) -> int:
        return self._written + len(self._rows["time"])

    @property
    def pending_bytes(self) -> int:
        return len(self._rows["time"]) * self._row_bytes

    def add(self, values: Mapping[str, object]) -> None:
        if values.keys() != self._datasets.keys():
            raise ValueError(f"a row has {sorted(values)}, the table {sorted(self._datasets)}")
        row = {}
        for name, data in self._datasets.items():
            row[name] = np.array(values[name], dtype=data.dtype)  # a copy: the caller may reuse its array
            if row[name].shape != data.shape[1:]:
                raise ValueError(f"{name} has the shape {row[name].shape}, the table {data.shape[1:]}")
        for name, value in row.items():
            self._rows[name].append(value)

    def write(self) -> None:
        if not self._rows["time"]:
            return
        end = self.rows
        for name, data in self._datasets.items():
            if len(data) < end:
                data.resize(end, axis=0)
            data[self._written : end] = np.stack(self._rows[name])
        self._written = end
        for rows in self._rows.values():
            rows.clear()


def _create_table(group: h5py.Group, shapes: Mapping[str, tuple[tuple[int, ...], str]]) -> None:
    """Empty data sets with such rows, which can grow."""
    for name, (shape, kind) in shapes.items():
        rows = max(1, min(CHUNK_ROWS, CHUNK_BYTES // max(1, _row_bytes(shape, kind))))
        chunk = (rows, *(max(1, size) for size in shape))
        room = (None, *(size or None for size in shape))  # HDF5 wants chunks no larger than the data set may become
        group.create_dataset(name, (0, *shape), kind, maxshape=room, chunks=chunk)


class Recording:
    """A recording opened for reading: a context manager; arrays are read when they are asked for.

    path, folder; name: of the preset; given: its TOML text; preset: all its values in SI, nested as
    in the TOML; status, created, versions, machine, step (s), wall_s, grain_steps;
    radius (W, n) m; kind (W, n), 0 of the preset's material and further numbers in the order of its kinds;
    outline (m, 2) m; fixed (k, 3) y, z, radius m; open_edges; parts, polylines (m, 2) m by name.
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
        with ExitStack() as otherwise, _reading(self.path):
            otherwise.callback(self._file.close)
            attributes = dict(self._file.attrs)
            self.name, status = str(attributes["preset"]), attributes["status"]
            self.status = status.decode(errors="ignore") if isinstance(status, bytes) else str(status)
            self.created = str(attributes["created"])
            self.versions = json.loads(attributes["versions"])
            self.machine = json.loads(attributes["machine"])
            self.step, self.wall_s = float(attributes["step"]), float(attributes["wall_s"])
            self.grain_steps = int(attributes["grain_steps"])
            self.given = self._file["preset/given"].asstr()[()]
            self.preset = json.loads(self._file["preset/resolved"].asstr()[()])
            self.radius, self.kind = self._file["grains/radius"][:], self._file["grains/kind"][:]
            tank = self._file["tank"]
            self.outline, self.fixed = tank["outline"][:], tank["fixed"][:]
            self.open_edges = tuple(int(edge) for edge in tank["open_edges"][:])
            self.parts = {name: line[:] for name, line in tank["parts"].items()}
            shapes = _table_shapes(*self.radius.shape, len(self.parts))
            self.series = Series(self._file["series"], shapes["series"], self.path)
            self.frames = Frames(self._file["frames"], shapes["frames"], self.path)
            otherwise.pop_all()  # all is well: it stays open

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

    def layout(self, name: str) -> tuple[tuple[int, ...], np.dtype]:
        """Shape and kind of a data set of the file as it lies there."""
        with _reading(self.path):
            return self._file[name].shape, self._file[name].dtype

    def copy_into(self, file: h5py.File) -> None:
        """Copy everything into an empty file, each table as far as all its arrays go."""
        with _reading(self.path):
            file.attrs.update(self._file.attrs)
            for name in ("preset", "grains", "tank"):
                self._file.copy(name, file)
            for name, table in {"series": self.series, "frames": self.frames}.items():
                table.copy_into(file.create_group(name))

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

    def copy_into(self, group: h5py.Group) -> None:
        """Copy the data sets into an empty group, in blocks."""
        _create_table(group, {name: (data.shape[1:], data.dtype.str) for name, data in self._columns.items()})
        for name, data in self._columns.items():
            copy = group[name]
            copy.resize(self._length, axis=0)
            for begin in range(0, self._length, copy.chunks[0]):
                end = min(begin + copy.chunks[0], self._length)
                copy[begin:end] = data[begin:end]


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


def _open_for_adding(path: Path) -> h5py.File:
    """Open a closed file as the writer in SWMR mode, in one stroke.

    Opened first and switched to that mode then, as h5py does it, a file would be unreadable had the writer been killed
    in between. A reader's lock is waited for: who reads opens and closes, or has the file that was mended.
    """
    access = h5py.h5p.create(h5py.h5p.FILE_ACCESS)
    access.set_libver_bounds(h5py.h5f.LIBVER_LATEST, h5py.h5f.LIBVER_LATEST)
    for _ in range(PATIENCE):
        try:
            return h5py.File(h5py.h5f.open(os.fsencode(path), h5py.h5f.ACC_RDWR | h5py.h5f.ACC_SWMR_WRITE, access))
        except BlockingIOError:
            time.sleep(A_MOMENT)
    raise LabError(f"{path} is open in another program: close it there.")


def _open(path: Path) -> h5py.File:
    if not path.is_file():
        raise LabError(f"{path} does not exist: name a recording or the folder of a run.")
    try:
        file = _open_closed_or_live(path)
    except PermissionError as error:
        raise LabError(f"{path} may not be read: ask for the right to read it.") from error
    except OSError as error:
        raise LabError(f"{path} cannot be read as a recording: it is cut short or another kind of file.") from error
    with _reading(path):
        form = file.attrs.get("format")
    if form == FORMAT:
        return file
    file.close()
    if str(form).startswith(FORMAT.split()[0]):
        raise LabError(f"{path} was written by another version ('{form}'): record the run again.")
    raise LabError(f"{path} is not a recording of this lab: name another file.")


def _open_closed_or_live(path: Path) -> h5py.File:
    """Open in SWMR mode only what was never closed: HDF5 rereads a damaged file for ever in it.

    A writer that opens or closes the file just now is waited for.
    """
    error: OSError | None = None
    for _ in range(PATIENCE):
        try:
            return h5py.File(path, "r")
        except BlockingIOError as locked:
            error = locked
        except OSError as open_elsewhere:
            if "already open for write" not in str(open_elsewhere):
                raise
            with suppress(OSError):  # closed by now, or not yet in that mode
                return h5py.File(path, "r", swmr=True)
            error = open_elsewhere
        time.sleep(A_MOMENT)
    raise error


def _status(text: str) -> np.ndarray:
    """As it is stored: in a place of its own, so that it can be changed under a reader's eyes."""
    return np.array(text.encode()[:LONGEST_STATUS], h5py.string_dtype(length=LONGEST_STATUS))


def _unfinished(path: Path) -> Path:
    """The name a file goes by until it is whole."""
    return path.with_name(f"{path.name}.new")


def _publish(path: Path) -> None:
    """Put the unfinished file on the disk and give it its name, in one stroke."""
    with _unfinished(path).open("r+b") as file:
        os.fsync(file.fileno())
    _unfinished(path).replace(path)


def _reserve(file: h5py.File, size: int) -> None:
    """Have the system set aside `size` bytes for a file. Raises OSError where disk, quota or a limit have no room."""
    if hasattr(os, "posix_fallocate"):
        os.posix_fallocate(file.id.get_vfd_handle(), 0, size)
    elif shutil.disk_usage(file.filename).free < size - file.id.get_filesize():
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


def _give_back(path: Path) -> None:
    """Return what was reserved and not used: in SWMR mode HDF5 leaves it to the file."""
    with path.open("r+b") as file:
        head = file.read(36)  # of the superblock, whose last eight bytes here say where the file ends
        file.truncate(int.from_bytes(head[28:], "little"))


@contextmanager
def _writing(folder: Path) -> Iterator[None]:
    """Turn what the system or HDF5 says against writing into one sentence."""
    try:
        yield
    except FileExistsError as error:
        raise LabError(f"{folder} already holds a recording or is a file: choose another folder.") from error
    except (OSError, RuntimeError) as error:
        number = getattr(error, "errno", None)
        reason = os.strerror(number) if number else _sentence(error)
        remedy = "make room there" if number in FULL else "choose another folder"
        raise LabError(f"{folder} cannot be written ({reason}): {remedy}.") from error


@contextmanager
def _reading(path: Path) -> Iterator[None]:
    try:
        yield
    except (OSError, RuntimeError, KeyError, ValueError, TypeError, AttributeError) as error:
        raise LabError(f"{path} is damaged ({_sentence(error)}): record the run again.") from error


def _table_shapes(worlds: int, count: int, parts: int) -> dict[str, dict[str, tuple[tuple[int, ...], str]]]:
    """Shape of a row and kind of number of every data set that grows."""
    time = {"time": ((), "f8")}
    return {
        "series": time | {name: ((worlds, *shape), "f8") for name, shape in SERIES.items()},
        "frames": time
        | {name: ((worlds, *shape), "f8") for name, shape in WORLD_FRAMES.items()}
        | {"part": ((worlds, parts, 2), "f8")}
        | {name: ((worlds, count, *shape), "f4") for name, shape in GRAIN_FRAMES.items()},
    }


def _row_bytes(shape: tuple[int, ...], kind: str) -> int:
    return int(np.prod(shape, dtype=int)) * np.dtype(kind).itemsize


def versions() -> dict[str, str]:
    """Of Python and of the packages whose results a recording holds."""
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
