"""Walls of a tank that is turned about an axis: those of its section, seen in the plane through the axis."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import taichi as ti

from solvers.machine.state import State
from solvers.tank.pieces import Pieces
from solvers.tank.solids.bearing import faces_of
from solvers.tank.solids.solid import Lying, Turned
from solvers.tank.tank import Tank
from solvers.tank.walls import Walls

SMALLEST = 1e-12  # m, the distance from the axis below which a direction across it counts as along y


@ti.data_oriented
class TurnedWalls:
    """The walls of a tank turned about z, or lying about x, with the grains inside: features and gaps, as of `Walls`.

    A sphere at a distance ρ from the axis and a place s along it touches what a disc at (ρ, s) in the section does: the
    nearest point of a turned surface is in the plane through the axis. So cylinders, cones, round floors and rims are
    exact, one feature each, and a contact's history goes on as a grain runs round the axis. The section's other half is
    touched by grains on the axis alone, which are then beside both.

    A drum that rotates is a lying tank whose motion turns it about its axis.
    """

    smooth = False

    def __init__(self, arrays: State, tanks: Sequence[Tank], pieces: Pieces, solid: Turned | Lying):
        self.lying = isinstance(solid, Lying)
        if self.lying:
            tanks = [replace(tanks[0], outline=solid.corners)]
        self.section = Walls(arrays, tanks, pieces)
        self.tanks, self.parts = self.section.tanks, self.section.parts
        self.moved, self.moving, self.fastest = pieces, pieces.moving, pieces.fastest
        self.features, self.real = self.section.features, arrays.real
        faces = len(solid.faces(tanks[0].outline))
        self.pieces, own = faces + self.parts, arrays.under("turned")
        self.bearing = own.holding("bearing", faces_of(self.section, tanks[0].outline, faces), "feature", ti.i32)

    @property
    def said(self) -> str:
        """Its features in words."""
        return f"{self.section.said}, turned about {'x' if self.lying else 'z'},"

    @property
    def bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper corner (m) of the box round the tank, with a margin round an open one."""
        order = [0, 0, 1] if self.lying else [0, 1, 0]
        lower, upper = self.section.bounds
        return lower[order], upper[order]

    bounds_of_grains = bounds

    @ti.func
    def shift(self, w, t):
        """The poses of all pieces at time t (s)."""
        return self.section.shift(w, t)

    @ti.func
    def piece(self, feature):
        """Number of the piece of a feature: the faces of the tank come first (`InSpace.faces`), then the parts."""
        return self.bearing[feature]

    @ti.func
    def split(self, y, z, x):
        """Two components of a place or vector across the axis, and that along it."""
        return ti.Vector([y, z, x] if ti.static(self.lying) else [y, x, z])

    @ti.func
    def joined(self, one, two, along):
        """A vector (y, z, x) of two components across the axis, and that along it."""
        return ti.Vector([one, two, along] if ti.static(self.lying) else [one, along, two])

    @ti.func
    def outward(self, y, z, x):
        """The unit vector away from the axis, its two components, the distance (m) from it, and the place along it."""
        place = self.split(y, z, x)
        away = ti.sqrt(place[0] * place[0] + place[1] * place[1])
        cos, sin = 1.0 + 0.0 * away, 0.0 * away
        if away > SMALLEST:
            cos, sin = place[0] / away, place[1] / away
        return ti.Vector([cos, sin, away, place[2]])

    @ti.func
    def velocity(self, feature, shift: ti.template(), y, z, x):
        """Velocity (m/s) of the point (y, z, x) of a feature in the tank's frame."""
        out = self.outward(y, z, x)
        v = self.section.velocity(feature, shift, out[2], out[3])
        cos, sin = ti.cast(out[0], self.real), ti.cast(out[1], self.real)
        return self.joined(cos * v[0], sin * v[0], v[1])

    @ti.func
    def rate(self, feature, shift: ti.template()):
        """Rate (rad/s) at which a feature turns in the tank's frame: none does."""
        none = ti.cast(0.0, self.real)
        return [none, none, none]

    @ti.func
    def gap(self, feature, shift: ti.template(), y, z, x):
        """Signed distance (m) of a point from a wall feature and the unit normal towards the point, as of `Walls`."""
        out = self.outward(y, z, x)
        flat = self.section.gap(feature, shift, out[2], out[3])
        normal = self.joined(out[0] * flat[1], out[1] * flat[1], flat[2])
        return ti.Vector([flat[0], normal[0], normal[1], normal[2]])

    @ti.func
    def near(self, feature, shift: ti.template(), reach, y, z, x):
        """Whether a point is within `reach` (m) of a wall feature, on either side."""
        out = self.outward(y, z, x)
        return self.section.near(feature, shift, reach, out[2], out[3])

    @ti.func
    def holds(self, y, z, x):
        """Whether a point lies in the tank or above its mouth."""
        out = self.outward(y, z, x)
        return self.section.holds(out[2], out[3])

    @ti.func
    def follows(self, y, z, x):
        """Whether a point lies in the box in which grains that have left the tank are followed."""
        out = self.outward(y, z, x)
        return self.section.follows(out[2], out[3])
