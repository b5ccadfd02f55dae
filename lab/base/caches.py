"""Cache folders for results that take time to compute: settled beds, tables, kernels, lists of fonts."""

import os
from pathlib import Path

from platformdirs import user_cache_path

from solvers.machine import kernel_cache


def cache_folder() -> Path:
    """The lab's cache folder: the one that CARGOLAB_CACHE names, else one in the user's cache."""
    own = os.environ.get("CARGOLAB_CACHE")
    return Path(own) if own else user_cache_path("cargo-shift-lab", appauthor=False)


def provide_for_matplotlib() -> None:
    """Point Matplotlib to a folder in the user's cache if it could not create its usual one. Call before importing it.

    Without a folder Matplotlib prints a long warning and searches for fonts again in every process.
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
    """Whether the permissions allow creating this folder, or files in it."""
    there = next(one for one in (folder, *folder.parents) if os.path.lexists(one))
    return there.is_dir() and os.access(there, os.W_OK | os.X_OK)


def lacking() -> str:
    """One sentence on what is slower because the user has no writable folder; empty if there is one."""
    return kernel_cache.lacking()
