"""The live experiment: it runs in pieces, and records its course and all changes made by the user.

A piece is one sampling interval of the series. A change takes effect at the start of the next piece, so that a replay
with the same changes at the same pieces has the same bits (`lab.view.replay`).
"""

import time
from collections.abc import Callable, Mapping
from contextlib import ExitStack
from dataclasses import dataclass, replace
from math import sqrt
from pathlib import Path

import numpy as np

from lab.assembly.scene import build, largest_multiple
from lab.assembly.water import updates
from lab.base.errors import LabError
from lab.base.progress import Progress
from lab.preset.find import LoadedPreset
from lab.preset.schema import Preset
from lab.preset.sections.motion import Motion
from lab.preset.sections.water.liquid import sound_speed
from lab.preset.sections.water.schemes import SCHEMES
from lab.recording import WAVES, Recorder
from lab.recording.own import filled
from lab.runs.beds import settled, settling
from lab.runs.run import Run
from lab.view.panel.controls import ALTERS, CONTROLS, MOVES, offered
from lab.view.panel.sea_controls import sea_controls_of
from lab.view.panel.steering import Steering
from solvers.grains.pressing import Pressing
from solvers.machine.errors import Unavailable
from solvers.simulation import Simulation

PICTURES = 25.0  # Hz; lowest rate of the frames
SOUND = 8.0  # times the speed of a fall through the tank: water that hits a wall at v is compressed by v/c0


@dataclass(frozen=True)
class LiveFrame:
    """The state at the end of a piece: time (s), observed rows (W,), grains (W, n) by name, contacts with forces.

    The grains are in 32 bits, as in recordings, since many frames are kept for rewinding.
    """

    time: float
    rows: Mapping[str, np.ndarray]
    grains: Mapping[str, np.ndarray]
    pressing: Pressing

    @classmethod
    def of(cls, simulation: Simulation, rows: Mapping[str, np.ndarray], pressing: Pressing) -> "LiveFrame":
        """The present state of a simulation, with the rows just observed of it."""
        grains = {name: values.astype(np.float32) for name, values in simulation.snapshot().items()}
        return cls(simulation.time, {**rows, **simulation.placed()}, grains, pressing)

    @property
    def bytes(self) -> int:
        """Memory in bytes."""
        pressing = self.pressing
        arrays = *self.rows.values(), *self.grains.values(), pressing.grains, pressing.place, pressing.force
        return sum(array.nbytes for array in arrays)


def steerable(loaded: LoadedPreset) -> LoadedPreset:
    """The preset prepared for steering: one bed, none of its own motions, and a picture rate of at least PICTURES.

    Nobody knows how a hand will move the water, so its speed of sound follows from a fall through the whole tank.
    Raises LabError for grains in a floating hull, whose tank must be at rest.
    """
    preset = loaded.resolved
    if preset.tank.solid is not None:
        key = next(f"tank.{key}" for key in ("mesh", "turned", "along") if getattr(preset.tank, key))
        raise LabError(f"{key}: a scene in space cannot be steered yet; `cargolab run` films it.")
    if preset.bulk is not None:
        raise LabError("bulk: cannot be watched as it runs yet; `cargolab run` films it.")
    if preset.grains is not None and preset.grains.room is not None:
        raise LabError("grains.room: the tank of a hull with grains cannot be steered; `cargolab run` films it.")
    record = replace(preset.record, picture_rate=max(preset.record.picture_rate, PICTURES))
    changes = {"motion": Motion(), "run": replace(preset.run, repeats=1, duration=preset.duration), "record": record}
    if preset.water and preset.water.sound_speed == "auto":
        fall = sqrt(2.0 * preset.run.gravity * preset.tank.extent[1])
        sound = max(SOUND * fall, sound_speed(preset, SCHEMES[preset.water.scheme]))
        changes["water"] = replace(preset.water, sound_speed=sound)
    return LoadedPreset(loaded.name, loaded.given_text, replace(preset, **changes))


