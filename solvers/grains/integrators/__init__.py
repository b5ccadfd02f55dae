"""Integrators of the grains' motion, one file each; the registry names them as presets do.

An integrator is a class with `extra`, the number of fields it keeps of each of a grain's coordinates, the places along
the axes and the angle, beyond that and its rate, and a Taichi function `step` that takes one grain from the forces at
its present place to its next place. Beside Verlet it bears steps `reach` times as long and dampers `damping` times as
strong; `cargolab bench stability` measures both. What springs with history have to know of it is `ahead` and `stiffer`,
see `solvers.grains.laws.history`.
"""

from solvers.grains.integrators.gear import Gear
from solvers.grains.integrators.symplectic_euler import SymplecticEuler
from solvers.grains.integrators.verlet import Verlet

INTEGRATORS = {"verlet": Verlet, "symplectic-euler": SymplecticEuler, "gear": Gear}
