"""What the lab keeps on a machine between runs: it makes runs start sooner, and may be deleted at any time."""

import os
import shutil
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from lab.base.caches import cache_folder
from lab.base.errors import LabError
from solvers.machine.kernel_cache import usual_folder

OF_LAB = {  # folders in the lab's cache, and what deleting each costs
    "beds": ("settled beds", "they settle anew"),
    "hydrodynamics": ("what water does to hulls", "it is computed anew, seconds to minutes a hull"),
    "collisions": ("collisions of outlines", "they are computed anew, seconds"),
    "presets": ("presets from tables and texts in Python", "nothing, they are written anew"),
}


@dataclass(frozen=True)
class Store:
    """A store: its name, its folder, what it holds, and what deleting it costs."""

    name: str
    folder: Path
    holds: str
    costs: str


def stores() -> list[Store]:
    """All stores, whether they are there or not."""
    found = [Store(name, cache_folder() / name, *about) for name, about in OF_LAB.items()]
    kernels = usual_folder()
    if kernels is not None:
        found.insert(0, Store("kernels", kernels, "compiled kernels", "the next runs compile theirs anew"))
    return found


def size_of(folder: Path) -> int:
    """Bytes of the files in a folder; 0 if it is not there."""
    total = 0
    for place, _, files in os.walk(folder):
        for name in files:
            try:
                total += os.lstat(os.path.join(place, name)).st_size
            except OSError:  # another process has just removed it
                continue
    return total


def clear(names: Sequence[str]) -> int:
    """Delete what these stores hold, all without names; returns how many bytes. Raises LabError for an unknown name."""
    known = {store.name: store for store in stores()}
    for name in names:
        if name not in known:
            raise LabError(f"cache: there is no store {name!r}; there are {', '.join(known)}.")
    freed = 0
    for store in (known[name] for name in names or known):
        size = size_of(store.folder)
        shutil.rmtree(store.folder, ignore_errors=True)
        freed += size - size_of(store.folder)
    return freed


def told() -> str:
    """The stores with their sizes, as lines of text."""
    found = stores()
    width = max(len(store.name) for store in found)
    lines = [
        f"{store.name:<{width}}  {size_of(store.folder) / 2**20:8.1f} MiB  {store.holds}; without: {store.costs}"
        for store in found
    ]
    folders = dict.fromkeys(str(store.folder.parent) for store in found)
    return "\n".join([*lines, *(f"in {folder}" for folder in folders)]) + "\n"
