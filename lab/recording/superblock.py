"""The first bytes of an HDF5 file, its superblock of version 3, with the writer flags and the size of the file.

HDF5 sets a flag while a file is open for writing, and refuses to open a file whose flag is set. A killed writer leaves
the flag set. The recorded size may also be out of date: the last data may lie beyond it and would be overwritten by a
process that continues the file. `amended` returns a superblock with other flags and another size.
(HDF5 File Format Specification Version 3.0, section II.A; the checksum is Bob Jenkins's lookup3, 2006.)
"""

import struct

SIZE = 48  # bytes
SIGNATURE = b"\x89HDF\r\n\x1a\n\x03\x08\x08"  # version 3, offsets and lengths of eight bytes
FLAGS = len(SIGNATURE)  # position of the byte with the flags
WRITING = 0b101  # open for writing, in SWMR mode
_END = slice(28, 36)
_WORD = 2**32 - 1


def is_sound(head: bytes) -> bool:
    """Whether these bytes are a superblock of version 3 with a correct checksum."""
    return len(head) == SIZE and head.startswith(SIGNATURE) and sealed(head[:-4]) == head


def is_marked(head: bytes) -> bool:
    """Whether the file is open for writing, or was when its writer was killed."""
    return bool(head[FLAGS])


def end(head: bytes) -> int:
    """The recorded size of the file in bytes."""
    return int.from_bytes(head[_END], "little")


def amended(head: bytes, flags: int, end: int) -> bytes:
    """The superblock with these flags and this file size (bytes)."""
    changed = bytearray(head[:-4])
    changed[FLAGS], changed[_END] = flags, end.to_bytes(8, "little")
    return sealed(bytes(changed))


def sealed(content: bytes) -> bytes:
    """The content followed by its checksum."""
    return content + struct.pack("<I", _lookup3(content))


def _lookup3(content: bytes) -> int:
    """The checksum of at least one byte (Jenkins, lookup3.c, function hashlittle)."""
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
