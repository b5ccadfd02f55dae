"""Where an outline is turned to, by the cosine and sine of its angle."""

from math import factorial, pi

import taichi as ti

# Taylor's, in powers of the square of an angle of up to π/4: the first left out is less than 1e-16 of the first.
COSINE = [(-1.0) ** k / factorial(2 * k) for k in range(9)]
SINE = [(-1.0) ** k / factorial(2 * k + 1) for k in range(8)]


@ti.func
def towards(angle):
    """Cosine and sine of an angle (rad), to within some units of its last digit: those of its quarter, doubled twice.

    The library's are called for one angle at a time, so that no loop with them gets SIMD instructions; this is
    straight-line arithmetic.
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
    """An outline: the number of its class, how many times as large as that it is, and (cos, sin) of its angle."""
    return ti.Struct(shape=shape, scale=scale, turn=turn)


@ti.func
def turned(turn, vector):
    """A vector (x, y) turned counter-clockwise."""
    return ti.Vector([turn[0] * vector[0] - turn[1] * vector[1], turn[1] * vector[0] + turn[0] * vector[1]])


@ti.func
def turned_back(turn, vector):
    """A vector (x, y) turned clockwise."""
    return ti.Vector([turn[0] * vector[0] + turn[1] * vector[1], turn[0] * vector[1] - turn[1] * vector[0]])
