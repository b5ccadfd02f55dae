"""The matters that a tank may hold, a line each: what makes one from a scene, or None where the scene has none."""

from solvers.fluid.matter import make_water
from solvers.grains.matter import make_grains
from solvers.liquid.matter import make_liquid

MATTERS = (make_grains, make_water, make_liquid)
