"""Manipulated recordings, for tests of damaged or invalid contents."""

import h5py
import numpy as np

from lab.recording.checks import row_checks


def sealed(file: h5py.File) -> None:
    """Make the checksums of a recording those of what its tables hold now."""
    for table, checks in file["checks"].items():
        for column, name in enumerate(checks.attrs["columns"]):
            found = row_checks(file[f"{table}/{name.decode()}"][()])
            rows = min(len(found), len(checks))
            checks[:rows, column] = found[:rows]


def flipped(content: bytes, bit: int) -> bytes:
    """The content of a file with one bit flipped."""
    changed = bytearray(content)
    changed[bit // 8] ^= 1 << bit % 8
    return bytes(changed)


def used(path) -> np.ndarray:
    """Which bytes of a recording hold numbers or texts of its data sets, (bytes,)."""
    found = []

    def look(_: str, item: object) -> None:
        if isinstance(item, h5py.Dataset) and item.size:
            if item.chunks:
                item.id.chunk_iter(lambda chunk: found.append((item, chunk)))
            else:
                found.append((item, None))

    with h5py.File(path, "r") as file:
        file.visititems(look)
        places = [np.arange(*_span(item, chunk)) for item, chunk in found]
    return np.concatenate(places)


def _span(item: h5py.Dataset, chunk) -> tuple[int, int]:
    """Where a chunk, or a data set in one piece, begins and where its last row ends."""
    if chunk is None:
        return item.id.get_offset(), item.id.get_offset() + item.nbytes
    rows = min(item.chunks[0], len(item) - chunk.chunk_offset[0])
    return chunk.byte_offset, chunk.byte_offset + rows * chunk.size // item.chunks[0]
