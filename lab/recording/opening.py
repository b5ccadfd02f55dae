"""Open recordings for reading and for appending, also after their writer was killed.

A writer holds a shared lock on its file, in addition to HDF5's own locks, until it closes the file. A process that
finds HDF5's writer flag set and can lock the file exclusively knows that the writer is gone, and clears the flag
(`release`). Where files cannot be locked, as in some network folders, only a process that continues the recording
clears the flag.
"""

import errno
import os
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import BinaryIO, TypeVar

import h5py

from lab.base.errors import LabError
from lab.base.trust import format_of
from lab.recording import older, superblock
from lab.recording.layout import ATTEMPTS, FORMAT, RETRY_DELAY
from lab.recording.tables import reading

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None

NO_LOCKS = (errno.ENOLCK, errno.ENOTSUP, errno.EOPNOTSUPP, errno.ENOSYS)
# Whether the writer reserves disk space before it writes; then a file shorter than its recorded size was truncated.
RESERVES = hasattr(os, "posix_fallocate")
BLOCK = 2**20  # bytes; no block of a chunk index is larger

# The format of HDF5 1.10, the first with SWMR mode and with checksums of all structures. "latest" is the newest format
# that this HDF5 knows, which programs built with an older one cannot read, or misread.
VERSION = "v110"

Opened = TypeVar("Opened")


def create(path: Path) -> h5py.File:
    """Create a file, replacing one of the same name."""
    return _with_or_without_locks(lambda lock: h5py.File(path, "w", libver=(VERSION, VERSION), locking=lock))


def opened(path: Path) -> tuple[h5py.File, str]:
    """The file and its format. Raises LabError."""
    if not path.is_file():
        raise LabError(f"{path} does not exist: name a recording or the folder of a run.")
    try:
        file = open_to_read(path)
    except PermissionError as error:
        raise LabError(f"{path} may not be read: change its permissions.") from error
    except OSError as error:
        raise LabError(f"{path} cannot be read as a recording: it is truncated or another kind of file.") from error
    try:
        with reading(path):
            form = format_of(file)
    except LabError:
        file.close()
        raise
    if form in (FORMAT, *older.FORMATS):
        return file, form
    file.close()
    if form.startswith(FORMAT.split()[0]):
        raise LabError(f"{path} was written by another version ('{form}'): record the run again.")
    raise LabError(f"{path} is not a recording of this lab: name another file.")


def open_to_read(path: Path) -> h5py.File:
    """Open a recording for reading, whether it was closed, is being written, or its writer was killed. Raises OSError.

    Only a file that was never closed is opened in SWMR mode, since in that mode HDF5 rereads a damaged file endlessly.
    Waits for a writer that is opening or closing the file.
    """
    error: OSError | None = None
    for _ in range(ATTEMPTS):
        try:
            return _plain(path)
        except BlockingIOError as locked:
            error = locked
        except OSError as marked:
            if not _is_marked(marked):
                raise
            error = marked
            if not release(path):
                with suppress(OSError):  # closed meanwhile, or not yet in SWMR mode
                    return _live(path)
        time.sleep(RETRY_DELAY)
    raise error


def open_to_add(path: Path) -> h5py.File:
    """Open a file as its only writer, directly in SWMR mode. Raises LabError if another program has it open, OSError.

    h5py opens a file first and then switches to SWMR mode; if the writer were killed in between, the file would be
    unreadable. Waits for readers, which hold their locks only briefly.
    """
    for _ in range(ATTEMPTS):
        release(path, sure=True)
        try:
            file = _with_or_without_locks(lambda lock: _adding(path, lock))
            _hold(file)
            return file
        except BlockingIOError:
            pass
        except OSError as error:
            if not _is_marked(error):
                raise
        time.sleep(RETRY_DELAY)
    raise LabError(f"{path} is open in another program: close it there.")


