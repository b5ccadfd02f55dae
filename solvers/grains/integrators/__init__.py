"""Integrators of the grains' motion, one file each; the registry has their names in presets.

An integrator is a class with `extra`, the number of fields that it keeps per coordinate of a grain (places along the
axes, then angles) beyond the coordinate and its rate, and a Taichi function `step` that moves one grain under the
forces at its present position. Relative to Verlet it is stable with steps `reach` times as long and dampers `damping`
times as strong, and `bearing` times as many derived steps may be forced; `cargolab bench stability` measures all three.
Springs with contact history use its `ahead` and `stiffer`, see `solvers.grains.laws.history`. `late` tells how far the
velocities that contacts see lag behind: their error in Δt² times the rate of change of the acceleration
(`HertzViscoelastic`).
"""

from solvers.grains.integrators.gear import Gear
from solvers.grains.integrators.symplectic_euler import SymplecticEuler
from solvers.grains.integrators.verlet import Verlet

INTEGRATORS = {"verlet": Verlet, "symplectic-euler": SymplecticEuler, "gear": Gear}
