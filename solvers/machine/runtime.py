"""The one place where Taichi is started.

Taichi 1.7.4 silently miscompiles reads of a local vector's element after the vector was reassigned (upstream report
8744); switching its control-flow-graph optimisation off cures it. Every kernel of the lab relies on this module.
"""

import atexit
import ctypes
import gc
import os
import sys
from contextlib import redirect_stdout, suppress
from dataclasses import dataclass
from glob import glob
from io import StringIO
from weakref import WeakSet

from solvers.machine import sources  # first, since it loads Taichi faster

# isort: split
import taichi as ti

from solvers.machine import address_space, compiling, kernel_cache, memory
from solvers.machine.errors import Unavailable

ARCHES = ("auto", "cpu", "cuda", "vulkan")
# Grains and particles of water a core that a core moves in 0.3 ms (20 ns and 0.3 µs each, Zen 4), the least time of a
# step on a graphics processor (H200): from there on the device can be faster.
WORTH_OF_GRAINS, WORTH_OF_WATER = 15_000, 1000
KERNELS = 256 * 2**20  # bytes of compiled kernels kept; one of water takes 2 MB, and Taichi's 100 MiB are soon full


@dataclass(frozen=True)
class Precision:
    """Number types: `place` for positions (m), `real` for the rest."""

    place: object
    real: object


PRECISIONS = {
    "f64": Precision(ti.f64, ti.f64),
    "mixed": Precision(ti.f64, ti.f32),
    "f32": Precision(ti.f32, ti.f32),
}


sources.remember()
compiling.watch()
compiling.compute_once()
compiling.copy_once()

_most_cores = 2**31
_running: tuple | None = None
_used = False  # whether a state was made since the last start
_started_by = 0  # the process that has started Taichi; 0: none yet
_live: WeakSet = WeakSet()  # states (`machine.state`) that have not been released
_threads: list[int] = []  # Taichi's threads in the order in which they started (Linux)


def use_cores(most: int) -> None:
    """Limit what `available_cores` returns, in a process that shares the machine with others like it."""
    global _most_cores
    _most_cores = most


def available_cores() -> int:
    """Cores this process may use."""
    return min(cores_of_machine(), _most_cores)


