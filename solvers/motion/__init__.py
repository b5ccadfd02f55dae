"""Motions of the tank, one file a kind; the registry names them as presets do.

A motion moves one coordinate of the tank (`coordinate`: "y", "z" or "turn" about its `centre`). It offers `parameters`,
the numbers its kernel function `state` reads; `duration`, and `fastest` for the step size. A
`history.History` is not one of them, but a record of several.
"""

from solvers.motion.harmonic import Heave, Roll, Sway
from solvers.motion.tilt import Tilt

MOTIONS = {"tilt": Tilt, "sway": Sway, "heave": Heave, "roll": Roll}
