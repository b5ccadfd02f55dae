"""How much memory this machine has for a run."""

import os
from contextlib import suppress
from pathlib import Path

SHARE = 0.5  # of the machine's memory that a run may take
UNKNOWN = 8 * 2**30  # bytes, assumed where the machine does not tell
GROUP = Path("/sys/fs/cgroup/memory.max")  # what the system allows this process, on Linux


def machine_memory() -> int:
    """Bytes of memory that this process may count on."""
    found = UNKNOWN
    with suppress(AttributeError, ValueError, OSError):  # Windows has no sysconf
        found = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    with suppress(OSError, ValueError):  # no such file, or the word "max"
        found = min(found, int(GROUP.read_text(encoding="ascii")))
    return found