def release(path: Path, sure: bool = False) -> bool:
    """Clear the flag of a writer that is gone and correct the recorded size; returns whether the flag is cleared.

    Returns False while a writer or a reader has the file open, and if the file cannot be written. sure: treat the
    writer as gone where files cannot be locked. Each superblock is written in a single call, the first one with the
    full size of the file, so an interruption in between leaves a valid recording. Damage is not repaired here.
    """
    try:
        with path.open("r+b", buffering=0) as file:
            if not _alone(file, sure):
                return False
            head = file.read(superblock.SIZE)
            if superblock.is_sound(head) and superblock.is_marked(head):
                recorded, size = superblock.end(head), os.fstat(file.fileno()).st_size
                if size < recorded and not RESERVES:  # the last blocks had not been written yet
                    file.truncate(recorded)
                _write_head(file, superblock.amended(head, 0, max(recorded, size)))
                with suppress(OSError, RuntimeError):
                    needed = _needed(path, file, recorded, size)
                    _write_head(file, superblock.amended(head, 0, needed))
                    file.truncate(needed)
            return True
    except OSError:
        return False


def end_of(path: Path) -> int:
    """Size (bytes) of a closed file as recorded in it; what was reserved beyond that is not used."""
    with path.open("rb") as file:
        return superblock.end(file.read(superblock.SIZE))


def _alone(file: BinaryIO, sure: bool) -> bool:
    """Try to lock a file exclusively; returns whether this process has it alone (`sure` where locks are missing)."""
    if fcntl is None:
        return sure
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        return True
    except BlockingIOError:
        return False
    except OSError:
        return sure


def _hold(file: h5py.File) -> None:
    """Hold a shared lock on a file opened for appending, so that no other process takes its writer for dead."""
    if fcntl is None:
        return
    handle = file.id.get_vfd_handle()
    with suppress(OSError):
        fcntl.flock(handle, fcntl.LOCK_SH)  # waits for a process that is releasing the file
        head = os.pread(handle, superblock.SIZE, 0)
        if superblock.is_sound(head) and not superblock.is_marked(head):
            os.pwrite(handle, superblock.amended(head, superblock.WRITING, superblock.end(head)), 0)


def _write_head(file: BinaryIO, head: bytes) -> None:
    file.seek(0)
    file.write(head)


def _needed(path: Path, file: BinaryIO, recorded: int, size: int) -> int:
    """The end (bytes) of the used part of a file of this size, at least the size recorded in its superblock.

    Chunks and chunk indices may end with zeros; all other blocks end with a checksum.
    """
    ends = [recorded]

    def add_chunks(_: str, item: object) -> None:
        if isinstance(item, h5py.Dataset) and item.chunks:
            item.id.chunk_iter(lambda chunk: ends.append(chunk.byte_offset + chunk.size))

    with h5py.File(path, "r", locking=False) as recording:
        recording.visititems(add_chunks)
    for begin in reversed(range(recorded, size, BLOCK)):
        file.seek(begin)
        if filled := file.read(BLOCK).rstrip(b"\0"):
            ends.append(begin + len(filled) + BLOCK)
            break
    return max(ends)


def _plain(path: Path) -> h5py.File:
    return _with_or_without_locks(lambda lock: h5py.File(path, "r", locking=lock))


def _live(path: Path) -> h5py.File:
    return _with_or_without_locks(lambda lock: h5py.File(path, "r", swmr=True, locking=lock))


def _adding(path: Path, lock: bool | None) -> h5py.File:
    access = h5py.h5p.create(h5py.h5p.FILE_ACCESS)
    access.set_libver_bounds(h5py.h5f.LIBVER_V110, h5py.h5f.LIBVER_V110)
    if lock is not None:
        access.set_file_locking(lock, True)
    return h5py.File(h5py.h5f.open(os.fsencode(path), h5py.h5f.ACC_RDWR | h5py.h5f.ACC_SWMR_WRITE, access))


def _with_or_without_locks(opened: Callable[[bool | None], Opened]) -> Opened:
    """Open a file, without HDF5's locks if the file system does not support them."""
    try:
        return opened(None)
    except OSError as error:
        if error.errno not in NO_LOCKS:
            raise
        return opened(False)


def _is_marked(error: OSError) -> bool:
    return "already open for write" in str(error)
