"""A flooded ship's stability: displacement, GM and righting levers by added weight and by lost buoyancy.

Added weight: the water is part of her, its volume in each room stays as she heels, and levers are those of
M + ρ Σ v_i. Lost buoyancy: rooms that are open to the sea are no part of her; as she heels they stay filled to the sea,
and levers are those of M alone. Both give one position of rest. Righting moments differ where a room aside takes or
gives water as she heels: then the second is hers if she heels slowly, the first if she heels fast.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from solvers.ship.flooding.balance import Floating, Pose
from solvers.ship.flooding.rooms import Rooms
from solvers.ship.flooding.solids import Less

STEP = 1e-4  # rad: for the slope of the moment


def without(ship: Floating, lost: np.ndarray) -> Floating:
    """The ship without the buoyancy of rooms that are open to the sea, `lost` (n,) true; the others stay aboard."""
    rooms = ship.rooms
    gone = Rooms([one for one, out in zip(rooms.rooms, lost, strict=True) if out])
    kept = Rooms([one for one, out in zip(rooms.rooms, lost, strict=True) if not out])
    return replace(ship, hull=Less(ship.hull, gone.prisms, gone.share), rooms=kept)


def displacement(ship: Floating, volume: np.ndarray) -> float:
    """Mass (kg) with the water (n,) m³ in her rooms."""
    return ship.mass + ship.water.density * float(volume.sum())


def metacentric_height(ship: Floating, volume: np.ndarray, pose: Pose) -> float:
    """GM (m), the slope of GZ where she lies, all free surfaces counted."""
    moments = [ship.moment(volume, ship.at_heel(volume, pose.roll + step, pose)) for step in (-STEP, STEP)]
    return (moments[0] - moments[1]) / (2.0 * STEP * displacement(ship, volume) * ship.water.gravity)


def levers(ship: Floating, volume: np.ndarray, heels: Sequence[float], pose: Pose, side: int) -> np.ndarray:
    """GZ (m) at heels (rad) to a side, 1 port and −1 starboard; nan where she cannot float."""
    found, weight = [], displacement(ship, volume) * ship.water.gravity
    near = replace(pose, roll=side * heels[0])
    for heel in heels:
        near = ship.at_heel(volume, side * heel, near)
        found.append(-side * ship.moment(volume, near) / weight)
    return np.array(found)
