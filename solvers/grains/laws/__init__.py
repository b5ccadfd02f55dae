"""Contact laws, one file each; the registries name them as presets do.

A law is a class with
- `coefficients`, the numbers it needs of an interface between two materials, and `limits`, the longest steps it bears;
  a normal law also `deepest`, how deep an impact without losses goes;
- `constants` and `memory`, names of what it keeps for each listed contact, which no other kind of law may use too;
  `prepare` works out the constants of a new contact;
- `force` (a rolling law: `torque`, one of cohesion: `pull`) and `energy`, Taichi functions. They take a block of
  contacts at once, as vectors of lanes, and so hold element-wise arithmetic alone; a coefficient may be a number or a
  vector of lanes. A contact whose overlap is zero must come out with no force and no memory; under a law of cohesion,
  one whose gap is beyond the law's `range`.
  A law of cohesion names the keys of a material that it `needs`.
Only the laws a scene names are compiled.
"""

from solvers.grains.laws.bridge import Bridge
from solvers.grains.laws.constant_torque import ConstantTorque
from solvers.grains.laws.coulomb import Coulomb
from solvers.grains.laws.cundall_strack import CundallStrack
from solvers.grains.laws.elastic_plastic import ElasticPlastic
from solvers.grains.laws.frictionless import Frictionless
from solvers.grains.laws.haff_werner import HaffWerner
from solvers.grains.laws.hertz import Hertz
from solvers.grains.laws.hertz_dashpot import HertzDashpot
from solvers.grains.laws.hertz_viscoelastic import HertzViscoelastic
from solvers.grains.laws.humid import Humid
from solvers.grains.laws.hysteretic import Hysteretic
from solvers.grains.laws.linear import Linear
from solvers.grains.laws.mindlin import Mindlin
from solvers.grains.laws.no_cohesion import NoCohesion
from solvers.grains.laws.no_rolling import NoRolling
from solvers.grains.laws.viscous import Viscous

# Along the line of the centres: what keeps grains apart and takes their energy.
NORMAL = {
    "hertz-viscoelastic": HertzViscoelastic,
    "hertz": Hertz,
    "hertz-dashpot": HertzDashpot,
    "linear": Linear,
    "hysteretic": Hysteretic,
}
# Across it: friction.
TANGENTIAL = {
    "haff-werner": HaffWerner,
    "mindlin": Mindlin,
    "cundall-strack": CundallStrack,
    "coulomb": Coulomb,
    "viscous": Viscous,
    "none": Frictionless,
}
# Against turning on one another.
ROLLING = {"none": NoRolling, "constant-torque": ConstantTorque, "elastic-plastic": ElasticPlastic}
# Across a gap: liquid that pulls.
COHESION = {"none": NoCohesion, "humid": Humid, "bridge": Bridge}
