"""The memory that a run may use on this machine, and what it uses, in words."""

import os
from contextlib import suppress
from pathlib import Path

import numpy as np

from solvers.machine.quantity import PLANE

SHARE = 0.5  # of the machine's memory that a run may take
UNKNOWN = 8 * 2**30  # bytes, assumed where the size is not known
# Of water in space, measured as resident memory of `cargolab run` without a video: 340 MiB with 1 700 particles; with
# 56 000, 230 000 and 1 064 000 these numbers give 426, 656 and 1 684 MiB where 396, 638 and 1 707 were found
PROGRAM = 340 * 2**20  # bytes of Python, its libraries, Taichi and the kernels
BESIDE = 400  # bytes a particle: the scene as it was laid, a row of what is recorded, copies of single arrays
GROUP = Path("/sys/fs/cgroup/memory.max")  # the limit for this process, on Linux


def machine_memory() -> int:
    """Bytes of memory available to this process."""
    found = UNKNOWN
    with suppress(AttributeError, ValueError, OSError):  # Windows has no sysconf
        found = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    with suppress(OSError, ValueError):  # no such file, or the word "max"
        found = min(found, int(GROUP.read_text(encoding="ascii")))
    return found


def memory_of(simulation, worlds: int, count: int, what: str) -> str:
    """The memory of so many worlds as a `solvers.simulation.Simulation` is one, with `count` particles in each.

    At its peak a run holds a copy of its state, for a checkpoint and at the first look.
    """
    size = simulation.arrays.bytes
    told = f"{worlds * size / 2**20:.1f} MiB" + (f", {size / count:.0f} bytes a {what}" if count else "")
    if simulation.scene.axes == PLANE or not simulation.water:
        return told
    from solvers.machine.memory import KINDS  # here, since it loads Taichi, and a file that is refused does not need it

    kept = [array for array in simulation.arrays.arrays.values() if array.kept]
    copy = sum(int(np.prod(array.shape)) * np.dtype(KINDS[array.field.dtype]).itemsize for array in kept)
    peak = PROGRAM + worlds * (size + copy + BESIDE * count)
    return f"{told}, in arrays; some {peak / 2**20:.0f} MiB at the peak of a run"
