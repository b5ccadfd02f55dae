"""Grains: state, lists of contacts, laws, integrators, and how they are filled in and moved."""

from solvers.machine import runtime  # noqa: F401 (it changes how Taichi declares the functions of this package)
