"""Viscosity by name: the force between two particles that move at different velocities."""

from solvers.fluid.viscosity.approaching import Approaching
from solvers.fluid.viscosity.artificial import Artificial
from solvers.fluid.viscosity.laminar import Laminar
from solvers.fluid.viscosity.laminar_stress import LaminarStress

LAMINAR = {"laminar": Laminar, "laminar-stress": LaminarStress}  # those with a viscosity of their own
VISCOSITY = {"artificial": Artificial, "approaching": Approaching, **LAMINAR}
