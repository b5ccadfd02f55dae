"""Small scenes made like any experiment: a preset's tables and a file of grains are loaded and built."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from lab.assembly.scene import build
from lab.base import toml
from lab.preset.fields import join, taken_by
from lab.preset.find import load
from lab.preset.schema import Preset
from solvers.scene import Scene
from solvers.simulation import Simulation

G = 9.81  # m/s²
# Cellulose acetate of Spandonidis (2016), table 5.2, with a restitution of our own.
ACETATE = {"density": 1319.0, "young": 3.2e9, "poisson": 0.28, "friction": 0.25, "restitution": 0.6}
WEIGHTLESS = 1e-15  # m/s²: a preset wants some gravity, and takes no less

_level: ContextVar[str] = ContextVar("level of accuracy", default="reference")


@contextmanager
def at_level(name: str) -> Iterator[None]:
    """Build setups with the steps of a level of accuracy; their stiffness stays what the references know it to be."""
    before = _level.set(name)
    try:
        yield
    finally:
        _level.reset(before)


@dataclass(frozen=True)
class Setup:
    """A preset's tables in SI numbers, and its grains one by one: rows y, z, radius (m), v_y, v_z (m/s), ω (rad/s).

    Unless they say otherwise nothing settles, the stiffness is the material's own, and the step that of `at_level`: the
    reference's, which is the derived one.
    """

    grains: np.ndarray
    material: Mapping
    tank: Mapping
    wall: Mapping = field(default_factory=dict)
    contact: Mapping = field(default_factory=dict)
    motion: Mapping = field(default_factory=dict)
    run: Mapping = field(default_factory=dict)

    def build(self) -> tuple[Scene, np.ndarray]:
        """The scene and the grains' places (1, n, 2) m, as `cargolab run` makes them of a preset and its files."""
        tables = {name: getattr(self, name) for name in ("material", "tank", "wall", "contact", "motion")}
        tables["contact"] = {"stiffness_scale": 1.0, **self.contact}
        run = {"accuracy": _level.get(), "settle": False, "duration": 1.0, **self.run}
        written = {"title": "verification", **tables, "run": run, "grains": {"bed": "bed.csv"}}
        with TemporaryDirectory() as folder:
            preset = Path(folder) / "case.toml"
            preset.write_text(toml.dumps(_with_units(written)), encoding="utf-8")
            header = "y,z,radius,vy,vz,omega"
            np.savetxt(Path(folder) / "bed.csv", self.grains, "%.17g", ",", header=header, comments="")
            return build(load(preset).resolved)


def _with_units(table: Mapping, path: str = "") -> dict:
    """A table of numbers in SI as a preset writes them, with the units of its keys."""
    keys = {key: join(path, key) for key in table}
    return {
        key: _with_units(value, keys[key])
        if isinstance(value, Mapping)
        else _quantity(value, taken_by(Preset, keys[key]).symbol)
        for key, value in table.items()
    }


def _quantity(value: object, unit: str) -> object:
    if unit == "1" or isinstance(value, str):
        return value
    if isinstance(value, Sequence | np.ndarray):
        return [_quantity(item, unit) for item in value]
    return f"{float(value)!r} {unit}"


def grain(y: float, z: float, radius: float, vy: float = 0.0, vz: float = 0.0, spin: float = 0.0) -> list[float]:
    """A row of a setup's grains: place and radius (m), velocity (m/s), spin (rad/s)."""
    return [y, z, radius, vy, vz, spin]


@contextmanager
def simulated(*setups: Setup, **options) -> Iterator[Simulation]:
    """A simulation with a world for each setup, at the smallest of their steps, on one core unless `options` differ."""
    scenes, positions = zip(*(setup.build() for setup in setups), strict=True)
    step = min(scene.step for scene in scenes)
    for scene in scenes:
        scene.step = step
    run = Simulation(Scene.joined(scenes), np.concatenate(positions), **{"threads": 1, "arch": "cpu"} | options)
    try:
        yield run
    finally:
        run.close()


def again(run: Simulation, position: np.ndarray, step: float, velocity=None, spin=None) -> None:
    """Start anew at time zero with another step (s), from places (W, n, 2) m, velocities and spins (None: at rest)."""
    run.dt = step
    run.start_clock()
    run.place(position, velocity, spin)


@dataclass(frozen=True)
class Track:
    """States at times (T,) s: positions and velocities (T, W, n, 2), spins (T, W, n)."""

    time: np.ndarray
    position: np.ndarray
    velocity: np.ndarray
    spin: np.ndarray

    def acceleration(self) -> np.ndarray:
        """(T − 2, W, n, 2) m/s² of a track of every step: second differences, which are Verlet's forces to rounding."""
        return np.diff(self.position, 2, axis=0) / (self.time[1] - self.time[0]) ** 2


def track(run: Simulation, looks: int, steps: int = 1) -> Track:
    """The state now and at each of `looks` times, `steps` steps apart."""
    states, times = [run.snapshot()], [run.time]
    for _ in range(looks):
        run.advance(steps)
        states.append(run.snapshot())
        times.append(run.time)
    columns = (np.array([state[name] for state in states]) for name in ("position", "velocity", "spin"))
    return Track(np.array(times), *columns)
