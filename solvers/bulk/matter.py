"""Bulk as a matter: what a step asks of it, and what a simulation does."""

import numpy as np
import taichi as ti

from solvers.bulk.checks import check_bulk, refuse_speed
from solvers.bulk.diagnostics import Diagnostics
from solvers.bulk.gather import Gather
from solvers.bulk.given import Bulk
from solvers.bulk.nodes import Nodes
from solvers.bulk.order import Order
from solvers.bulk.spread import Spread
from solvers.bulk.start import sideways
from solvers.bulk.state import Points
from solvers.machine.errors import Unavailable
from solvers.machine.phase import Phase
from solvers.motion.carrier import per_slab
from solvers.ship.body import Body, frozen
from solvers.tank.context import Context
from solvers.tank.matter import Matter

AT_REST = 1e-6  # of m g h, what the restlessness counts in


@ti.data_oriented
class BulkMatter(Matter):
    """Bulk: points are listed by columns and spread to nodes, nodes move in their walls, and points follow them.

    The scheme is symplectic: stresses of the beginning of a step change velocities, which change places and stresses.
    """

    name = "bulk"

    def __init__(self, scene, context: Context):
        bulk: Bulk = scene.of(Bulk)
        arrays, carrier = context.arrays, context.carrier
        self.scene, self.bulk, self.thickness = scene, bulk, scene.tanks[0].thickness
        self.units = units = context.units(bulk.grid.columns)
        self.load = context.load(arrays.under("bulk"), units)
        self.points = Points(arrays, bulk)
        order = Order(arrays, self.points, bulk)
        self.spread = Spread(arrays, units, self.points, order, bulk)
        self.nodes = Nodes(arrays, units, self.spread, order, bulk, self.load, carrier, self.thickness)
        self.gather = Gather(arrays, units, self.points, order, self.spread, self.nodes, bulk, scene.gravity)
        self.diagnostics = Diagnostics(arrays, self.gather, carrier, bulk.material.bulk_modulus, _alongs(scene))
        if carrier.responds:
            self.load.lag(self._held_mass(), relaxed=False)
        self.before = (Phase(order.sort), Phase(self.spread.spread, units), Phase(self.nodes.react, units))
        moving = [self.nodes.kick] if carrier.responds else []
        self.after = tuple(Phase(act, units) for act in (*moving, self.gather.move))

    def _held_mass(self) -> np.ndarray:
        """The added mass (W, 3, 3), per metre of a ship, of the points whose next node walls hold."""
        points, grid = self.bulk.points, self.bulk.grid
        place, tank = points["position"][0], np.repeat(np.arange(len(self.bulk.fill)), self.bulk.fill)
        node = np.round((place - grid.origin[tank]) / grid.spacing[tank]).astype(int)
        node = np.clip(node, 0, np.column_stack([np.diff(grid.first), [grid.rows] * len(grid.origin)])[tank] - 1)
        held = np.abs(grid.walls).max(axis=(-1, -2))[node[:, 0] + grid.first[tank], node[:, 1]] > 0.0
        y, z = place.T
        found = []
        for factor in per_slab(self.scene):
            mass = factor * points["mass"][0] * held
            total, of_y, of_z = mass.sum(), mass @ y, mass @ z
            found.append([[total, 0.0, -of_z], [0.0, total, of_y], [-of_z, of_y, mass @ (y * y + z * z)]])
        return np.array(found)

    @property
    def extent(self) -> float:
        """How far (m) from the tank's origin a point may be."""
        return self.scene.span

    @ti.func
    def speed(self, u):
        """The highest speed (m/s) of a unit."""
        return self.gather.fastest[u]

    @ti.func
    def is_sound(self, u, speed, dt):
        """Whether a unit's speed is one that the bulk bears."""
        return speed < self.gather.numbers[4]

    def observe(self, time: float) -> dict[str, np.ndarray]:
        """The quantities of every world at its time (s): (W, *shape) of each by name."""
        return self.diagnostics.sums_at(time)

    def check(self, rows: dict[str, np.ndarray], time: float) -> None:
        """Raise BadState if the quantities at `time` (s) show an unphysical state."""
        check_bulk(rows, time)

    def refuse(self, world: int, time: float, dt: float) -> None:
        """Raise BadState for a world that was stopped at `time` (s) since its bulk is too fast."""
        own = slice(world * self.units.a_world, (world + 1) * self.units.a_world)
        fastest, sound = self.gather.fastest.to_numpy()[own].max(), self.bulk.material.sound_speed
        refuse_speed(world, float(fastest), sound, time)

    def restlessness(self, rows: dict[str, np.ndarray]) -> np.ndarray:
        """Kinetic energy in units of m g h, of cells h high and a millionth, (W,)."""
        scale = self.thickness * self.bulk.mass * self.scene.gravity * self.bulk.grid.smallest
        return rows["kinetic"] / (AT_REST * scale) if scale > 0.0 else np.zeros(len(rows["kinetic"]))

    def place(self, position: np.ndarray | None) -> None:
        """Place the points as the scene says, at rest."""
        material = self.bulk.material
        self.points.put(self.bulk.points, sideways(material.friction), material.bulk_modulus)
        self.load.forget()
        self.nodes.lost.fill(0.0)
        self.gather.lost.fill(0.0)
        self.nodes.gained.fill(0.0)

    def bear(self, scene) -> None:
        """Raise Unavailable: no array has room for another material or gravity."""
        if scene.of(Bulk).material != self.bulk.material or scene.gravity != self.scene.gravity:
            raise Unavailable("bulk: start the experiment anew with another material or gravity")

    def snapshot(self, time: float) -> dict[str, np.ndarray]:
        """Places, velocities, pressures, mobilised friction and plastic strain (W, n) of the points now."""
        p = self.points
        y, z, v_y, v_z, volume, free, use, strain = p.read(*p.place, *p.velocity, p.volume, p.free, p.use, p.strain)
        pressure = np.maximum(0.0, self.bulk.material.bulk_modulus * (free / volume - 1.0))
        return {
            "bulk_position": np.stack([y, z], axis=-1),
            "bulk_velocity": np.stack([v_y, v_z], axis=-1),
            "bulk_pressure": pressure,
            "bulk_friction": use,
            "bulk_strain": strain,
        }

    def fields(self) -> list[ti.Field]:
        """The arrays that a step changes."""
        return [*self.points.fields(), self.nodes.lost, self.gather.lost, self.nodes.gained, *self.load.impulse]

    def as_rigid(self) -> list[Body]:
        """The bulk of each world as one rigid body, per metre of the ship's length, in the tank's frame."""
        p = self.points
        y, z, mass, volume = p.read(*p.place, p.mass, p.volume)
        return [frozen(*one) for one in zip(y, z, per_slab(self.scene) * mass, volume, strict=True)]


def _alongs(scene) -> np.ndarray:
    """How long each tank (W, tanks) is along its ship, over the first one."""
    rows = [[tank.share(ship.length) for tank in scene.tanks] for ship in scene.vessels]
    shares = np.array(rows or np.ones((scene.worlds, len(scene.tanks))))
    return shares / shares[:, :1]


def make_bulk(scene, context: Context) -> BulkMatter | None:
    """The bulk of a scene (`solvers.scene.Scene`)."""
    return BulkMatter(scene, context)
