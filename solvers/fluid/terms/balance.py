"""The sums of forces and powers to which all terms of the momentum pass add."""

import taichi as ti

from solvers.fluid.terms.term import Sums


@ti.data_oriented
class Balance:
    """Places of the sums, over V_i and the kernel's factor: vectors by axis.

    `push` is of the water's pressure and what else acts along it, `drag` of viscosity without its strength, `own_push`
    of the wall particles' own pressures; `taken` and `stored` are the powers that viscosity and wall particles take.
    """

    def __init__(self, sums: Sums, axes: int):
        self.push, self.drag, self.own_push = sums.room(axes), sums.room(axes), sums.room(axes)
        self.taken, self.stored = sums.room(), sums.room()
