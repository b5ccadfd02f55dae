"""Motions of the tank, one file per kind; the registry has their names in presets.

A motion moves one coordinate of the tank (`coordinate`: "y" or "z", or "turn" about its `centre`; in space also "x",
"pitch" and "yaw"). It offers `parameters`, the numbers that its kernel function `state` reads, `duration`, and
`fastest`, from which the step is derived. A `history.History` is not a motion itself but a record of several.
"""

from solvers.machine import runtime  # noqa: F401 (first: a Taichi that cannot be loaded is told there)

# isort: split
from solvers.motion.harmonic import Heave, Pitch, Roll, Surge, Sway, Yaw
from solvers.motion.tilt import Tilt

MOTIONS = {"tilt": Tilt, "sway": Sway, "heave": Heave, "roll": Roll}  # in the plane
IN_SPACE = {"surge": Surge, "pitch": Pitch, "yaw": Yaw}  # there alone
ORDER = ("tilt", "sway", "heave", "surge", "roll", "pitch", "yaw")  # innermost first
OF_TANK = {name: (MOTIONS | IN_SPACE)[name] for name in ORDER}
