"""A running simulation: the scene's arrays, its clock, and the calls that advance and read it."""

from collections.abc import Callable
from collections.abc import Sequence as Several
from dataclasses import replace

import numpy as np

from solvers.grains.observe import Observer
from solvers.grains.pressing import Presser, Pressing
from solvers.grains.renumbering import renumber_list
from solvers.machine import runtime
from solvers.machine.errors import Unavailable
from solvers.machine.quantity import parted
from solvers.machine.state import Axes, Axis, State
from solvers.machine.units import Units
from solvers.matters import MATTERS
from solvers.motion.carrier import carrier_kind, make_carrier
from solvers.scene import Scene
from solvers.ship.body import Body
from solvers.ship.vessel import Vessel
from solvers.space import order as renumber
from solvers.tank.load import Load
from solvers.tank.setting import Setting
from solvers.tank.walls import Walls
from solvers.time import watch
from solvers.time.clock import Clock
from solvers.time.schedules import SCHEDULES, choose_schedule, units_a_world
from solvers.time.sequence import Sequence

LOOK_FOR_MIXING = 0.25  # s, between checks of whether the grains' numbers still follow their positions
SKIN = 0.05  # of the mean diameter: the fastest of 0.05 … 0.3, in settled and in shaken beds
SKIN_OF_CONVEX = 0.1  # for convex outlines, whose lists cost more to build
SHORTER = 0.9  # of the limit on the step at set-up: the lowest limit that `alter` accepts
AT_REST = -1e9  # a time long before any motion starts
OF_CONTACTS = ("elastic", "contacts", "overlap")


