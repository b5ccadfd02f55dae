"""A simulation in Python: advance it, look at it, change it, call functions meanwhile, and film it at the end."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Self

import numpy as np

from lab import dotted
from lab.base.errors import LabError
from lab.preset.python.written import asked

if TYPE_CHECKING:
    from cargolab._preset import Preset
    from lab.recording.fields.reading import Bed
    from lab.runs.runner import Result
    from lab.runs.running import Moment, Running


class Matter:
    """What is known now of each particle of a matter, as arrays: `simulation.grains.position` is (beds, grains, 2), m.

    `units` and `labels` tell of each name; `dir()` lists them. Places and velocities are in the frame of the tank.
    """

    def __init__(self, running: "Running", name: str, constants: Mapping[str, np.ndarray]) -> None:
        from lab.recording.layout import OF_MATTERS

        self._running, self._name, self._constants = running, name, constants
        prefix = "" if name == "grains" else f"{name}_"
        quantities = {one.name.removeprefix(prefix): one for one in OF_MATTERS[name].FRAMES}
        self._stored = {short: one.name for short, one in quantities.items()}
        self.units = {short: one.unit for short, one in quantities.items()}
        self.labels = {short: one.label for short, one in quantities.items()}

    def __getattr__(self, name: str) -> np.ndarray:
        if name.startswith("_"):
            raise AttributeError(name)
        if name in self._constants:
            return self._constants[name]
        if name in self._stored:
            return self._running.snapshot()[self._stored[name]]
        raise AttributeError(f"{self._name} have no {name!r}; they have {', '.join(dir(self))}")

    def __dir__(self) -> list[str]:
        return [*self._stored, *self._constants, "units", "labels"]

    def __repr__(self) -> str:
        return f"<{self._name}: {', '.join([*self._stored, *self._constants])}>"


class Simulation:
    """A run in one's hands: `sim = cargolab.Simulation("tilting/quick"); sim.run("1 s"); sim.grains.position`.

    It is recorded as `cargolab.run` does, with the same bits, into the folder `out` (default: renders/NAME), and stops
    only at samples of the series (`record.series_rate`). preset, repeats, overrides: as of `cargolab.run`. A context
    manager; `report` ends it with its numbers, figures and film, `close` without. Raises cargolab.Error.
    """

    def __init__(
        self,
        preset: "str | Path | Mapping | Preset",
        out: Path | str | None = None,
        *,
        repeats: int | None = None,
        quiet: bool = False,
        **overrides: object,
    ) -> None:
        from lab.preset.find import screen

        name, changes = asked(preset)
        given = changes | dotted(overrides, repeats)
        screen(name, given)  # before the slow imports
        from lab.runs.running import Running

        self._begin(Running(name, given, out, quiet=quiet))

    @classmethod
    def resume(cls, folder: Path | str, *, quiet: bool = False) -> Self:
        """Go on with the run in a folder that was closed, interrupted or killed before its end."""
        from lab.runs.running import Running

        found = cls.__new__(cls)
        found._begin(Running(out=None, quiet=quiet, resumed=folder))
        return found

    def _begin(self, running: "Running") -> None:
        self._running = running
        scene = running.simulation.scene
        self._matters = {
            name: Matter(running, name, {"radius": scene.grains.radius} if name == "grains" else {})
            for name in running.loaded.resolved.matters
        }

    def __getattr__(self, name: str) -> Matter:
        """A matter by its name: grains, water, air or bulk."""
        matters = self.__dict__.get("_matters", {})
        if name in matters:
            return matters[name]
        raise AttributeError(f"this simulation has no {name!r}; its matters are {', '.join(matters) or 'none'}")

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._matters]

    @property
    def folder(self) -> Path:
        """The folder of its recording."""
        return self._running.folder

    @property
    def preset(self) -> "Preset":
        """Its preset, with what was changed since."""
        from cargolab._preset import Preset

        running = self._running
        return Preset(running.name or running.loaded.given_text, **running.changes)

    @property
    def time(self) -> float:
        """Model time (s)."""
        return self._running.time

    @property
    def duration(self) -> float:
        """The model time (s) at which it ends."""
        return self._running.duration

    @property
    def ended(self) -> bool:
        """Whether it has reached its end, or its ship is lost."""
        return self._running.ended

    @property
    def now(self) -> Mapping[str, np.ndarray]:
        """The quantities of the series at the last sample, (beds, …) each, in SI: `sim.now["centre_of_mass"]`."""
        return self._running.rows

    def run(self, span: str | float | None = None) -> Self:
        """Advance by a span of time, "1 s" or seconds, or without one to the end; returns itself."""
        self._running.run(span)
        return self

    def every(self, interval: str | float, call: Callable[["Simulation"], object] | None = None) -> object:
        """Call a function with the simulation every so often while it runs; also as `@sim.every("0.1 s")`.

        What it raises stops the run, which can go on after it.
        """
        if call is None:
            return lambda function: self.every(interval, function) and function
        self._running.every(interval, lambda _: call(self))
        return call

    def stop(self) -> None:
        """End the present `run` at this sample; to be called by a function of `every`."""
        self._running.stop()

    def set(self, key: str | Mapping[str, object], value: object = None) -> None:
        """Change a key of material or wall, or run.gravity, from now on; or several of a table. The recording says so.

        `sim.set("material.friction", 0.3)`.
        """
        if not isinstance(key, str | Mapping):
            raise LabError("set: a key and its value are needed, or a table of keys.")
        self._running.alter({key: value} if isinstance(key, str) else dict(key))

    def bed(self, world: int = 0) -> "Bed":
        """The grains of a bed now and the forces between them, for `cargolab.fields`."""
        from lab.recording.fields.reading import bed_now

        running = self._running
        return bed_now(running.loaded.resolved, running.simulation, running.snapshot(), world)

    def save(self) -> "Moment":
        """The present state, for `restore`."""
        return self._running.moment()

    def restore(self, moment: "Moment") -> None:
        """Go back to a saved state, and on from it bit for bit; what was recorded after it is dropped."""
        self._running.go_back(moment)

    def report(self, *, video: bool = True, plots: bool = True) -> "Result":
        """End it: measure, plot and film what was recorded, and write the summary."""
        return self._running.report(video=video, plots=plots)

    def close(self) -> None:
        """End it. One that has not reached its end can go on with `Simulation.resume(folder)`."""
        self._running.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()

    def __repr__(self) -> str:
        running = self._running
        if running.over:
            return f"<Simulation of {running.loaded.name}, ended: {running.folder}>"
        return (
            f"<Simulation of {running.loaded.name} at {running.time:.4g} of {running.duration:.4g} s: {running.folder}>"
        )
