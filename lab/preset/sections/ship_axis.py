"""The position and the motion of a ship's axis."""

import numpy as np

from lab.preset.sections.ship import Ship
from lab.preset.units import show
from solvers.ship.hydrostatics import turned


def axis_place(ship: Ship) -> str:
    """Where the ship's axis is, in words."""
    y, z = ship.about
    beside = "" if y == 0.0 else f"{show(abs(y), 'm')} to {'starboard' if y > 0.0 else 'port'} of and "
    return f"{beside}{show(z, 'm')} above her origin" + ("" if ship.axis else ", in the waterline")


def axis_motion(ship: Ship, pose: np.ndarray) -> np.ndarray:
    """Sway and heave (m) of the ship's axis from its position at rest, and roll (rad), from the tank's poses (…, 3).

    Everywhere in the lab, sway and heave of a ship are defined in this way.
    """
    arm = turned(tuple(np.subtract(ship.hold, ship.about)), pose[..., 2])
    rest = np.array([ship.about[0], ship.heave + ship.about[1]])
    return np.concatenate([pose[..., :2] - arm - rest, pose[..., 2:]], axis=-1)