class Simulation:
    """W worlds of one scene, from `position` (W, n, 2) m, at rest or with the scene's velocities.

    `threads` 0 uses all cores; `arch` is one of `runtime.ARCHES`; the `skin` (m) of the Verlet lists affects speed
    only. `units` is the number of units per world, by default the schedule's choice. Steps are up to `stretch` times
    the scene's step, which is the base step. Raises Unavailable.
    """

    def __init__(
        self,
        scene: Scene,
        position: np.ndarray,
        threads: int = 0,
        skin: float | None = None,
        arch: str = "auto",
        units: int | None = None,
        stretch: int = 1,
    ):
        self.threads = threads or runtime.available_cores()
        answers = carrier_kind(scene.vessels).answers
        self.arch = "cpu" if answers and arch == "auto" else runtime.choose_arch(arch, scene.precision)
        runtime.initialise(self.threads, self.arch, scene.precision)
        worlds, count = scene.radius.shape
        self.scene, self.dt = scene, scene.time_step()
        self.longest_step = scene.step_limits()[0].step  # s, the limit at set-up
        self.schedule_name = choose_schedule(scene.schedule, self.arch, worlds, count, self.threads, answers)
        self.units_a_world = units or units_a_world(self.schedule_name, worlds, count, self.threads)
        self.skin = skin or (SKIN_OF_CONVEX if scene.shapes and scene.shapes.convex else SKIN) * 2.0 * scene.mean_radius
        self.steps, self.room, self.stretch = 0, 1, stretch
        self.origin = 0.0  # s, time of the tank's motion at step 0
        self.unkicked = 0  # the first step since the launch
        self.number = np.tile(np.arange(count), (worlds, 1))  # the grains' own numbers, in solver order
        self._build()
        means = [quantity for quantity in self.observer.quantities if quantity.mean]
        # When last, and what the means were
        self.observed, self.means = 0, {mean.name: np.zeros((worlds, *mean.shape)) for mean in means}
        self.place(np.asarray(position, dtype=np.float64).reshape(worlds, count, 2), scene.velocity, scene.spin)

    def _build(self) -> None:
        """Make the arrays and the objects whose kernels work on them."""
        scene, (worlds, count) = self.scene, self.scene.radius.shape
        self.arrays = arrays = State(scene.precision)
        units = Units(worlds, count, self.units_a_world, count + len(scene.fixed))
        self.walls = Walls(arrays, scene.tanks, scene.parts)
        pieces = len(scene.tanks) + len(scene.parts) + bool(len(scene.fixed))
        self.load_on_tank = load = Load(arrays, units, pieces, scene.shares)
        self.carrier = make_carrier(arrays, scene, self.dt, load)
        way = watch.FASTEST_STEP * scene.sizes[0]
        lists = self.skin, self.room, way, self.stretch
        setting = Setting(arrays, units, self.walls, load, self.carrier.rotating, *lists)
        self.matters = [matter for make in MATTERS if (matter := make(scene, setting))]
        self.clock = Clock(arrays, units)
        self.schedule = SCHEDULES[self.schedule_name](Sequence(self.matters, self.carrier), self.clock, self.threads)
        [matter] = self.matters
        self.grains, self.neighbours, self.contacts = matter.grains, matter.neighbours, matter.contacts
        self.mover = matter.mover
        parts = units, self.grains, self.walls, self.neighbours, self.contacts, self.carrier, load
        self.observer = Observer(arrays, *parts)
        self.presser = Presser(units, self.grains, self.walls, self.neighbours, self.contacts)
        arrays.finish()

    def place(self, position: np.ndarray, velocity: np.ndarray | None = None, spin: np.ndarray | None = None) -> None:
        """Place the grains at `position` (W, n, 2) m without contact history, and `launch` them."""
        position = self._in_solver_order(position)
        self.grains.put(position)
        self.neighbours.forget()
        self.ordered = position.copy()  # positions at the time of the last renumbering
        self.launch(velocity, spin)

    def launch(self, velocity: np.ndarray | None = None, spin: np.ndarray | None = None) -> None:
        """Set the grains' velocities (W, n, 2) m/s and spins (W, n) rad/s; None: at rest."""
        velocity = np.zeros((*self.scene.radius.shape, 2)) if velocity is None else velocity
        spin = np.zeros(self.scene.radius.shape) if spin is None else spin
        self.grains.launch(self._in_solver_order(velocity), self._in_solver_order(spin))
        self.mover.rest()
        self.load_on_tank.forget()
        self.clock.launch()
        self.unkicked = self.observed = self.steps
        self.moored = False

    def _in_solver_order(self, values: np.ndarray) -> np.ndarray:
        """Reorder values (W, n, …) from the grains' own numbers to solver order."""
        return values[np.arange(self.scene.worlds)[:, None], self.number]

    def _make_room(self) -> None:
        """Double the capacity of the contact lists; all other state is kept."""
        old = self.arrays
        self.room *= 2
        self._build()
        self.arrays.take_over(old)
        old.release()

    @property
    def time(self) -> float:
        """Model time (s); while settling, the time since settling began."""
        return self.steps * self.dt

    @property
    def grain_steps(self) -> int:
        """Total number of grain updates so far: grains times steps, over all worlds."""
        return self.steps * self.scene.radius.size

    def advance(self, steps: int) -> None:
        """Advance every world by `steps` base steps.

        Raises BadState if the state check stops a world; the state is kept as it is.
        """
        self._moor()
        target, often = self.steps + steps, max(1, round(LOOK_FOR_MIXING / self.dt))
        # Contact history of outlines depends on the order of the two grains' numbers, so these are not renumbered.
        large = self.ordered.shape[1] >= renumber.FEWEST and self.scene.shapes is None
        while self.steps < target:
            if large and self.steps % often == 0:
                self._keep_order()  # before the steps: it expires the lists, which `observe` needs and a step rebuilds
            self.steps = min(target, often * (self.steps // often + 1)) if large else target
            self._reach_step()

    def _reach_step(self) -> None:
        """Advance every running world to base step `self.steps`, with larger contact lists if they overflow."""
        runtime.merge_repeats(self.scene.shapes is None)
        while True:
            self.schedule.advance(self.steps, self.origin, self.dt)
            status = self.clock.status.to_numpy()
            if not np.any(status == watch.NO_ROOM):
                break
            self._make_room()
            self.clock.status.from_numpy(np.where(status == watch.NO_ROOM, watch.RUNNING, status).astype(np.int32))
        if np.any(status == watch.TOO_FAST):
            watch.report_speed(status, self.grains.read()["velocity"], self.clock.step.to_numpy() * self.dt, self.dt)

    def _keep_order(self) -> None:
        """Renumber the grains in worlds where they have mixed."""
        position, diameter = self.grains.read()["position"], 2.0 * self.scene.mean_radius
        order = {
            w: renumber.spatial_order(places, diameter)
            for w, places in enumerate(position)
            if renumber.has_mixed(places, self.ordered[w], diameter)
        }
        for w, old in order.items():
            self.number[w], self.ordered[w] = self.number[w][old], position[w][old]
        if order:
            self.arrays.reorder("grain", order)
            lists, laws = self.neighbours, self.neighbours.laws
            renumber_list(lists.pairs, lists.units, order, laws.odd, mates=True)
            renumber_list(lists.contacts, lists.units, order, laws.odd, mates=False)
            lists.expire()

    def observe(self) -> dict[str, np.ndarray]:
        """Quantities of every world now, (W, *shape) of each by name. Raises BadState if a check fails.

        The force on the tank is the mean since the last observation; right after grains were placed, the present one.
        """
        self._moor()
        return self._observe_unmoved() if self.steps == self.unkicked else self._observe()

    def _observe_unmoved(self) -> dict[str, np.ndarray]:
        """Observe grains that have taken no step yet, so that no contacts are known.

        One step builds the contact lists and sums the forces at its start; then it is undone, bit for bit.
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
        # Worlds in which no time has passed keep the last means.
        ended = np.isin(self.clock.status.to_numpy(), (watch.WAITING, watch.OVER))
        still = ended | (self.observed == self.steps)
        for name, before in self.means.items():
            rows[name] = np.where(still.reshape(-1, *[1] * (before.ndim - 1)), before, rows[name])
        rows |= self.carrier.account()
        self.observed, self.means = self.steps, {name: rows[name] for name in self.means}
        watch.check_state(rows["overlap"], rows["escaped"].astype(int), self.time)
        return rows

    def loads(self) -> np.ndarray:
        """Force y, z (N) and moment (N m) of the cargo on each piece of the tank, (W, pieces, 3), as last observed.

        The pieces are the walls of each tank, then the parts, then the fixed grains if there are any.
        """
        return self.observer.loads.to_numpy()

    def settle(self, rest: float, limit: float, tell: Callable[[float], None] = lambda _: None) -> bool:
        """Let the grains settle in the upright tank, then start the clock at zero; returns whether all are at rest.

        A world is at rest, and waits for the others, once the mean kinetic energy of its grains (spin included) is
        below `rest` times m g d in two checks in a row, 10 ms apart. Settling ends after `limit` s at the latest.
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

    def steer(self, pieces: Several[np.ndarray]) -> None:
        """Let the scene's motions, which must all be `Steered`, follow these polynomials (6,) from now on."""
        self.carrier.steer(self.time, pieces)

    def meet(self, vessels: Several[Vessel]) -> None:
        """Change the waves to those of `vessels`, which must equal the present ones in everything else."""
        self.scene = replace(self.scene, vessels=list(vessels))
        self.carrier.meet(vessels)

    def alter(self, **changes: object) -> None:
        """Go on with other materials or another gravity, given as fields of the scene. The grains stay as they are.

        Raises Unavailable if the changes need shorter steps or longer liquid bridges than the arrays were made for.
        """
        altered = replace(self.scene, **changes)
        if altered.step_limits()[0].step < SHORTER * self.longest_step:
            raise Unavailable("this asks for shorter time steps: start the experiment anew with it")
        if altered.longest_bridge > self.scene.longest_bridge:
            raise Unavailable("this lets the liquid reach farther: start the experiment anew with it")
        self.scene = altered
        self.carrier.gravity.fill(altered.gravity)
        self.neighbours.laws.learn(altered.interfaces_of)
        self.neighbours.expire()  # so that the constants of each contact are recomputed

    def start_clock(self) -> None:
        """Start the tank's motion now, at time zero."""
        self.unkicked -= self.steps
        self.origin, self.steps, self.observed = 0.0, 0, 0
        self.clock.step.fill(0)
        self.clock.status.fill(watch.RUNNING)
        self.grains.count_turns_anew()
        self.moored = False

    def _moor(self) -> None:
        """Let the carrier begin with the settled cargo in place, once. Raises Unavailable if it cannot."""
        if not self.moored and self.origin == 0.0:
            self.carrier.begin(self.cargo)
            self.moored = True

    def cargo(self) -> list[Body]:
        """The grains of each world as one rigid body, per metre of the ship's length, in the tank's frame."""
        place, mass = self.grains.read()["position"], self._in_solver_order(self.grains.mass)
        share = self._per_metre(place)
        own = share / self.grains.inverse_inertia.to_numpy()[:, : mass.shape[1]]
        mass = share * mass
        total = mass.sum(axis=1)
        centre = (mass[..., None] * place).sum(axis=1) / total[:, None]
        apart = ((place - centre[:, None]) ** 2).sum(axis=2)
        inertia = (mass * apart + own).sum(axis=1)
        return [Body(float(m), tuple(c), float(i)) for m, c, i in zip(total, centre.tolist(), inertia, strict=True)]

    def _per_metre(self, position: np.ndarray) -> np.ndarray:
        """Factor (W, n), 1/m, from each grain's mass to mass per metre of ship, by the tank that it lies in."""
        share = np.empty(position.shape[:2])
        for w, vessel in enumerate(self.scene.vessels):
            share[w] = self.scene.tanks[0].share(vessel.length)
            for tank in self.scene.more_tanks:
                share[w][tank.holds(position[w])] = tank.share(vessel.length)
        return share

    def snapshot(self) -> dict[str, np.ndarray]:
        """Positions, velocities (W, n, 2), angles and spins (W, n) now, in the tank's frame."""
        worlds = np.arange(self.scene.worlds)[:, None]
        found = {}
        for name, values in self.grains.read().items():
            found[name] = np.empty_like(values)
            found[name][worlds, self.number] = values
        return found

    def pressing(self, world: int = 0) -> Pressing:
        """The present elastic contact forces in a world."""
        runtime.merge_repeats(self.scene.shapes is None)
        return self.presser.read(world, self.origin + self.time, self.number[world])

    def part_places(self) -> np.ndarray:
        """Displacements (W, P, 2) m of the scene's parts at the last `observe`; they are the same in every world."""
        places = self.walls.places.to_numpy()[: len(self.scene.parts)].astype(float)
        return np.tile(places, (self.scene.worlds, 1, 1))

    def state(self) -> dict[str, np.ndarray]:
        """The complete state, from which `restore` continues bit for bit."""
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

    def axes(self) -> dict[str, Axes]:
        """The axes of all that `state` tells, by its names."""
        world, grain = Axis("world", self.scene.worlds), Axis("grain", self.scene.radius.shape[1])
        means = {name: (world, *(Axis("component", size) for size in m.shape[1:])) for name, m in self.means.items()}
        own = {"numbers": (Axis("number", 6),), "origin": (), **means}
        order = {"number": (world, grain), "ordered": (world, grain, Axis("direction", 2))}
        return own | order | self.arrays.axes()

    def restore(self, state: dict[str, np.ndarray]) -> None:
        """Restore what `state` returned in a simulation of the same scene."""
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
        """Free the arrays; the simulation must not be used afterwards."""
        self.arrays.release()
