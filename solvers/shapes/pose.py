"""Turning vectors of a plane by an angle that is given by its cosine and sine."""

import taichi as ti


@ti.func
def turned(turn, vector):
    """A vector (x, y) turned counter-clockwise."""
    return ti.Vector([turn[0] * vector[0] - turn[1] * vector[1], turn[1] * vector[0] + turn[0] * vector[1]])


@ti.func
def turned_back(turn, vector):
    """A vector (x, y) turned clockwise."""
    return ti.Vector([turn[0] * vector[0] + turn[1] * vector[1], turn[0] * vector[1] - turn[1] * vector[0]])
