"""Smoothing kernels by name. Each says, for t = 1 − r/(2h) within the support, W and −W'(r)/r up to constant factors.

In this form ∇W needs no division by the distance: ∇_i W(r_i − r_j) = −(−W'/r) (r_i − r_j).
"""

from solvers.fluid.kernels.wendland_c2 import WendlandC2
from solvers.fluid.kernels.wendland_c4 import WendlandC4

KERNELS = {"wendland-c2": WendlandC2, "wendland-c4": WendlandC4}
