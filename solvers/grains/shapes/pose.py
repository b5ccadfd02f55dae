"""The orientation of an outline, by the cosine and sine of its angle."""

from math import factorial, pi

import taichi as ti

# Taylor coefficients in powers of the square of an angle up to π/4; the first term left out is below 1e-16 of the sum.
COSINE = [(-1.0) ** k / factorial(2 * k) for k in range(9)]
SINE = [(-1.0) ** k / factorial(2 * k + 1) for k in range(8)]


@ti.func
def towards(angle):
    """Cosine and sine of an angle (rad), to a few units in the last place, from a quarter of it by doubling twice.

    The library's functions take one angle at a time, which prevents vectorisation; this arithmetic has no branches.
    """
    turns = ti.floor(angle * (0.5 / pi) + 0.5)
    quarter = 0.25 * (angle - turns * (2.0 * pi))
    square = quarter * quarter
    c, s = COSINE[-1] + 0.0 * quarter, SINE[-1] + 0.0 * quarter
    for a in ti.static(COSINE[-2::-1]):
        c = a + square * c
    for a in ti.static(SINE[-2::-1]):
        s = a + square * s
    s *= quarter
    for _ in ti.static(range(2)):
        s, c = 2.0 * s * c, 1.0 - 2.0 * s * s
    return ti.Vector([c, s])


@ti.func
def posed(shape, scale, turn):
    """An outline: the number of its class, its scale relative to that, and (cos, sin) of its angle."""
    return ti.Struct(shape=shape, scale=scale, turn=turn)


@ti.func
def turned(turn, vector):
    """A vector (x, y) rotated counter-clockwise by `turn` = (cos, sin)."""
    return ti.Vector([turn[0] * vector[0] - turn[1] * vector[1], turn[1] * vector[0] + turn[0] * vector[1]])


@ti.func
def turned_back(turn, vector):
    """A vector (x, y) rotated clockwise by `turn` = (cos, sin)."""
    return ti.Vector([turn[0] * vector[0] + turn[1] * vector[1], turn[0] * vector[1] - turn[1] * vector[0]])
