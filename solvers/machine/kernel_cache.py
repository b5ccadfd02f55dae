"""A folder in which Taichi can keep compiled kernels, found before Taichi is imported.

Taichi 1.7.4 keeps them in taichi/ticache of the user's cache folder. Without a home it aborts as it is imported, and
where it cannot make that folder it ends in a segmentation fault. Such a person gets a folder for this process and those
that it starts, which goes when it ends. A process that was killed while it wrote there leaves Taichi's lock behind;
Taichi then neither reads nor writes kernels any more, without a word, until that file is removed.
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
    """Have the environment name a folder that can be written, if it does not, and remove a lock that is left there."""
    global _lacking
    if os.name != "posix":  # elsewhere Taichi has a folder of its own
        return
    folder = _usual()
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
    """What this process lacks and what that costs, in a sentence; empty where it has a folder that lasts."""
    return _lacking


def missing() -> bool:
    """Whether there is no folder at all, so that Taichi must not be started."""
    return os.environ.get("XDG_CACHE_HOME") == NOWHERE


def _usual() -> Path | None:
    """Where Taichi looks."""
    base, home = os.environ.get("XDG_CACHE_HOME"), os.environ.get("HOME")
    if base == NOWHERE or not (base or home):
        return None
    return (Path(base) if base else Path(home) / ".cache") / "taichi" / "ticache"


def _usable(folder: Path) -> bool:
    """Whether files can be made in a folder, itself made if missing."""
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
    """A folder that goes when this process ends; empty where none can be made."""
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
        taichi.reset()  # which writes its kernels, and would make the folder again later
    shutil.rmtree(folder, ignore_errors=True)
