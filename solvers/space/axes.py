"""The axes of space, in the order of all arrays: y, z and, in three dimensions, x.

This is a cyclic permutation of x, y, z: the plane is the first two, and cross products stay right-handed.

The number of axes is known when kernels are compiled. A vector is a list with one entry per axis, and loops over axes
are unrolled: the resulting code is that of separately named scalars. (A Taichi vector cannot have components that are
themselves vectors of lanes.)
"""

import taichi as ti

PLANE = 2  # axes of the plane
UP = 1  # index of z
NAMES = ("y", "z", "x")


def named(what: str, axes: int) -> tuple[str, ...]:
    """Names of the arrays of a quantity, one per axis."""
    return tuple(f"{what}_{name}" for name in NAMES[:axes])


@ti.func
def dot(a: ti.template(), b: ti.template()):
    """Scalar product of two vectors, lists of components, summed in the order of the axes."""
    total = a[0] * b[0]
    for k in ti.static(range(1, len(a))):
        total += a[k] * b[k]
    return total
