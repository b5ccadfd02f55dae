"""The lab's own runs of a pool, in processes of their own."""

import time
from collections.abc import Mapping, Sequence

import numpy as np

from benchmarks.aside import Aside
from benchmarks.peers.pool import Frame, PoolRun
from benchmarks.water.cases import Case
from solvers.simulation import Simulation

AHEAD = 200  # steps before the first timing: compiling


class Worker(Aside):
    """A simulation of a case on an `arch` in a process of its own; the rest goes to `Case.scene`."""

    def __init__(self, case: Case, threads: int = 1, ahead: int = AHEAD, arch: str = "cpu", **of_scene: object):
        super().__init__(_Pool, case, threads, ahead, arch, of_scene)
        self.worlds = of_scene.get("worlds", 1)

    def run(self, seconds: float, wall: float) -> PoolRun:
        """From the start for `seconds`, over and over until `wall` seconds have gone by."""
        return self.ask("timed", seconds, wall)

    def memory(self) -> int:
        """Bytes of the arrays."""
        return self.ask("bytes")

    def step(self) -> float:
        """The time step (s)."""
        return self.ask("step")

    def listed(self) -> int:
        """Neighbours in the lists of all blocks, walls left out."""
        return self.ask("neighbours")

    def unbalanced(self, steps: int) -> float:
        """By what the water's momentum misses its weight less the load on the tank after so many steps, of the weight
        in that time."""
        return self.ask("missed", steps)

    def frames(self, times: Sequence[float]) -> list[Frame]:
        """The particles at these times (s), from the start."""
        return self.ask("followed", list(times))


class _Pool:
    """The simulation in the process of a worker."""

    def __init__(self, case: Case, threads: int, ahead: int, arch: str, of_scene: Mapping[str, object]):
        self.run = Simulation(case.scene(**of_scene), threads=threads, arch=arch)
        self.run.advance(ahead)

    def bytes(self) -> int:
        return self.run.arrays.bytes

    def step(self) -> float:
        return self.run.dt

    def neighbours(self) -> int:
        return int(self.run.water.lists.near.first.to_numpy().max())

    def restart(self) -> None:
        self.run.place(np.zeros((self.run.scene.worlds, 0, 2)))
        self.run.start_clock()

    def timed(self, seconds: float, wall: float) -> PoolRun:
        run, steps, done, spent, busy = self.run, round(seconds / self.run.dt), 0, 0.0, 0.0
        while done == 0 or spent < wall:
            self.restart()
            begun, before = time.perf_counter(), time.process_time()
            run.advance(steps)
            spent += time.perf_counter() - begun
            busy += time.process_time() - before
            done += steps
        return PoolRun(spent, busy, done, done * run.dt, run.scene.worlds * run.scene.particles, [])

    def missed(self, steps: int) -> float:
        run, weight = self.run, self.run.scene.gravity * self._mass()
        self.restart()
        run.advance(1)  # the load is a mean since the last look
        run.observe()
        before = self._momentum()
        run.advance(steps)
        gained = (self._momentum() - before) / (steps * run.dt)
        load = run.observe()["wall_force"][0, :2]
        return float(np.linalg.norm(gained + load - [0.0, -weight]) / weight)

    def _mass(self) -> float:
        return float(self.run.water.particles.read(self.run.water.particles.mass)[0][0].sum())

    def _momentum(self) -> np.ndarray:
        p = self.run.water.particles
        mass, *velocity = p.read(p.mass, *p.velocity)
        return np.array([(mass[0] * one[0].astype(float)).sum() for one in velocity])

    def followed(self, times: Sequence[float]) -> list[Frame]:
        self.restart()
        found = []
        for instant in times:
            self.run.advance(round(instant / self.run.dt) - self.run.steps)
            now = self.run.snapshot()
            held = (now[f"water_{name}"][0] for name in ("position", "velocity", "pressure"))
            found.append(Frame(self.run.time, *held))
        return found
