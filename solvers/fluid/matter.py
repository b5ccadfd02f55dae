"""Water as a matter: what a step asks of it, and what a simulation does."""

from typing import ClassVar

import numpy as np
import taichi as ti

from solvers.fluid.account import quantities_of, snapshot_of
from solvers.fluid.bodies.bodies import Bodies
from solvers.fluid.checks import (
    LEAST,
    check_water,
    refuse_state,
    residual,
    suspects,
)
from solvers.fluid.constants import Constants
from solvers.fluid.continuity import Continuity
from solvers.fluid.diagnostics import Diagnostics, Pool
from solvers.fluid.forces import Forces
from solvers.fluid.given import Fluid
from solvers.fluid.inflow.inflow import Inflow
from solvers.fluid.lists.capacity import Laid
from solvers.fluid.lists.context import FluidContext
from solvers.fluid.lists.grid import grid_round
from solvers.fluid.lists.neighbours import Lists
from solvers.fluid.lists.order import Order, Tanks
from solvers.fluid.lists.work_ranges import WorkRanges
from solvers.fluid.mover import Mover
from solvers.fluid.phases.sound_switch import SoundSwitch
from solvers.fluid.shifting import SHIFTING
from solvers.fluid.state import LANES, Particles
from solvers.fluid.terms.damping import DampingZones
from solvers.fluid.walls.added_mass import wall_added_mass
from solvers.fluid.walls.divergence_correction import DivergenceCorrection
from solvers.fluid.walls.edges import Edges
from solvers.fluid.walls.extrapolation import Extrapolation
from solvers.fluid.walls.gauges import Gauges
from solvers.fluid.walls.prism_layers import layers_of
from solvers.fluid.walls.tangential_correction import TangentialCorrection
from solvers.machine.phase import Phase
from solvers.machine.quantity import PLANE
from solvers.machine.state import Axes
from solvers.motion.carrier import per_slab
from solvers.motion.poses_in_space import poses_of
from solvers.ship.body import Body, frozen
from solvers.tank.context import Context
from solvers.tank.matter import Matter
from solvers.tank.substeps import Substeps


