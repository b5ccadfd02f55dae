"""Folders in which things are kept that cost time to make again: settled beds, tables, kernels, lists of fonts."""

import os
from pathlib import Path

from platformdirs import user_cache_path

from solvers.machine import kernel_cache


def cache_folder() -> Path:
    """The lab's own: that which CARGOLAB_CACHE names, or one in the user's cache."""
    own = os.environ.get("CARGOLAB_CACHE")
    return Path(own) if own else user_cache_path("cargo-shift-lab", appauthor=False)


def provide_for_matplotlib() -> None:
    """Give Matplotlib, before it is imported, a folder in the user's cache where it could not make its usual one.

    It would say so at length, and look for the fonts anew in every process.
    """
    if os.name != "posix" or os.environ.get("MPLCONFIGDIR"):
        return
    home = Path(os.environ.get("HOME") or kernel_cache.NOWHERE)
    usual, cache = (
        Path(os.environ.get(name) or home / folder)
        for name, folder in (("XDG_CONFIG_HOME", ".config"), ("XDG_CACHE_HOME", ".cache"))
    )
    if lacking() or not _could_make(usual):
        os.environ["MPLCONFIGDIR"] = str(cache / "matplotlib")


def _could_make(folder: Path) -> bool:
    """Whether a folder could be made, or files in it, as far as rights tell."""
    there = next(one for one in (folder, *folder.parents) if os.path.lexists(one))
    return there.is_dir() and os.access(there, os.W_OK | os.X_OK)


def lacking() -> str:
    """What costs time since the user has no folder that can be written, in a sentence; empty where there is one."""
    return kernel_cache.lacking()
