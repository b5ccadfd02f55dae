"""Write recordings: create a new one, and append rows to it, also after an interruption."""

import errno
import json
import os
import shutil
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager, suppress
from datetime import datetime
from pathlib import Path

import h5py
import numpy as np

from lab.base.errors import LabError, Unusable
from lab.base.files import replacing
from lab.base.trust import attribute_words, format_of
from lab.preset import recorded
from lab.recording import older
from lab.recording.checks import Checks, row_checks
from lab.recording.layout import (
    CHECKS,
    COLUMNS,
    FILE_NAME,
    FLUSHED_ROWS,
    FORMAT,
    PARTS,
    create_tables,
    fixed_text,
    names_of,
    row_bytes,
    sentence,
    store,
    tables_of,
)
from lab.recording.opening import create, end_of, open_to_add
from lab.recording.origin import reference_points, this_machine, versions
from lab.recording.outlines import GROUP, Outlines, outline_tables
from lab.recording.own import with_own

BUFFER_BYTES = 2**25  # most that is kept in memory before it is written
FLUSH_EVERY = 2.0  # wall-clock time (s) between flushes, which a killed run may lose
SPARE_BYTES = 2**22  # disk space reserved in addition, to close the file and to write the run's summary
LONGEST_STATUS = 500  # bytes
FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)  # errors of a full disk or quota


def new_recording(
    folder: Path | str,
    *,
    preset: str,
    given: str,
    resolved: "recorded.Preset",
    radius: np.ndarray,
    outline: np.ndarray,
    step: float,
    volume: np.ndarray | None = None,
    air: np.ndarray | None = None,
    bulk: np.ndarray | None = None,
    kind: np.ndarray | None = None,
    fixed: np.ndarray = (),
    open_edges: Sequence[int] = (),
    parts: Mapping[str, np.ndarray] | None = None,
    shapes: Outlines | None = None,
    machine: Mapping | None = None,
    steered: bool = False,
) -> Path:
    """Create the recording of a run, without rows yet; returns its file.

    folder: of the new recording.h5, created if missing; preset: its name; given: its TOML text; resolved: the preset
    itself; radius (W, n) m, n is 0 without grains; outline (m, 2) m; step: the time step, s; volume, air, bulk (W, n)
    m²: of particles of water and air and of points, None without; kind (W, n): numbers of the kinds of grains, 0 for
    the preset's material, None if all are 0; fixed (k, 3): y, z, radius m of the fixed grains; open_edges: those with
    no wall; parts: moving parts by name, polylines at rest (m, 2) m; shapes: outlines of irregular grains, None if all
    are discs; machine: device and threads, added to the data found here; steered: whether the user steers the run.
    The file gets its name only when it is complete. Raises LabError if the folder cannot be written, is full, or
    already holds a recording.
    """
    path = Path(folder) / FILE_NAME
    radius, parts, tables = np.asarray(radius, dtype=float), parts or {}, outline_tables(shapes) if shapes else {}
    attributes = {
        "format": fixed_text(FORMAT),
        "preset": fixed_text(preset),
        "status": _status("running"),
        "created": fixed_text(datetime.now().astimezone().isoformat(timespec="seconds")),
        "versions": fixed_text(json.dumps(versions())),
        "machine": fixed_text(json.dumps({**this_machine(), **(machine or {})})),
        "step": float(step),
        "wall_s": 0.0,
        "grain_steps": 0,
        **reference_points(resolved),
    }
    with _writing(path.parent):
        path.parent.mkdir(parents=True, exist_ok=True)
        if path.exists():
            raise FileExistsError(path)
        with _new(path) as file:
            _reserve(file, radius.nbytes + sum(table.nbytes for table in tables.values()) + len(given) + SPARE_BYTES)
            file.attrs.update(attributes)
            store(file, "preset/given", fixed_text(given)[None])
            store(file, "preset/resolved", fixed_text(json.dumps(recorded.to_table(resolved)))[None])
            if radius.size:
                store(file, "grains/radius", radius)
                store(file, "grains/kind", np.asarray(np.zeros(radius.shape) if kind is None else kind, dtype="u1"))
            for phase, of_phase in {"water": volume, "air": air, "bulk": bulk}.items():
                if of_phase is not None and of_phase.size:
                    store(file, f"{phase}/volume", np.asarray(of_phase, dtype=float))
            store(file, "tank/outline", np.asarray(outline, dtype=float))
            store(file, "tank/fixed", np.asarray(fixed, dtype=float).reshape(-1, 3))
            store(file, "tank/open_edges", np.asarray(open_edges, dtype=int))
            file.create_group(PARTS, track_order=True)
            for name, line in parts.items():
                store(file, f"{PARTS}/{name}", np.asarray(line, dtype=float))
            for name, table in tables.items():
                store(file, f"{GROUP}/{name}", table)
            names = names_of(resolved, parts)
            create_tables(file, with_own(tables_of(resolved, steered)), names, radius, volume, air, bulk)
    return path


