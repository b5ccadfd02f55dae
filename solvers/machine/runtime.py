"""The one place where Taichi is started.

Taichi 1.7.4 silently miscompiles reads of a local vector's element after the vector was reassigned (upstream report
8744); switching its control-flow-graph optimisation off cures it. Every kernel of the lab relies on this module.
"""

import ctypes
import os
import sys
from contextlib import redirect_stdout, suppress
from dataclasses import dataclass
from glob import glob
from io import StringIO
from weakref import WeakSet

import numpy as np
import taichi as ti

from solvers.machine import address_space, kernel_cache, memory, sources
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


sources.remember()

_most_cores = 2**31
_running: tuple | None = None
_starts = 0
_used = False  # whether arrays were made since the last start
_live: WeakSet["Arrays"] = WeakSet()  # those that have not been released
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
    global _running, _starts, _used
    if kernel_cache.missing():
        raise Unavailable(kernel_cache.lacking())
    wanted = (threads or available_cores(), choose_arch(arch, precision), PRECISIONS[precision].real)
    if _running == wanted and not options and (_live or not _used):
        return
    for arrays in _live:
        memory.close(arrays.fields)
    _live.clear()
    _used = False
    with redirect_stdout(StringIO()):  # Taichi announces its backend, and has no switch for it
        _start(*wanted, options)
    _running = None if options else wanted
    _starts += 1


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


class Arrays:
    """Fields of one simulation, in one Taichi field tree.

    One tree, since each tree a kernel touches costs it a pointer to reload in the inner loops (three times slower
    with a tree a field), and since Taichi holds at most 512 trees and frees none by itself. Fields are declared
    first, then `finish` makes and fills them, before others are begun; the last index is contiguous, or with `across`
    the first. What is `kept` makes up the state of a simulation; the rest is scratch, or follows from the scene.
    """

    def __init__(self, precision: str = "f64"):
        kinds = PRECISIONS[precision]
        self.place, self.real = kinds.place, kinds.real
        # Sums and times deserve 64 bits whatever the grains have, where the device can.
        self.exact = ti.f32 if running_arch() == "vulkan" else ti.f64
        self._builder = ti.FieldsBuilder()
        self.fields: list[ti.Field] = []
        self._across: list[bool] = []
        self._kept: dict[str, ti.Field] = {}
        self._bases: dict[int, np.ndarray] = {}
        self._below: dict[int, int] = {}
        self._contents: list[tuple[ti.Field, np.ndarray]] = []
        self._tree = None
        self._born = _starts

    def reals(self, count: int, shape: tuple[int, ...], kind=None, kept: bool = True) -> list[ti.Field]:
        """`count` fields of floats: of the reals' kind, or of another, such as `self.place`."""
        return [self._placed(ti.field(kind or self.real), shape, kept=kept) for _ in range(count)]

    def integers(
        self, count: int, shape: tuple[int, ...], across: bool = False, kept: bool = True, below: int | None = None
    ) -> list[ti.Field]:
        """`count` fields of 32-bit integers; places in other arrays are `below` a number, which `write` checks."""
        fields = [self._placed(ti.field(ti.i32), shape, across, kept) for _ in range(count)]
        return self._bounded(fields, below)

    def vectors(
        self, count: int, size: int, shape: tuple[int, ...], across: bool = False, kept: bool = True
    ) -> list[ti.Field]:
        """`count` fields of vectors of `size` reals."""
        return [self._placed(ti.Vector.field(size, self.real), shape, across, kept) for _ in range(count)]

    def integer_vectors(
        self,
        count: int,
        size: int,
        shape: tuple[int, ...],
        across: bool = False,
        base: np.ndarray | None = None,
        below: int | None = None,
    ) -> list[ti.Field]:
        """`count` fields of vectors of `size` 32-bit integers; `read` and `write` count from `base` (shape[0],)."""
        fields = [self._placed(ti.Vector.field(size, ti.i32), shape, across) for _ in range(count)]
        if base is not None:
            self._bases.update({id(field): base for field in fields})
        return self._bounded(fields, below)

    def _bounded(self, fields: list[ti.Field], below: int | None) -> list[ti.Field]:
        if below is not None:
            self._below.update({id(field): below for field in fields})
        return fields

    def holding(self, values: np.ndarray, kind=None, kept: bool = False) -> ti.Field:
        """A field of reals, or of numbers of another kind, that starts with these values."""
        field = self._placed(ti.field(kind or self.real), values.shape, kept=kept)
        self._contents.append((field, np.ascontiguousarray(values, dtype=np.float64)))
        return field

    def _placed(self, field: ti.Field, shape: tuple[int, ...], across: bool = False, kept: bool = True) -> ti.Field:
        if across:
            self._builder.dense(ti.j, shape[1]).dense(ti.i, shape[0]).place(field)
        else:
            self._builder.dense((ti.i, ti.ij, ti.ijk)[len(shape) - 1], shape).place(field)
        if kept:
            self._kept[f"{len(self.fields):03}"] = field
        self.fields.append(field)
        self._across.append(across)
        return field

    def finish(self) -> None:
        """Make the declared fields, zero but for what they are to hold."""
        global _used
        self._tree = self._builder.finalize()
        _used = True
        _live.add(self)
        if running_arch() == "cpu":
            memory.lay_open(self.fields, self._across)
        for field, values in self._contents:
            field.from_numpy(values.astype(memory.KINDS[field.dtype]))
        self._contents = []

    @property
    def bytes(self) -> int:
        """Memory of the declared fields."""
        return sum(
            int(np.prod(f.shape)) * getattr(f, "n", 1) * np.dtype(memory.KINDS[f.dtype]).itemsize for f in self.fields
        )

    def read(self) -> dict[str, np.ndarray]:
        """What is in the kept fields, by their numbers: all but scratch and what never changes."""
        return {name: field.to_numpy() - self._base(field) for name, field in self._kept.items()}

    def write(self, contents: dict[str, np.ndarray]) -> None:
        """Put back what `read` gave from the same declarations.

        No number is left that is no place in the array that it points into, for a kernel would read and write elsewhere
        in memory. Vectors of places may hold such where they are not in use, in a world that has come from another
        number: these are made zero. Elsewhere they raise ValueError, before anything is put back.
        """
        whole = {name: np.ascontiguousarray(contents[name] + self._base(field)) for name, field in self._kept.items()}
        for name, field in self._kept.items():
            places, below = whole[name], self._below.get(id(field))
            if below is None or not places.size or 0 <= places.min() <= places.max() < below:
                continue
            if not hasattr(field, "n"):
                raise ValueError(f"array {name} has numbers that are no places")
            whole[name] = np.where((places >= 0) & (places < below), places, 0).astype(places.dtype)
        for name, field in self._kept.items():
            field.from_numpy(whole[name])

    def _base(self, field: ti.Field) -> np.ndarray | int:
        base = self._bases.get(id(field))
        return 0 if base is None else base.astype(np.int32).reshape(-1, 1, 1)

    def take_over(self, smaller: "Arrays") -> None:
        """Copy what the same declarations hold in arrays of smaller or equal shapes."""
        for field, old in zip(self.fields, smaller.fields, strict=True):
            contents, held = field.to_numpy(), old.to_numpy()
            contents[tuple(slice(size) for size in held.shape)] = held
            field.from_numpy(contents)

    def release(self) -> None:
        """Give the memory back; the fields must not be used after it."""
        if self._tree is not None and self._born == _starts:
            memory.close(self.fields)
            self._tree.destroy()
        self._tree = None
        _live.discard(self)
