"""What holds a continuum of grains against shear, by name: the friction that it has at an inertial number."""

from solvers.bulk.laws.constant import Constant
from solvers.bulk.laws.mu_of_i import MuOfI

LAWS = {"constant": Constant, "mu-of-i": MuOfI}
