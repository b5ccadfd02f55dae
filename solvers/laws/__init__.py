"""Contact laws, one file each; the registries name them as presets do.

A law is a class with `coefficients`, the numbers it needs of an interface between two materials; `constants` and
`memory`, names of what it keeps for each listed contact; `prepare`, which works out the constants of a new
contact; and `force` and `energy`, Taichi functions. Only the laws a scene names are compiled.
"""

from solvers.laws.haff_werner import HaffWerner
from solvers.laws.hertz_viscoelastic import HertzViscoelastic
from solvers.laws.mindlin import Mindlin

NORMAL = {"hertz-viscoelastic": HertzViscoelastic}
TANGENTIAL = {"haff-werner": HaffWerner, "mindlin": Mindlin}
