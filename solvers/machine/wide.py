"""Kernels on real vectors: blocks of lanes that the compiler keeps together in the processor's vector registers.

Taichi 1.7.4 takes vectors apart into scalars before it compiles a kernel, unless `real_matrix_scalarize` is off. What
such a kernel reads and writes are the scalar fields of `State.wide`, as `ti.Vector([f[b, l] for l in lanes])` with
`lanes` of `ti.static`: elements of a `ti.Vector.field` come out as rubbish without a word. Within it negate as 0.0 - v,
subtract as a = a - v, and take no abs, exp, sin, casts or real powers of vectors: most of these abort the process.
"""

from collections.abc import Iterator
from contextlib import contextmanager

import taichi as ti


@contextmanager
def real_vectors() -> Iterator[None]:
    """Have kernels whose first call is made in here keep their vectors whole; other kernels stay as they are."""
    config = ti.lang.impl.current_cfg()
    before = config.real_matrix_scalarize
    config.real_matrix_scalarize = False
    try:
        yield
    finally:
        config.real_matrix_scalarize = before
