"""How long this process has spent on compiling kernels, what shortens it, and whether it is to be as short as may be.

The time is that of tracing their Python, and of Taichi's compiler or its cache. With CARGOLAB_COMPILE=quick in the
environment, the kernels of discs take half the time to compile and run a fifth slower: neither on real vectors
(`machine.wide`) nor with their common subexpressions merged (`runtime.merge_repeats`). Numbers change in their last
digits. Those of water and of outlines take three quarters of the time.
"""

import os
import time
from collections.abc import Callable
from functools import wraps

from solvers.machine.errors import Unavailable

_spent = 0.0


def quick() -> bool:
    """Whether kernels are to compile fast rather than run fast. Raises Unavailable, one sentence, if it is unclear."""
    wanted = os.environ.get("CARGOLAB_COMPILE", "")
    if wanted not in ("", "quick"):
        raise Unavailable(f"CARGOLAB_COMPILE is {wanted!r}: set it to quick, or not at all.")
    return bool(wanted)


def seconds() -> float:
    """Seconds spent so far."""
    return _spent


def watch() -> None:
    """Have Taichi's two steps of compiling a kernel be timed from now on; needs Taichi to be imported."""
    from taichi._lib.core.taichi_python import Program
    from taichi.lang.kernel_impl import Kernel

    for kind, step in ((Kernel, "materialize"), (Program, "compile_kernel")):
        if not hasattr(getattr(kind, step), "__wrapped__"):
            setattr(kind, step, _timed(getattr(kind, step)))


def compute_once() -> None:
    """Have a number that is combined with a vector be computed once from now on; needs Taichi to be imported.

    Taichi 1.7.4 writes it out for each component: `volume[j] * lanes` reads the array 16 times, until LLVM finds that
    all are the same. That was half of the statements of a kernel of water, and its compiler walks through all of them
    for each one that it replaces. Such a kernel now compiles in three fifths of the time. A step costs the same
    within the scatter of its timings, 5 % and, with air, 15 %.
    """
    from taichi.lang import ops

    if not hasattr(ops._binary_operation, "__wrapped__"):
        ops._binary_operation = _with_numbers_kept(ops._binary_operation)


def _with_numbers_kept(operation: Callable) -> Callable:
    from taichi.lang.expr import Expr
    from taichi.lang.impl import expr_init

    @wraps(operation)
    def kept(compiled: Callable, interpreted: Callable, a, b):
        if isinstance(a, Expr) and isinstance(b, Expr) and a.ptr.is_tensor() != b.ptr.is_tensor():
            a, b = (one if one.ptr.is_tensor() else expr_init(one) for one in (a, b))
        return operation(compiled, interpreted, a, b)

    return kept


def _timed(step: Callable) -> Callable:
    @wraps(step)
    def timed(*args, **kwargs):
        global _spent
        begun = time.perf_counter()
        try:
            return step(*args, **kwargs)
        finally:
            _spent += time.perf_counter() - begun

    return timed
