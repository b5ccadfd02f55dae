"""Batches: runs whose worlds are simulated together, each with its own recording.

A recording has the same bits as that of its run alone by the same schedule, unless others have faster tanks or parts.
"""

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from functools import partial
from operator import attrgetter
from pathlib import Path

import numpy as np

from lab.assembly.drawn import classes
from lab.assembly.grains import fixed_of, radii_of
from lab.assembly.scene import build, largest_multiple, volumes
from lab.assembly.water import particles, updates
from lab.base.errors import Unusable
from lab.base.interrupt import Interrupt
from lab.base.progress import Progress
from lab.base.trust import check_state
from lab.preset.fields import marked
from lab.preset.find import LoadedPreset
from lab.preset.schema import Preset
from lab.preset.units import show
from lab.recording import BUFFER_BYTES, FLUSH_EVERY, Outlines, Recorder, new_recording
from lab.recording.ship_end import VERBS
from lab.runs.beds import settled, settling
from lab.runs.checkpoint import Checkpoint, remove_checkpoint
from solvers.machine.errors import BadState
from solvers.machine.runtime import available_cores, choose_arch
from solvers.machine.state import without_worlds
from solvers.scene import Scene
from solvers.simulation import Simulation
from solvers.time.schedules import choose_schedule, units_a_world, work

# Steps per call of the solver times grains per world: a delay after Ctrl-C of some tenths of a second for each world on
# a core. It must not depend on other runs or on the clock, since grains may be renumbered between calls.
GRAIN_STEPS_A_CALL = 2_000_000


def outlines_of(preset: Preset, scene: Scene) -> Outlines | None:
    """The outlines of a preset's irregular grains, None if all are discs."""
    shapes = scene.grains.shapes if scene.grains else None
    return Outlines(shapes.outlines, classes(preset), shapes.which) if shapes else None


@dataclass(frozen=True)
class Run:
    """A run ready to start: its preset, the folder of its recording, its scene, initial positions (W, n, 2) m."""

    loaded: LoadedPreset
    folder: Path
    scene: Scene
    position: np.ndarray

    @property
    def shared(self) -> tuple:
        """The values that must be equal for two runs to share a batch."""
        preset = self.loaded.resolved
        alike = tuple(attrgetter(key)(preset) for key in marked(Preset, "alike"))
        return self.scene.shared(), settling(preset), preset.duration, alike

    @property
    def can_share(self) -> bool:
        """Whether it may share a batch; not in schedule per-band, which divides a world by the number of threads."""
        return self.device()["schedule"] != "per-band"

    def device(self, worlds: int = 0) -> dict[str, object]:
        """The device for a batch of `worlds` worlds (0: the run's own): `arch`, `schedule`, on the CPU `threads`."""
        settings, own, count = self.loaded.resolved.run, self.scene.worlds, particles(self.scene)
        responds, worlds = self.scene.responds, worlds or own
        threads, asked = settings.threads or available_cores(), (self.scene.particles > 0, worlds * count)
        arch = "cpu" if responds and settings.arch == "auto" else choose_arch(settings.arch, settings.precision, *asked)
        schedule = choose_schedule(settings.schedule, arch, worlds, count, threads, responds)
        if arch != "cpu":
            return {"arch": arch, "schedule": schedule}
        units = worlds * units_a_world(schedule, worlds, count, threads)
        return {"arch": arch, "schedule": schedule, "threads": min(threads, units)}

    def make_recording(self, steered: bool = False, device: Mapping[str, object] | None = None) -> None:
        """Create the recording without rows; device: of the batch, None: of this run. Raises LabError."""
        preset, scene = self.loaded.resolved, self.scene
        new_recording(
            self.folder,
            preset=self.loaded.name,
            given=self.loaded.given_text,
            resolved=preset,
            radius=radii_of(scene),
            outline=scene.outline,
            step=scene.step,
            **volumes(scene),
            kind=scene.grains.kind if scene.grains else None,
            fixed=fixed_of(scene),
            open_edges=scene.open_edges,
            parts={name: part.line for name, part in preset.parts.items()},
            shapes=outlines_of(preset, scene),
            machine=self.device() if device is None else device,
            steered=steered,
        )


def prepare(loaded: LoadedPreset, folder: Path) -> Run:
    """Prepare a run of this preset with its recording in `folder`.

    Raises LabError if the grains or the step do not fit, Unavailable if this machine lacks the device.
    """
    choose_arch(loaded.resolved.run.arch, loaded.resolved.run.precision)
    return Run(loaded, folder, *build(loaded.resolved))


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

    def run(self, interrupt: Interrupt) -> None:
        """Take samples until the end. On an interrupt, saves everything and raises KeyboardInterrupt."""
        if not self.runs:
            return
        rate = self._record.series_rate
        steps = round(1.0 / (rate * self._simulation.dt))
        samples = max(1, round(self._duration * rate))
        a_frame = max(1, round(rate / self._record.picture_rate))
        cost = self._duration * sum(work(run.scene) for run in self.runs)
        self.progress.start("running", self._duration, cost)
        self._counted = time.perf_counter()
        for k in range(self._recorders[0].rows[0], samples + 1):
            rows = self._reach(k * steps, partial(self._pause, interrupt))
            if not self.runs:
                break
            self._write(rows, k % a_frame == 0)
            self._count_cost()
            self.progress.reach(self._simulation.time)
            self._end_lost(rows, k % a_frame == 0)
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
                return self._simulation.observe()
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
