"""The binary files of particles (.bi4) of the peer code DualSPHysics 5: written for its start, read for its results.

A file is a head of 64 bytes and a tree of items. An item has values, arrays and further items; each begins with the
length of its description. Numbers are little-endian, a text is its length and its bytes. Layout as DualSPHysics 5.4
writes it; files of more than 4 GB have another one.
"""

import struct
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

TEXT, BOOL, UINT, ULLONG, DOUBLE3 = 1, 2, 8, 10, 23
HEAD, TITLE = 64, 58  # bytes
ITEM, VALUES, ARRAY = "\nITEM\n", "\nVALUES", "\nARRAY"
NUMBERS = {
    2: "<i4", 3: "<i1", 4: "<u1", 5: "<i2", 6: "<u2", 7: "<i4", 8: "<u4", 9: "<i8", 10: "<u8", 11: "<f4", 12: "<f8",
    20: "3<i4", 21: "3<u4", 22: "3<f4", 23: "3<f8",
}  # fmt: skip


@dataclass
class Item:
    """A node of a file: values by name as (kind, value), arrays by name as (kind, array), and further items."""

    name: str
    values: Mapping[str, tuple[int, object]] = field(default_factory=dict)
    arrays: Mapping[str, tuple[int, np.ndarray]] = field(default_factory=dict)
    items: list["Item"] = field(default_factory=list)


def write_file(path: Path, root: Item) -> None:
    """Write a file; its code is the name of the root."""
    title = f"#FileJBD {root.name}".encode()[:TITLE].ljust(TITLE) + b"\n\0"
    path.write_bytes(title + bytes(HEAD - len(title)) + _item(root))


def read_file(path: Path) -> Item:
    """The root of a file."""
    return _Reader(path.read_bytes(), HEAD).item()


def _uint(number: int) -> bytes:
    return struct.pack("<I", number)


def _text(text: str) -> bytes:
    return _uint(len(text.encode())) + text.encode()


def _value(name: str, kind: int, value: object) -> bytes:
    data = _text(value) if kind == TEXT else np.asarray(value, np.dtype(NUMBERS[kind]).base).tobytes()
    return _text(name) + _uint(kind) + data


def _array(name: str, kind: int, values: np.ndarray) -> bytes:
    data = np.ascontiguousarray(values, np.dtype(NUMBERS[kind]).base).tobytes()
    what = _text(ARRAY) + _text(name) + _uint(0) + _uint(kind) + _uint(len(values)) + _uint(len(data))
    return _uint(len(what)) + what + data


def _item(item: Item) -> bytes:
    values = b"".join(_value(name, *value) for name, value in item.values.items())
    values = _text(VALUES) + _uint(len(item.values)) + values
    what = _text(ITEM) + _text(item.name) + _uint(0) + _uint(0) + _text("%.7E") + _text("%.15E")
    what += _uint(len(item.arrays)) + _uint(len(item.items)) + _uint(len(values))
    arrays = b"".join(_array(name, *array) for name, array in item.arrays.items())
    return _uint(len(what)) + what + values + arrays + b"".join(map(_item, item.items))


class _Reader:
    """Reads bytes from a place on."""

    def __init__(self, data: bytes, place: int):
        self.data, self.place = data, place

    def uint(self) -> int:
        return int(self.numbers(UINT, 1)[0])

    def text(self) -> str:
        size = self.uint()
        self.place += size
        return self.data[self.place - size : self.place].decode()

    def numbers(self, kind: int, count: int) -> np.ndarray:
        dtype = np.dtype(NUMBERS[kind])
        self.place += dtype.itemsize * count
        return np.frombuffer(self.data, dtype, count, self.place - dtype.itemsize * count)

    def value(self) -> tuple[str, tuple[int, object]]:
        name, kind = self.text(), self.uint()
        return name, (kind, self.text() if kind == TEXT else self.numbers(kind, 1)[0])

    def array(self) -> tuple[str, tuple[int, np.ndarray]]:
        self.uint()
        assert self.text() == ARRAY
        name, _, kind, count, _ = self.text(), self.uint(), self.uint(), self.uint(), self.uint()
        return name, (kind, self.numbers(kind, count))

    def item(self) -> Item:
        self.uint()
        assert self.text() == ITEM
        name, *_ = self.text(), self.uint(), self.uint(), self.text(), self.text()
        arrays, items, values = self.uint(), self.uint(), self.uint()
        found = {}
        if values:
            assert self.text() == VALUES
            found = dict(self.value() for _ in range(self.uint()))
        held = dict(self.array() for _ in range(arrays))
        return Item(name, found, held, [self.item() for _ in range(items)])
