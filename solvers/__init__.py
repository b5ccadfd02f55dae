"""Physics of loose cargo: Taichi kernels and the arrays they own. Files, presets and pictures are left to `lab`."""

import os

from solvers.machine import kernel_cache

os.environ.setdefault("ENABLE_TAICHI_HEADER_PRINT", "0")  # otherwise Taichi prints a banner
os.environ.setdefault("TI_SKIP_VERSION_CHECK", "ON")  # and asks a server for newer versions
os.environ.setdefault("TI_ENABLE_PYBUF", "0")  # and says in a notebook that what kernels print goes to the cell
kernel_cache.provide()
