"""A run that Python holds in its hands: it advances as far as it is told, can be looked at, changed and set back."""

from collections.abc import Callable, Mapping
from contextlib import ExitStack
from dataclasses import dataclass, replace
from math import ceil
from pathlib import Path

import numpy as np

from lab.assembly.scene import build
from lab.base.errors import LabError, Unusable
from lab.base.files import named
from lab.base.interrupt import Interrupt
from lab.base.lock import only_one
from lab.base.progress import Progress
from lab.base.turn import in_turn
from lab.preset.find import LoadedPreset, load
from lab.preset.python.keys import value_of
from lab.preset.units import parse, show
from lab.recording import open_recording, versions
from lab.runs.batch import Batch
from lab.runs.belongs import check_belongs
from lab.runs.checkpoint import read_checkpoint, remove_checkpoint
from lab.runs.run import prepare
from lab.runs.runner import RENDERS, Result, check_untouched, free_folder, recorded_preset, report
from solvers.machine.errors import Unavailable
from solvers.machine.runtime import is_live

CHANGEABLE = "material.", "wall.", "run.gravity"  # keys, or beginnings of keys, that a running scene can be given
FIXED = "material.density", "wall.density"  # of these: masses are set when grains are made
SLACK = 1e-9  # of an interval, within which two times are one


@dataclass(frozen=True)
class Moment:
    """A state to go back to: the solver's arrays, rows recorded until then, how often keys were changed, and which."""

    state: Mapping[str, np.ndarray]
    rows: tuple[int, int]
    actions: int
    changes: Mapping[str, object]


@dataclass
class Reminder:
    """A function to be called with the running run every `interval` (s), next at `due` (s)."""

    interval: float
    due: float
    call: Callable[[object], object]