class Recorder:
    """Appends rows to a recording; a context manager that closes it with its final status.

    folder: of the recording, new or of an interrupted run; samples, frames, actions: numbers of rows of the series, of
    the frames and of what the user did to keep; later rows are overwritten as the run continues; flush_every: seconds
    of wall-clock time between flushes, which a killed run may lose; buffer: most bytes kept in memory. The caller keeps
    `wall_s` and `grain_steps` up to date; every flush writes them. Raises LabError if the folder cannot be written or
    has fewer rows than are to be kept, Unusable if one of these is damaged.
    """

    def __init__(
        self,
        folder: Path | str,
        *,
        samples: int = 0,
        frames: int = 0,
        actions: int = 0,
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
            if format_of(self._file) not in (FORMAT, older.WITH_OTHER_NAMES):
                raise Unusable(f"{self.path} was begun by another version: start the run again.")
            kept = {"series": samples, "frames": frames} | ({"steering": actions} if "steering" in self._file else {})
            self._tables = {name: _Table(self._file, name, rows) for name, rows in kept.items()}
            self._spare = SPARE_BYTES + sum(table.chunk_bytes for table in self._tables.values())
            if any(table.short for table in self._tables.values()):
                raise LabError(f"{self.path} has fewer rows than its checkpoint: start the run again.")
            for table in self._tables.values():
                if damaged := table.damage():
                    raise Unusable(f"{self.path}: {damaged}, before its checkpoint: start the run again.")
            self._reserved = 0
            self._make_room()
            self._file.attrs.modify("status", _status("running"))
            otherwise.pop_all()  # no error: the file stays open

    def sample(self, values: Mapping[str, object]) -> None:
        """Add a row to the series: "time" (s) and each of its other quantities, (W, *shape)."""
        self._add("series", values)

    def frame(self, values: Mapping[str, object]) -> None:
        """Add a picture frame: "time" (s) and each of its other quantities, for every world, grain or part."""
        self._add("frames", values)

    def steer(self, time: float, name: str, value: float) -> None:
        """Add an action of the user: a control was set to a value (SI) at a time (s)."""
        self._add("steering", {"time": time, "name": name.encode(), "value": value})

    @property
    def series(self) -> tuple[str, ...]:
        """Names of the quantities in the series, time first."""
        return self._tables["series"].names

    @property
    def rows(self) -> tuple[int, int]:
        """Numbers of rows of the series and of the frames so far."""
        return self._tables["series"].rows, self._tables["frames"].rows

    def flush(self) -> None:
        """Write the rows added so far to the file. Raises LabError if that fails."""
        with self._writing():
            self._make_room()
            for table in self._tables.values():
                table.write()
            self._file.attrs.modify("wall_s", float(self.wall_s))
            self._file.attrs.modify("grain_steps", int(self.grain_steps))
            self._file.flush()
        self._flushed = time.monotonic()

    def sync(self) -> None:
        """Flush, and make the system write everything to the disk, so that it survives a power failure."""
        self.flush()
        with self._writing():
            os.fsync(self._file.id.get_vfd_handle())

    def close(self, status: str = "complete") -> None:
        """Write the remaining rows and the status, "complete" or "stopped: <sentence>"; further calls do nothing."""
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
        with suppress(LabError):  # the error that stopped the run is the one to report
            self.close(f"stopped: {sentence(error)}")

    @property
    def _pending(self) -> int:
        return sum(table.pending_bytes for table in self._tables.values())

    def _make_room(self) -> None:
        """Reserve disk space for the pending rows and for closing the file.

        Once a write has failed, HDF5 can neither continue nor close the file, so space is reserved before writing.
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

    rows: number of rows to keep; `short`: whether a data set has fewer.
    """

    def __init__(self, file: h5py.File, table: str, rows: int) -> None:
        group, self._checks = file[table], file[f"{CHECKS}/{table}"]
        self._datasets = {older.present(name): group[name] for name in attribute_words(self._checks, COLUMNS)}
        self.names = tuple(self._datasets)
        self._rows: dict[str, list[np.ndarray]] = {name: [] for name in self.names}
        self._row = {name: (data.shape[1:], data.dtype) for name, data in self._datasets.items()}  # slow in h5py
        self._written, grow = rows, (*self._datasets.values(), self._checks)
        self._row_bytes = sum(row_bytes(data.shape[1:], data.dtype) for data in grow)
        self.chunk_bytes = sum(row_bytes(data.chunks, data.dtype) for data in grow)
        self.short = any(len(data) < rows for data in grow)

    def damage(self) -> str:
        """A text on the first damaged row among those kept; empty if there is none."""
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
        if values.keys() - older.ADDED != self._datasets.keys() - older.ADDED:
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
        self._checks.attrs.modify(FLUSHED_ROWS, end)
        self._written = end
        for rows in self._rows.values():
            rows.clear()

    def _put(self, data: h5py.Dataset, end: int, values: np.ndarray) -> None:
        if len(data) < end:
            data.resize(end, axis=0)
        data[self._written : end] = values


def _status(text: str) -> np.ndarray:
    """A status as a string of fixed length, so that it can be changed in place while others read the file."""
    return np.array(text.encode()[:LONGEST_STATUS], h5py.string_dtype(length=LONGEST_STATUS))


@contextmanager
def _new(path: Path) -> Iterator[h5py.File]:
    """A new file that gets its name once it is complete and on the disk."""
    with replacing(path) as part:
        with create(part) as file:
            yield file
        with part.open("r+b") as written:
            os.fsync(written.fileno())


def _reserve(file: h5py.File, size: int) -> None:
    """Reserve `size` bytes of disk space for a file. Raises OSError if disk, quota or file-size limit forbid it."""
    if hasattr(os, "posix_fallocate"):
        os.posix_fallocate(file.id.get_vfd_handle(), 0, size)
    elif shutil.disk_usage(file.filename).free < size - file.id.get_filesize():
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


def _give_back(path: Path) -> None:
    """Cut off reserved space that was not used, which HDF5 does not do in SWMR mode."""
    os.truncate(path, end_of(path))


@contextmanager
def _writing(folder: Path) -> Iterator[None]:
    """Turn errors of the system or of HDF5 during writing into a LabError with one sentence."""
    try:
        yield
    except FileExistsError as error:
        raise LabError(f"{folder} already holds a recording or is a file: choose another folder.") from error
    except (OSError, RuntimeError) as error:
        number = getattr(error, "errno", None)
        reason = os.strerror(number) if number else sentence(error)
        remedy = "make room there" if number in FULL else "choose another folder"
        raise LabError(f"{folder} cannot be written ({reason}): {remedy}.") from error
