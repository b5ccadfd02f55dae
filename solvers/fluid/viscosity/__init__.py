"""Viscosity by name: the force between two particles that move at different velocities."""

from solvers.fluid.viscosity.approaching import Approaching
from solvers.fluid.viscosity.artificial import Artificial
from solvers.fluid.viscosity.laminar import Laminar

VISCOSITY = {"artificial": Artificial, "approaching": Approaching, "laminar": Laminar}
