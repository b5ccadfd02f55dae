"""The axes of space, in the order of all arrays: y, z and, where there is a third one, x.

That is a cyclic permutation of x, y, z: the plane is the first two, and cross products stay right-handed.

How many there are is known when kernels are compiled. What is said of each axis is a list with an entry an axis, and
loops over axes are unrolled: the code that results is that of numbers with names of their own. (A Taichi vector would
not do for components that are themselves vectors of lanes.)
"""

import taichi as ti

PLANE = 2  # axes of the plane
UP = 1  # which of them is z
NAMES = ("y", "z", "x")


def named(what: str, axes: int) -> tuple[str, ...]:
    """Names of the arrays that hold something of each axis."""
    return tuple(f"{what}_{name}" for name in NAMES[:axes])


@ti.func
def dot(a: ti.template(), b: ti.template()):
    """Scalar product of two vectors, lists of components in variables of their own, summed in the axes' order."""
    total = a[0] * b[0]
    for k in ti.static(range(1, len(a))):
        total += a[k] * b[k]
    return total
