"""Ships for tests of flooding: boxes, so large that they hardly move, or as a closed form needs them."""

import numpy as np

from solvers.ship.flooding.balance import Floating, Pose
from solvers.ship.flooding.openings import Opening
from solvers.ship.flooding.rooms import Room, Rooms
from solvers.ship.flooding.run import Course, Flooding
from solvers.ship.flooding.solids import Prisms
from solvers.ship.water import Water

WATER = Water(1025.0)


def box(left: float, right: float, low: float, high: float) -> np.ndarray:
    """A rectangle (4, 2) m of y and z."""
    return np.array([[left, low], [right, low], [right, high], [left, high]])


def barge(rooms: list[Room], length=100.0, breadth=20.0, depth=10.0, draught=4.0, height=4.0, aside=0.0, **more):
    """A box with rooms, floating at an even draught (m) while they are empty; G is `height` up and `aside` (m)."""
    hull = Prisms([box(-0.5 * breadth, 0.5 * breadth, 0.0, depth)], [0.0], [length])
    mass = WATER.density * length * breadth * draught
    return Floating(hull, Rooms(rooms), mass, np.array([0.5 * length, aside, height]), WATER, **more)


def flooded(ship: Floating, openings: list[Opening], duration: float, level: float, **more) -> Course:
    """The run of a ship that begins upright with the sea at a level (m)."""
    return Flooding(ship, openings, Pose(level), duration, **more).course()