class Running:
    """A run of a preset in its folder, which it holds until `close`; a context manager.

    It records as `run_preset` does, with the same bits. name, changes: the preset and changes to it; resumed: the
    folder of a run to go on with, in place of both. Raises LabError and Unavailable if it cannot be run, BadState if
    its bed cannot settle.
    """

    @in_turn
    def __init__(
        self,
        name: str = "",
        changes: Mapping | None = None,
        out: Path | str | None = None,
        *,
        quiet: bool = False,
        resumed: Path | str | None = None,
    ) -> None:
        self.name, self.changes, kept = name, dict(changes or {}), None
        if resumed is None:
            self.loaded: LoadedPreset = load(name, self.changes)
            self.folder = named(out) if out is not None else free_folder(RENDERS / self.loaded.name)
        else:
            self.folder = Path(resumed)
            self.loaded, kept = _interrupted(self.folder)
        self.reminders: list[Reminder] = []
        self.rows: Mapping[str, np.ndarray] = {}
        self._seen: tuple[int, dict] = (-1, {})  # the last snapshot and its step
        self.asked_to_stop, self.over, self.actions = False, False, 0
        self._stack = stack = ExitStack()
        with ExitStack() as otherwise:
            otherwise.push(stack)
            self.progress = stack.enter_context(Progress(quiet))
            with self.progress.costs.of("settle"):
                run = prepare(self.loaded, self.folder)
            stack.enter_context(only_one(self.folder))
            if kept is None:
                run.make_recording(steered=not self.loaded.resolved.ship)
            else:
                check_belongs(run)
            self.batch = Batch([run], self.folder, self.progress, stack)
            with self.progress.costs.of("settle"):
                self.batch.start(kept)
            otherwise.pop_all()
        self._check_stopped()
        self.rows = self.simulation.observe() if kept else {}
        if kept is None:
            self.run(0.0)

    @property
    def simulation(self):
        """The solver's simulation. Raises LabError once the run is closed, or another has taken Taichi from it."""
        simulation = None if self.over else self.batch.simulation
        if simulation is None:
            raise LabError(f"this simulation has ended; {self.folder} has its recording.")
        if not is_live(simulation.arrays):
            raise LabError(
                "another run with other threads or another precision has taken over since; go on from the last "
                f"checkpoint with cargolab.Simulation.resume({str(self.folder)!r})."
            )
        return simulation

    @property
    def time(self) -> float:
        """Model time (s)."""
        return self.simulation.time

    @property
    def duration(self) -> float:
        """The model time (s) at which the run ends."""
        return self.loaded.resolved.duration

    @property
    def interval(self) -> float:
        """The time (s) between two samples, at which alone a run can stop and be looked at."""
        return 1.0 / self.loaded.resolved.record.series_rate

    @property
    def ended(self) -> bool:
        """Whether the run has reached its end, or its ship is lost."""
        return not self.batch.runs or self.batch.taken > self.batch.samples

    @in_turn
    def run(self, span: str | float | None = None) -> None:
        """Advance by a span of time, "0.5 s" or seconds; without one, to the end.

        It stops at the first sample that is not before. Raises BadState if the watch stops it, KeyboardInterrupt after
        a signal; it may go on after that one.
        """
        simulation, last = self.simulation, None
        if span is not None:
            until = simulation.time + parse(span, "s") if isinstance(span, str) else simulation.time + float(span)
            last = ceil(until / self.interval - SLACK)
        self.asked_to_stop = False
        with Interrupt() as interrupt, self.progress.costs.of("run"):
            self.batch.run(interrupt, last, self._look)
        self._check_stopped()

    def _look(self, rows: Mapping[str, np.ndarray]) -> bool:
        """Keep what was observed and call whom it is time for; returns whether to stop here."""
        self.rows = rows
        for one in list(self.reminders):
            if self.time >= one.due - SLACK * one.interval:
                one.due = self.time + one.interval
                one.call(self)
        return self.asked_to_stop

    def snapshot(self) -> dict[str, np.ndarray]:
        """What is known of each particle now, by the names in the recording."""
        steps = self.simulation.steps
        if self._seen[0] != steps:
            self._seen = steps, self.simulation.snapshot()
        return self._seen[1]

    def stop(self) -> None:
        """End the present `run` at this sample; for a function that is called meanwhile."""
        self.asked_to_stop = True

    def every(self, interval: str | float, call: Callable[[object], object]) -> None:
        """Call a function with this object every so often, first after one interval."""
        span = parse(interval, "s") if isinstance(interval, str) else float(interval)
        if span < self.interval * (1.0 - SLACK):
            raise LabError(
                f"every: {show(span, 's')} is shorter than the time between two samples, {show(self.interval, 's')}; "
                "raise record.series_rate."
            )
        self.reminders.append(Reminder(span, self.time + span, call))

    @in_turn
    def alter(self, changes: Mapping[str, object]) -> None:
        """Go on with other keys from now on. Raises LabError for one that a running scene cannot change."""
        for key in changes:
            if not key.startswith(CHANGEABLE) or key in FIXED:
                raise LabError(
                    f"{key}: cannot change while it runs (material, wall and run.gravity can, densities aside); begin "
                    "another simulation with it."
                )
        if self.loaded.resolved.ship:
            raise LabError(f"{next(iter(changes))}: cannot change while a ship is afloat; begin another simulation.")
        resolved = load(self.name, {**self.changes, **changes}).resolved
        now, new = self.simulation.scene, build(resolved)[0]
        altered = replace(now, gravity=new.gravity)
        if now.grains:
            kinds = {kind: getattr(new.grains, kind) for kind in ("grain", "wall", "others", "unlike")}
            altered = altered.holding(replace(now.grains, **kinds))
        try:
            self.simulation.alter(altered)
        except Unavailable as error:
            raise LabError(f"{next(iter(changes))}: {error}.") from None
        self.changes |= changes
        for key in changes:
            self.batch.recorder.steer(self.time, key, float(value_of(resolved, key) or 0.0))
            self.actions += 1

    def moment(self) -> Moment:
        """The present state, to which `go_back` returns."""
        return Moment(self.simulation.state(), self.batch.recorder.rows, self.actions, dict(self.changes))

    @in_turn
    def go_back(self, moment: Moment) -> None:
        """Go on from an earlier state, bit for bit; what was recorded after it is dropped, reminders are kept."""
        if dropped := {key for key in self.changes if self.changes[key] != moment.changes.get(key)}:
            self.alter({key: value_of(load(self.name, moment.changes).resolved, key) for key in dropped})
        self.simulation.restore(dict(moment.state))
        self._seen = -1, {}
        self.batch.rewind(moment.rows, moment.actions)
        self.actions, self.changes = moment.actions, dict(moment.changes)
        self.rows = self.simulation.observe()
        for one in self.reminders:
            one.due = min(one.due, self.time + one.interval)

    def close(self) -> None:
        """End the run and its recording; one that has not reached its end can be resumed from here."""
        if self.over:
            return
        unfinished, held = not self.ended, is_live(self.batch.simulation.arrays)
        if unfinished:
            if held:
                self.batch.save()
            self.batch.recorder.close("stopped: ended by the user")
        self.over = True
        self._stack.close()
        if not unfinished:
            remove_checkpoint(self.folder)

    @in_turn
    def report(self, *, video: bool = True, plots: bool = True) -> Result:
        """End the run; measure, plot and film what was recorded, and write the summary."""
        self.close()
        with self.progress:
            return report(self.folder, self.progress, video=video, plots=plots, costs=True)

    def _check_stopped(self) -> None:
        for error in self.batch.stopped.values():
            self.close()
            raise error

    def __enter__(self) -> "Running":
        return self

    def __exit__(self, *error: object) -> None:
        self.close()


def _interrupted(folder: Path):
    """The preset and the checkpoint of the run in a folder. Raises LabError where there is nothing to go on with."""
    with open_recording(folder) as recording:
        loaded, complete = recorded_preset(recording), recording.complete
        check_untouched(recording)
        changed = recording.versions != versions()
    kept = None if complete else read_checkpoint(folder)
    if kept is None:
        why = "is complete" if complete else "has no checkpoint"
        raise LabError(f"{folder} {why}: there is nothing to go on with.")
    if changed:
        raise Unusable(f"{folder} was begun with other versions of the lab or its libraries: begin it again.")
    return loaded, kept
