"""Opening recordings: by whom, how often it is tried, and what a writer that was killed has left.

Who adds to a recording holds a shared lock on its file, beside HDF5's own locks, until it is closed. Who finds HDF5's
mark of a writer on a file and can lock it for itself knows that the writer is gone, and clears the mark (`release`).
Where files cannot be locked, as in some network folders, only who is to go on with a recording does that.
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
from lab.recording import superblock
from lab.recording.layout import A_MOMENT, PATIENCE

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None

NO_LOCKS = (errno.ENOLCK, errno.ENOTSUP, errno.EOPNOTSUPP, errno.ENOSYS)
RESERVES = hasattr(os, "posix_fallocate")  # whether a recording has all the room that it says, so a short one was cut
BLOCK = 2**20  # bytes: no piece of an index of chunks is larger

Opened = TypeVar("Opened")


def create(path: Path) -> h5py.File:
    """A new file, in place of another of that name."""
    return _with_or_without_locks(lambda lock: h5py.File(path, "w", libver="latest", locking=lock))


def open_to_read(path: Path) -> h5py.File:
    """Open what was closed, is being written or was killed. Raises OSError.

    In SWMR mode only what was never closed: HDF5 rereads a damaged file for ever in it. A writer that opens or closes
    the file just now is waited for.
    """
    error: OSError | None = None
    for _ in range(PATIENCE):
        try:
            return _plain(path)
        except BlockingIOError as locked:
            error = locked
        except OSError as marked:
            if not _is_marked(marked):
                raise
            error = marked
            if not release(path):
                with suppress(OSError):  # closed by now, or not yet in that mode
                    return _live(path)
        time.sleep(A_MOMENT)
    raise error


def open_to_add(path: Path) -> h5py.File:
    """Open a file that nobody else writes to as its writer in SWMR mode, in one stroke.

    Opened first and switched to that mode then, as h5py does it, a file would be unreadable had the writer been killed
    in between. A reader's lock is waited for: who reads opens and closes. Raises LabError, OSError.
    """
    for _ in range(PATIENCE):
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
        time.sleep(A_MOMENT)
    raise LabError(f"{path} is open in another program: close it there.")


def release(path: Path, sure: bool = False) -> bool:
    """Clear the mark of a writer that is gone, and say where its file ends; whether the file is without it now.

    It is not while a writer lives or somebody reads, nor where the file cannot be written. sure: whether the writer is
    known to be gone where files cannot be locked. Each head is written in one stroke, the first with all that there
    is: whatever ends this in between leaves a recording. What is damaged is left to who opens it.
    """
    try:
        with path.open("r+b", buffering=0) as file:
            if not _alone(file, sure):
                return False
            head = file.read(superblock.SIZE)
            if superblock.is_sound(head) and superblock.is_marked(head):
                said, size = superblock.end(head), os.fstat(file.fileno()).st_size
                if size < said and not RESERVES:  # what was said to be there was not written yet
                    file.truncate(said)
                _write_head(file, superblock.amended(head, 0, max(said, size)))
                with suppress(OSError, RuntimeError):
                    needed = _needed(path, file, said, size)
                    _write_head(file, superblock.amended(head, 0, needed))
                    file.truncate(needed)
            return True
    except OSError:
        return False


def end_of(path: Path) -> int:
    """Where a closed file ends, in bytes: what was reserved behind it was not needed."""
    with path.open("rb") as file:
        return superblock.end(file.read(superblock.SIZE))


def _alone(file: BinaryIO, sure: bool) -> bool:
    """Lock a file against everybody else, if it can be."""
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
    """Hold a file that was opened to be added to until it is closed, so that nobody takes its writer for gone."""
    if fcntl is None:
        return
    handle = file.id.get_vfd_handle()
    with suppress(OSError):
        fcntl.flock(handle, fcntl.LOCK_SH)  # waits for who was about to release the file
        head = os.pread(handle, superblock.SIZE, 0)
        if superblock.is_sound(head) and not superblock.is_marked(head):
            os.pwrite(handle, superblock.amended(head, superblock.WRITING, superblock.end(head)), 0)


def _write_head(file: BinaryIO, head: bytes) -> None:
    file.seek(0)
    file.write(head)


def _needed(path: Path, file: BinaryIO, said: int, size: int) -> int:
    """Bytes that hold something of a file of this size, of which its head said so many.

    Chunks may be empty at their end, and indices of chunks, too; all else ends with a checksum.
    """
    ends = [said]

    def look(_: str, item: object) -> None:
        if isinstance(item, h5py.Dataset) and item.chunks:
            item.id.chunk_iter(lambda chunk: ends.append(chunk.byte_offset + chunk.size))

    with h5py.File(path, "r", locking=False) as recording:
        recording.visititems(look)
    for begin in reversed(range(said, size, BLOCK)):
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
    access.set_libver_bounds(h5py.h5f.LIBVER_LATEST, h5py.h5f.LIBVER_LATEST)
    if lock is not None:
        access.set_file_locking(lock, True)
    return h5py.File(h5py.h5f.open(os.fsencode(path), h5py.h5f.ACC_RDWR | h5py.h5f.ACC_SWMR_WRITE, access))


def _with_or_without_locks(opened: Callable[[bool | None], Opened]) -> Opened:
    """Open a file, without HDF5's locks where the file system has none."""
    try:
        return opened(None)
    except OSError as error:
        if error.errno not in NO_LOCKS:
            raise
        return opened(False)


def _is_marked(error: OSError) -> bool:
    return "already open for write" in str(error)
