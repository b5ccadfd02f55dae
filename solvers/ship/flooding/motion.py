"""A ship that sinks and heels faster than she comes to rest: heave and roll with added mass and drag.

    (M + ρ Σ v_i + A_33) z̈ = ρ g (∇ − Σ v_i) − M g − ½ ρ C_D S ż |ż|
    (I + A_44 + ρ Σ v_i r_i²) φ̈ = K − 2 ζ √((I + A_44) ρ g ∇_0 GM_0) φ̇

about her centre of gravity without the water, with the moment K of buoyancy, weight and water. She keeps the trim in
which she began. The water lies level and moves with her: its weight acts where it is, its mass is that of a point
there. ∇_0 and GM_0 are hers before she floods.

Source: Newton's second law. Limits: added masses are given and constant; no waves, no sloshing, no force of the jet.
Units: SI.
"""

from dataclasses import dataclass

import numpy as np

from solvers.ship.flooding.balance import Floating, Pose
from solvers.ship.flooding.rooms import Filled


@dataclass(frozen=True)
class Inertia:
    """Added mass (kg), roll inertia about G with its added part (kg m²), drag in heave and damping in roll.

    `drag` is C_D with the `area` (m²) of her bottom, `damping` (kg m²/s) that of roll rate.
    """

    added_mass: float
    roll: float
    area: float
    drag: float = 1.0
    damping: float = 0.0


def pose_of(ship: Floating, height: float, roll: float, slope: float) -> Pose:
    """The pose of a ship whose centre of gravity is at a height (m) above the sea."""
    gravity = Pose(0.0, slope, roll).turned(ship.centre)
    return Pose(float(gravity[2] - slope * gravity[0] - height * np.hypot(1.0, slope)), slope, roll)


def height_of(ship: Floating, pose: Pose) -> float:
    """Height (m) of the centre of gravity above the sea."""
    return float(pose.heights(ship.centre))


def accelerations(ship: Floating, inertia: Inertia, volume: np.ndarray, pose: Pose, filled: Filled, rates) -> tuple:
    """Heave (m/s²) and roll (rad/s²) of her centre of gravity at rates (m/s, rad/s)."""
    density, g = ship.water.density, ship.water.gravity
    weight, wet = density * volume, ship.wet(pose)
    gravity = pose.turned(ship.centre)
    away = filled.centre[:, 1:] - gravity[1:]
    force = g * (density * float(wet.volume[0]) - ship.mass - weight.sum())
    force -= 0.5 * density * inertia.drag * inertia.area * rates[0] * abs(rates[0])
    moment = ship.moment(volume, pose, filled)
    # about G: weights and buoyancy balance in height only at rest
    moment -= gravity[1] * g * (density * float(wet.volume[0]) - ship.mass - weight.sum())
    moment -= inertia.damping * rates[1]
    mass = ship.mass + weight.sum() + inertia.added_mass
    return force / mass, moment / (inertia.roll + float(weight @ (away**2).sum(axis=1)))
