"""Writing recordings: a new one, and rows added to it or to one that a dead run has left."""

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

from lab import __version__
from lab.base.errors import LabError, Useless
from lab.base.trust import attribute_words, format_of
from lab.preset.ship import axis_place, recorded_ship
from lab.recording.checks import Checks, row_checks
from lab.recording.layout import (
    CHECKS,
    COLUMNS,
    FILE_NAME,
    FORMAT,
    STANDING,
    create_tables,
    fixed_text,
    row_bytes,
    sentence,
    store,
    tables_of,
)
from lab.recording.opening import create, end_of, open_to_add
from lab.recording.outlines import GROUP, Outlines, outline_tables

BUFFER_BYTES = 2**25  # kept in memory at most before it is written
FLUSH_EVERY = 2.0  # s of wall-clock time between writings: what a run that is killed may lose
SPARE_BYTES = 2**22  # room kept beside that for a chunk of each data set, to close the file and to sum up the run
LONGEST_STATUS = 500  # bytes
FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
PACKAGES = ("taichi", "numpy", "scipy", "h5py")


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
    shapes: Outlines | None = None,
    machine: Mapping | None = None,
    steered: bool = False,
) -> Path:
    """Make the recording of a run, without rows yet; returns its file.

    folder: where recording.h5 is made, created if missing; preset: its name; given: its TOML text;
    resolved: all its values in SI; radius (W, n) m; outline (m, 2) m; step: the time step, s;
    kind (W, n): numbers of the kinds of grains, 0 of the preset's material, or None;
    fixed (k, 3): y, z, radius m of grains that never move; open_edges: outline edges without a wall;
    parts: moving parts by name, polylines at rest (m, 2) m; shapes: outlines of irregular grains, None
    where all are discs; machine: what runs it (added to what is found out here); steered: whether a hand
    moves the tank. The file appears under
    its name when it is whole, so that it is readable from then on. Raises LabError when the folder
    cannot be written, is full, or already holds a recording.
    """
    path = Path(folder) / FILE_NAME
    radius, parts = np.asarray(radius, dtype=float), parts or {}
    tables = outline_tables(shapes) if shapes else {}
    attributes = {
        "format": fixed_text(FORMAT),
        "preset": fixed_text(preset),
        "status": _status("running"),
        "created": fixed_text(datetime.now().astimezone().isoformat(timespec="seconds")),
        "versions": fixed_text(json.dumps(versions())),
        "machine": fixed_text(json.dumps({**_machine(), **(machine or {})})),
        "step": float(step),
        "wall_s": 0.0,
        "grain_steps": 0,
        **_reference(resolved),
    }
    with _writing(path.parent):
        path.parent.mkdir(parents=True, exist_ok=True)
        if path.exists():
            raise FileExistsError(path)
        with create(_unfinished(path)) as file:
            tables_bytes = sum(table.nbytes for table in tables.values())
            _reserve(file, radius.nbytes + tables_bytes + len(given) + SPARE_BYTES)
            file.attrs.update(attributes)
            store(file, "preset/given", fixed_text(given)[None])
            store(file, "preset/resolved", fixed_text(json.dumps(resolved))[None])
            store(file, "grains/radius", radius)
            store(file, "grains/kind", np.zeros(radius.shape, "u1") if kind is None else np.asarray(kind, dtype="u1"))
            store(file, "tank/outline", np.asarray(outline, dtype=float))
            store(file, "tank/fixed", np.asarray(fixed, dtype=float).reshape(-1, 3))
            store(file, "tank/open_edges", np.asarray(open_edges, dtype=int))
            file.create_group("tank/parts", track_order=True)
            for name, line in parts.items():
                store(file, f"tank/parts/{name}", np.asarray(line, dtype=float))
            for name, table in tables.items():
                store(file, f"{GROUP}/{name}", table)
            sizes = dict(zip(("world", "grain"), radius.shape, strict=True)) | {"part": len(parts)}
            create_tables(file, tables_of(bool(resolved.get("ship")), steered), sizes)
        _publish(path)
    return path


