"""Kernels on real vectors: blocks of lanes that the compiler keeps together in the processor's vector registers.

Taichi 1.7.4 splits vectors into scalars before it compiles a kernel, unless `real_matrix_scalarize` is off. A kernel
compiled with it off must read and write scalar fields of `State.wide`, as `ti.Vector([f[b, l] for l in lanes])` with
`lanes` of `ti.static`: elements of a `ti.Vector.field` silently give wrong values. In it negate as 0.0 - v, subtract as
a = a - v, and use no abs, exp, sin, casts or real powers of vectors: most of these abort the process.
"""

from collections.abc import Iterator
from contextlib import contextmanager

import taichi as ti


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
