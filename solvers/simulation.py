"""A running simulation: the scene's arrays, its clock, and the calls that advance and read it."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from solvers.grains.contacts import Contacts
from solvers.grains.integrators import INTEGRATORS
from solvers.grains.laws.chosen import ChosenLaws
from solvers.grains.mover import Mover
from solvers.grains.neighbours import Neighbours
from solvers.grains.observe import Observer
from solvers.grains.pressing import Presser, Pressing
from solvers.grains.shapes.grains import ShapedGrains
from solvers.grains.shapes.rules.area import Area
from solvers.grains.shapes.rules.contacts import ShapedContacts
from solvers.grains.shapes.rules.continuous import Continuous
from solvers.grains.shapes.rules.discrete import Discrete
from solvers.grains.shapes.rules.lists import ShapedNeighbours
from solvers.grains.state import Grains
from solvers.machine import runtime
from solvers.machine.errors import Unavailable
from solvers.machine.quantity import parted
from solvers.machine.runtime import Arrays
from solvers.machine.units import Units
from solvers.motion.afloat import Afloat, steps_an_interval
from solvers.motion.frame import Frame
from solvers.scene import Scene
from solvers.ship.body import Body
from solvers.ship.vessel import Vessel
from solvers.space import order as renumber
from solvers.tank.walls import Walls
from solvers.time import watch
from solvers.time.clock import Clock
from solvers.time.schedules import SCHEDULES, choose_schedule, units_a_world
from solvers.time.schedules.engine import Engine

LOOK_FOR_MIXING = 0.25  # s, between looks at whether the grains' numbers still follow their places
SKIN = 0.05  # of the mean diameter; in settled and in shaken beds the fastest of 0.05 … 0.3
SKIN_OF_CONVEX = 0.1  # outlines, whose lists cost more to make
RULES = {"continuous": Continuous, "nodes": Discrete, "area": Area}  # of contact between outlines
SHORTER = 0.9  # of the limit on the step: how much shorter one may come to be while the grains move
AT_REST = -1e9  # a time long before any motion starts
OF_CONTACTS = ("elastic", "contacts", "overlap")


class Simulation:
    """W worlds of one scene, from `position` (W, n, 2) m, at rest or with the scene's velocities.

    `threads` 0 uses all cores; `arch` is one of `runtime.ARCHES`; `skin` (m) of the Verlet lists affects speed alone.
    `units` is the number of units a world is cut into; None: as the schedule likes it here. Raises Unavailable.
    """

    def __init__(
        self,
        scene: Scene,
        position: np.ndarray,
        threads: int = 0,
        skin: float | None = None,
        arch: str = "auto",
        units: int | None = None,
    ):
        self.threads = threads or runtime.available_cores()
        self.afloat = bool(scene.vessels)
        self.arch = "cpu" if self.afloat and arch == "auto" else runtime.choose_arch(arch, scene.precision)
        runtime.initialise(self.threads, self.arch, scene.precision)
        worlds, count = scene.radius.shape
        self.scene, self.dt = scene, scene.time_step()
        self.longest_step = scene.step_limits()[0].step  # s, at which it was made
        self.schedule_name = choose_schedule(scene.schedule, self.arch, worlds, count, self.threads, self.afloat)
        self.units_a_world = units or units_a_world(self.schedule_name, worlds, count, self.threads)
        self.skin = skin or (SKIN_OF_CONVEX if scene.shapes and scene.shapes.convex else SKIN) * 2.0 * scene.mean_radius
        self.steps, self.room = 0, 1
        self.origin = 0.0  # what the tank's motion takes for the time at step 0
        self.unkicked = 0  # the step that is the grains' first
        self.number = np.tile(np.arange(count), (worlds, 1))  # the grains' own, in solver order
        self._build()
        means = [quantity for quantity in self.observer.quantities if quantity.mean]
        # When last, and what the means were
        self.observed, self.means = 0, {mean.name: np.zeros((worlds, *mean.shape)) for mean in means}
        self.place(np.asarray(position, dtype=np.float64).reshape(worlds, count, 2), scene.velocity, scene.spin)

    def _build(self) -> None:
        """Make the arrays and the kernels that work on them."""
        scene, worlds = self.scene, self.scene.worlds
        self.arrays = arrays = Arrays(scene.precision)
        count = scene.radius.shape[1]
        units = Units(worlds, count, self.units_a_world, count + len(scene.fixed))
        may_leave = bool(scene.open_edges)
        grains = scene.radius, scene.density, scene.fixed, units.ghosts, may_leave, scene.kind
        self.walls = Walls(arrays, scene.outline, scene.open_edges, scene.parts)
        integrator = INTEGRATORS[scene.integrator]()
        laws = ChosenLaws(arrays, units, *scene.laws, scene.interfaces_of, scene.kinds, integrator)
        moduli = np.array([[between.young_modulus for between in world] for world in scene.interfaces_of])
        bridges = scene.longest_bridge
        reach = 2.0 * scene.farthest_reach + max(self.skin, bridges)
        lists = self.skin, bridges, reach, laws, moduli, self.room
        if scene.shapes is None:
            self.grains = Grains(arrays, *grains)
            self.neighbours = Neighbours(arrays, units, self.grains, self.walls, *lists)
            self.contacts = Contacts(arrays, units, self.grains, self.walls, self.neighbours, laws)
        else:
            rule = RULES[scene.shapes.contact](arrays, units, self.walls, scene.shapes)
            self.grains = ShapedGrains(arrays, scene.shapes, *grains)
            self.neighbours = ShapedNeighbours(arrays, units, self.grains, self.walls, *lists, rule)
            self.contacts = ShapedContacts(arrays, units, self.grains, self.walls, self.neighbours, laws, rule)
        if self.afloat:
            every = steps_an_interval(scene.vessels, scene.interval, self.dt)
            self.frame = Afloat(arrays, scene.vessels, scene.gravity, every)
        else:
            self.frame = Frame(arrays, scene.motions, scene.soft_start, scene.gravity)
        self.mover = Mover(arrays, units, self.grains, integrator, self.frame.rotating, self.frame.afloat)
        self.clock = Clock(arrays, units)
        engine = Engine(
            units, self.grains, self.walls, self.neighbours, self.contacts, self.mover, self.frame, self.clock
        )
        self.schedule = SCHEDULES[self.schedule_name](engine, self.threads)
        parts = units, self.grains, self.walls, self.neighbours, self.contacts, self.frame, self.mover
        self.observer = Observer(arrays, *parts)
        self.presser = Presser(units, self.grains, self.walls, self.neighbours, self.contacts)
        arrays.finish()

    def place(self, position: np.ndarray, velocity: np.ndarray | None = None, spin: np.ndarray | None = None) -> None:
        """Put the grains somewhere, (W, n, 2) m, without history: at rest, or at (W, n, 2) m/s and (W, n) rad/s."""
        position = self._in_solver_order(position)
        self.grains.place(position)
        self.neighbours.forget()
        self.ordered = position.copy()  # where they were when they got their places in the arrays
        self.launch(velocity, spin)

    def launch(self, velocity: np.ndarray | None = None, spin: np.ndarray | None = None) -> None:
        """Set the grains' velocities (W, n, 2) m/s and spins (W, n) rad/s; None is rest."""
        velocity = np.zeros((*self.scene.radius.shape, 2)) if velocity is None else velocity
        spin = np.zeros(self.scene.radius.shape) if spin is None else spin
        self.grains.launch(self._in_solver_order(velocity), self._in_solver_order(spin))
        self.mover.rest()
        self.unkicked = self.observed = self.steps
        self.moored = False

    def _in_solver_order(self, values: np.ndarray) -> np.ndarray:
        """Values (W, n, …) of the grains by their own numbers, as the arrays hold them."""
        return values[np.arange(self.scene.worlds)[:, None], self.number]

    def _make_room(self) -> None:
        """Double the room of the contact lists; what the worlds hold stays as it is."""
        old = self.arrays
        self.room *= 2
        self._build()
        self.arrays.take_over(old)
        old.release()

    @property
    def time(self) -> float:
        """Model time (s); while settling, since that began."""
        return self.steps * self.dt

    @property
    def grain_steps(self) -> int:
        """Grains times steps of all worlds so far."""
        return self.steps * self.scene.radius.size

    def advance(self, steps: int) -> None:
        """Take `steps` steps of Δt in every world.

        Raises BadState where the watch stops a world; the state is kept as it is.
        """
        self._moor()
        target, often = self.steps + steps, max(1, round(LOOK_FOR_MIXING / self.dt))
        # Contacts of outlines are remembered in the order of their grains' numbers, so these stay as they are.
        large = self.ordered.shape[1] >= renumber.FEWEST and self.scene.shapes is None
        while self.steps < target:
            if large and self.steps % often == 0:
                self._keep_order()  # before steps, which make new lists: the old ones are no good for looking at
            self.steps = min(target, often * (self.steps // often + 1)) if large else target
            self._reach_step()

    def _reach_step(self) -> None:
        """Take every running world to the step that `steps` says."""
        runtime.merge_repeats(self.scene.shapes is None)
        fastest = watch.FASTEST_STEP * self.scene.sizes[0] / self.dt
        while True:
            self.schedule.advance(self.steps, self.origin, self.unkicked, self.dt, fastest)
            status = self.clock.status.to_numpy()
            if not np.any(status == watch.NO_ROOM):
                break
            self._make_room()
            self.clock.status.from_numpy(np.where(status == watch.NO_ROOM, watch.RUNNING, status).astype(np.int32))
        if np.any(status == watch.TOO_FAST):
            watch.report_speed(status, self.grains.read()["velocity"], self.clock.step.to_numpy() * self.dt, self.dt)

    def _keep_order(self) -> None:
        """Number the grains anew in worlds where they have mixed."""
        position, diameter = self.grains.read()["position"], 2.0 * self.scene.mean_radius
        order = {
            w: renumber.spatial_order(places, diameter)
            for w, places in enumerate(position)
            if renumber.has_mixed(places, self.ordered[w], diameter)
        }
        for w, old in order.items():
            self.number[w], self.ordered[w] = self.number[w][old], position[w][old]
        if order:
            self.grains.permute(order, self.mover.extra)
            lists, laws = self.neighbours, self.neighbours.laws
            renumber.renumber_list(lists.pairs, lists.units, order, laws.odd, mates=True)
            renumber.renumber_list(lists.contacts, lists.units, order, laws.odd, mates=False)
            lists.expire()

    def observe(self) -> dict[str, np.ndarray]:
        """Numbers of every world now, (W, *shape) of each quantity by name. Raises BadState from the watch.

        The force on the tank is the mean since the last look; of grains that were just put where they are, that of now.
        """
        self._moor()
        return self._observe_unmoved() if self.steps == self.unkicked else self._observe()

    def _observe_unmoved(self) -> dict[str, np.ndarray]:
        """The numbers of grains that have taken no step yet, so that nothing is known of their contacts.

        A step makes the contact lists and adds up the forces at its start; then it is taken back, bit for bit.
        """
        rows, before = self._observe(), self.state()
        start = [(field, field.to_numpy()) for field in self.grains.fields()]
        try:
            self.advance(1)
            load = self._observe()
            for field, values in start:
                field.from_numpy(values)
            self.steps -= 1
            touching = self._observe()
        finally:
            self.restore(before)
        self.means = {name: load[name] for name in self.means}
        return rows | {name: touching[name] for name in OF_CONTACTS} | self.means

    def _observe(self) -> dict[str, np.ndarray]:
        runtime.merge_repeats(self.scene.shapes is None)
        self.observer.observe(self.origin + self.time, max(self.steps - self.observed, 1) * self.dt)
        rows = parted(self.observer.rows.to_numpy().astype(float), self.observer.quantities)
        # Where no time has passed there is nothing to average over.
        ended = np.isin(self.clock.status.to_numpy(), (watch.WAITING, watch.CAPSIZED))
        still = ended | (self.observed == self.steps)
        for name, before in self.means.items():
            rows[name] = np.where(still.reshape(-1, *[1] * (before.ndim - 1)), before, rows[name])
        if self.afloat:
            rows |= self.frame.account()
        self.observed, self.means = self.steps, {name: rows[name] for name in self.means}
        watch.check_state(rows["overlap"], rows["escaped"].astype(int), self.time)
        return rows

    def settle(self, rest: float, limit: float, tell: Callable[[float], None] = lambda _: None) -> bool:
        """Let the grains come to rest in the upright tank; the clock then starts at zero. Returns whether all rest.

        A world rests, and waits for the others, when the mean kinetic energy of its grains (spin included) is below
        `rest` times m g d at two looks in a row, 10 ms apart. At most `limit` s.
        """
        self.origin = AT_REST
        look = max(1, round(0.01 / self.dt))
        radius = self.scene.radius
        scale = (self.grains.mass * self.scene.gravity * 2.0 * radius).mean(axis=1)
        quiet = np.zeros(len(radius), dtype=int)
        while np.any(quiet < 2) and self.steps * self.dt < limit:
            self.advance(look)
            rows = self.observe()
            energy = (rows["kinetic"] + rows["rotational"]) / radius.shape[1]
            quiet = np.where(energy < rest * scale, quiet + 1, 0)
            self.clock.status.from_numpy(np.where(quiet < 2, watch.RUNNING, watch.WAITING).astype(np.int32))
            tell(self.steps * self.dt)
        self.start_clock()
        return bool(np.all(quiet >= 2))

    def steer(self, pieces: Sequence[np.ndarray]) -> None:
        """From now on, have the scene's motions, all of them steered, follow these polynomials (6,)."""
        self.frame.steer(self.time, pieces)

    def meet(self, vessels: Sequence[Vessel]) -> None:
        """Have the ships meet other waves, those of these vessels, which are else as they were."""
        self.scene = replace(self.scene, vessels=list(vessels))
        self.frame.meet(vessels)

    def alter(self, **changes: object) -> None:
        """Go on with other materials or another gravity: fields of the scene. The grains stay as they are.

        Raises Unavailable for what asks for shorter steps, or lets liquid reach farther, than the arrays were made for.
        """
        altered = replace(self.scene, **changes)
        if altered.step_limits()[0].step < SHORTER * self.longest_step:
            raise Unavailable("this asks for shorter time steps: start the experiment anew with it")
        if altered.longest_bridge > self.scene.longest_bridge:
            raise Unavailable("this lets the liquid reach farther: start the experiment anew with it")
        self.scene = altered
        self.frame.gravity.fill(altered.gravity)
        self.neighbours.laws.learn(altered.interfaces_of)
        self.neighbours.expire()  # what was worked out for each contact is worked out anew

    def start_clock(self) -> None:
        """The tank's motion begins now, at time zero."""
        self.unkicked -= self.steps
        self.origin, self.steps, self.observed = 0.0, 0, 0
        self.clock.step.fill(0)
        self.clock.status.fill(watch.RUNNING)
        self.grains.count_turns_anew()
        self.moored = False

    def _moor(self) -> None:
        """Have ships float with their cargo where it lies, once it has settled. Raises Unavailable if they cannot."""
        if self.afloat and not self.moored and self.origin == 0.0:
            self.frame.begin(self.cargo())
            self.moored = True

    def cargo(self) -> list[Body]:
        """The grains of each world as they lie, as if frozen: per metre of a ship's length, in the tank's frame."""
        place, mass = self.grains.read()["position"], self._in_solver_order(self.grains.mass)
        own = 1.0 / self.grains.inverse_inertia.to_numpy()[:, : mass.shape[1]]
        total = mass.sum(axis=1)
        centre = (mass[..., None] * place).sum(axis=1) / total[:, None]
        apart = ((place - centre[:, None]) ** 2).sum(axis=2)
        inertia = (mass * apart + own).sum(axis=1)
        thick = [vessel.thickness for vessel in self.scene.vessels]
        rows = zip(total, centre.tolist(), inertia, thick, strict=True)
        return [Body(float(m / d), tuple(c), float(i / d)) for m, c, i, d in rows]

    def snapshot(self) -> dict[str, np.ndarray]:
        """Positions, velocities (W, n, 2), angles and spins (W, n) now, in the tank's frame."""
        worlds = np.arange(self.scene.worlds)[:, None]
        found = {}
        for name, values in self.grains.read().items():
            found[name] = np.empty_like(values)
            found[name][worlds, self.number] = values
        return found

    def pressing(self, world: int = 0) -> Pressing:
        """The elastic forces of the contacts in a world now."""
        runtime.merge_repeats(self.scene.shapes is None)
        return self.presser.read(world, self.origin + self.time, self.number[world])

    def part_places(self) -> np.ndarray:
        """Displacements (W, P, 2) m of the scene's parts at the last `observe`; they are the same in every world."""
        places = self.walls.places.to_numpy()[: len(self.scene.parts)].astype(float)
        return np.tile(places, (self.scene.worlds, 1, 1))

    def state(self) -> dict[str, np.ndarray]:
        """All it takes to go on bit for bit, for `restore`."""
        schedule = list(SCHEDULES).index(self.schedule_name)
        numbers = self.steps, self.room, self.unkicked, self.observed, self.units_a_world, schedule
        order = {"number": self.number, "ordered": self.ordered}
        return {
            "numbers": np.array(numbers),
            "origin": np.array(self.origin),
            **order,
            **self.means,
            **self.arrays.read(),
        }

    def restore(self, state: dict[str, np.ndarray]) -> None:
        """Become what `state` was told of, by a simulation of the same scene."""
        self.steps, room, self.unkicked, self.observed, units, schedule = (int(number) for number in state["numbers"])
        self.origin, self.means = float(state["origin"]), {name: np.array(state[name]) for name in self.means}
        self.number, self.ordered = np.array(state["number"]), np.array(state["ordered"])
        if (room, units) != (self.room, self.units_a_world):
            self.arrays.release()
            self.room, self.units_a_world, self.schedule_name = room, units, list(SCHEDULES)[schedule]
            self._build()
        self.arrays.write(state)
        self.moored = self.steps > 0

    def close(self) -> None:
        """Give the arrays back; the simulation must not be used after it."""
        self.arrays.release()
