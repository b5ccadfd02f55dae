"""Reading files that users name, and writing results."""

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from stat import S_ISREG

from lab.base.errors import LabError


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


def named(path: str | Path, option: str = "out") -> Path:
    """A path that a user names. Raises LabError for an empty one, which would be the current folder."""
    if path == "":
        raise LabError(f"{option}: the name is empty; write . for the current folder.")
    return Path(path)


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """A place beside `path` to write a file to, which then gets its name: it is whole, or as it was before.

    A full disk, an error or a kill leave no cut file. A symbolic link at `path` is replaced and not followed: in a
    folder from a stranger it may lead to a file of the user's. A device or a pipe is written to as it is.
    """
    if path.exists() and not path.is_file() and not path.is_dir():
        yield path
        return
    part = unfinished(path)
    part.unlink(missing_ok=True)  # of a process that was killed, or a link
    try:
        yield part
        part.replace(path)
    except BaseException:
        with suppress(OSError):
            part.unlink(missing_ok=True)
        raise


def unfinished(path: Path) -> Path:
    """The name of a file until it is complete; its ending, by which some programs go, stays."""
    return path.with_name(f"{path.stem}.part{path.suffix}")


def write_text(path: Path, text: str) -> None:
    """Write a text, whole or not at all (see `replacing`). Raises OSError."""
    with replacing(path) as part:
        part.write_text(text, encoding="utf-8")
