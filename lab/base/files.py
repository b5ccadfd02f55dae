"""Reading files that users name."""

import os
from pathlib import Path
from stat import S_ISREG


def read_bytes(path: str | Path, most: int) -> bytes | None:
    """The first `most` bytes of a file; None if it is not a regular file: a folder, a device, a pipe.

    Files that the system generates on reading, such as /proc/kmsg, may never end; their size is 0, so they count as
    empty. Raises OSError, and ValueError for an impossible file name.
    """
    found = os.stat(path)
    if not S_ISREG(found.st_mode):
        return None
    if found.st_size == 0:
        return b""
    with Path(path).open("rb") as file:
        return file.read(most)
