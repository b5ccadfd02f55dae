"""Files that people name."""

import os
from pathlib import Path
from stat import S_ISREG


def read_bytes(path: str | Path, most: int) -> bytes | None:
    """What a file holds, at most so many bytes; None where it is none: a folder, a device, a pipe that never ends.

    What the system makes as it is read, such as /proc/kmsg, may never end either; it has no size, and counts as empty.
    Raises OSError, and ValueError for what is no name of a file.
    """
    found = os.stat(path)
    if not S_ISREG(found.st_mode):
        return None
    if found.st_size == 0:
        return b""
    with Path(path).open("rb") as file:
        return file.read(most)
