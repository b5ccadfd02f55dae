"""How long this process has spent on compiling kernels: tracing their Python, and Taichi's compiler or its cache."""

import time
from collections.abc import Callable
from functools import wraps

_spent = 0.0


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
