"""Minimum, maximum and clamping of numbers or vectors, in the fewest instructions.

Taichi's own `min` and `max` treat NaN specially and take three instructions where the processor has one. Here a
comparison with NaN is false, so the second argument is taken.
"""

import taichi as ti

from solvers.machine.wide import minus


@ti.func
def lesser(a, b):
    """The lesser of a and b."""
    return ti.select(a < b, a, b)


@ti.func
def greater(a, b):
    """The greater of a and b."""
    return ti.select(a > b, a, b)


@ti.func
def within(value, most):
    """The value, clamped to between −most and most."""
    return greater(lesser(value, most), minus(most))
