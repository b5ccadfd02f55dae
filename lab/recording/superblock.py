"""The head of a recording's file, HDF5's superblock of version 3: who writes to the file, and where it ends.

HDF5 marks a file that is written to, and refuses to open one that bears the mark. A writer that is killed leaves the
mark behind. The end may also be out of date then: what was written last may lie behind it, and would be written over
by who goes on with the file. `amended` gives the head without the mark and with another end.
(HDF5 File Format Specification Version 3.0, section II.A; its checksum is Bob Jenkins's lookup3, 2006.)
"""

import struct

SIZE = 48  # bytes
SIGNATURE = b"\x89HDF\r\n\x1a\n\x03\x08\x08"  # version 3, offsets and lengths of eight bytes
MARKS = len(SIGNATURE)  # where the byte with the marks is
WRITING = 0b101  # open for writing, in SWMR mode
_END = slice(28, 36)
_WORD = 2**32 - 1


def is_sound(head: bytes) -> bool:
    """Whether these bytes are the head of such a file."""
    return len(head) == SIZE and head.startswith(SIGNATURE) and _sealed(head[:-4]) == head


def is_marked(head: bytes) -> bool:
    """Whether somebody writes to the file, or did when they were killed."""
    return bool(head[MARKS])


def end(head: bytes) -> int:
    """Where the file ends: its size in bytes as the head says it."""
    return int.from_bytes(head[_END], "little")


def amended(head: bytes, marks: int, end: int) -> bytes:
    """The head with other marks and another end."""
    changed = bytearray(head[:-4])
    changed[MARKS], changed[_END] = marks, end.to_bytes(8, "little")
    return _sealed(bytes(changed))


def _sealed(content: bytes) -> bytes:
    return content + struct.pack("<I", _lookup3(content))


def _lookup3(content: bytes) -> int:
    """The checksum of some bytes, at least one (Jenkins, lookup3.c, function hashlittle)."""
    a = b = c = (0xDEADBEEF + len(content)) & _WORD
    while len(content) > 12:
        x, y, z = struct.unpack("<3I", content[:12])
        a, b, c = _mixed((a + x) & _WORD, (b + y) & _WORD, (c + z) & _WORD)
        content = content[12:]
    x, y, z = struct.unpack("<3I", content.ljust(12, b"\0"))
    return _final((a + x) & _WORD, (b + y) & _WORD, (c + z) & _WORD)


def _turned(word: int, bits: int) -> int:
    return (word << bits | word >> 32 - bits) & _WORD


def _mixed(a: int, b: int, c: int) -> tuple[int, int, int]:
    for bits in (4, 6, 8, 16, 19, 4):
        a = (a - c & _WORD) ^ _turned(c, bits)
        c = c + b & _WORD
        a, b, c = b, c, a
    return a, b, c


def _final(a: int, b: int, c: int) -> int:
    for bits in (14, 11, 25, 16, 4, 14, 24):
        c = (c ^ b) - _turned(b, bits) & _WORD
        a, b, c = b, c, a
    return b
