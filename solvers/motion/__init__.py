"""Motions of the tank, one file per kind; the registry has their names in presets.

A motion moves one coordinate of the tank (`coordinate`: "y", "z" or "turn" about its `centre`). It offers `parameters`,
the numbers that its kernel function `state` reads, `duration`, and `fastest`, from which the step is derived. A
`history.History` is not a motion itself but a record of several.
"""

from solvers.motion.harmonic import Heave, Roll, Sway
from solvers.motion.tilt import Tilt

MOTIONS = {"tilt": Tilt, "sway": Sway, "heave": Heave, "roll": Roll}