class Live:
    """The experiment; a context manager. It starts with the tank at rest.

    loaded: a preset as `steerable` returns it. Raises LabError and Unavailable if it cannot be run, BadState if its
    bed cannot settle.
    """

    def __init__(self, loaded: LoadedPreset, folder: Path, progress: Progress) -> None:
        preset = loaded.resolved
        self.preset, self.folder, self.pieces = preset, folder, 0
        self.steering = None if preset.ship or preset.axle else Steering(offered(preset))
        self.sea_controls = sea_controls_of(preset)
        self.run = Run(loaded, folder, *build(preset, Steering.motions() if self.steering else None))
        self._end = ExitStack()
        with ExitStack() as otherwise:
            self.simulation = settled(self.run.scene, self.run.position, settling(preset), self._start, progress)
            otherwise.callback(self.simulation.close)
            self.run.make_recording(steered=True)
            self.recorder = otherwise.enter_context(Recorder(folder))
            self._end.push(otherwise.pop_all())
        self.steps_a_piece = round(1.0 / (preset.record.series_rate * self.simulation.dt))
        self._a_frame = max(1, round(preset.record.series_rate / preset.record.picture_rate))
        self.rows = self._record()

    def _start(self, scene, position) -> Simulation:
        settings = self.preset.run
        return Simulation(
            scene,
            position,
            threads=settings.threads,
            arch=settings.arch,
            largest_multiple=largest_multiple(self.preset),
        )

    @property
    def time(self) -> float:
        """Model time (s)."""
        return self.simulation.time

    def set(self, name: str, value: float) -> None:
        """Set a control from the next piece on. Raises LabError for one that cannot be changed during a run."""
        control = CONTROLS[name]
        mover = self.sea_controls if self.preset.ship else self.steering
        if control.kind == MOVES and mover and name in mover.wanted:
            mover.wanted[name] = value
        elif control.kind == ALTERS:
            try:
                self.simulation.alter(control.changes(self.simulation.scene, value))
            except Unavailable as error:
                raise LabError(f"{control.label}: {error}.") from None
        else:
            raise LabError(f"{control.label}: start the experiment again with it.")
        self.recorder.steer(self.time, name, value)

    def advance(self, pause: Callable[[], None] = lambda: None, most: int | None = None) -> None:
        """Run one piece, calling `pause` after every `most` steps. Raises BadState; what was recorded stays."""
        length = self.steps_a_piece * self.simulation.dt
        if self.steering:
            self.simulation.steer(self.steering.follow(length))
        if self.sea_controls and (vessel := self.sea_controls.follow(length)):
            self.simulation.meet([vessel])
        begun, target = time.perf_counter(), self.simulation.steps + self.steps_a_piece
        most = self.simulation.whole(most or self.steps_a_piece)  # so that looks cut no step
        while self.simulation.steps < target:
            self.simulation.advance(min(most, target - self.simulation.steps))
            pause()
        self.pieces += 1
        self.recorder.wall_s += time.perf_counter() - begun
        self.rows = self._record()

    def frame(self) -> LiveFrame:
        """The present state."""
        return LiveFrame.of(self.simulation, {**self.rows, **self._waves()}, self.simulation.pressing())

    def _record(self) -> dict[str, np.ndarray]:
        """Observe, add a row to the series and, if one is due, a frame; returns the observation."""
        rows, now = filled(self.simulation, self.simulation.observe()), self.time
        self.recorder.sample({"time": now, **{name: rows[name] for name in self.recorder.series if name != "time"}})
        if self.pieces % self._a_frame == 0:
            more = {**self.simulation.placed(), **self._waves(), **self.simulation.snapshot()}
            self.recorder.frame({"time": now, "pose": rows["pose"], **more})
        self.recorder.grain_steps = updates(self.simulation.scene, self.simulation.steps)
        return rows

    def _waves(self) -> dict[str, np.ndarray]:
        """The data on the present waves for a frame of a ship."""
        if not self.preset.ship:
            return {}
        return {"waves": self.sea_controls.now if self.sea_controls else np.full(WAVES.shape, np.nan)}

    def close(self, status: str = "complete") -> None:
        """End the recording."""
        self.recorder.close(status)
        self._end.close()

    def __enter__(self) -> "Live":
        return self

    def __exit__(self, *error: object) -> None:
        self._end.__exit__(*error)


def own_motion(preset: Preset) -> dict[str, float]:
    """The control values that give the preset's own motion."""
    return {name: value for name, value in offered(preset).items() if CONTROLS[name].kind == MOVES}
