"""The one place where Taichi is started.

Taichi 1.7.4 silently miscompiles reads of a local vector's element after the vector was reassigned (upstream report
8744); switching its control-flow-graph optimisation off cures it. It also draws, for every expression that it traces,
the source lines with a mark under them, in case that one is wrong: half of the time that a simulation takes to set up.
Here it tells file and line. Every kernel of the lab relies on this module.
"""

import ctypes
import os
import sys
from contextlib import redirect_stdout, suppress
from dataclasses import dataclass
from glob import glob
from io import StringIO
from weakref import WeakSet

import taichi as ti
from taichi.lang.ast.ast_transformer_utils import ASTTransformerContext

from solvers.machine import address_space, kernel_cache, memory
from solvers.machine.errors import Unavailable

ARCHES = ("auto", "cpu", "cuda", "vulkan")


@dataclass(frozen=True)
class Precision:
    """Kinds of numbers: of places (m) and times, and of all the rest."""

    place: object
    real: object


PRECISIONS = {
    "f64": Precision(ti.f64, ti.f64),
    "mixed": Precision(ti.f64, ti.f32),
    "f32": Precision(ti.f32, ti.f32),
}


def _place(context: ASTTransformerContext, node) -> str:
    """Where an expression stands, in words."""
    return f'File "{context.file}", line {node.lineno + context.lineno_offset}, in {context.func.func.__name__}:\n'


ASTTransformerContext.get_pos_info = _place

_most_cores = 2**31
_running: tuple | None = None
_used = False  # whether a state was made since the last start
_live: WeakSet = WeakSet()  # states (`machine.state`) that have not been released
_threads: list[int] = []  # Taichi's, in the order in which they began (Linux)


def use_cores(most: int) -> None:
    """Have `available_cores` say no more than this, in a process that shares the machine with others like it."""
    global _most_cores
    _most_cores = most


def available_cores() -> int:
    """Cores this process may use."""
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    return min(cores, _most_cores)


def choose_arch(wanted: str, precision: str) -> str:
    """What "auto" stands for here: CUDA, else a real Vulkan GPU, else the CPU; else what is wanted, if it is there.

    Taichi's Vulkan has no 64-bit functions, so it is for f32 alone; one that runs in software is 5 to 8 times slower
    than the CPU, so it is used on request only. Raises Unavailable, one sentence.
    """
    if wanted == "auto":
        if _cuda():
            return "cuda"
        return "vulkan" if precision == "f32" and _real_vulkan() else "cpu"
    if wanted == "cuda" and not _cuda():
        raise Unavailable("run.arch: there is no CUDA device here; use cpu or auto.")
    if wanted == "vulkan":
        if precision != "f32":
            raise Unavailable('run.arch: vulkan computes in 32 bits only; set run.precision = "f32", or use cpu.')
        if not ti._lib.core.with_vulkan():
            raise Unavailable("run.arch: there is no Vulkan driver here; use cpu or auto.")
    return wanted


def _cuda() -> bool:
    """Whether there is a CUDA driver; asked here first, since Taichi grumbles where there is none."""
    try:
        ctypes.CDLL("nvcuda.dll" if sys.platform == "win32" else "libcuda.so.1")
    except OSError:
        return False
    return bool(ti._lib.core.with_cuda())


def _real_vulkan() -> bool:
    """Whether there is Vulkan and a graphics device behind it."""
    device = not sys.platform.startswith("linux") or bool(glob("/dev/dri/renderD*"))
    return device and bool(ti._lib.core.with_vulkan())


def initialise(threads: int = 0, arch: str = "cpu", precision: str = "f64", **options) -> None:
    """Start Taichi with `threads` threads (0: all cores); nothing happens if it runs like that already.

    Starting it anew invalidates every field and kernel made before. It is also done where no arrays are in use any
    more: Taichi numbers its fields from the start on, and finds a kernel that it has compiled before only where the
    fields have the same numbers. Raises Unavailable (see `choose_arch`), also where Taichi lacks a folder or memory.
    """
    global _running, _used
    if kernel_cache.missing():
        raise Unavailable(kernel_cache.lacking())
    wanted = (threads or available_cores(), choose_arch(arch, precision), PRECISIONS[precision].real)
    if _running == wanted and not options and (_live or not _used):
        return
    for state in _live:
        memory.close(state.fields)
    _live.clear()
    _used = False
    with redirect_stdout(StringIO()):  # Taichi announces its backend, and has no switch for it
        _start(*wanted, options)
    _running = None if options else wanted


def _start(threads: int, arch: str, real, options: dict) -> None:
    before = _own_threads()
    address_space.check()
    ti.init(
        arch=getattr(ti, arch),
        default_fp=real,
        cpu_max_num_threads=threads,
        cfg_optimization=False,
        # Taichi warns of every place where a 64-bit time is meant to lose digits, and when two processes share a cache.
        log_level=ti.ERROR,
        offline_cache=True,
        **options,
    )
    _threads[:] = sorted(_own_threads() - before)


def _own_threads() -> set[int]:
    return {int(name) for name in os.listdir("/proc/self/task")} if sys.platform == "linux" else set()


def spread_threads() -> None:
    """Hold Taichi's threads, where they are as many as the cores, to cores of their own (Linux).

    Bands of a world wait for each other by spinning. Beside a busy program Linux may give all of them one core, where
    each waits until the other's time is up: a step then took 180 times as long, held to their cores 2.6 times (2500
    grains, two cores).
    """
    if not _threads or not _running or _running[0] != len(os.sched_getaffinity(0)):
        return
    cores = sorted(os.sched_getaffinity(0))
    for place, thread in enumerate(_threads):  # a pool's threads follow one another, so none of its share a core
        with suppress(OSError):  # it has ended
            os.sched_setaffinity(thread, {cores[place % len(cores)]})


def merge_repeats(wanted: bool) -> None:
    """Whether Taichi is to look in kernels that are compiled from here on for what is worked out twice.

    Its search takes a time that grows as the square of a kernel's length, and much of what it finds LLVM finds, too. Of
    discs' kernels it takes 3 of 7 s and makes them a fifth faster; of outlines' 15 of 25 s, or 42 of 60 where they
    bend, for 5 to 15 % (each measured side by side on one core).
    """
    ti.lang.impl.current_cfg().opt_level = int(wanted)


def running_arch() -> str:
    """The arch Taichi runs on, "cpu", "cuda" or "vulkan"."""
    return _running[1] if _running else "cpu"


def take_in(state) -> None:
    """Count a `State` that has its memory now among those in use."""
    global _used
    _used = True
    _live.add(state)


def let_go(state) -> bool:
    """Count a state as released; returns whether Taichi still has its memory, not having been started anew."""
    held = state in _live
    _live.discard(state)
    return held
