"""Physics of loose cargo: Taichi kernels and the arrays they own. Knows no file, no preset, no picture."""
