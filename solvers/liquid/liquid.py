"""Water without particles: what all of its models share, with the interface of water as particles."""

from typing import ClassVar

import numpy as np
import taichi as ti

from solvers.fluid import quantities
from solvers.machine.state import Axis
from solvers.machine.units import Units
from solvers.motion.carrier import per_slab
from solvers.ship.body import Body, frozen
from solvers.tank.context import Context
from solvers.tank.matter import Matter


@ti.data_oriented
class Liquid(Matter):
    """Loads tanks by its weight and, with the load's added mass, by what it resists to an acceleration at once."""

    name = "water"
    of_contacts: ClassVar = ()

    def __init__(self, scene, context: Context):
        self.scene, self.water = scene, scene.fluid.water
        arrays, world = context.arrays, Axis("world", context.worlds)
        self.carrier, self.exact = context.carrier, arrays.exact
        # Of whole worlds: a band of one, cut for the grains beside it, has no liquid of its own.
        self.units = Units(context.worlds, 1, 1)
        self.load = context.load(arrays.under("water"), self.units)
        self.load.add_mass(arrays.under("water"))
        self.thickness = scene.tanks[0].thickness
        # Gravity, in the tank's axes
        self.pull = arrays.under("liquid").reals((world,), "pull_y", "pull_z", kind=arrays.exact, kept=False)

    @property
    def extent(self) -> float:
        """How far (m) from the tank's origin a particle may be."""
        return self.scene.span

    @ti.func
    def add_mass(self, u, piece, entries):
        """Set the added mass on a piece about the tank's origin: of sway, heave, sway–roll, heave–roll and roll."""
        across, up, slant, lever, turning = entries[0], entries[1], entries[2], entries[3], entries[4]
        none = 0.0 * across
        whole = ti.Vector([across, none, slant, none, up, lever, slant, lever, turning])
        for n in ti.static(range(self.load.entries)):
            self.load.added_mass[u, piece, n] = whole[n]

    @ti.func
    def react(self, u, frame: ti.template(), dt):
        """Book what the tank's acceleration adds to the load."""
        w = self.units.world(u)
        b, rise = ti.cast(frame[0], self.exact), ti.cast(frame[1], self.exact)
        gains = ti.Vector([self.pull[0][w] - b, self.pull[1][w] - rise, ti.cast(frame[3], self.exact)])
        for piece in range(self.load.pieces):
            self.load.book_reaction(u, piece, gains, dt)

    def as_rigid(self) -> list[Body]:
        """The water of each world at the start as one rigid body, per metre of the ship, in the tank's frame."""
        there = self.scene.fluid.present
        particles = self.scene.fluid.particles[:, there]
        mass = self.water.density * per_slab(self.scene)[:, there] * particles["volume"]
        return [frozen(*p["position"].T, m, p["volume"]) for p, m in zip(particles, mass, strict=True)]

    def unknown(self) -> dict[str, np.ndarray]:
        """The quantities of particles of water, all zero."""
        sizes = {"level": len(self.water.levels), "edge": len(self.water.edges), "gauge": len(self.water.gauges)}
        sizes |= {"part": 0}
        rows = {}
        for one in quantities.SERIES:
            owner = (sizes[one.per],) if one.per in sizes else ()
            rows[one.name] = np.zeros((self.units.worlds, *owner, *one.shape))
        return rows
