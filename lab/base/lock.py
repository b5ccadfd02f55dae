"""A lock that lets only one run at a time use a folder."""

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from lab.base.errors import LabError

try:
    import fcntl
except ImportError:  # Windows cannot lock folders
    fcntl = None


@contextmanager
def only_one(folder: Path) -> Iterator[None]:
    """Lock a folder, created if missing; the system releases the lock however the process ends.

    Raises LabError if another process holds it or it cannot be created. Does nothing where folders cannot be locked.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise LabError(f"{folder} cannot be written ({error.strerror}): choose another folder.") from error
    if fcntl is None:
        yield
        return
    handle = os.open(folder, os.O_RDONLY)
    try:
        with suppress(OSError):  # some network folders
            _take(handle, folder)
        yield
    finally:
        os.close(handle)


def _take(handle: int, folder: Path) -> None:
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        raise LabError(f"{folder} is in use by another run: wait until it ends.") from None
