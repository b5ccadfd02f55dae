"""The memory that a run may use on this machine."""

import os
from contextlib import suppress
from pathlib import Path

SHARE = 0.5  # of the machine's memory that a run may take
UNKNOWN = 8 * 2**30  # bytes, assumed where the size is not known
GROUP = Path("/sys/fs/cgroup/memory.max")  # the limit for this process, on Linux


def machine_memory() -> int:
    """Bytes of memory available to this process."""
    found = UNKNOWN
    with suppress(AttributeError, ValueError, OSError):  # Windows has no sysconf
        found = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    with suppress(OSError, ValueError):  # no such file, or the word "max"
        found = min(found, int(GROUP.read_text(encoding="ascii")))
    return found
