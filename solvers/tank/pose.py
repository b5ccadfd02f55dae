"""Poses of pieces in their tank: origin, velocity, rotation and rate of turning, as numbers one after the other.

A rotation is (cos, sin) in the plane and a matrix, row by row, in space; a rate of turning has an entry per axis about
which a piece can turn. All are lists, see `solvers.space.axes`.
"""

import taichi as ti

from solvers.machine.quantity import PLANE
from solvers.space.axes import turns

AT_START, AT_MIDDLE, AT_END = range(3)  # of a step


def numbers(axes: int) -> int:
    """How many numbers a pose has."""
    return 2 * axes + (2 if axes == PLANE else axes * axes) + turns(axes)


@ti.data_oriented
class PoseReader:
    """What the poses (W, pieces, 3 × `numbers`) of a step say, at its start, middle or end."""

    def __init__(self, poses: ti.Field, axes: int):
        self.poses, self.axes, self.size, self.turns = poses, axes, numbers(axes), turns(axes)

    @ti.func
    def part(self, w, k, when: ti.template(), first: ti.template(), count: ti.template()):
        """So many numbers of the pose of a piece, from the `first` on."""
        return [self.poses[w, k, self.size * when + first + n] for n in ti.static(range(count))]

    @ti.func
    def origin(self, w, k, when: ti.template()):
        """Where (m) the drawn origin is."""
        return self.part(w, k, when, 0, self.axes)

    @ti.func
    def velocity(self, w, k, when: ti.template()):
        """Its velocity (m/s)."""
        return self.part(w, k, when, self.axes, self.axes)

    @ti.func
    def rotation(self, w, k, when: ti.template()):
        """How the piece is turned."""
        return self.part(w, k, when, 2 * self.axes, self.size - 2 * self.axes - self.turns)

    @ti.func
    def rate(self, w, k, when: ti.template()):
        """Its rate of turning (rad/s)."""
        return self.part(w, k, when, self.size - self.turns, self.turns)


@ti.func
def rotated(rotation: ti.template(), v: ti.template()):
    """A vector (a list, of numbers or of lanes) turned by a rotation."""
    if ti.static(len(rotation) == 2):
        return [rotation[0] * v[0] - rotation[1] * v[1], rotation[1] * v[0] + rotation[0] * v[1]]
    else:
        return [
            rotation[3 * a] * v[0] + rotation[3 * a + 1] * v[1] + rotation[3 * a + 2] * v[2]
            for a in ti.static(range(3))
        ]


@ti.func
def turned_back(rotation: ti.template(), v: ti.template()):
    """A vector (a list, of numbers or of lanes) turned by the inverse of a rotation."""
    if ti.static(len(rotation) == 2):
        return [rotation[0] * v[0] + rotation[1] * v[1], rotation[0] * v[1] - rotation[1] * v[0]]
    else:
        return [rotation[a] * v[0] + rotation[3 + a] * v[1] + rotation[6 + a] * v[2] for a in ti.static(range(3))]