class Recorder:
    """Adds rows to a recording; a context manager that closes it with the right status.

    folder: of the recording, new or left by a run that was killed or stopped; samples, frames: rows of the series and
    of the frames that stand, those behind them stay until they are written over as they come again; flush_every:
    wall-clock seconds between writings, so what a killed run loses; buffer: bytes kept in memory at most. The runner
    keeps `wall_s` and `grain_steps` up to date; every flush writes them. Raises LabError when the folder cannot be
    written, or when fewer rows are there than should stand; Useless when one of those is damaged.
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
        with self._writing(), ExitStack() as otherwise:
            self._file = open_to_add(self.path)
            otherwise.callback(self._file.close)
            self.wall_s, self.grain_steps = float(self._file.attrs["wall_s"]), int(self._file.attrs["grain_steps"])
            if format_of(self._file) != FORMAT:
                raise Useless(f"{self.path} was begun by another version: start the run anew.")
            standing = {"series": samples, "frames": frames}
            standing |= {"steering": 0} if "steering" in self._file else {}
            self._tables = {name: _Table(self._file, name, rows) for name, rows in standing.items()}
            self._spare = SPARE_BYTES + sum(table.chunk_bytes for table in self._tables.values())
            if any(table.short for table in self._tables.values()):
                raise LabError(f"{self.path} holds less than its checkpoint says: start the run anew.")
            for table in self._tables.values():
                if damaged := table.damage():
                    raise Useless(f"{self.path}: {damaged}, before its checkpoint: start the run anew.")
            self._reserved = 0
            self._make_room()
            self._file.attrs.modify("status", _status("running"))
            otherwise.pop_all()  # all is well: it stays open

    def sample(self, values: Mapping[str, object]) -> None:
        """Add a row to the series: "time" (s) and every other quantity of it, (W, *shape) each."""
        self._add("series", values)

    def frame(self, values: Mapping[str, object]) -> None:
        """Add a picture frame: "time" (s) and every other quantity of it, one for each that has it."""
        self._add("frames", values)

    def steer(self, time: float, name: str, value: float) -> None:
        """Add what a hand did: it set a control to a value (SI) at a time (s)."""
        self._add("steering", {"time": time, "name": name.encode(), "value": value})

    @property
    def series(self) -> tuple[str, ...]:
        """Names of what the series hold, time first."""
        return self._tables["series"].names

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
            self.close(f"stopped: {sentence(error)}")

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
    """Data sets that grow together along their first axis, their checksums, and the rows not yet written.

    The first `rows` rows of the data sets stand; `short` says whether there are so many.
    """

    def __init__(self, file: h5py.File, table: str, rows: int) -> None:
        group, self._checks = file[table], file[f"{CHECKS}/{table}"]
        self.names = tuple(attribute_words(self._checks, COLUMNS))
        self._datasets: dict[str, h5py.Dataset] = {name: group[name] for name in self.names}
        self._rows: dict[str, list[np.ndarray]] = {name: [] for name in self.names}
        self._row = {name: (data.shape[1:], data.dtype) for name, data in self._datasets.items()}  # h5py is slow to ask
        grow = (*self._datasets.values(), self._checks)
        self._row_bytes = sum(row_bytes(data.shape[1:], data.dtype) for data in grow)
        self._written = rows
        self.chunk_bytes = sum(row_bytes(data.chunks, data.dtype) for data in grow)
        self.short = any(len(data) < rows for data in grow)

    def damage(self) -> str:
        """What is damaged of the rows that stand, in words; empty where nothing is."""
        checks = Checks(self._checks)
        for data in self._datasets.values():
            row = checks.first_bad(data, 0, self._written)
            if row < self._written:
                return f"{data.name[1:]} is damaged from row {row} of {self._written}"
        return ""

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
        for name, (shape, kind) in self._row.items():
            row[name] = np.array(values[name], dtype=kind)  # a copy: the caller may reuse its array
            if row[name].shape != shape:
                raise ValueError(f"{name} has the shape {row[name].shape}, the table {shape}")
        for name, value in row.items():
            self._rows[name].append(value)

    def write(self) -> None:
        if not self._rows["time"]:
            return
        end, checks = self.rows, []
        for name, data in self._datasets.items():
            values = np.stack(self._rows[name])
            checks.append(row_checks(values))
            self._put(data, end, values)
        self._put(self._checks, end, np.stack(checks, axis=1))
        self._checks.attrs.modify(STANDING, end)
        self._written = end
        for rows in self._rows.values():
            rows.clear()

    def _put(self, data: h5py.Dataset, end: int, values: np.ndarray) -> None:
        if len(data) < end:
            data.resize(end, axis=0)
        data[self._written : end] = values


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
    os.truncate(path, end_of(path))


@contextmanager
def _writing(folder: Path) -> Iterator[None]:
    """Turn what the system or HDF5 says against writing into one sentence."""
    try:
        yield
    except FileExistsError as error:
        raise LabError(f"{folder} already holds a recording or is a file: choose another folder.") from error
    except (OSError, RuntimeError) as error:
        number = getattr(error, "errno", None)
        reason = os.strerror(number) if number else sentence(error)
        remedy = "make room there" if number in FULL else "choose another folder"
        raise LabError(f"{folder} cannot be written ({reason}): {remedy}.") from error


def versions() -> dict[str, str]:
    """Of the lab, of Python and of the packages whose results a recording holds."""
    found = {"cargo-shift-lab": __version__, "python": platform.python_version()}
    for package in PACKAGES:
        try:
            found[package] = metadata.version(package)
        except metadata.PackageNotFoundError:
            continue
    return found


def _reference(resolved: Mapping) -> dict[str, object]:
    """What point the poses are of, and of a ship her axis, of which sway and heave are told: see `lab.preset.ship`."""
    found = {"pose_is_of": fixed_text("the origin of the tank's axes")}
    if resolved.get("ship"):
        ship = recorded_ship(resolved)
        found["ship_axis"] = np.array(ship.about)
        found["ship_axis_in_tank"] = np.subtract(ship.about, ship.hold)
        found["sway_and_heave_are_of"] = fixed_text(f"the ship's axis, {axis_place(ship)}")
    return found


def _machine() -> dict[str, object]:
    return {
        "system": platform.platform(),
        "processor": platform.processor() or platform.machine(),
        "cores": os.cpu_count(),
    }
