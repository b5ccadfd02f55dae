"""Grains with outlines, which have an orientation."""

import numpy as np
import taichi as ti

from solvers.grains.shapes.contour import Contour
from solvers.grains.shapes.given import Shapes
from solvers.grains.shapes.pose import posed
from solvers.grains.state import GrainState
from solvers.machine.quantity import PLANE
from solvers.machine.state import State
from solvers.machine.units import Units

DISC = Contour(1.0)


@ti.data_oriented
class ShapedState(GrainState):
    """Grains whose outlines have the numbers `shape` (W, room + ghosts); fixed grains are discs, the last outline.

    Mass is that of the sphere of equal area, inertia that of `Contour.inertia`. `turn_y` and `turn_z` are cos and sin
    of the angle, computed once per step for all contacts. Outlines are plane: `y` and `z` are all of `place`,
    and `angle` has one entry.
    """

    shaped = True

    def __init__(
        self,
        arrays: State,
        shapes: Shapes,
        radius: np.ndarray,
        density: np.ndarray,
        fixed: np.ndarray,
        units: Units,
        may_leave: bool,
        kind: np.ndarray | None = None,
    ):
        outlines = with_disc(shapes)
        spread = np.array([outline.spread for outline in outlines])[shapes.which]
        super().__init__(arrays, PLANE, radius, density, fixed, units, may_leave, kind, spread)
        self.y, self.z = self.place
        bounding = np.array([outline.bounding_radius for outline in outlines])[shapes.which]
        self.start_angle = shapes.angle
        self.crowding = float((bounding**2).mean())  # number of neighbours relative to that of discs
        disc = len(outlines) - 1
        own, axes = arrays.under("grains"), "world grain"
        self.shape = own.holding("shape", self._filled(shapes.which, disc, disc), axes, ti.i32, kept=True)
        self.reach = own.holding("reach", self._filled(radius * bounding, fixed[:, -1], 0.0), axes, kept=True)
        self.turn_y, self.turn_z = own.reals(self.each, "turn_y", "turn_z")

    def put(self, position: np.ndarray) -> None:
        """Place the grains at `position` (W, n, 2) m with their start angles, at rest and without history."""
        super().put(position)
        angle = self._filled(self.start_angle, 0.0, 0.0)
        for field, values in ((self.angle[0], angle), (self.turn_y, np.cos(angle)), (self.turn_z, np.sin(angle))):
            field.from_numpy(values.astype(np.float32) if field.dtype == ti.f32 else values)

    def count_turns_anew(self) -> None:
        """Do nothing: the angles are those of the outlines."""

    @ti.func
    def turn(self, w, i):
        """Cosine and sine of a grain's angle."""
        return ti.Vector([self.turn_y[w, i], self.turn_z[w, i]])

    @ti.func
    def outline(self, w, i):
        """A grain's outline as a `posed` struct."""
        return posed(self.shape[w, i], self.radius[w, i], self.turn(w, i))

    @ti.func
    def apart(self, w, i, j):
        """Vector (m) from the centre of grain j to that of grain i."""
        way = self.between(w, i, j)
        return ti.Vector([ti.cast(way[a], self.real) for a in ti.static(range(self.axes))])


def with_disc(shapes: Shapes) -> list[Contour]:
    """A scene's outlines, followed by the disc for fixed grains."""
    return [*shapes.outlines, DISC]
