"""The tables of an open recording: data sets by name; their rows are checked against checksums when read."""

import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path

import h5py
import numpy as np

from lab.base.errors import LabError, NotRecorded, Unusable
from lab.base.trust import check_room
from lab.preset.units import quoted, show
from lab.recording import older
from lab.recording.checks import Checks
from lab.recording.layout import ATTEMPTS, RETRY_DELAY, rows_of, sentence
from lab.recording.words import axes, indexed, recorded_by
from solvers.machine.quantity import Quantity


class Frames(Mapping):
    """The data sets of a group by name, each cut to their common length; `quantities` by name.

    Incomplete rows after the last flush are ignored. sizes: as for `rows_of`. checks: None for a recording of format 2,
    which may also lack some of the quantities. Raises ValueError if a data set does not have the shape and data type of
    its quantity.
    """

    def __init__(
        self,
        group: h5py.Group,
        quantities: Mapping[str, Quantity],
        sizes: Mapping[str, int],
        checks: Checks | None,
        path: Path,
    ) -> None:
        self.quantities, self._checks, self._path, self._table = quantities, checks, path, group.name.strip("/")
        stored = older.stored(group)
        self._columns: dict[str, h5py.Dataset] = {name: group[stored[name]] for name in quantities if name in stored}
        for name, (shape, kind) in rows_of(quantities.values(), sizes).items():
            data = self._columns.get(name)
            if data is not None and (data.shape[1:] != shape or data.dtype != np.dtype(kind)):
                raise ValueError(f"{group.name[1:]}/{name} is not what the lab writes there")
        self.rows = min(len(dataset) for dataset in self._columns.values())
        if checks is not None:
            if checks.names != self._columns.keys():
                raise ValueError(f"checks/{self._table} is not what the lab writes there")
            self.rows = min(self.rows, len(checks))
            self._cut(min(self.rows, checks.flushed_rows))

    def _cut(self, begin: int) -> None:
        """End the table before the first damaged row from `begin` on."""
        for data in self._columns.values():
            self.rows = self._checks.first_bad(data, begin, self.rows)

    def keep_sound(self) -> None:
        """End the table before its first damaged row."""
        if self._checks is not None:
            self._cut(0)

    def __getitem__(self, name: str) -> "Column":
        if name not in self._columns:
            known = ", ".join(self._columns)
            raise NotRecorded(f"{self._path}: no {quoted(name)} in its {self._table}, but {known}{recorded_by(name)}")
        self.check_open()
        return Column(self, self._columns[name])

    def check_open(self) -> None:
        """Raise LabError once the file has been closed."""
        if not all(self._columns.values()):
            raise LabError(f"{self._path} has been closed: open it again to read more of it.")

    def __iter__(self) -> Iterator[str]:
        return iter(self.quantities)

    def __len__(self) -> int:
        return len(self.quantities)

    def read(self, data: h5py.Dataset, rows: slice) -> np.ndarray:
        """Read and check rows of a data set. Raises Unusable if they are damaged."""
        live = data.file.swmr_mode
        for _ in range(ATTEMPTS if live else 1):
            with suppress(OSError, RuntimeError):
                found = data[rows]
                if self._checks is None or self._checks.agree(data, rows, found):
                    return found
            if live:  # the writer may be writing these rows
                time.sleep(RETRY_DELAY)
                data.id.refresh()
                self._checks.refresh()
        raise Unusable(self._damage(data))

    def _damage(self, data: h5py.Dataset) -> str:
        """One sentence on the damage of a data set and on the rows that can still be read."""
        where = f"{self._path}: {data.name[1:]} is damaged"
        if self._checks is None:
            return f"{where}: record the run again."
        row = self._checks.first_bad(data, 0, self.rows)
        where += f" from row {row} of {self.rows}{self._when(row)}"
        if not row:
            return f"{where}: record the run again."
        return f"{where}: the rows before can be painted (`cargolab render --sound`); record the run again."

    def _when(self, row: int) -> str:
        """The time of a row as a text; empty if it is not known."""
        clock = self._columns["time"]
        known = row < self.rows and self._checks.first_bad(clock, row, row + 1) > row
        return f" ({show(float(clock[row]), 's')})" if known else ""


class Series(Frames):
    """As Frames, but with whole arrays, read once and kept; quantities that are missing have their value `never`."""

    def __init__(self, *parts: object) -> None:
        super().__init__(*parts)
        self._read: dict[str, np.ndarray] = {}

    def __getitem__(self, name: str) -> np.ndarray:
        if name not in self._read:
            lacks = name in self.quantities and name not in self._columns
            self._read[name] = self._never(name) if lacks else super().__getitem__(name)[:]
        return self._read[name]

    def _never(self, name: str) -> np.ndarray:
        worlds = self._columns["pose"].shape[1]
        return np.full((self.rows, worlds, *self.quantities[name].shape), self.quantities[name].never)


class Column:
    """One data set, read by indexing: the first axis by a number or a slice, the others as in numpy."""

    def __init__(self, table: Frames, dataset: h5py.Dataset) -> None:
        self._table, self._dataset = table, dataset
        self.shape = (table.rows, *dataset.shape[1:])

    def __len__(self) -> int:
        return self.shape[0]

    def __getitem__(self, index: int | slice | tuple) -> np.ndarray:
        first, *others = index if isinstance(index, tuple) else (index,)
        self._table.check_open()
        try:
            many = isinstance(first, slice)
            row = None if many else range(len(self))[first]
            rows = slice(*first.indices(len(self))) if many else slice(row, row + 1)
            with reading(self._table._path):
                check_room(self._dataset, len(range(len(self))[rows]))
                found = self._table.read(self._dataset, rows)
            found = found if many else found[0]
            return found[(slice(None),) * many + tuple(others)] if others else found
        except (IndexError, TypeError) as error:
            name = self._dataset.name.strip("/")
            per = self._table.quantities[older.present(name.rpartition("/")[2])]
            raise NotRecorded(
                f"{self._table._path}: {name} has no {indexed(index)}; it is {axes(name, per, self.shape)}."
            ) from error


@contextmanager
def reading(path: Path) -> Iterator[None]:
    """Turn errors of HDF5, or of a file's content, into an Unusable with one sentence."""
    try:
        yield
    except (OSError, RuntimeError, KeyError, ValueError, TypeError, AttributeError) as error:
        raise Unusable(f"{path} is damaged ({sentence(error)}): record the run again.") from error
