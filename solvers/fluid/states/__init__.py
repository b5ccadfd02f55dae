"""Equations of state by name: the pressure, and the elastic energy per mass, of the density deviation s = ρ/ρ0 − 1."""

from solvers.fluid.states.linear import Linear
from solvers.fluid.states.tait import Tait

STATES = {"linear": Linear, "tait": Tait}
