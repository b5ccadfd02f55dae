"""Simulations in processes of their own, so that runs on different threads and precisions can be timed in turn.

Taichi has one number of threads and one precision per process; a simulation that restarts Taichi ends all others.
"""

import time
from collections.abc import Callable, Hashable, Iterator, Mapping
from contextlib import contextmanager, suppress
from multiprocessing import get_context
from multiprocessing.connection import Connection

import numpy as np

from lab.base.errors import LabError
from lab.studies.bench.speed.beds import Bed
from solvers.machine.errors import BadState, Unavailable
from solvers.simulation import Simulation

FEWEST = 5  # steps of a timing
Speeds = dict[Hashable, np.ndarray]


class Worker:
    """A simulation of a bed in as many equal worlds, in a process of its own; it rests unless it is asked.

    `how` goes to the scene; `arch`, `threads` and `stretch` to the simulation, whose motions have ended if `ended`.
    Raises LabError if it cannot be made or breaks off.
    """

    def __init__(
        self,
        bed: Bed,
        threads: int = 1,
        worlds: int = 1,
        arch: str = "cpu",
        stretch: int = 1,
        ended: bool = False,
        **how: object,
    ):
        context = get_context("spawn")  # Taichi hangs in a fork
        self._pipe, theirs = context.Pipe()
        told = theirs, bed, threads, worlds, arch, stretch, ended, how
        self._process = context.Process(target=_serve, args=told, daemon=True)
        self._process.start()
        theirs.close()
        self.dt = self._answer()

    def speed(self, seconds: float) -> float:
        """Grain-steps per second, measured over about `seconds` seconds."""
        return self._asked(("speed", seconds))

    def course(self, duration: float) -> float:
        """Grain-steps per second over the first `duration` (s, of model time) from where the bed was at first."""
        return self._asked(("course", duration))

    def _asked(self, question: tuple[str, float]) -> float:
        with suppress(BrokenPipeError):  # what it said last is still to be read
            self._pipe.send(question)
        return self._answer()

    def close(self) -> None:
        """End the process."""
        self._pipe.close()
        self._process.join()

    def _answer(self) -> float:
        try:
            answer = self._pipe.recv()
        except EOFError:
            raise LabError("a process that times a simulation broke off.") from None
        if isinstance(answer, str):
            raise LabError(answer)
        return answer


def _serve(
    pipe: Connection, bed: Bed, threads: int, worlds: int, arch: str, stretch: int, ended: bool, how: Mapping
) -> None:
    """Make the simulation, tell its step, then answer each question, what and for how long, by grain-steps a second."""
    try:
        run = Simulation(bed.scene(worlds, **how), bed.places(worlds), threads, arch=arch, stretch=stretch)
        if ended:
            run.origin = max(motion.duration() for motion in run.scene.motions[0])
        speed = _warmed(run)
        pipe.send(run.dt)
        while True:
            question, seconds = pipe.recv()
            if question == "course":
                run.place(bed.places(worlds))
                _warmed(run)
                run.place(bed.places(worlds))
                pipe.send(timed(run, max(FEWEST, round(seconds / run.dt))))
            else:
                speed = timed(run, max(FEWEST, round(seconds * speed / run.scene.radius.size)))
                pipe.send(speed)
    except EOFError:  # nobody asks any more
        pass
    except (BadState, Unavailable) as error:
        pipe.send(str(error))


def _warmed(run: Simulation) -> float:
    """Compile the kernels and list the contacts; returns grain-steps per second of the few steps after that."""
    timed(run, FEWEST)
    return timed(run, FEWEST)


def timed(run: Simulation, steps: int) -> float:
    """Grain-steps per second, measured over `steps` steps."""
    begun = time.perf_counter()
    run.advance(steps)
    run.clock.step.to_numpy()  # a graphics processor has done its steps when it can be read
    return steps * run.scene.radius.size / (time.perf_counter() - begun)


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


def in_turn(timings: Mapping[Hashable, Callable[[], float]], turns: int) -> Speeds:
    """What each timing gives (turns,), all of them once a turn in their order, after a turn to warm up."""
    rows = [[timing() for timing in timings.values()] for _ in range(turns + 1)]
    return dict(zip(timings, np.array(rows[1:]).T, strict=True))


def ratio(speeds: np.ndarray, others: np.ndarray) -> str:
    """The median of the ratios (turns,) of runs of the same turn, and their range, as text."""
    found = speeds / others
    return f"{np.median(found):.2f} ({found.min():.2f} to {found.max():.2f})"


def millions(speeds: np.ndarray) -> str:
    """The median of grain-steps a second, in millions, as text."""
    return f"{np.median(speeds) / 1e6:.1f}"
