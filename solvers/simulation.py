"""A running simulation: the scene's arrays, its clock, and the calls that advance and read it."""

from collections.abc import Callable
from collections.abc import Sequence as Several
from dataclasses import replace
from math import lcm

import numpy as np

from solvers.grains.pressing import UNTOUCHED, Pressing
from solvers.machine import runtime, wide
from solvers.machine.errors import Unavailable
from solvers.machine.state import Axes, Axis, State
from solvers.machine.wide import real_vectors
from solvers.matters import context_of, made, make_exchange
from solvers.motion.carrier import make_carrier
from solvers.motion.moved import make_pieces
from solvers.motion.sampler import Sampler
from solvers.scene import Scene
from solvers.ship.body import Body, bolted
from solvers.ship.vessel import Vessel
from solvers.tank.matter import Matter
from solvers.tank.solids.making import make_walls
from solvers.time import kept, watch
from solvers.time.changes import up_to_change
from solvers.time.clock import Clock
from solvers.time.schedules import SCHEDULES, choose_schedule, moved, units_a_world
from solvers.time.sequence import Sequence
from solvers.time.settling import settle

LOOK_FOR_MIXING = 0.25  # s, between checks of whether the grains' numbers still follow their positions
SHORTER = 0.9  # of the limit on the step at set-up: the lowest limit that `alter` accepts


