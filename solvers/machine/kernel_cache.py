"""The folder in which Taichi caches compiled kernels, provided before Taichi is imported.

Taichi 1.7.4 keeps them in taichi/ticache of the user's cache folder. If HOME is not set it aborts on import, and if it
cannot make that folder it ends in a segmentation fault. In both cases this process and its children get a temporary
folder, which is removed when the process ends. A process killed while it writes there leaves Taichi's lock file behind;
Taichi then silently stops reading and writing cached kernels until that file is removed.
"""

import atexit
import os
import shutil
import sys
import tempfile
import time
from contextlib import suppress
from pathlib import Path

LOCK = "ticache.lock"
STALE = 60.0  # s: Taichi holds its lock while it writes its files, a moment
NOWHERE = os.path.join(os.sep, "nonexistent")

_lacking = ""


def provide() -> None:
    """Make sure that the environment names a writable cache folder, and remove a stale lock from it."""
    global _lacking
    if os.name != "posix":  # elsewhere Taichi has a folder of its own
        return
    folder = usual_folder()
    if folder and _usable(folder):
        _unlock(folder)
        return
    where = f"{folder} cannot be written" if folder else "HOME is not set"
    own = _temporary()
    os.environ["XDG_CACHE_HOME"] = own or NOWHERE
    remedy = "set XDG_CACHE_HOME to a folder that can be written"
    slower = "kernels are compiled anew in every run"
    _lacking = f"{where}: {slower}; {remedy}." if own else f"{where}, nor any temporary folder: {remedy}."


def lacking() -> str:
    """One sentence on the missing cache folder and what that costs; empty if the folder is a permanent one."""
    return _lacking


def missing() -> bool:
    """Whether there is no cache folder at all, so that Taichi must not be started."""
    return os.environ.get("XDG_CACHE_HOME") == NOWHERE


def usual_folder() -> Path | None:
    """The folder that Taichi uses by default; None if there is none."""
    base, home = os.environ.get("XDG_CACHE_HOME"), os.environ.get("HOME")
    if base == NOWHERE or not (base or home):
        return None
    return (Path(base) if base else Path(home) / ".cache") / "taichi" / "ticache"


def _usable(folder: Path) -> bool:
    """Whether files can be written in a folder, which is made if missing."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return True
    except (OSError, ValueError):  # ValueError: a null byte in its name
        return False


def _unlock(folder: Path) -> None:
    with suppress(OSError):
        if abs(time.time() - (folder / LOCK).stat().st_mtime) > STALE:
            (folder / LOCK).unlink()


def _temporary() -> str:
    """A temporary folder, removed when this process ends; empty if none can be made."""
    try:
        folder = tempfile.mkdtemp(prefix="cargolab-")
    except OSError:
        return ""
    atexit.register(_remove, folder, os.getpid())
    return folder


def _remove(folder: str, maker: int) -> None:
    if os.getpid() != maker:
        return
    if taichi := sys.modules.get("taichi"):
        taichi.reset()  # it writes its kernels now; at exit it would make the folder again
    shutil.rmtree(folder, ignore_errors=True)
