"""The lesser, the greater and the limited of two numbers or vectors, in the fewest instructions.

Taichi's own `min` and `max` look out for what is not a number and take three instructions where the processor has one.
Here a comparison with what is not a number is false, and the second of the two is taken.
"""

import taichi as ti


@ti.func
def lesser(a, b):
    """The lesser of two."""
    return ti.select(a < b, a, b)


@ti.func
def greater(a, b):
    """The greater of two."""
    return ti.select(a > b, a, b)


@ti.func
def within(value, most):
    """The value, or ±most where it is larger, with the value's sign."""
    return greater(lesser(value, most), -most)