class Simulation:
    """W worlds of one scene, its grains, if any, at `position` (W, n, 2) m, at rest or with the scene's velocities.

    `threads` 0 uses all cores; `arch` is one of `runtime.ARCHES`; the `skin` (m) of the Verlet lists, by default wider
    for faster grains, affects speed only. `units` is the number of units per world, by default the schedule's choice.
    The scene's step is the base step; while grains are slow, steps are up to `largest_multiple` times as long, a power
    of two. Raises Unavailable.
    """

    def __init__(
        self,
        scene: Scene,
        position: np.ndarray | None = None,
        threads: int = 0,
        skin: float | None = None,
        arch: str = "auto",
        units: int | None = None,
        largest_multiple: int = 1,
    ):
        self.threads = threads or runtime.available_cores()
        worlds, count = scene.worlds, moved(scene)
        asked = scene.precision, scene.flows, worlds * count
        self.arch = "cpu" if scene.responds and arch == "auto" else runtime.choose_arch(arch, *asked)
        runtime.initialise(self.threads, self.arch, scene.precision)
        self.scene, self.dt, self.longest_step = scene, scene.time_step(), scene.longest_step(1.0)  # s; at set-up
        self.schedule_name = choose_schedule(scene.schedule, self.arch, worlds, count, self.threads, scene.responds)
        self.units_a_world = units or units_a_world(self.schedule_name, worlds, count, self.threads)
        # Per grain all worlds share a step, and one would depend on the others.
        alone = self.arch == "cpu" and (self.schedule_name != "per-grain" or worlds == 1)
        most = max(largest_multiple, *(matter.soft_multiple for matter in scene.matters), 1)
        self.largest_multiple = most if alone else 1
        self.vectors = min((matter.lanes(scene.precision) for matter in scene.matters), default=wide.lanes())
        self.steps, self.room, self.among, self.skin = 0, 1, worlds, skin  # `among`: worlds at the start
        # Short kernels; and of discs beside water, 1.4 times as fast so, but not the longest ones, which take minutes
        self.simple = not scene.matters or (not scene.is_long and any(matter.simple for matter in scene.matters))
        self.origin, self.unkicked = 0.0, 0  # time (s) of the tank's motion at step 0; the first step since the launch
        self._build()
        self.observed, self.means = 0, self.sampler.means  # when last, and what the means were
        self.place(position, *next((matter.start for matter in scene.matters if matter.start), ()))

    def _build(self) -> None:
        """Make the arrays and the objects whose kernels work on them."""
        scene, worlds = self.scene, self.scene.worlds
        self.arrays = arrays = State(scene.precision)
        self.carrier = make_carrier(arrays, scene, self.dt)
        self.parts = make_pieces(arrays, scene, self.carrier, self.dt)
        self.walls = make_walls(arrays, scene, self.parts)
        context = context_of(self)
        matters = made(scene, context)
        self.matters = {matter.name: matter for matter in matters}
        loads = [*(matter.load for matter in matters), *self.parts.bodies.own_loads]
        for carrier in (self.carrier, self.parts.bodies):
            carrier.bear(loads)
        cut = max((one.in_bands for one in scene.matters), default=0)
        self.clock = Clock(arrays, context.units(cut), self.carrier.numbers)
        sequence = Sequence(matters, self.carrier, self.parts, make_exchange(scene, context, matters))
        self.exchange_interval, self.wide = sequence.exchange_interval, any(matter.wide for matter in matters)
        self.schedule = SCHEDULES[self.schedule_name](sequence, self.clock, self.threads)
        told = scene.axes, scene.faces, scene.wall_pieces
        self.sampler = Sampler(arrays, worlds, scene.pieces, self.carrier, self.parts, loads, *told)
        arrays.finish()

    @property
    def grains(self) -> Matter | None:
        """The grains among the `matters`; None if there are none."""
        return self.matters.get("grains")

    @property
    def water(self) -> Matter | None:
        """The water among the `matters`; None if there is none."""
        return self.matters.get("water")

    def place(
        self, position: np.ndarray | None, velocity: np.ndarray | None = None, spin: np.ndarray | None = None
    ) -> None:
        """Place the grains at `position` (W, n, 2) m without contact history, and the water; `launch` all matters."""
        self.parts.bodies.hold_all()
        for matter in self.matters.values():
            matter.place(position)
        self.launch(velocity, spin)

    def launch(self, velocity: np.ndarray | None = None, spin: np.ndarray | None = None) -> None:
        """Set the grains' velocities (W, n, 2) m/s and spins (W, n) rad/s; None: at rest."""
        for matter in self.matters.values():
            matter.launch(velocity, spin)
        self.clock.launch()
        self.unkicked = self.observed = self.steps
        self.moored = False

    def _make_room(self) -> None:
        """Double the capacity of the contact lists; all other state is kept."""
        old, of_matters = self.arrays, self._of_matters()
        self.room *= 2
        self._build()
        self.arrays.take_over(old)
        for matter in self.matters.values():
            matter.restore(of_matters)
        old.release()

    def _of_matters(self) -> dict[str, np.ndarray]:
        """What the matters keep beside the arrays."""
        return {name: values for matter in self.matters.values() for name, values in matter.state().items()}

    @property
    def time(self) -> float:
        """Model time (s); while settling, the time since settling began."""
        return self.steps * self.dt

    def whole(self, steps: int) -> int:
        """The largest number of base steps, up to `steps`, that cuts no longer step; at least one such step."""
        return (least := lcm(self.largest_multiple, self.exchange_interval)) * max(1, steps // least)

    def advance(self, steps: int) -> None:
        """Advance every world by `steps` base steps, as many as `whole` says where matters have steps of their own.

        Raises BadState if the state check stops a world; the state is kept as it is.
        """
        self._moor()
        target, often = self.steps + steps, self.whole(round(LOOK_FOR_MIXING / self.dt))
        mixing = [matter for matter in self.matters.values() if matter.mixes]
        while self.steps < target:
            for matter in mixing if self.steps % often == 0 else ():
                matter.keep_order()  # before the steps: lists expire, which `observe` needs and steps rebuild
            self.steps = up_to_change(self, min(target, often * (self.steps // often + 1)) if mixing else target)
            self._reach_step()

    def _reach_step(self) -> None:
        """Advance every running world to base step `self.steps`, with larger contact lists if they overflow."""
        runtime.merge_repeats(self.simple)
        while True:
            with real_vectors(self.wide):
                self.schedule.advance(self.steps, self.origin, self.dt)
            status = self.clock.status.to_numpy()
            if not np.any(status == watch.NO_ROOM):
                break
            self._make_room()
            self.clock.status.from_numpy(np.where(status == watch.NO_ROOM, watch.RUNNING, status).astype(np.int32))
        for w in np.flatnonzero(status == watch.TOO_FAST):
            for matter in self.matters.values():
                matter.refuse(w, self.clock.step.to_numpy()[w] * self.dt, self.dt)

    def observe(self) -> dict[str, np.ndarray]:
        """Quantities of every world now, (W, *shape) of each by name. Raises BadState if a check fails.

        The force on the tank is the mean since the last observation; right after grains were placed, the present one.
        """
        self._moor()
        return self._observe_unmoved() if self.steps == self.unkicked else self._observe()

    def _observe_unmoved(self) -> dict[str, np.ndarray]:
        """Observe grains that have taken no step yet, so that no contacts are known.

        One step of all matters builds the lists and sums the forces at its start; then it is undone, bit for bit.
        """
        rows, before = self._observe(), self.state()
        start = [(name, k, f.to_numpy()) for name, one in self.matters.items() for k, f in enumerate(one.fields())]
        of_contacts = [name for matter in self.matters.values() for name in matter.of_contacts]
        try:
            self.advance(self.exchange_interval)
            load = self._observe()
            for name, k, values in start:  # the arrays are others now, if lists had to grow
                self.matters[name].fields()[k].from_numpy(values)
            self.steps -= self.exchange_interval
            touching = self._observe()
        finally:
            self.restore(before)
        self.means = {name: load[name] for name in self.means}
        return rows | {name: touching[name] for name in of_contacts} | self.means

    def _observe(self) -> dict[str, np.ndarray]:
        runtime.merge_repeats(self.simple)
        now = self.origin + self.time
        rows = self.sampler.read_and_reset(now, max(self.steps - self.observed, 1) * self.dt)
        for matter in self.matters.values():
            rows |= matter.observe(now)
        # Worlds in which no time has passed keep the last means.
        ended = np.isin(self.clock.status.to_numpy(), (watch.WAITING, watch.OVER))
        still = ended | (self.observed == self.steps)
        for name, before in self.means.items():
            rows[name] = np.where(still.reshape(-1, *[1] * (before.ndim - 1)), before, rows[name])
        rows |= self.carrier.account(rows) | self.parts.bodies.account(rows["pose"], self.scene.gravity, now)
        self.observed, self.means = self.steps, {name: rows[name] for name in self.means}
        for matter in self.matters.values():
            matter.check(rows, self.time)
        return rows

    def loads(self) -> np.ndarray:
        """Forces (N) and moments (N m) of the cargo on each piece of the tank, (W, pieces, freedoms), as last observed.

        The pieces are the walls of each tank, in space its faces, then the parts, then the fixed grains if any.
        """
        return self.sampler.on_pieces.to_numpy()

    def settle(self, rest: float, limit: float, tell: Callable[[float], None] = lambda _: None) -> bool:
        """Let all matters settle in the upright tank, then start the clock at zero; returns whether all are at rest.

        A world is at rest, and waits for the others, once the restlessness of its matters (of grains: the mean kinetic
        energy, spin included, in units of m g d) is below `rest` in two checks in a row, 10 ms apart. Settling ends
        after `limit` s at the latest.
        """
        return settle(self, rest, limit, tell)

    def steer(self, pieces: Several[np.ndarray]) -> None:
        """Let the scene's motions, which must all be `Steered`, follow these polynomials (6,) from now on."""
        self.carrier.steer(self.time, pieces)

    def meet(self, vessels: Several[Vessel]) -> None:
        """Change the waves to those of `vessels`, which must equal the present ones in everything else."""
        self.scene = replace(self.scene, vessels=list(vessels))
        self.carrier.meet(vessels)

    def alter(self, altered: Scene) -> None:
        """Go on with a scene of other materials or another gravity. The grains stay as they are.

        Raises Unavailable if the changes need shorter steps or longer liquid bridges than the arrays were made for.
        """
        if altered.longest_step(1.0) < SHORTER * self.longest_step:
            raise Unavailable("this asks for shorter time steps: start the experiment anew with it")
        for matter in self.matters.values():
            matter.bear(altered)
        self.scene = altered
        self.carrier.gravity.fill(altered.gravity)
        for matter in self.matters.values():
            matter.alter(altered)

    def start_clock(self) -> None:
        """Start the tank's motion now, at time zero."""
        self.unkicked -= self.steps
        self.origin, self.steps, self.observed = 0.0, 0, 0
        self.clock.step.fill(0)
        self.clock.status.fill(watch.RUNNING)
        for matter in self.matters.values():
            matter.start_clock()
        self.moored = False

    def _moor(self) -> None:
        """Let the carrier begin with the settled cargo in place, once. Raises Unavailable if it cannot."""
        if not self.moored and self.origin == 0.0:
            self.carrier.begin(self.cargo)
            self.moored = True

    def cargo(self) -> list[Body]:
        """All matters of each world as one rigid body, per metre of the ship's length, in the tank's frame."""
        bodies = [matter.as_rigid() for matter in self.matters.values()]
        return [bolted(*(of_matter[w] for of_matter in bodies)) for w in range(self.scene.worlds)]

    def snapshot(self) -> dict[str, np.ndarray]:
        """What is known of each particle now, in the tank's frame: of grains, positions, velocities (W, n, 2) …"""
        now, matters = self.origin + self.time, self.matters.values()
        return {name: values for matter in matters for name, values in matter.snapshot(now).items()}

    def placed(self) -> dict[str, np.ndarray]:
        """Where the scene's parts are now in the tank, see `Pieces.placed`."""
        return self.parts.placed(self.origin + self.time, self.scene.axes)

    def pressing(self, world: int = 0) -> Pressing:
        """The present elastic contact forces in a world; none without grains."""
        runtime.merge_repeats(self.simple)
        found = (matter.pressing(world, self.origin + self.time) for matter in self.matters.values())
        return next((pressing for pressing in found if pressing), UNTOUCHED)

    def state(self) -> dict[str, np.ndarray]:
        """The complete state, from which `restore` continues bit for bit."""
        own = kept.state_of(self) | {"origin": np.array(self.origin)}
        return own | self._of_matters() | self.means | self.arrays.read()

    def axes(self) -> dict[str, Axes]:
        """The axes of all that `state` tells, by its names."""
        world = Axis("world", self.scene.worlds)
        means = {name: (world, *(Axis("component", size) for size in m.shape[1:])) for name, m in self.means.items()}
        own = {**kept.axes_of(self), "origin": (), **means}
        own |= {name: axes for matter in self.matters.values() for name, axes in matter.axes().items()}
        return own | self.arrays.axes()

    def restore(self, state: dict[str, np.ndarray]) -> None:
        """Restore what `state` returned of the same scene, on whatever processor. Raises ValueError for any other."""
        state = kept.renamed(state)
        anew = kept.restore_numbers(self, state)
        self.origin, self.means = float(state["origin"]), {name: np.array(state[name]) for name in self.means}
        if anew:
            self.arrays.release()
            self._build()
        self.arrays.write(state)
        for matter in self.matters.values():
            matter.restore(state)
        self.moored = self.steps > 0

    def close(self) -> None:
        """Free the arrays; the simulation must not be used afterwards."""
        self.arrays.release()
