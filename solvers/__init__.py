"""Physics of loose cargo: Taichi kernels and the arrays they own. Knows no file, no preset, no picture."""

import os

from solvers.machine import kernel_cache

os.environ.setdefault("ENABLE_TAICHI_HEADER_PRINT", "0")  # Taichi greets on stdout otherwise
os.environ.setdefault("TI_SKIP_VERSION_CHECK", "ON")  # and asks its makers' machine for a newer version
kernel_cache.provide()
