"""Grains as a matter: what a step asks of them, and what a simulation does."""

from typing import ClassVar

import numpy as np
import taichi as ti

from solvers.grains.checks import FASTEST_STEP, check_state, refuse_speed
from solvers.grains.contacts import Contacts
from solvers.grains.diagnostics import Diagnostics
from solvers.grains.lists.neighbours import Neighbours
from solvers.grains.lists.numbering import Numbering
from solvers.grains.mover import Mover
from solvers.grains.pressing import Presser, Pressing
from solvers.grains.state import GrainState
from solvers.grains.timestep import calm_speed
from solvers.machine.errors import Unavailable
from solvers.machine.phase import Phase
from solvers.machine.quantity import PLANE
from solvers.machine.state import Axes
from solvers.motion.carrier import per_metre
from solvers.ship.body import Body
from solvers.space.axes import dot
from solvers.tank.context import Context
from solvers.tank.load import Load
from solvers.tank.matter import Matter

# A speed (m/s) whose 16th power is no number in 32 bits any more.
UNSEEN = 5e-3
HASTE = 1.25  # what grains may gain in speed until the next look, at most half the skin later


@ti.data_oriented
class GrainMatter(Matter):
    """Grains, discs or irregular ones: their contacts push before they move, then all move.

    `way_a_step` (m) is how far a grain may move in a step, `mass` (W, n) kg.
    """

    name = "grains"
    of_contacts: ClassVar = ("elastic", "contacts", "overlap")  # quantities that are known only after a step

    def __init__(
        self,
        scene,
        context: Context,
        load: Load,
        grains: GrainState,
        lists: Neighbours,
        contacts: Contacts,
        mover: Mover,
    ):
        arrays, walls, units = context.arrays, context.walls, load.units
        given = scene.grains
        self.scene, self.units, self.load, self.grains, self.lists = scene, units, load, grains, lists
        self.contacts, self.mover, self.mass = contacts, mover, grains.mass
        self.wide = lists.pairs.wide
        # Contact history of outlines depends on the order of the two grains' numbers, so these are not renumbered.
        self.numbering = Numbering(arrays, grains, lists, 2.0 * given.mean_radius, given.shapes is None)
        self.diagnostics = Diagnostics(arrays, units, grains, walls, lists, contacts, context.carrier)
        self.presser = Presser(units, grains, walls, lists, contacts)
        own = arrays.under("grains")
        self.unseen = UNSEEN if own.real is ti.f32 else 0.0  # speed (m/s) below which the mover's bound may miss one
        way = np.array([FASTEST_STEP * given.sizes[0]])
        self.way_a_step = own.holding("way_a_step", way, "one", own.exact)
        self.largest_multiple = (
            1 if given.integrator == "gear" else context.largest_multiple
        )  # Gear's derivatives are of one step
        self.has_multiples, self.doublings = self.largest_multiple > 1, int(np.log2(self.largest_multiple))
        if self.has_multiples:
            speeds = [calm_speed(scene, 2.0 ** (k + 1)) for k in range(self.doublings)]
            self.calm = own.holding("calm", np.array(speeds), "doubling")
        self.before = (Phase(self.push, units), *(mover.hold.gathering if mover.is_aboard else ()))
        self.after = (Phase(self.move, units),)

    @property
    def extent(self) -> float:
        """How far (m) from the tank's origin a grain may be."""
        return float(np.hypot.reduce(np.abs(self.lists.walls.bounds_of_grains).max(axis=0)))

    @property
    def nearing(self) -> float:
        """How fast (m/s) parts of the tank come at grains."""
        return self.lists.walls.fastest

    def slack(self) -> float:
        """How far (m) two grains may near each other before the lists are no good."""
        return float(self.lists.skin.width.to_numpy()[0])

    def sort_all(self) -> None:
        """Sort the grains of all worlds into cells."""
        self.lists.cells.sort_all()

    @ti.func
    def push(self, u, t, kick, dt):
        """The forces of all contacts of a unit, on the grains and on the tank."""
        self.load.begin(u)
        self.contacts.forces(u, t, dt)

    @ti.func
    def move(self, u, frame, kick, dt):
        """Move the grains of a unit; returns whether all of them are slow enough for the step."""
        speed = self.mover.move(self.grains, u, frame, kick, dt)
        if ti.static(not self.units.single):
            self.lists.validity.displacement[u] = self.lists.validity.displacement[u] + (speed + self.unseen) * dt
        return self.is_sound(u, speed, dt)

    @ti.func
    def is_sound(self, u, speed, dt):
        """Whether a speed (m/s) is one the step bears; not one that is no number."""
        return speed * dt < self.way_a_step[0]

    @ti.func
    def speed(self, u):
        """The speed (m/s) of a unit that is a single grain."""
        w, i = self.units.world(u), self.units.first(u)
        v = [field[w, i] for field in ti.static(self.grains.velocity)]
        return ti.sqrt(dot(v, v))

    @ti.func
    def way(self, u, t):
        """How far (m) any grain of a unit has gone since there are lists; huge where there are none."""
        validity = self.lists.validity
        moved = validity.displacement[u]
        if moved == 0.0:  # there are lists; without, it says NEVER
            moved = validity.moved(u)
            if ti.static(validity.walls.moving):
                moved += 2.0 * validity.walls.moved.gone(self.units.world(u), validity.built_at[u], t)
        return moved

    @ti.func
    def allowed_multiple(self, w):
        """Base steps that a step may take: a power of two, by how fast any two grains of a world may meet now."""
        allowed_multiple = 1
        if ti.static(self.has_multiples):
            meeting = HASTE * (2.0 * self.grains.fastest(w) + self.lists.walls.fastest)
            for k in ti.static(range(self.doublings)):
                if meeting < self.calm[k]:
                    allowed_multiple = 2 ** (k + 1)
        return allowed_multiple

    @ti.func
    def invalid(self, u, t):
        """Whether two grains may be in reach of each other unlisted at time t (s)."""
        return self.lists.invalid(u, t)

    @ti.func
    def may_be_invalid(self, u, t):
        """Whether that may be so by a bound on what grains have travelled."""
        return self.lists.may_be_invalid(u, t)

    @ti.func
    def asked(self, u):
        """Whether some contacts are to be searched again."""
        return self.lists.asked(u)

    @ti.func
    def sort(self, w):
        """Sort the grains of a world into cells, where that is needed."""
        self.lists.sort(w)

    @ti.func
    def make_lists(self, u, t, dt, whole):
        """List the contacts of a unit anew, or seek some; False, with the old lists, where they do not fit."""
        return self.lists.rebuild(u, t, dt, whole)

    def observe(self, time: float) -> dict[str, np.ndarray]:
        """The quantities of every world at its time (s): (W, *shape) of each by name."""
        return self.diagnostics.sums_at(time)

    def check(self, rows: dict[str, np.ndarray], time: float) -> None:
        """Raise BadState if the quantities at `time` (s) show an unphysical state."""
        check_state(rows["overlap"], rows["escaped"].astype(int), time)

    def refuse(self, world: int, time: float, dt: float) -> None:
        """Raise BadState for a world that was stopped at `time` (s) since its grains are too fast for steps of dt.

        Beside water, which may have been the cause, only if they are.
        """
        # Those that are checked: particle by particle they are looked at before a step, which has yet to spread them
        velocity = np.stack([field.to_numpy()[world, : self.grains.mobile] for field in self.grains.velocity], axis=-1)
        fastest = np.linalg.norm(velocity, axis=1).max()
        if self.scene.fluid is None or not fastest * dt < self.way_a_step.to_numpy()[0]:
            refuse_speed(world, velocity, time, dt)

    def restlessness(self, rows: dict[str, np.ndarray]) -> np.ndarray:
        """Mean kinetic energy of a grain, spin included, in units of m g d, (W,)."""
        radius = self.scene.grains.radius
        scale = (self.grains.mass * self.scene.gravity * 2.0 * radius).mean(axis=1)
        return (rows["kinetic"] + rows["rotational"]) / radius.shape[1] / scale

    def place(self, position: np.ndarray) -> None:
        """Place the grains at `position` (W, n, axes) m, at rest and without contact history."""
        position = np.asarray(position, dtype=np.float64).reshape(*self.scene.grains.radius.shape, self.grains.axes)
        position = self.numbering.in_solver_order(position)
        self.grains.put(position)
        self.lists.forget()
        self.numbering.ordered = position.copy()

    def launch(self, velocity: np.ndarray | None, spin: np.ndarray | None) -> None:
        """Set the grains' velocities (W, n, axes) m/s and spins rad/s, (W, n), in space (W, n, 3); None: at rest."""
        shape = self.scene.grains.radius.shape
        velocity = np.zeros((*shape, self.grains.axes)) if velocity is None else velocity
        spin = np.zeros((*shape, self.grains.turns)) if spin is None else spin
        self.grains.launch(*(self.numbering.in_solver_order(values) for values in (velocity, spin)))
        self.mover.rest()
        self.load.forget()

    @property
    def mixes(self) -> bool:
        """Whether the grains may have to be renumbered as they mix."""
        return self.numbering.follows

    def keep_order(self) -> None:
        """Renumber the grains in worlds where they have mixed."""
        self.numbering.follow()

    def ease(self, settles: bool) -> None:
        """A bed in water settles as one of grains of its own size in thin water, where it comes to rest the same."""
        if self.mover.is_wet:
            self.mover.water.ease(settles)

    def start_clock(self) -> None:
        """The clock starts: angles count from here on."""
        self.grains.count_turns_anew()

    def bear(self, scene) -> None:
        """Raise Unavailable if liquid bridges of a scene reach farther than the lists were made for."""
        if scene.grains.longest_bridge > self.scene.grains.longest_bridge:
            raise Unavailable("this lets the liquid reach farther: start the experiment anew with it")

    def alter(self, scene) -> None:
        """Go on with the materials of a scene that equals the present one in everything else."""
        self.scene = scene
        self.lists.laws.learn(scene.grains.interfaces_of)
        self.lists.expire()  # so that the constants of each contact are recomputed

    def snapshot(self, time: float) -> dict[str, np.ndarray]:
        """Positions, velocities (W, n, axes), angles and spins (W, n) now, in the tank's frame."""
        return {name: self.numbering.in_own_order(values) for name, values in self.grains.read().items()}

    def pressing(self, world: int, time: float) -> Pressing:
        """The elastic contact forces in a world at its time (s)."""
        return self.presser.read(world, time, self.numbering.number[world])

    def fields(self) -> list[ti.Field]:
        """The arrays that a step changes, lists aside."""
        return self.grains.fields()

    def state(self) -> dict[str, np.ndarray]:
        """What `restore` continues from, beside the arrays."""
        return self.numbering.state()

    def axes(self) -> dict[str, Axes]:
        """The axes of the arrays of `state`, by name."""
        return self.numbering.axes()

    def restore(self, state: dict[str, np.ndarray]) -> None:
        """Restore what `state` returned."""
        self.numbering.restore(state)

    def as_rigid(self) -> list[Body]:
        """The grains of each world as one rigid body, per metre of the ship's length, in the tank's frame."""
        place, mass = self.grains.read()["position"][..., :PLANE], self.numbering.in_solver_order(self.grains.mass)
        share = per_metre(self.scene, place)
        own = share / self.grains.inverse_inertia.to_numpy()[:, : mass.shape[1]]
        mass = share * mass
        total = mass.sum(axis=1)
        centre = (mass[..., None] * place).sum(axis=1) / total[:, None]
        apart = ((place - centre[:, None]) ** 2).sum(axis=2)
        inertia = (mass * apart + own).sum(axis=1)
        return [Body(float(m), tuple(c), float(i)) for m, c, i in zip(total, centre.tolist(), inertia, strict=True)]