def cores_of_machine() -> int:
    """Cores that this process and those beside it share."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def choose_arch(wanted: str, precision: str, water: bool = False, particles: int = 0) -> str:
    """The arch to use: for "auto" CUDA, else a Vulkan GPU in hardware, else the CPU; otherwise the one `wanted`.

    A step on a graphics processor takes some 0.3 ms however few particles it moves, so "auto" takes one only for at
    least WORTH_OF_GRAINS or WORTH_OF_WATER `particles` a core, those of all worlds together. Taichi's Vulkan backend
    has no 64-bit functions, so it serves f32 only. Software Vulkan is 5 to 8 times slower than the CPU, so it is used
    on request only. It cannot compile the kernels of particles of water (Taichi 1.7.4; "Value does not yet exist",
    which is known of other programs, too), so `water` has none. Raises Unavailable, one sentence, if the wanted arch
    is not there, or if nothing can be computed in this process.
    """
    if _started_by not in (0, os.getpid()):
        raise Unavailable(
            "this process was forked from one in which the lab has computed, and has none of its threads: start it "
            "anew, in Python by multiprocessing.get_context('spawn'), or fork before the first run."
        )
    if wanted == "auto":
        least = WORTH_OF_WATER if water else WORTH_OF_GRAINS
        if particles < least * cores_of_machine():  # processes side by side have one device as well
            return "cpu"
        if has_cuda():
            return "cuda"
        return "vulkan" if precision == "f32" and not water and has_vulkan() else "cpu"
    if wanted == "cuda" and not has_cuda():
        raise Unavailable("run.arch: there is no CUDA device here; use cpu or auto.")
    if wanted == "vulkan":
        if water:
            raise Unavailable("run.arch: Taichi cannot compile water for vulkan; use cuda or cpu.")
        if precision != "f32":
            raise Unavailable('run.arch: vulkan computes in 32 bits only; set run.precision = "f32", or use cpu.')
        if not ti._lib.core.with_vulkan():
            raise Unavailable("run.arch: there is no Vulkan driver here; use cpu or auto.")
    return wanted


def has_cuda() -> bool:
    """Whether there is a CUDA driver; checked here first, since Taichi prints a warning if there is none."""
    try:
        ctypes.CDLL("nvcuda.dll" if sys.platform == "win32" else "libcuda.so.1")
    except OSError:
        return False
    return bool(ti._lib.core.withhas_cuda())


def has_vulkan() -> bool:
    """Whether there is Vulkan with a graphics device behind it."""
    device = not sys.platform.startswith("linux") or bool(glob("/dev/dri/renderD*"))
    return device and bool(ti._lib.core.with_vulkan())


def initialise(
    threads: int = 0, arch: str = "cpu", precision: str = "f64", *, fields: bool = True, **options: object
) -> None:
    """Start Taichi with `threads` threads (0: all cores); nothing happens if it runs with these settings already.

    A restart invalidates every field and kernel made before. For kernels of `fields` Taichi is also restarted when it
    has run, or has held arrays, and no arrays are in use any more: it numbers its fields from the start on, and finds a
    cached kernel only if the fields have the same numbers again. Kernels that are given all their arrays, as those that
    paint, need no `fields`. Raises Unavailable (see `choose_arch`), also if Taichi lacks a cache folder or memory.
    """
    global _running, _used
    if kernel_cache.missing():
        raise Unavailable(kernel_cache.lacking())
    wanted = (threads or available_cores(), choose_arch(arch, precision), PRECISIONS[precision].real)
    if _live:
        gc.collect()  # a simulation that nobody uses any more refers to itself in circles
    anew = _forget_refused() and not _live
    fresh = _live or not (_used or ti.lang.impl.get_runtime().materialized)
    if _running == wanted and not options and not anew and (fresh or not fields):
        return
    for state in _live:
        memory.close(state.fields)
    _live.clear()
    _used = False
    with redirect_stdout(StringIO()):  # Taichi prints its backend, and no option turns that off
        _start(*wanted, options)
    _running = None if options else wanted


def _forget_refused() -> bool:
    """Forget the fields of simulations that ended as they were made; returns whether there were any."""
    waiting = ti.lang.impl.get_runtime().unfinalized_fields_builder
    refused = [builder for builder in waiting if builder is not ti.lang.impl._root_fb]  # which is Taichi's own
    for builder in refused:
        del waiting[builder]
    return bool(refused)


def _start(threads: int, arch: str, real, options: dict) -> None:
    global _started_by
    before = _own_threads()
    address_space.check()
    _started_by = os.getpid()
    ti.init(
        arch=getattr(ti, arch),
        default_fp=real,
        cpu_max_num_threads=threads,
        cfg_optimization=False,
        # Taichi warns at every intended cast of a 64-bit time to 32 bits, and when two processes share a cache.
        log_level=ti.ERROR,
        offline_cache=True,
        offline_cache_max_size_of_files=KERNELS,
        **options,
    )
    _threads[:] = sorted(_own_threads() - before)


def _keep_kernels() -> None:
    """Have Taichi write the kernels that it compiled: it does so as its program ends, which Python may never end."""
    if _started_by == os.getpid():
        ti.lang.impl.get_runtime().clear()


atexit.register(_keep_kernels)


def _own_threads() -> set[int]:
    return {int(name) for name in os.listdir("/proc/self/task")} if sys.platform == "linux" else set()


def spread_threads() -> None:
    """Pin each of Taichi's threads to its own core if there are as many threads as cores (Linux).

    Bands of a world wait for each other by spinning. Beside a busy program Linux may put all of them on one core, where
    each spins until its time slice ends: a step then took 180 times as long, with pinned threads 2.6 times (2500
    grains, two cores).
    """
    if not _threads or not _running or _running[0] != len(os.sched_getaffinity(0)):
        return
    cores = sorted(os.sched_getaffinity(0))
    for place, thread in enumerate(_threads):  # threads of one pool are consecutive, so no two of them share a core
        with suppress(OSError):  # the thread has ended
            os.sched_setaffinity(thread, {cores[place % len(cores)]})


def merge_repeats(wanted: bool) -> None:
    """Switch Taichi's elimination of common subexpressions on or off for kernels compiled from here on.

    Its time grows as the square of a kernel's length, and LLVM finds much of the same. For discs it takes 3 of 7 s of
    compilation and makes kernels a fifth faster; for outlines 15 of 25 s, for non-convex ones 42 of 60 s, and gains 5
    to 15 %; for water 7 of 13 s, and gains nothing (each measured side by side on one core). It stays off where kernels
    are to compile fast (`machine.compiling`). There long kernels, those for which it is off anyway, are not simplified
    over and over, either: each statement that is replaced is a walk through the whole kernel, and these are half of the
    rest. Of 11 s for water that takes 3.
    """
    config = ti.lang.impl.current_cfg()
    config.opt_level = int(wanted and not compiling.quick())
    config.advanced_optimization = not compiling.quick()


def running_arch() -> str:
    """The arch Taichi runs on, "cpu", "cuda" or "vulkan"."""
    return _running[1] if _running else "cpu"


def take_in(state) -> None:
    """Register a `State` whose memory has been allocated."""
    global _used
    _used = True
    _live.add(state)


def states() -> int:
    """How many states have memory."""
    return len(_live)


def is_live(state) -> bool:
    """Whether a registered state still has its memory."""
    return state in _live


def let_go(state) -> bool:
    """Unregister a state; returns whether its memory is still allocated, since Taichi was not restarted."""
    held = state in _live
    _live.discard(state)
    return held
