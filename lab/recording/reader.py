"""Reading recordings: the file checked as it is opened, arrays read when they are asked for."""

import json
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager
from pathlib import Path

import h5py
import numpy as np

from lab.base.errors import LabError, NotRecorded, Useless
from lab.base.trust import BEYOND, attributes, check_recording, check_room, format_of, is_preset, text
from lab.preset.units import quoted
from lab.recording.layout import ADDED, FILE_NAME, FORMAT, STEERING, sentence, table_shapes
from lab.recording.opening import open_to_read
from lab.recording.outlines import GROUP, read_outlines
from lab.recording.words import axes, indexed, recorded_by


class Recording:
    """A recording opened for reading: a context manager; arrays are read when they are asked for.

    path, folder; name: of the preset; given: its TOML text; preset: all its values in SI, nested as
    in the TOML; status, created, versions, machine, step (s), wall_s, grain_steps;
    radius (W, n) m; kind (W, n), 0 of the preset's material and further numbers in the order of its kinds;
    outline (m, 2) m; fixed (k, 3) y, z, radius m; open_edges; parts, polylines (m, 2) m by name;
    shapes: the Outlines of irregular grains, None where all are discs.
    series: "time" (T,) s and the names of SERIES, whole arrays (T, W, ...).
    frames: "time" (F,) s and the names of GRAIN_FRAMES and WORLD_FRAMES, (F, W, ...), read from the
    file by indexing: `recording.frames["position"][-1]`.
    steering: what a hand did, as (time (s), control, value in SI), None where none moved the tank.
    The tables end where the shortest of their arrays ends. Raises LabError when the file is missing,
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
            check_recording(self._file)
            said = attributes(self._file)
            self.name, status = str(said["preset"]), said["status"]
            self.status = status.decode(errors="ignore") if isinstance(status, bytes) else str(status)
            self.created = str(said["created"])
            self.versions = json.loads(said["versions"])
            self.machine = json.loads(said["machine"])
            self.step, self.wall_s = float(said["step"]), float(said["wall_s"])
            self.grain_steps = int(said["grain_steps"])
            self.given = text(self._file["preset/given"])
            self.preset = json.loads(text(self._file["preset/resolved"]))
            self.radius, self.kind = self._file["grains/radius"][:], self._file["grains/kind"][:]
            tank = self._file["tank"]
            self.outline, self.fixed = tank["outline"][:], tank["fixed"][:]
            self.open_edges = tuple(int(edge) for edge in tank["open_edges"][:])
            self.parts = {name: line[:] for name, line in tank["parts"].items()}
            self.shapes = read_outlines(self._file[GROUP]) if GROUP in self._file else None
            self._check_contents()
            afloat, swell = bool(self.preset.get("ship")), "frames/waves" in self._file
            shapes = table_shapes(*self.radius.shape, len(self.parts), afloat, swell)
            self.series = Series(self._file["series"], shapes["series"], self.path)
            self.frames = Frames(self._file["frames"], shapes["frames"], self.path)
            steering = Series(self._file["steering"], STEERING, self.path) if "steering" in self._file else None
            self._steering = steering
            otherwise.pop_all()  # all is well: it stays open

    def _check_contents(self) -> None:
        """Raises ValueError where something is not what a Recorder writes."""
        worlds_and_grains = self.radius.shape
        sound = {
            "a number of its attributes": all(np.isfinite([self.step, self.wall_s])) and self.step > 0.0,
            "attribute versions": isinstance(self.versions, dict),
            "attribute machine": isinstance(self.machine, dict),
            "preset/resolved": is_preset(self.preset),
            "grains/radius": _finite(self.radius, 2) and self.radius.size > 0 and self.radius.min() > 0.0,
            "grains/kind": self.kind.shape == worlds_and_grains and self.kind.dtype == np.uint8,
            "shapes/which": self.shapes is None or self.shapes.which.shape == worlds_and_grains,
            "tank/outline": _finite(self.outline, 2, columns=2) and len(self.outline) > 2 and _wide(self.outline),
            "tank/fixed": _finite(self.fixed, 2, columns=3),
            "tank/open_edges": all(0 <= edge < len(self.outline) for edge in self.open_edges),
            "tank/parts": all(_finite(line, 2, columns=2) and len(line) > 1 for line in self.parts.values()),
        }
        for name, is_sound in sound.items():
            if not is_sound:
                raise ValueError(f"{name} is not what the lab writes there")

    @property
    def steering(self) -> list[tuple[float, str, float]] | None:
        """What a hand did, in its order."""
        if self._steering is None:
            return None
        time, name, value = (self._steering[column].tolist() for column in STEERING)
        return [(t, word.decode(errors="replace"), v) for t, word, v in zip(time, name, value, strict=True)]

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
        self._path, self._table = path, group.name.strip("/")
        self._lacking = {name: row for name, row in names.items() if name in ADDED and name not in group}
        self._columns = {name: group[name] for name in names if name not in self._lacking}
        for name, (shape, kind) in ((name, names[name]) for name in self._columns):
            if self._columns[name].shape[1:] != shape or self._columns[name].dtype != kind:
                raise ValueError(f"{group.name}/{name} is not what the lab writes there")
        self._length = min(len(dataset) for dataset in self._columns.values())

    def __getitem__(self, name: str) -> "Column":
        if name not in self._columns:
            there = ", ".join(self._columns)
            raise NotRecorded(f"{self._path}: no {quoted(name)} in its {self._table}, but {there}{recorded_by(name)}")
        return Column(self._columns[name], self._length, self._path)

    def __iter__(self) -> Iterator[str]:
        return iter((*self._columns, *self._lacking))

    def __len__(self) -> int:
        return len(self._columns) + len(self._lacking)


class Series(Frames):
    """As Frames, but whole arrays, read once and kept; what an earlier version did not write is as it would be."""

    def __init__(self, group: h5py.Group, names: Mapping, path: Path) -> None:
        super().__init__(group, names, path)
        self._read: dict[str, np.ndarray] = {}

    def __getitem__(self, name: str) -> np.ndarray:
        if name in self._lacking:
            return np.full((self._length, *self._lacking[name][0]), ADDED[name])
        if name not in self._read:
            self._read[name] = super().__getitem__(name)[:]
        return self._read[name]


class Column:
    """One data set, read by indexing as an array: its first axis with a number or a slice, others as numpy has it."""

    def __init__(self, dataset: h5py.Dataset, length: int, path: Path) -> None:
        self._dataset, self._path = dataset, path
        self.shape = (length, *dataset.shape[1:])

    def __len__(self) -> int:
        return self.shape[0]

    def __getitem__(self, index: int | slice | tuple) -> np.ndarray:
        first, *others = index if isinstance(index, tuple) else (index,)
        try:
            rows = slice(*first.indices(len(self))) if isinstance(first, slice) else range(len(self))[first]
            with _reading(self._path):
                check_room(self._dataset, len(range(len(self))[rows]) if isinstance(rows, slice) else 1)
                found = self._dataset[rows]
            return found[(slice(None),) * isinstance(first, slice) + tuple(others)] if others else found
        except (IndexError, TypeError) as error:
            name = self._dataset.name.strip("/")
            raise NotRecorded(
                f"{self._path}: {name} has no {indexed(index)}; it is {axes(name, self.shape)}."
            ) from error


def _finite(array: np.ndarray, axes: int, columns: int | None = None) -> bool:
    """Whether an array holds finite numbers, along so many axes, the last of that length."""
    right = array.ndim == axes and columns in (None, array.shape[-1]) and array.dtype.kind in "fiu"
    return bool(right and (np.abs(array) < BEYOND).all())


def _wide(outline: np.ndarray) -> bool:
    return bool((np.ptp(outline, axis=0) > 0.0).all())


def open_recording(path: Path | str) -> Recording:
    """Open a recording, given as its file or its run's folder. Raises LabError (see Recording)."""
    return Recording(path)


def _open(path: Path) -> h5py.File:
    if not path.is_file():
        raise LabError(f"{path} does not exist: name a recording or the folder of a run.")
    try:
        file = open_to_read(path)
    except PermissionError as error:
        raise LabError(f"{path} may not be read: ask for the right to read it.") from error
    except OSError as error:
        raise LabError(f"{path} cannot be read as a recording: it is cut short or another kind of file.") from error
    try:
        with _reading(path):
            form = format_of(file)
    except LabError:
        file.close()
        raise
    if form == FORMAT:
        return file
    file.close()
    if form.startswith(FORMAT.split()[0]):
        raise LabError(f"{path} was written by another version ('{form}'): record the run again.")
    raise LabError(f"{path} is not a recording of this lab: name another file.")


@contextmanager
def _reading(path: Path) -> Iterator[None]:
    try:
        yield
    except (OSError, RuntimeError, KeyError, ValueError, TypeError, AttributeError) as error:
        raise Useless(f"{path} is damaged ({sentence(error)}): record the run again.") from error
