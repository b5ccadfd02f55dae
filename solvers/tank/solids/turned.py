"""Walls of a tank that is turned about the vertical axis: those of its section, seen in the plane through the axis."""

from collections.abc import Sequence

import numpy as np
import taichi as ti

from solvers.machine.state import State
from solvers.tank.pieces import Pieces
from solvers.tank.tank import Tank
from solvers.tank.walls import Walls

SMALLEST = 1e-12  # m, the distance from the axis below which a direction across it counts as along y


@ti.data_oriented
class TurnedWalls:
    """The walls of a turned tank, with the grains inside, as `Walls` has them in the plane: features, and their gaps.

    A sphere at a distance ρ from the axis and a height z touches what a disc at (ρ, z) in the section does: the nearest
    point of a turned surface is in the plane through the axis. So cylinders, cones, round floors and rims are exact,
    one feature each, and a contact's history goes on as a grain runs round the axis. The section's other half is
    touched by grains on the axis alone, which are then beside both.
    """

    def __init__(self, arrays: State, tanks: Sequence[Tank], pieces: Pieces):
        self.section = Walls(arrays, tanks, pieces)
        self.tanks, self.pieces, self.parts = self.section.tanks, self.section.pieces, self.section.parts
        self.moved, self.moving, self.fastest = pieces, pieces.moving, pieces.fastest
        self.features, self.real = self.section.features, arrays.real

    @property
    def said(self) -> str:
        """Its features in words."""
        return f"{self.section.said}, turned about z,"

    @property
    def bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper corner (m) of the box round the tank, with a margin round an open one."""
        lower, upper = self.section.bounds
        return np.append(lower, lower[0]), np.append(upper, upper[0])

    bounds_of_grains = bounds

    @ti.func
    def shift(self, w, t):
        """The poses of all pieces at time t (s)."""
        return self.section.shift(w, t)

    @ti.func
    def piece(self, feature):
        """Number of the piece of a feature."""
        return self.section.piece(feature)

    @ti.func
    def outward(self, y, x):
        """The unit vector (y, x) away from the axis, and the distance (m) from it."""
        away = ti.sqrt(y * y + x * x)
        cos, sin = 1.0 + 0.0 * away, 0.0 * away
        if away > SMALLEST:
            cos, sin = y / away, x / away
        return ti.Vector([cos, sin, away])

    @ti.func
    def velocity(self, feature, shift: ti.template(), y, z, x):
        """Velocity (m/s) of the point (y, z, x) of a feature in the tank's frame."""
        out = self.outward(y, x)
        v = self.section.velocity(feature, shift, out[2], z)
        cos, sin = ti.cast(out[0], self.real), ti.cast(out[1], self.real)
        return ti.Vector([cos * v[0], v[1], sin * v[0]])

    @ti.func
    def rate(self, feature, shift: ti.template()):
        """Rate (rad/s) at which a feature turns in the tank's frame: none does."""
        none = ti.cast(0.0, self.real)
        return [none, none, none]

    @ti.func
    def gap(self, feature, shift: ti.template(), y, z, x):
        """Signed distance (m) of a point from a wall feature and the unit normal towards the point, as of `Walls`."""
        out = self.outward(y, x)
        flat = self.section.gap(feature, shift, out[2], z)
        return ti.Vector([flat[0], out[0] * flat[1], flat[2], out[1] * flat[1]])

    @ti.func
    def near(self, feature, shift: ti.template(), reach, y, z, x):
        """Whether a point is within `reach` (m) of a wall feature, on either side."""
        return self.section.near(feature, shift, reach, ti.sqrt(y * y + x * x), z)

    @ti.func
    def holds(self, y, z, x):
        """Whether a point lies in the tank or above its mouth."""
        return self.section.holds(ti.sqrt(y * y + x * x), z)

    @ti.func
    def follows(self, y, z, x):
        """Whether a point lies in the box in which grains that have left the tank are followed."""
        return self.section.follows(ti.sqrt(y * y + x * x), z)
