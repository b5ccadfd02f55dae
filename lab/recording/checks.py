"""Checksums of a table's rows: CRC-32 of the bytes of each row of each data set, as they lie in the file.

HDF5's own checksums (Fletcher-32) are of whole chunks. A chunk of rows is written again as more rows come, in place,
and a run that is killed meanwhile would leave chunk and checksum unlike: rows that had been flushed could not be read.
With a checksum a row, what is written again has the same bytes, and at worst the new rows are lost.
(CRC-32 of ISO 3309, ITU-T V.42, as `zlib.crc32` has it.)
"""

from zlib import crc32

import h5py
import numpy as np

from lab.base.trust import attribute_words
from lab.recording.layout import COLUMNS, STANDING, row_bytes

BLOCK = 2**22  # bytes that are read at a time where all rows are looked through


def row_checks(rows: np.ndarray) -> np.ndarray:
    """The checksum of each row (k,) of an array (k, …)."""
    content = memoryview(np.ascontiguousarray(rows)).cast("B") if rows.size else b""
    size = row_bytes(rows.shape[1:], rows.dtype)
    if not size:
        return np.zeros(len(rows), "<u4")
    return np.fromiter((crc32(content[k : k + size]) for k in range(0, len(content), size)), "<u4", len(rows))


class Checks:
    """The checksums of one table of a file. Raises KeyError, ValueError or Useless where they are none."""

    def __init__(self, data: h5py.Dataset) -> None:
        self._data = data
        self._column = {name: k for k, name in enumerate(attribute_words(data, COLUMNS))}
        self.standing = int(data.attrs[STANDING])
        if data.ndim != 2 or data.shape[1] != len(self._column) or data.dtype != np.dtype("<u4"):
            raise ValueError(f"{data.name[1:]} is not what the lab writes there")

    def __len__(self) -> int:
        return len(self._data)

    @property
    def names(self) -> set[str]:
        """The data sets whose checksums are here."""
        return set(self._column)

    def refresh(self) -> None:
        """Look at the file again, to which another process writes."""
        self._data.id.refresh()

    def agree(self, data: h5py.Dataset, rows: slice, values: np.ndarray) -> bool:
        """Whether these rows of a data set, (k, …), are what was written. Raises OSError."""
        name = data.name.rpartition("/")[2]
        return bool(np.array_equal(row_checks(values), self._data[rows, self._column[name]]))

    def first_bad(self, data: h5py.Dataset, begin: int, end: int) -> int:
        """The first row of some that cannot be read or is not what was written; `end` where all are sound."""
        step = max(1, BLOCK // max(1, row_bytes(data.shape[1:], data.dtype)))
        for block in range(begin, end, step):
            if self._is_sound(data, slice(block, min(end, block + step))):
                continue
            for row in range(block, min(end, block + step)):
                if not self._is_sound(data, slice(row, row + 1)):
                    return row
        return end

    def _is_sound(self, data: h5py.Dataset, rows: slice) -> bool:
        try:
            return self.agree(data, rows, data[rows])
        except (OSError, RuntimeError):
            return False
