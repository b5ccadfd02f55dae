"""Kernels on real vectors: blocks of lanes that the compiler keeps together in the processor's vector registers.

Taichi 1.7.4 splits vectors into scalars before it compiles a kernel, unless `real_matrix_scalarize` is off. A kernel
compiled with it off must read and write scalar fields of `State.wide`, as `ti.Vector([f[b, l] for l in lanes])` with
`lanes` of `ti.static`: elements of a `ti.Vector.field` silently give wrong values. In it negate as 0.0 - v, subtract as
a = a - v, and use no abs, exp, sin, casts or real powers of vectors: most of these abort the process.
"""

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path

import taichi as ti
from taichi.lang.expr import Expr
from taichi.lang.impl import expr_init, subscript
from taichi.lang.matrix import make_matrix

from solvers.machine import compiling

OF_OUTLINES = 4  # lanes of a block
LANES = (0, OF_OUTLINES, 8, 16)  # of outlines, and of discs by the width of registers


@contextmanager
def real_vectors(wanted: bool = True) -> Iterator[None]:
    """Context in which kernels called for the first time keep their vectors whole, if `wanted`; others do not."""
    config = ti.lang.impl.current_cfg()
    before = config.real_matrix_scalarize
    config.real_matrix_scalarize = not wanted
    try:
        yield
    finally:
        config.real_matrix_scalarize = before


def lanes() -> int:
    """Lanes of a block of pairs of discs on real vectors: two registers of 64-bit numbers.

    With AVX-512 two are a seventh faster than one. 0, for no real vectors, on other processors and where kernels are to
    compile fast.
    """
    return 0 if compiling.quick() else registers() // 32


def lanes_of_outlines(precision: str) -> int:
    """Lanes of a block of contacts of outlines on real vectors: a register of AVX2, of 64-bit numbers; 0 for none.

    Eight, in two such registers or as 32-bit numbers in one, take the compiler twice as long. With AVX2 the first are a
    tenth slower than four, and the second 1 to 6 % faster than scalars.
    """
    return OF_OUTLINES if lanes() and precision == "f64" else 0


def told_of_outlines(told: int) -> int:
    """Lanes of outlines by a state. Older ones, of outlines on scalars, tell the lanes that discs would have: 0."""
    return told if told <= OF_OUTLINES else 0


@cache
def registers() -> int:
    """Bits of the processor's vector registers: 512 (AVX-512), 256 (AVX2), or 0 where neither is known of."""
    with suppress(OSError):
        flags = Path("/proc/cpuinfo").read_text(encoding="utf-8", errors="replace").split()
        return 512 if "avx512f" in flags else 256 if "avx2" in flags else 0
    return 0


def on_real_vectors() -> bool:
    """Whether the kernel that is being compiled keeps its vectors whole."""
    return not ti.lang.impl.current_cfg().real_matrix_scalarize


class Lanes:
    """A scalar field (…, lanes) for kernels on real vectors, in which field[row, block] is the vector of a block.

    It can be read and assigned to as that of a field of vectors. One lane of it is `entry(field, row, block, lane)`.
    """

    def __init__(self, field: ti.Field):
        self.field, self.n = field, field.shape[-1]

    def __getattr__(self, name: str) -> object:
        return getattr(self.field, name)

    def __getitem__(self, where: tuple) -> Expr:
        return _Block([subscript(None, self.field, *where, lane) for lane in range(self.n)])


class _Block(Expr):
    """The vector of a block's lanes, read when it is used in an expression, and assigned to lane by lane."""

    def __init__(self, lanes: list[Expr]):
        super().__init__(make_matrix(lanes).ptr)
        self._lanes = lanes

    def _assign(self, value: Expr) -> None:
        value = expr_init(value)
        for k, lane in enumerate(self._lanes):
            lane._assign(subscript(None, value, k))


@ti.func
def entry(field: ti.template(), row, block, lane):
    """One lane of a block in a field of vectors or of `Lanes`."""
    if ti.static(isinstance(field, Lanes)):
        return field.field[row, block, lane]
    else:
        return field[row, block][lane]


@ti.func
def enter(field: ti.template(), row, block, lane, value):
    """Set one lane of a block."""
    if ti.static(isinstance(field, Lanes)):
        field.field[row, block, lane] = value
    else:
        field[row, block][lane] = value


@ti.func
def minus(x):
    """−x, which for vectors has to be written differently on real ones."""
    if ti.static(on_real_vectors()):
        return 0.0 - x
    else:
        return -x


@ti.func
def size(x):
    """|x|, which for vectors has to be written differently on real ones."""
    if ti.static(on_real_vectors()):
        return ti.select(x > 0.0, x, 0.0 - x)
    else:
        return ti.abs(x)
