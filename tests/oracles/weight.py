"""A matter as small as can be: a weight on a spring that is fixed to the tank."""

import numpy as np
import taichi as ti

from solvers.machine.phase import Phase
from solvers.machine.state import Axis
from solvers.ship.body import Body
from solvers.tank.matter import Matter


@ti.data_oriented
class Weight(Matter):
    """A point of `mass` (kg) in every world, held at `place` (m) by a spring (N/m) in both directions and a `push` (N).

    It acts every `substeps` base steps, by Verlet's scheme.
    """

    name = "weight"

    def __init__(self, scene, context, mass: float, place, spring: float, push, every: int):
        self.scene, self.mass, self.middle, self.spring, self.thrust = scene, mass, place, spring, push
        self.units = context.units(2)
        own = context.arrays.under("weight")
        self.load = context.load(own, self.units, every)
        world = (Axis("world", context.worlds),)
        self.y, self.z, self.vy, self.vz, self.fy, self.fz = own.reals(world, "y", "z", "vy", "vz", "fy", "fz")
        self.before = (Phase(self.hold, every=every),)
        self.after = (Phase(self.move, every=every),)

    def put(self, y: float, z: float) -> None:
        """Put the weight at (y, z) m, at rest."""
        self.y.fill(y)
        self.z.fill(z)

    def as_rigid(self) -> list[Body]:
        """Nothing: a hull given without cargo is the hull alone."""
        return [Body(1e-12, self.middle, 1e-12) for _ in range(self.units.worlds)]

    @ti.func
    def hold(self, w, t, kick, dt):
        """The spring's force and the push, and their reaction on the tank."""
        y, z = self.middle  # where the spring is fixed
        self.fy[w] = self.thrust[0] - self.spring * (self.y[w] - y)
        self.fz[w] = self.thrust[1] - self.spring * (self.z[w] - z)
        u = w * self.units.a_world
        self.load.begin(u)
        self.load.book(u, 0, ti.Vector([-self.fy[w], -self.fz[w], -(y * self.fz[w] - z * self.fy[w])]), dt)

    @ti.func
    def move(self, w, frame, kick, dt):
        """Kick and drift, in a tank that does not turn."""
        self.vy[w] = self.vy[w] + kick * (self.fy[w] / self.mass + frame[0])
        self.vz[w] = self.vz[w] + kick * (self.fz[w] / self.mass + frame[1])
        self.y[w] = self.y[w] + dt * self.vy[w]
        self.z[w] = self.z[w] + dt * self.vz[w]
        return True

    def read(self) -> np.ndarray:
        """Place (m) and velocity (m/s) of each world's weight, (W, 4); the velocity is half a beat behind."""
        return np.stack([field.to_numpy() for field in (self.y, self.z, self.vy, self.vz)], axis=1)
