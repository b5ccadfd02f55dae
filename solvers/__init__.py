"""Physics of loose cargo: Taichi kernels and the arrays they own. Knows no file, no preset, no picture."""

import os

os.environ.setdefault("ENABLE_TAICHI_HEADER_PRINT", "0")  # Taichi greets on stdout otherwise
