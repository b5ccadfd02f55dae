"""Pixels: grains, water and lines in a numpy array."""

from solvers.machine import runtime  # noqa: F401 (first: a Taichi that cannot be loaded is told there)
