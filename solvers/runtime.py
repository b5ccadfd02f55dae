"""The one place where Taichi is started.

Taichi 1.7.4 silently miscompiles reads of a local vector's element after the vector was reassigned (upstream report
8744); switching its control-flow-graph optimisation off cures it. Every kernel of the lab relies on this module.
"""

import os

import taichi as ti

_threads: int | None = None


def available_cores() -> int:
    """Cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def initialise(threads: int = 0, **options) -> None:
    """Start Taichi on the CPU with `threads` threads (0: all cores); nothing happens if it runs like that already.

    Starting it anew invalidates every field and kernel made before.
    """
    global _threads
    wanted = threads or available_cores()
    if _threads == wanted and not options:
        return
    ti.init(
        arch=ti.cpu,
        default_fp=ti.f64,
        cpu_max_num_threads=wanted,
        cfg_optimization=False,
        log_level=ti.WARN,
        offline_cache=True,
        **options,
    )
    _threads = None if options else wanted
