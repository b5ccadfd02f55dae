"""Simulations in processes of their own, so that runs on different threads and precisions can be timed in turn."""

import time
from collections.abc import Callable, Hashable, Iterator, Mapping
from contextlib import contextmanager

import numpy as np

from benchmarks.aside import Aside
from benchmarks.speed.beds import Bed
from solvers.simulation import Simulation

FEWEST = 5  # steps of a timing
Speeds = dict[Hashable, np.ndarray]


class Worker(Aside):
    """A simulation of a bed in as many equal worlds, in a process of its own.

    `how` goes to the scene; `arch`, `threads` and `largest_multiple` to the simulation, whose motions began `origin`
    (s) ago.
    """

    def __init__(
        self,
        bed: Bed,
        threads: int = 1,
        worlds: int = 1,
        arch: str = "cpu",
        largest_multiple: int = 1,
        origin: float = 0.0,
        **how: object,
    ):
        super().__init__(_Timed, bed, threads, worlds, arch, largest_multiple, origin, how)
        self.dt = self.ask("step")

    def speed(self, seconds: float) -> float:
        """Grain-steps per second, measured over about `seconds` seconds."""
        return self.ask("speed", seconds)

    def course(self, duration: float, velocity: np.ndarray | None = None) -> float:
        """Grain-steps per second over about the first `duration` (s, of model time) from where the bed was at first.

        velocity: (n, 2) of the grains there (m/s); None for grains at rest.
        """
        return self.ask("course", duration, velocity)


class _Timed:
    """The simulation in the process of a worker."""

    def __init__(
        self, bed: Bed, threads: int, worlds: int, arch: str, largest_multiple: int, origin: float, how: Mapping
    ):
        self.places = bed.places(worlds)
        self.run = Simulation(
            bed.scene(worlds, **how), self.places, threads, arch=arch, largest_multiple=largest_multiple
        )
        self.origin = self.run.origin = origin
        self.last = self.warmed()

    def step(self) -> float:
        return self.run.dt

    def speed(self, seconds: float) -> float:
        self.last = timed(self.run, max(FEWEST, round(seconds * self.last / self.run.scene.grains.radius.size)))
        return self.last

    def course(self, duration: float, velocity: np.ndarray | None) -> float:
        velocity = None if velocity is None else np.tile(velocity, (len(self.places), 1, 1))
        self.run.place(self.places, velocity)
        self.warmed()
        self.run.place(self.places, velocity)
        self.run.origin = self.origin - self.run.time  # the motion goes by time, which goes on
        self.run.advance(2 * FEWEST)  # makes the lists, which other codes do not time either
        return timed(self.run, max(FEWEST, round(duration / self.run.dt)))

    def warmed(self) -> float:
        """Compile the kernels and list the contacts; returns grain-steps per second of the few steps after that."""
        timed(self.run, FEWEST)
        return timed(self.run, FEWEST)


def timed(run: Simulation, steps: int, clock: Callable[[], float] = time.perf_counter) -> float:
    """Grain-steps per second of a clock, measured over `steps` steps."""
    begun = clock()
    run.advance(steps)
    run.clock.step.to_numpy()  # a graphics processor has done its steps when it can be read
    return steps * run.scene.grains.radius.size / (clock() - begun)


def worked(run: Simulation, steps: int) -> float:
    """Grain-steps per second of processor time, which other programs disturb less."""
    return timed(run, steps, time.process_time)


@contextmanager
def workers(made: Mapping[Hashable, Callable[[], Worker]]) -> Iterator[dict[Hashable, Worker]]:
    """Workers by their names, all made before any is timed, and all ended at the end."""
    found: dict[Hashable, Worker] = {}
    try:
        for name, make in made.items():
            found[name] = make()
        yield found
    finally:
        for worker in found.values():
            worker.close()


def compared(made: Mapping[Hashable, Callable[[], Worker]], turns: int, seconds: float) -> Speeds:
    """Grain-steps per second (turns,) of workers, each timed for about `seconds` seconds per turn."""
    with workers(made) as found:
        return in_turn({name: lambda w=worker: w.speed(seconds) for name, worker in found.items()}, turns)


def in_turn(timings: Mapping[Hashable, Callable[[], float]], turns: int, warming: int = 1) -> Speeds:
    """What each timing gives (turns,), all of them once a turn in their order, after turns to warm up."""
    rows = [[timing() for timing in timings.values()] for _ in range(turns + warming)]
    return dict(zip(timings, np.array(rows[warming:]).T, strict=True))


def ratio(speeds: np.ndarray, others: np.ndarray) -> str:
    """The median of the ratios (turns,) of runs of the same turn, and their range, as text."""
    found = speeds / others
    return f"{np.median(found):.2f} ({found.min():.2f} to {found.max():.2f})"


def millions(speeds: np.ndarray) -> str:
    """The median of grain-steps a second, in millions, as text."""
    return f"{np.median(speeds) / 1e6:.1f}"