@ti.data_oriented
class WaterMatter(Matter):
    """Water: the pressures of its walls, its forces, then kick and drift, the rates of density, and drift."""

    name = "water"
    laying = None  # what lays the particles between grains
    of_contacts: ClassVar = ("gauge_pressure", "gauge_peak", "edge_force", "part_force")  # known only after a step

    def __init__(self, scene, context: Context):
        fluid: Fluid = scene.fluid.softened
        self.scene, self.fluid, self.water = scene, fluid, (water := fluid.water)
        arrays, worlds, tank, count = context.arrays, context.worlds, scene.tanks[0], fluid.count
        lanes = LANES[context.axes] if context.wide and not context.per_particle else 1
        self.wide = lanes > 1
        layers, along = layers_of(scene, water), 2.0 * scene.solid.half(tank.outline) if scene.solid else 0.0
        grid = grid_round(water, fluid.particles["position"], scene.tanks, context.walls.bounds, lanes, along)
        slots, blocks, first = grid.arranged(layers.points, layers.tanks)
        layers.blocks = len(blocks)
        self.bodies = Bodies(arrays, context.parts, water, scene, lanes)
        walls = (len(blocks) + self.bodies.rows) * lanes
        self.nearing, self.gas = self.bodies.fastest, fluid.particles["gas"].astype(float)
        of_air, shifting = count - int(self.gas[0].sum()), SHIFTING[water.shifting]  # particles of air come last
        thickness = tank.thickness if context.axes == PLANE else 1.0  # in space particles have volumes
        self.phases = {"water": slice(0, of_air)} | ({"air": slice(of_air, None)} if water.air else {})
        sizes = context.axes, worlds, count, lanes, walls, grid.strips
        kinds = shifting, water.air, context.among, water.gap > 0.0, scene.mixture is not None
        self.particles = p = Particles(arrays, *sizes, *kinds)
        self.units = units = context.units(p.fluid_blocks)
        # Free bodies answer as a step of the water begins: for them its load need not stand
        self.load = context.load(arrays.under("water"), units, 1 if self.bodies.floats else fluid.substeps)
        self.load.lag(wall_added_mass(scene, layers), water.added_mass == "layer")
        self.wall_points = slots, blocks, layers.volumes, layers.firm
        self.ranges = ranges = WorkRanges(p, units)
        self.constants = Constants(arrays, water, scene.gravity, p.axes)
        self.poses = poses_of(arrays, context.carrier, worlds, fluid.substeps > 1, p.axes)
        of_parts = np.array(self.bodies.tanks, dtype=int)[self.bodies.solids.owner]
        self.order = Order(arrays, p, grid, Tanks.of(scene, p, slots, layers.tanks, of_parts))
        self.bodies.join(arrays, p, self.order, ranges, self.poses, units)
        of_bodies = self.bodies.solids.places.reshape(-1, lanes, context.axes)
        laid = Laid(context.room, fluid.particles["position"], np.concatenate([blocks, of_bodies]))
        self.lists = Lists(arrays, units, self.order, ranges, self.constants, first, self.bodies, laid)
        self.substeps = substeps = Substeps(arrays.under("water"), self.lists, fluid.substeps)
        self.context = shared = FluidContext(units, p, ranges, self.lists, self.constants, self.poses)
        tangential = TangentialCorrection(arrays, shared, layers, slots, scene.tanks)
        self.extrapolation = Extrapolation(arrays, shared, tangential, self.load, thickness)
        self.forces = Forces(arrays, shared, self.extrapolation, self.load, thickness, (layers, slots, scene))
        self.sound_switch = SoundSwitch(arrays, p, self.constants, scene, context.largest_multiple)
        self.has_multiples = self.sound_switch.has_multiples
        self.continuity = Continuity(arrays, shared, self.forces)
        self.inflow = Inflow(arrays, scene, shared, context.carrier) if fluid.inlets else None
        self.damping = DampingZones(arrays, water, p, units)
        self.mover = Mover(arrays, shared, self.extrapolation, self.forces.voids, substeps, self.damping)
        probes = [slots[slot] + p.fluid_blocks * lanes for slot in layers.probes]
        self.gauges = Gauges(arrays, p, self.constants, self.poses, water.gauges, probes, layers.open)
        pool = Pool.of(scene, context.walls, self.order, self.poses)
        self.edges = Edges(arrays, shared, self.extrapolation, layers, slots, scene.tanks, pool.first, water)
        self.diagnostics = Diagnostics(arrays, p, self.constants, context.carrier, pool, water.levels)
        self.start, self.thickness = np.full(worlds, np.nan), thickness  # J, energy at the first look; m
        mass = water.density * fluid.particles["volume"].sum(axis=1).max() * thickness
        self.least = 0.5 * mass * (LEAST * water.sound_speed) ** 2  # J
        passage, rest = [Phase(self.note_passage)], self.extrapolation.coupling.between
        self.before = substeps.first(self._before())
        self.between = (*substeps.first(rest), *substeps.last(passage))
        correction = [DivergenceCorrection(arrays, shared, layers, slots).correct] if self.continuity.corrects else []
        acts = self.mover.kick, *correction, self.continuity.continuity_pass, self.finish
        entering = [Phase(self.inflow.flow)] if self.inflow else []
        self.after = substeps.last([*(Phase(act, units) for act in acts), *entering])

    def _before(self) -> tuple[Phase, ...]:
        return (
            Phase(self.note_poses),
            Phase(self.forces.update_state, self.units),
            *self.extrapolation.phases,
            *([Phase(self.gauges.measure)] if self.gauges.count else ()),
            *([Phase(self.edges.bear, self.units), Phase(self.edges.add)] if self.edges.wanted else ()),
            Phase(self.forces.momentum_pass, self.units),
        )

    @property
    def extent(self) -> float:
        """How far (m) from the tank's origin a particle may be."""
        return self.scene.span

    def slack(self) -> float:
        """How far (m) two particles may near each other before the lists are no good."""
        return self.lists.fixed_skin

    def sort_all(self) -> None:
        """Sort the particles of all worlds."""
        self.order.sort_all()

    @ti.func
    def note_poses(self, w, t, kick, dt):
        """Note how the tank of a world and the parts in it move as the step begins."""
        self.poses.note_start(w, t, dt)
        self.substeps.note(w, kick)
        if ti.static(self.bodies.count > 0):
            self.bodies.note(w, t, dt)
        if ti.static(self.order.leaks):
            self.inflow.note(w, t)

    @ti.func
    def note_passage(self, w, t, kick, dt):
        """Note how the tank moves through the step."""
        self.poses.note_passage(w, t, dt)

    @ti.func
    def finish(self, u, frame, kick, dt):
        """End a unit's step; returns whether its particles are sound."""
        if u % self.units.a_world == 0:
            self.diagnostics.behind[self.units.world(u)] = 0.5 * ti.cast(dt, self.particles.exact)
        return self.mover.finish(u, frame, kick, dt)

    @ti.func
    def speed(self, u):
        """The speed (m/s) of a unit that is a single particle, relative to the tank."""
        return self.mover.fastest[u]

    @ti.func
    def is_sound(self, u, speed, dt):
        """Whether a unit's speed is one that the liquid bears: up to Mach 0.5."""
        return self.mover.bears(u)

    @ti.func
    def way(self, u, t):
        """How far (m) any particle of a unit has gone since there are lists; huge where there are none."""
        return self.lists.displacement[u]

    @ti.func
    def invalid(self, u, t):
        """Whether two particles may come within reach of each other unlisted in the coming step."""
        return self.lists.invalid(u)

    @ti.func
    def may_be_invalid(self, u, t):
        """Whether that may be so by a bound on what particles have travelled."""
        return self.lists.may_be_invalid(u)

    @ti.func
    def sort(self, w):
        """Sort the particles of a world, if its own lists are to be rebuilt."""
        self.substeps.sort(w)

    @ti.func
    def make_lists(self, u, t, dt, whole):
        """List the neighbours of a unit anew; False where they do not fit."""
        fits = True
        if whole and self.substeps.rebuilds(u):
            fits = self.lists.rebuild(u)
        return fits

    @ti.func
    def allowed_multiple(self, w):
        """The largest multiple of a world: more than 1 while its air is soft."""
        return self.sound_switch.allowed_multiple()

    @property
    def changes(self) -> int:
        """The base step before which the air is to become stiff."""
        return self.sound_switch.next

    def change(self) -> None:
        """Go on with stiff air; the energy that it loses counts as diffused."""
        lost = self.continuity.diffused.to_numpy().reshape(self.particles.worlds, -1)
        lost[:, 0] += self.sound_switch.change(self.scene.gravity)
        self.continuity.diffused.from_numpy(lost.reshape(-1))

    def as_rigid(self) -> list[Body]:
        """The water of each world as one rigid body, per metre of the ship's length, in the tank's frame."""
        p = self.particles
        y, z, mass, volume = p.read(*p.place, p.mass, p.volume)
        there, mass = np.isfinite(mass), per_slab(self.scene) * mass
        columns = zip(y, z, mass, volume, there, strict=True)
        return [frozen(*(one[inside] for one in of_world)) for *of_world, inside in columns]

    def lay_by(self, laying) -> None:
        """Have the particles laid between grains, by a `laying` (`solvers.mixture.exchange.Exchange`)."""
        self.laying = laying

    def place(self, position: np.ndarray | None) -> None:
        """Place the particles as the scene says, and the wall particles; all that was noted is forgotten."""
        p = self.particles
        self.sound_switch.use(False, self.scene.gravity)
        start = self.laying.lay(position) if self.laying else self.fluid.particles
        p.put(start, self.water, self.fluid.present)
        p.put_walls(*self.wall_points, self.bodies.solids)
        lists, sums = self.lists, (*self.forces.kept, self.continuity.diffused, self.diagnostics.behind)
        for field in (*sums, lists.last, lists.skin):
            field.fill(0.0)
        lists.expire()
        for noted in (
            self.bodies,
            self.gauges,
            self.edges,
            self.load,
            self.poses,
            self.extrapolation.coupling,
            self.damping,
            *([self.inflow] if self.inflow else []),
        ):
            noted.forget()
        self.start[:] = np.nan

    def observe(self, time: float) -> dict[str, np.ndarray]:
        """The quantities of every world at its time (s): (W, *shape) of each by name."""
        rows = quantities_of(self, time)
        np.copyto(self.start, residual(rows, 0.0), where=np.isnan(self.start))
        return rows

    def check(self, rows: dict[str, np.ndarray], time: float) -> None:
        """Raise BadState if the quantities at `time` (s) show an unphysical state."""
        # A particle that goes round falls for ever; what tension and cohesion hold is not known.
        # At time zero no work is done yet, but velocities may have half a kick: m (g Δt/2)²/2 that nothing has given.
        unknown = time == 0.0 or self.water.periodic or not self.constants.accounted or self.laying
        lifts = self.water.shifting == "delta-plus" and not (self.water.full or self.water.air)
        check_water(rows, np.nan if unknown else self.start, time, self.least, lifts)

    def refuse(self, world: int, time: float, dt: float) -> None:
        """Raise BadState for a world that was stopped at `time` (s)."""
        refuse_state(world, suspects(self, world, time), time, self.water.sound_speed)

    def snapshot(self, time: float) -> dict[str, np.ndarray]:
        """Places, velocities relative to the tank (W, n, 2) and pressures (W, n) at `time` (s), which must be now."""
        return snapshot_of(self, time)

    def alter(self, scene) -> None:
        """Go on with another gravity; the account of energy begins anew."""
        self.scene = scene
        self.constants.become(self.sound_switch.now, scene.gravity)
        self.start[:] = np.nan

    def fields(self) -> list[ti.Field]:
        """The arrays that a step changes, lists aside."""
        return self.particles.fields()

    def state(self) -> dict[str, np.ndarray]:
        """What `restore` continues from, beside the arrays."""
        return {"water_start": self.start.copy()} | self.sound_switch.state()

    def axes(self) -> dict[str, Axes]:
        """The axes of the arrays of `state`, by name."""
        return {"water_start": (self.particles.each_world,)} | self.sound_switch.axes()

    def restore(self, state: dict[str, np.ndarray]) -> None:
        """Restore what `state` returned."""
        self.start = np.array(state["water_start"])
        self.sound_switch.restore(state, self.scene.gravity)
