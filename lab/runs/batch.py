"""Batches: runs whose worlds are simulated together, each with its own recording.

A recording has the same bits as that of its run alone by the same schedule, unless others have faster tanks or parts.
"""

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack
from functools import partial
from pathlib import Path

import numpy as np

from lab.assembly.grains import radii_of
from lab.assembly.scene import largest_multiple
from lab.assembly.water import updates
from lab.base.errors import Unusable
from lab.base.interrupt import Interrupt
from lab.base.progress import Progress
from lab.base.trust import check_state
from lab.preset.units import show
from lab.recording import BUFFER_BYTES, FLUSH_EVERY, Recorder
from lab.recording.own import filled
from lab.recording.ship_end import VERBS
from lab.runs.beds import settled, settling
from lab.runs.checkpoint import Checkpoint, remove_checkpoint
from lab.runs.run import Run
from solvers.machine import compiling
from solvers.machine.errors import BadState
from solvers.machine.state import without_worlds
from solvers.scene import Scene
from solvers.simulation import Simulation
from solvers.time import compiled
from solvers.time.schedules import work

# Steps per call of the solver times grains per world: a delay after Ctrl-C of some tenths of a second for each world on
# a core. It must not depend on other runs or on the clock, since grains may be renumbered between calls.
GRAIN_STEPS_A_CALL = 2_000_000

Tell = Callable[[Mapping[str, np.ndarray]], object]


def run_batch(
    runs: Sequence[Run], home: Path, progress: Progress, kept: Checkpoint | None = None
) -> dict[Path, BadState]:
    """Settle the beds of all runs, simulate them to the end, and append to their recordings, which must exist.

    home: the folder of the checkpoint; kept: a checkpoint to continue from. If the watch stops a run, the others
    continue; returns the reasons by folder. Raises LabError if writing fails, KeyboardInterrupt; a checkpoint stays.
    """
    with ExitStack() as stack:
        together = Batch(runs, home, progress, stack)
        with progress.costs.of("settle"):
            together.start(kept)
        with Interrupt() as interrupt, progress.costs.of("run"):
            together.run(interrupt)
    remove_checkpoint(home)
    return together.stopped


