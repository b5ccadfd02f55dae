"""The one place where Taichi is started.

Taichi 1.7.4 silently miscompiles reads of a local vector's element after the vector was reassigned (upstream report
8744); switching its control-flow-graph optimisation off cures it. Every kernel of the lab relies on this module.
"""

import os
from contextlib import redirect_stdout
from io import StringIO

import numpy as np
import taichi as ti

_threads: int | None = None
_starts = 0


def available_cores() -> int:
    """Cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def initialise(threads: int = 0, **options) -> None:
    """Start Taichi on the CPU with `threads` threads (0: all cores); nothing happens if it runs like that already.

    Starting it anew invalidates every field and kernel made before.
    """
    global _threads, _starts
    wanted = threads or available_cores()
    if _threads == wanted and not options:
        return
    with redirect_stdout(StringIO()):  # Taichi announces its backend, and has no switch for it
        _start(wanted, options)
    _threads = None if options else wanted
    _starts += 1


def _start(threads: int, options: dict) -> None:
    ti.init(
        arch=ti.cpu,
        default_fp=ti.f64,
        cpu_max_num_threads=threads,
        cfg_optimization=False,
        log_level=ti.WARN,
        offline_cache=True,
        **options,
    )


@ti.data_oriented
class Arrays:
    """Fields of one simulation, in one Taichi field tree.

    One tree, since each tree a kernel touches costs it a pointer to reload in the inner loops (three times slower
    with a tree a field), and since Taichi holds at most 512 trees and frees none by itself. Fields are declared
    first, then `finish` makes and fills them; the last index is contiguous.
    """

    def __init__(self):
        self._builder = ti.FieldsBuilder()
        self._fields: list[ti.Field] = []
        self._contents: list[tuple[ti.Field, np.ndarray]] = []
        self._tree = None
        self._born = _starts

    def reals(self, count: int, shape: tuple[int, ...]) -> list[ti.Field]:
        """`count` fields of 64-bit floats."""
        return [self._placed(ti.field(ti.f64), shape) for _ in range(count)]

    def integers(self, count: int, shape: tuple[int, ...]) -> list[ti.Field]:
        """`count` fields of 32-bit integers."""
        return [self._placed(ti.field(ti.i32), shape) for _ in range(count)]

    def vectors(self, count: int, size: int, shape: tuple[int, ...]) -> list[ti.Field]:
        """`count` fields of vectors of `size` 64-bit floats."""
        return [self._placed(ti.Vector.field(size, ti.f64), shape) for _ in range(count)]

    def integer_vectors(self, count: int, size: int, shape: tuple[int, ...]) -> list[ti.Field]:
        """`count` fields of vectors of `size` 32-bit integers."""
        return [self._placed(ti.Vector.field(size, ti.i32), shape) for _ in range(count)]

    def holding(self, values: np.ndarray) -> ti.Field:
        """A field of 64-bit floats that starts with these values."""
        field = self._placed(ti.field(ti.f64), values.shape)
        self._contents.append((field, np.ascontiguousarray(values, dtype=np.float64)))
        return field

    def _placed(self, field: ti.Field, shape: tuple[int, ...]) -> ti.Field:
        axes = (ti.i, ti.ij, ti.ijk)[len(shape) - 1]
        self._builder.dense(axes, shape).place(field)
        self._fields.append(field)
        return field

    def finish(self) -> None:
        """Make the declared fields, zero but for what they are to hold."""
        self._tree = self._builder.finalize()
        self._count = len(self._fields)
        for field, values in self._contents:
            field.from_numpy(values)
        self._contents = []

    @property
    def bytes(self) -> int:
        """Memory of the declared fields."""
        return sum(int(np.prod(f.shape)) * getattr(f, "n", 1) * (4 if f.dtype == ti.i32 else 8) for f in self._fields)

    def take_over(self, smaller: "Arrays") -> None:
        """Copy what the same declarations hold in arrays of smaller or equal shapes."""
        self._copy(smaller)

    @ti.kernel
    def _copy(self, smaller: ti.template()):
        for k in ti.static(range(self._count)):
            for place in ti.grouped(smaller._fields[k]):
                self._fields[k][place] = smaller._fields[k][place]

    def release(self) -> None:
        """Give the memory back; the fields must not be used after it."""
        if self._tree is not None and self._born == _starts:
            self._tree.destroy()
        self._tree = None
