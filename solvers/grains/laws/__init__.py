"""Contact laws, one file each; the registries have their names in presets.

A law is a class with
- `coefficients`, the numbers it needs of an interface between two materials, and `limits`, the longest steps at which
  it is resolved; a normal law also has `deepest`, the largest overlap of an impact without losses;
- `constants` and `memory`, names of what it keeps for each listed contact, unique among the kinds of laws; `prepare`
  computes the constants of a new contact; `tangents` are those of `memory` that are vectors along or about the contact;
- `force` (a rolling law: `torque`, a cohesion law: `pull`) and `energy`, Taichi functions. They take a block of
  contacts at once, as vectors of lanes, so only element-wise arithmetic is allowed; a coefficient may be a number or a
  vector of lanes. Slip, turning, the force or torque against them and `tangents` are lists, with an entry per axis
  about which grains turn (`solvers.space.tangent`). `way` is how the contact has turned in the step, by which a vector
  in memory has to be turned in space; None in the plane. A contact with a gap must come out with no memory, and with no
  force where it does not begin within the kick (`kick`); under a cohesion law, one whose gap is beyond the law's
  `range`. A cohesion law lists in `needs` the keys that a material must have.
Only the laws that a scene uses are compiled.
"""

from solvers.machine import runtime  # noqa: F401 (it changes how Taichi declares the functions of this package)

# isort: split
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
from solvers.grains.laws.marshall import Marshall
from solvers.grains.laws.mindlin import Mindlin
from solvers.grains.laws.no_cohesion import NoCohesion
from solvers.grains.laws.no_rolling import NoRolling
from solvers.grains.laws.no_twisting import NoTwisting
from solvers.grains.laws.viscous import Viscous

# Along the normal: repulsion and restitution.
NORMAL = {
    "hertz-viscoelastic": HertzViscoelastic,
    "hertz": Hertz,
    "hertz-dashpot": HertzDashpot,
    "linear": Linear,
    "hysteretic": Hysteretic,
}
# Along the tangent: friction.
TANGENTIAL = {
    "haff-werner": HaffWerner,
    "mindlin": Mindlin,
    "cundall-strack": CundallStrack,
    "coulomb": Coulomb,
    "viscous": Viscous,
    "none": Frictionless,
}
# Against relative rotation: rolling friction.
ROLLING = {"none": NoRolling, "constant-torque": ConstantTorque, "elastic-plastic": ElasticPlastic}
# Against relative rotation about the normal, in space: twisting friction.
TWISTING = {"none": NoTwisting, "marshall": Marshall}
# Across a gap: liquid bridges.
COHESION = {"none": NoCohesion, "humid": Humid, "bridge": Bridge}
