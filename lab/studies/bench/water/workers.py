"""The lab's own runs of a pool, in processes of their own: Taichi has one number of threads a process."""

import time
from collections.abc import Sequence
from contextlib import suppress
from multiprocessing import get_context
from multiprocessing.connection import Connection

from lab.base.errors import LabError
from lab.studies.bench.peers.pool import Frame, PoolRun
from lab.studies.bench.water.cases import Case
from solvers.machine.errors import BadState, Unavailable
from solvers.simulation import Simulation

AHEAD = 200  # steps before the first timing: compiling


class Worker:
    """A simulation of a case in a process of its own; it rests unless it is asked. Raises LabError if it stops."""

    def __init__(self, case: Case, threads: int = 1, **of_water: object):
        context = get_context("spawn")  # Taichi hangs in a fork
        self._pipe, theirs = context.Pipe()
        self._process = context.Process(target=_serve, args=(theirs, case, threads, of_water), daemon=True)
        self._process.start()
        theirs.close()
        self.dt = self._answer()

    def run(self, seconds: float, wall: float) -> PoolRun:
        """From the start for `seconds`, over and over until `wall` seconds have gone by."""
        return self._ask(("run", seconds, wall))

    def frames(self, times: Sequence[float]) -> list[Frame]:
        """The particles at these times (s), from the start."""
        return self._ask(("frames", list(times), 0.0))

    def close(self) -> None:
        """End the process."""
        self._pipe.close()
        self._process.join()

    def _ask(self, question: tuple) -> object:
        with suppress(BrokenPipeError):  # what it said last is still to be read
            self._pipe.send(question)
        return self._answer()

    def _answer(self) -> object:
        try:
            answer = self._pipe.recv()
        except EOFError:
            raise LabError("a process that times water broke off.") from None
        if isinstance(answer, str):
            raise LabError(answer)
        return answer


def _serve(pipe: Connection, case: Case, threads: int, of_water: dict) -> None:
    try:
        run = Simulation(case.scene(**of_water), threads=threads, arch="cpu")
        run.advance(AHEAD)
        pipe.send(run.dt)
        while True:
            what, times, wall = pipe.recv()
            pipe.send(_timed(run, times, wall) if what == "run" else _followed(run, times))
    except EOFError:  # nobody asks any more
        pass
    except (BadState, Unavailable) as error:
        pipe.send(str(error))


def _restart(run: Simulation) -> None:
    run.place(run.scene.radius.reshape(1, 0, 1) * [0.0, 0.0])
    run.start_clock()


def _timed(run: Simulation, seconds: float, wall: float) -> PoolRun:
    steps, done, spent, busy = round(seconds / run.dt), 0, 0.0, 0.0
    while spent < wall:
        _restart(run)
        begun, before = time.perf_counter(), time.process_time()
        run.advance(steps)
        spent += time.perf_counter() - begun
        busy += time.process_time() - before
        done += steps
    return PoolRun(spent, busy, done, done * run.dt, run.scene.particles, [])


def _followed(run: Simulation, times: Sequence[float]) -> list[Frame]:
    _restart(run)
    found = []
    for instant in times:
        run.advance(round(instant / run.dt) - run.steps)
        now = run.snapshot()
        held = (now[f"water_{name}"][0] for name in ("place", "velocity", "pressure"))
        found.append(Frame(run.time, *held))
    return found
