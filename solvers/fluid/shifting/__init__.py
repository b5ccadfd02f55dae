"""Shifting of particles by name: how their distances are evened."""

from solvers.fluid.shifting.delta_plus import DeltaPlus
from solvers.fluid.shifting.delta_plus_momentum import DeltaPlusMomentum
from solvers.fluid.shifting.none import NoShifting

SHIFTING = {"delta-plus": DeltaPlus, "delta-plus-momentum": DeltaPlusMomentum, "none": NoShifting}
