"""Row checksums: the CRC-32 of the bytes of each row of each data set, as stored in the file.

HDF5's own checksums (Fletcher-32) cover whole chunks. A partly filled chunk is rewritten in place when rows are added.
If the run is killed during that write, the chunk no longer matches its checksum, and rows that had already been flushed
become unreadable. With one checksum per row, old rows keep their bytes and checksums; at worst the new rows are lost.
(CRC-32 of ISO 3309 and ITU-T V.42, as in `zlib.crc32`.)
"""

from zlib import crc32

import h5py
import numpy as np

from lab.base.trust import attribute_words
from lab.recording import older
from lab.recording.layout import COLUMNS, FLUSHED_ROWS, row_bytes

BLOCK = 2**22  # bytes read at a time when all rows are checked


def row_checks(rows: np.ndarray) -> np.ndarray:
    """Checksums (k,) of the rows of an array (k, …)."""
    content = memoryview(np.ascontiguousarray(rows)).cast("B") if rows.size else b""
    size = row_bytes(rows.shape[1:], rows.dtype)
    if not size:
        return np.zeros(len(rows), "<u4")
    return np.fromiter((crc32(content[k : k + size]) for k in range(0, len(content), size)), "<u4", len(rows))


class Checks:
    """The checksums of one table of a file. Raises KeyError, ValueError or Unusable if the data set is not valid."""

    def __init__(self, data: h5py.Dataset) -> None:
        self._data = data
        self._column = {name: k for k, name in enumerate(attribute_words(data, COLUMNS))}
        self.flushed_rows = int(data.attrs[FLUSHED_ROWS])
        if data.ndim != 2 or data.shape[1] != len(self._column) or data.dtype != np.dtype("<u4"):
            raise ValueError(f"{data.name[1:]} is not what the lab writes there")

    def __len__(self) -> int:
        return len(self._data)

    @property
    def names(self) -> set[str]:
        """Present names of the data sets that have checksums."""
        return set(map(older.present, self._column))

    def refresh(self) -> None:
        """Reload the data set, which another process may have extended."""
        self._data.id.refresh()

    def agree(self, data: h5py.Dataset, rows: slice, values: np.ndarray) -> bool:
        """Whether `values` (k, …), read from these rows of a data set, match their checksums. Raises OSError."""
        name = data.name.rpartition("/")[2]
        return bool(np.array_equal(row_checks(values), self._data[rows, self._column[name]]))

    def first_bad(self, data: h5py.Dataset, begin: int, end: int) -> int:
        """The first damaged or unreadable row in [begin, end); `end` if there is none."""
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
