"""A running simulation: the scene's arrays, its clock, and the calls that advance and read it."""

from collections.abc import Callable

import numpy as np
import taichi as ti

from solvers import runtime, watch
from solvers.contacts import Contacts
from solvers.frame import Frame
from solvers.grains import Grains
from solvers.laws.chosen import ChosenLaws
from solvers.neighbours import Neighbours
from solvers.observe import Observer
from solvers.per_world import PerWorld
from solvers.runtime import Arrays
from solvers.scene import Scene
from solvers.walls import Walls

SKIN = 0.05  # of the mean diameter; in settled and in shaken beds the fastest of 0.05 … 0.3
AT_REST = -1e9  # a time long before any motion starts


@ti.data_oriented
class Clock:
    """Where each world stands: steps done, status of the watch, whether it has had its first kick."""

    def __init__(self, arrays: Arrays, worlds: int):
        self.step, self.status = arrays.integers(2, (worlds,))
        self.kicked = arrays.integers(1, (worlds,))[0]


class Simulation:
    """W worlds of one scene, from `position` (W, n, 2) m at rest.

    `threads` 0 uses all cores; `skin` (m) of the Verlet lists affects speed alone.
    """

    def __init__(self, scene: Scene, position: np.ndarray, threads: int = 0, skin: float | None = None):
        runtime.initialise(threads)
        self.scene, self.dt = scene, scene.time_step()
        self.skin = skin or SKIN * 2.0 * scene.mean_radius
        self.steps, self.room = 0, 1
        self.origin = 0.0  # what the tank's motion takes for the time at step 0
        self._build()
        self.grains.place(np.asarray(position, dtype=np.float64).reshape(*scene.radius.shape, 2))

    def _build(self) -> None:
        """Make the arrays and the kernels that work on them."""
        scene, worlds = self.scene, len(self.scene.radius)
        normal, tangential = scene.laws
        pair, wall = scene.interfaces
        moduli = np.tile([pair.young_modulus, wall.young_modulus], (worlds, 1))
        self.arrays = arrays = Arrays()
        self.grains = Grains(arrays, scene.radius, scene.grain.density)
        self.walls = Walls(arrays, scene.outline)
        laws = ChosenLaws(arrays, normal, tangential, [scene.interfaces] * worlds)
        reach = 2.0 * scene.sizes[1] + self.skin
        self.neighbours = Neighbours(arrays, self.grains, self.walls, self.skin, reach, laws, moduli, self.room)
        self.contacts = Contacts(laws)
        self.frame = Frame(arrays, scene.motions, scene.soft_start, scene.gravity)
        self.clock = Clock(arrays, worlds)
        parts = self.grains, self.walls, self.neighbours, self.contacts, self.frame
        self.schedule = PerWorld(*parts)
        self.observer = Observer(arrays, *parts)
        arrays.finish()

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
        self.steps += steps
        fastest = watch.FASTEST_STEP * self.scene.sizes[0] / self.dt
        while True:
            self.schedule.advance(self.clock, self.steps, self.origin, self.dt, fastest)
            status = self.clock.status.to_numpy()
            if not np.any(status == watch.NO_ROOM):
                break
            self._make_room()
            self.clock.status.from_numpy(np.where(status == watch.NO_ROOM, watch.RUNNING, status))
        if np.any(status == watch.TOO_FAST):
            watch.report_speed(status, self.grains.read()["velocity"], self.clock.step.to_numpy() * self.dt, self.dt)

    def observe(self) -> dict[str, np.ndarray]:
        """Numbers of every world now, each (W,), named as in `Observer.NAMES`. Raises BadState from the watch."""
        self.observer.observe(self.origin + self.time)
        rows = dict(zip(Observer.NAMES, self.observer.rows.to_numpy().T, strict=True))
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
        self.origin = 0.0
        self.steps = 0
        self.clock.step.fill(0)
        self.clock.status.fill(watch.RUNNING)
        self.grains.angle.fill(0.0)
        return bool(np.all(quiet >= 2))

    def close(self) -> None:
        """Give the arrays back; the simulation must not be used after it."""
        self.arrays.release()

    def snapshot(self) -> dict[str, np.ndarray]:
        """Positions, velocities (W, n, 2), angles and spins (W, n) now, in the tank's frame."""
        return self.grains.read()