class Batch:
    """The runs that have not ended, their recorders, and the simulation with their worlds, in the same order."""

    def __init__(self, runs: Sequence[Run], home: Path, progress: Progress, stack: ExitStack) -> None:
        self.runs, self.home, self.progress, self._stack = list(runs), home, progress, stack
        self.stopped: dict[Path, BadState] = {}
        preset = runs[0].loaded.resolved  # the runs agree in all values that are read here
        self._duration, self._record = preset.duration, preset.record
        run, longest = preset.run, largest_multiple(preset)
        self._simulate = partial(Simulation, threads=run.threads, arch=run.arch, largest_multiple=longest)
        self._settling, self._saved = settling(preset), time.monotonic()
        self._compiled, self._noted = compiling.seconds(), False
        self._a_call = GRAIN_STEPS_A_CALL * runs[0].scene.worlds // work(runs[0].scene)

    def start(self, kept: Checkpoint | None) -> None:
        """Settle the beds, or restore a checkpoint, and open the recordings."""
        rows = kept.rows if kept else (0, 0)
        count = len(self.runs)  # with several recordings each flushes more rarely, so that writes stay as rare
        opened = {"flush_every": count * FLUSH_EVERY, "buffer": BUFFER_BYTES // count}
        self._recorders = [
            self._stack.enter_context(Recorder(run.folder, samples=rows[0], frames=rows[1], **opened))
            for run in self.runs
        ]
        self._stack.callback(lambda: self._simulation and self._simulation.close())
        self._simulation = None
        if kept:
            self.progress.warnings.extend(kept.warnings)
            self.progress.notes.extend(kept.notes)
            self._simulation = self._simulate(self._scene(), self._position())
            try:
                check_state(kept.state, *radii_of(self._simulation.scene).shape)
                self._simulation.restore(kept.state)
            except (KeyError, ValueError, TypeError, IndexError) as error:
                raise Unusable(f"{self.home}: its checkpoint is of another scene: start the run again.") from error
            return
        while self.runs and self._simulation is None:
            try:
                self._simulation = settled(
                    self._scene(), self._position(), self._settling, self._simulate, self.progress
                )
            except BadState as error:
                self._leave_out(error)
        if self.runs:
            self.save()

    @property
    def simulation(self) -> Simulation | None:
        """The solver's simulation; None before the start."""
        return self._simulation

    @property
    def recorder(self) -> Recorder:
        """The recorder of the only run."""
        (recorder,) = self._recorders
        return recorder

    @property
    def taken(self) -> int:
        """How many samples have been taken."""
        return self._recorders[0].rows[0]

    def rewind(self, rows: tuple[int, int], actions: int) -> None:
        """Drop what the only run has recorded after so many rows of series and frames, and actions of the user."""
        self.recorder.close("stopped: set back by the user")
        folder, (samples, frames) = self.runs[0].folder, rows
        opened = Recorder(folder, samples=samples, frames=frames, actions=actions)
        self._recorders = [self._stack.enter_context(opened)]

    @property
    def samples(self) -> int:
        """Number of the last sample; the first, at the start, is 0."""
        return max(1, round(self._duration * self._record.series_rate))

    def run(self, interrupt: Interrupt, last: int | None = None, tell: Tell = lambda _: False) -> None:
        """Take samples until the end, or until that of number `last`.

        `tell` gets what was observed at each sample; where it returns true, this stops there. On an interrupt, saves
        everything and raises KeyboardInterrupt.
        """
        if not self.runs:
            return
        rate, last = self._record.series_rate, self.samples if last is None else min(last, self.samples)
        steps = round(1.0 / (rate * self._simulation.dt))
        a_frame = max(1, round(rate / self._record.picture_rate))
        cost = self._duration * sum(work(run.scene) for run in self.runs)
        self.progress.start("running", last / rate, cost)
        self._counted = time.perf_counter()
        for k in range(self._recorders[0].rows[0], last + 1):
            rows = self._reach(k * steps, partial(self._pause, interrupt))
            if not self.runs:
                break
            self._write(rows, k % a_frame == 0)
            self._count_cost()
            self._note_compiled()
            self.progress.reach(self._simulation.time)
            self._end_lost(rows, k % a_frame == 0)
            if tell(rows):
                break
        self.progress.finish()

    def save(self) -> None:
        """Write a checkpoint, and everything recorded up to it, to the disk."""
        for recorder in self._recorders:
            recorder.sync()
        Checkpoint(
            state=self._simulation.state(),
            runs=tuple(run.folder.relative_to(self.home).as_posix() for run in self.runs),
            rows=self._recorders[0].rows,
            warnings=tuple(self.progress.warnings),
            notes=tuple(self.progress.notes),
        ).write(self.home)
        self._saved = time.monotonic()

    def _pause(self, interrupt: Interrupt) -> None:
        if interrupt.asked:
            self.save()
            raise KeyboardInterrupt(f"interrupted at {show(self._simulation.time, 's')} of {show(self._duration, 's')}")
        if time.monotonic() - self._saved >= self._record.checkpoint_every:
            self.save()

    def _reach(self, step: int, pause: Callable[[], None]) -> Mapping[str, np.ndarray]:
        """Advance to a step and observe; removes runs that the watch stops, possibly all of them."""
        while self.runs:
            try:
                self._simulation.advance(0)  # raises again if the watch has stopped another run, too
                a_call = self._simulation.whole(self._a_call)
                while self._simulation.steps < step:
                    self._simulation.advance(min(a_call, step - self._simulation.steps))
                    pause()
                return filled(self._simulation, self._simulation.observe())
            except BadState as error:
                self._leave_out(error)
        return {}

    def _write(self, rows: Mapping[str, np.ndarray], picture: bool) -> None:
        """Add a row to every recording, and a frame where one is due."""
        now = self._simulation.time
        sample = {name: rows[name] for name in self._recorders[0].series if name != "time"}
        frame = self._frame(rows) if picture else {}
        for recorder, worlds in zip(self._recorders, self._worlds(), strict=True):
            recorder.sample({"time": now, **{name: values[worlds] for name, values in sample.items()}})
            if picture:
                recorder.frame({"time": now, **{name: values[worlds] for name, values in frame.items()}})

    def _frame(self, rows: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
        """The present values of all quantities of a picture frame, for all worlds."""
        return {"pose": rows["pose"], **self._simulation.placed(), **self._simulation.snapshot()}

    def _end_lost(self, rows: Mapping[str, np.ndarray], pictured: bool) -> None:
        """End the runs whose ships have all capsized, flooded or sunk, with a last frame; the others continue."""
        if "capsized" not in rows:
            return
        lost = np.any([rows[kind] >= 0.0 for kind in VERBS if kind in rows], axis=0)
        slices, now = list(self._worlds()), self._simulation.time
        over = [k for k, worlds in enumerate(slices) if lost[worlds].all()]
        frame = {} if pictured or not over else self._frame(rows)
        for out in reversed(over):
            if frame:
                row = {name: values[slices[out]] for name, values in frame.items()}
                self._recorders[out].frame({"time": now, **row})
            self._close(out, "complete")

    def _count_cost(self) -> None:
        """Share the wall-clock time since the last count among the runs by their work."""
        now, whole = time.perf_counter(), sum(work(run.scene) for run in self.runs)
        for recorder, run in zip(self._recorders, self.runs, strict=True):
            recorder.wall_s += (now - self._counted) * work(run.scene) / whole
            recorder.grain_steps = updates(run.scene, self._simulation.steps)
        self._counted = now

    def _note_compiled(self) -> None:
        """After the first steps, note what their kernels took."""
        if not self._noted and self._simulation.steps:
            compiled.note(self._simulation, compiling.seconds() - self._compiled)
            self._noted = True

    def _worlds(self) -> Iterator[slice]:
        """The worlds of each run in the simulation."""
        begin = 0
        for run in self.runs:
            yield slice(begin, begin + run.scene.worlds)
            begin += run.scene.worlds

    def _scene(self) -> Scene:
        return Scene.joined([run.scene for run in self.runs])

    def _position(self) -> np.ndarray:
        return np.concatenate([run.position for run in self.runs])

    def _leave_out(self, error: BadState) -> None:
        """Close the recording of the run that the watch has stopped, and continue with the other runs."""
        slices = list(self._worlds())
        out = next(k for k, worlds in enumerate(slices) if worlds.start <= error.world < worlds.stop)
        own = BadState(error.world - slices[out].start, error.what)
        self.stopped[self.runs[out].folder] = own
        self._close(out, f"stopped: {own}")

    def _close(self, out: int, status: str) -> None:
        """Close the recording of run number `out`, and continue with the other runs."""
        slices = list(self._worlds())
        self.runs.pop(out)
        self._recorders.pop(out).close(status)
        if self.runs and self._simulation:
            before, axes, worlds = self._simulation.state(), self._simulation.axes(), slices[-1].stop
            self._simulation.close()
            self._simulation = self._simulate(self._scene(), self._position())
            self._simulation.restore(
                {name: without_worlds(values, axes[name], worlds, slices[out]) for name, values in before.items()}
            )
