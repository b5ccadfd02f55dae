"""The tables of an open recording: data sets by name, whose rows are checked as they are read."""

import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path

import h5py
import numpy as np

from lab.base.errors import NotRecorded, Useless
from lab.base.trust import check_room
from lab.preset.units import quoted, show
from lab.recording.checks import Checks
from lab.recording.layout import A_MOMENT, PATIENCE, rows_of, sentence
from lab.recording.words import axes, indexed, recorded_by
from solvers.machine.quantity import Quantity


class Frames(Mapping):
    """The data sets of a group by name, each cut to the length that all of them have; `quantities` by name.

    Rows behind the last flush that were not written whole are as if they were not there. sizes: as of `rows_of`;
    checks: None in a recording of an earlier version, as are quantities that it lacks, which are as never happened.
    Raises ValueError where a data set has not the shape that its quantity has.
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
        self._columns: dict[str, h5py.Dataset] = {name: group[name] for name in quantities if name in group}
        for name, (shape, kind) in rows_of(quantities.values(), sizes).items():
            data = self._columns.get(name)
            if data is not None and (data.shape[1:] != shape or data.dtype != np.dtype(kind)):
                raise ValueError(f"{group.name[1:]}/{name} is not what the lab writes there")
        self.rows = min(len(dataset) for dataset in self._columns.values())
        if checks is not None:
            if checks.names != self._columns.keys():
                raise ValueError(f"checks/{self._table} is not what the lab writes there")
            self.rows = min(self.rows, len(checks))
            self._cut(min(self.rows, checks.standing))

    def _cut(self, begin: int) -> None:
        """End before the first row from `begin` on that is not what was written."""
        for data in self._columns.values():
            self.rows = self._checks.first_bad(data, begin, self.rows)

    def keep_sound(self) -> None:
        """End before the first row that is damaged."""
        if self._checks is not None:
            self._cut(0)

    def __getitem__(self, name: str) -> "Column":
        if name not in self._columns:
            there = ", ".join(self._columns)
            raise NotRecorded(f"{self._path}: no {quoted(name)} in its {self._table}, but {there}{recorded_by(name)}")
        return Column(self, self._columns[name])

    def __iter__(self) -> Iterator[str]:
        return iter(self.quantities)

    def __len__(self) -> int:
        return len(self.quantities)

    def read(self, data: h5py.Dataset, rows: slice) -> np.ndarray:
        """Some rows of a data set, checked. Raises Useless where they are damaged."""
        live = data.file.swmr_mode
        for _ in range(PATIENCE if live else 1):
            with suppress(OSError, RuntimeError):
                found = data[rows]
                if self._checks is None or self._checks.agree(data, rows, found):
                    return found
            if live:  # its writer may be at these rows just now
                time.sleep(A_MOMENT)
                data.id.refresh()
                self._checks.refresh()
        raise Useless(self._damage(data))

    def _damage(self, data: h5py.Dataset) -> str:
        """One sentence on what is damaged of a data set, and what can be read."""
        where = f"{self._path}: {data.name[1:]} is damaged"
        if self._checks is None:
            return f"{where}: record the run again."
        row = self._checks.first_bad(data, 0, self.rows)
        where += f" from row {row} of {self.rows}{self._when(row)}"
        if not row:
            return f"{where}: record the run again."
        return f"{where}: what lies before can be painted (`cargolab render --sound`); record the run again."

    def _when(self, row: int) -> str:
        """The time of a row in words, where it is known."""
        clock = self._columns["time"]
        known = row < self.rows and self._checks.first_bad(clock, row, row + 1) > row
        return f" ({show(float(clock[row]), 's')})" if known else ""


class Series(Frames):
    """As Frames, but whole arrays, read once and kept; what an earlier version did not write is as it would be."""

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
    """One data set, read by indexing as an array: its first axis with a number or a slice, others as numpy has it."""

    def __init__(self, table: Frames, dataset: h5py.Dataset) -> None:
        self._table, self._dataset = table, dataset
        self.shape = (table.rows, *dataset.shape[1:])

    def __len__(self) -> int:
        return self.shape[0]

    def __getitem__(self, index: int | slice | tuple) -> np.ndarray:
        first, *others = index if isinstance(index, tuple) else (index,)
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
            per = self._table.quantities[name.rpartition("/")[2]]
            raise NotRecorded(
                f"{self._table._path}: {name} has no {indexed(index)}; it is {axes(name, per, self.shape)}."
            ) from error


@contextmanager
def reading(path: Path) -> Iterator[None]:
    """Turn what HDF5 or the content of a file says against reading into one sentence."""
    try:
        yield
    except (OSError, RuntimeError, KeyError, ValueError, TypeError, AttributeError) as error:
        raise Useless(f"{path} is damaged ({sentence(error)}): record the run again.") from error
