"""A quantity of a table as an array that xarray reads piece by piece; each row that is read is checked."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
from xarray.backends import BackendArray
from xarray.core.indexing import ExplicitIndexer, IndexingSupport, explicit_indexing_adapter

from lab.recording.layout import row_bytes

if TYPE_CHECKING:
    from lab.recording.tables import Frames

BLOCK = 2**24  # bytes read at a time where only a part of each row is asked for


class Lazy(BackendArray):
    """A quantity of a table, (rows, …), as its file has it. Raises what the table raises, for the rows that are read.

    A row is read as a whole, since its checksum is of the whole row; of many rows only the part that is asked for is
    kept.
    """

    def __init__(self, table: "Frames", name: str, shape: tuple[int, ...], dtype: str) -> None:
        self._table, self._name = table, name
        self.shape, self.dtype = (table.rows, *shape), np.dtype(dtype)

    def __getitem__(self, key: ExplicitIndexer) -> np.ndarray:
        return explicit_indexing_adapter(key, self.shape, IndexingSupport.OUTER, self._read)

    def __deepcopy__(self, _: dict) -> "Lazy":
        return self  # nothing of it changes, and the file stays open once

    def _read(self, key: tuple) -> np.ndarray:
        """The part of an outer index: numbers, slices and sorted arrays, one an axis."""
        first, *others = key
        if isinstance(first, int | np.integer):
            return _part(self._table[self._name][int(first)], others)
        whole = all(isinstance(one, slice) and one == slice(None) for one in others)
        most = len(self) if whole else BLOCK // max(1, row_bytes(self.shape[1:], self.dtype))
        step = (first.step or 1) if isinstance(first, slice) else 1
        found = [
            _part(self._table[self._name][run], [slice(None), *others])
            for run in _runs(np.arange(len(self))[first], step, max(1, most))
        ]
        if not found:
            return _part(np.empty((0, *self.shape[1:]), self.dtype), [slice(None), *others])
        return found[0] if len(found) == 1 else np.concatenate(found)

    def __len__(self) -> int:
        return self.shape[0]


def _runs(rows: np.ndarray, step: int, most: int) -> Iterator[slice]:
    """Slices of this step, of `most` rows or fewer, that give these rows in order."""
    for run in np.split(rows, np.flatnonzero(np.diff(rows) != step) + 1):
        for begin in range(0, len(run), most):
            part = run[begin : begin + most]
            yield slice(int(part[0]), int(part[-1]) + 1, step)


def _part(values: np.ndarray, index: list) -> np.ndarray:
    """A part of an array by one index for each axis, each for itself."""
    for axis, one in reversed(list(enumerate(index))):
        values = values[(slice(None),) * axis + (one,)]
    return values
