"""Where an outline is turned to, by the cosine and sine of its angle."""

import taichi as ti


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
