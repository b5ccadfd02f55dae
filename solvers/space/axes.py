"""The axes of space, in the order of all arrays: y, z and, in three dimensions, x.

This is a cyclic permutation of x, y, z: the plane is the first two, and cross products stay right-handed.

The number of axes is the scene's and known when kernels are compiled. A vector is a list with one entry per axis, a
rotation one with an entry per axis about which a body can turn: about x in the plane. Loops over either are unrolled:
the resulting code is that of separately named scalars. (A Taichi vector cannot have components that are themselves
vectors of lanes.)
"""

import taichi as ti

from solvers.machine.quantity import directions, rotations

UP = 1  # index of z


def turns(axes: int) -> int:
    """Number of axes about which a body can turn: one in the plane, three in space."""
    return axes * (axes - 1) // 2


def named(what: str, axes: int) -> tuple[str, ...]:
    """Names of the arrays of a vector, one per axis."""
    return tuple(f"{what}_{name}" for name in directions(axes))


def named_turns(what: str, axes: int) -> tuple[str, ...]:
    """Names of the arrays of a rotation, one per axis about which a body can turn; of a single one, that alone."""
    return tuple(f"{what}_{name}" for name in rotations(axes)) or (what,)


@ti.func
def cross(a: ti.template(), b: ti.template()):
    """Vector product of two vectors in space."""
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


@ti.func
def swing(rate: ti.template(), arm: ti.template(), velocity: ti.template()):
    """Add the velocity ω × r of a rate of turning (rad/s) and an arm (m), lists, to a `velocity`."""
    if ti.static(len(rate) == 1):
        velocity[0] = velocity[0] - rate[0] * arm[1]
        velocity[1] += rate[0] * arm[0]
    else:
        swung = cross(rate, arm)
        for a in ti.static(range(3)):
            velocity[a] += swung[a]


@ti.func
def dot(a: ti.template(), b: ti.template()):
    """Scalar product of two vectors, lists of components, summed in the order of the axes."""
    total = a[0] * b[0]
    for k in ti.static(range(1, len(a))):
        total += a[k] * b[k]
    return total


@ti.func
def joined(along: ti.template(), about: ti.template()):
    """The entries of two lists in space one after the other, as a Taichi vector of numbers."""
    both = [along, about]
    return ti.Vector([both[k // 3][k % 3] for k in ti.static(range(6))])
