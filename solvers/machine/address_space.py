"""Check that a memory limit leaves Taichi enough address space to start; without it Taichi aborts the program."""

import os
from pathlib import Path

from solvers.machine.errors import Unavailable

try:
    import resource
except ImportError:  # Windows
    resource = None

NEEDED = 1.6e9  # bytes of address space: a pool of 1 GiB, the compiler, stacks; 1.4e9 measured on one thread


def check() -> None:
    """Raise Unavailable, one sentence, if less than NEEDED bytes are left."""
    limit = resource.getrlimit(resource.RLIMIT_AS)[0] if resource else -1
    if limit in (-1, getattr(resource, "RLIM_INFINITY", -1)):
        return
    try:
        taken = int(Path("/proc/self/statm").read_text().split()[0]) * os.sysconf("SC_PAGE_SIZE")
    except (OSError, ValueError):
        taken = 0
    if limit - taken < NEEDED:
        raise Unavailable(
            f"the limit on memory leaves {max(0, limit - taken) / 1e9:.1f} GB of address space, and Taichi needs "
            f"{NEEDED / 1e9:g} GB to start: raise it with ulimit -v."
        )
