"""The frames of a live experiment so far, with the interface of `lab.paint.footage.Footage`."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np

from lab.assembly.grains import fixed_of, radii_of
from lab.assembly.scene import vessels
from lab.assembly.water import air_volumes_of, volumes_of
from lab.paint.cargo.looks import Stowage
from lab.paint.footage import NO_GRAINS, Bed
from lab.paint.painter import Edges
from lab.paint.scene.moves import moved_line
from lab.paint.sea import Sea
from lab.paint.water.basins import basins_of
from lab.paint.water.pool import Pool
from lab.preset.find import LoadedPreset
from lab.preset.schema import Preset
from lab.recording import Outlines
from lab.runs.run import outlines_of
from lab.view.live import LiveFrame
from solvers.grains.pressing import Pressing
from solvers.ship.hydrostatics import righting_levers
from solvers.simulation import Simulation

HEELS = 91  # points of the righting-arm curve
MOST_BYTES = 2**29  # largest size of the frames kept in memory; the recording has all
DROPPED = 0.1  # share of the frames that is dropped at once when they exceed it


@dataclass(frozen=True)
class StaticScene:
    """The constant data of a live experiment; fields as in a `Footage`, for one world."""

    preset: Preset
    name: str
    folder: Path
    radius: np.ndarray
    kind: np.ndarray
    outline: np.ndarray
    open_edges: tuple[int, ...]
    fixed: np.ndarray
    parts: Mapping[str, np.ndarray]
    shapes: Outlines | None
    step: float
    water: Pool | None = None

    @classmethod
    def of(cls, loaded: LoadedPreset, folder: Path, simulation: Simulation) -> "StaticScene":
        """The static scene of a preset's simulation, running or while its bed settles."""
        preset, scene = loaded.resolved, simulation.scene
        radius, grains = radii_of(scene), scene.grains
        kind = grains.kind if grains and grains.kind is not None else np.zeros(radius.shape, dtype=int)
        lines = {name: np.array(part.line) for name, part in preset.parts.items()}
        bounds = scene.outline, tuple(scene.open_edges), fixed_of(scene)
        shapes = outlines_of(preset, scene)
        pool = Pool.of(preset, *(of(scene) for of in (volumes_of, air_volumes_of)))
        return cls(preset, loaded.name, folder, radius, kind, *bounds, lines, shapes, simulation.dt, pool)

    def for_filling(self, top: float) -> "StaticScene":
        """The static scene while the bed settles: no ship, and the tank cut off at the height `top` (m)."""
        above = self.outline[:, 1] > top
        cut = np.column_stack([self.outline[:, 0], np.minimum(self.outline[:, 1], top)])
        lid = tuple(int(k) for k in np.nonzero(above & np.roll(above, -1))[0])
        return replace(self, preset=replace(self.preset, ship=None), outline=cut, open_edges=(*self.open_edges, *lid))


class LiveFootage:
    """The frames of one world so far; the oldest are dropped when they take too much memory."""

    worlds = 1

    def __init__(self, static: StaticScene) -> None:
        self.static = static
        for name in ("radius", "kind", "water", "outline", "open_edges", "fixed", "parts", "shapes"):
            setattr(self, name, getattr(static, name))
        self.matters, self.hold, self.leaks = static.preset.matters, None, bool(static.preset.inflow)
        volume = self.water.volume if self.water else np.zeros((1, 0))
        self.basins = basins_of(static.preset, static.outline, static.open_edges, volume)
        self.cargo = Stowage.of(static.preset)
        self.kinds = ["the rest", *static.preset.kinds]
        self.shape_names = list(static.preset.shapes) if self.shapes else ["disc"]
        self.sea = Sea(static.preset) if static.preset.ship else None
        self.settings, self.title = static.preset.video, static.preset.title
        self._frames: list[LiveFrame] = []
        self._bytes = 0

    def add(self, frame: LiveFrame) -> int:
        """Add a frame; returns how many of the oldest were dropped for it."""
        self._frames.append(frame)
        self._bytes += frame.bytes
        if self._bytes <= MOST_BYTES or len(self._frames) < 2:
            return 0
        dropped = max(1, round(DROPPED * len(self._frames)))
        self._bytes -= sum(old.bytes for old in self._frames[:dropped])
        del self._frames[:dropped]
        return dropped

    def __len__(self) -> int:
        return len(self._frames)

    @property
    def time(self) -> np.ndarray:
        """(F,) s."""
        return np.array([frame.time for frame in self._frames])

    @property
    def pose(self) -> np.ndarray:
        """(F, 1, 3) m, m, rad."""
        return np.stack([frame.rows["pose"] for frame in self._frames])

    @property
    def part(self) -> np.ndarray:
        """(F, 1, P, 2) m."""
        return np.stack([frame.rows["part"] for frame in self._frames])

    def pressing(self, frame: int, world: int = 0) -> Pressing:
        """The contacts with their forces in a frame."""
        return self._frames[frame].pressing

    def row(self, frame: int, name: str) -> np.ndarray:
        """A quantity of a frame: its components, or the one number."""
        return self._frames[frame].rows[name][0]

    def sea_of(self, frame: int) -> Sea | None:
        """The sea as it is in a frame."""
        if self.sea:
            self.sea.waves = self._frames[frame].rows.get("waves")
        return self.sea

    def row_time(self, frame: int) -> float:
        """The time of a frame (s)."""
        return self._frames[frame].time

    def plates(self, frame: int) -> list[np.ndarray]:
        """The parts as polylines (m, 2) m in the tank where they are in a frame."""
        rows = self._frames[frame].rows
        parts = zip(self.parts.values(), rows["part"][0], rows["part_turn"][0], strict=True)
        return [moved_line(*part) for part in parts]

    def curve(self, name: str, frames: np.ndarray) -> np.ndarray:
        """A quantity of some frames (k, *shape)."""
        return np.array([self._frames[frame].rows[name][0] for frame in frames])

    def grains(self, name: str, frame: int, world: int = 0) -> np.ndarray:
        """The value `name` of each grain in a frame."""
        return self.drops(name, frame, world) if self.radius.size else NO_GRAINS[name]

    def drops(self, name: str, frame: int, world: int = 0) -> np.ndarray:
        """The value `name` of each particle of water in a frame."""
        return self._frames[frame].grains[name][world]

    @cached_property
    def extent(self) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper corner (m) of the tank and its parts at rest."""
        points = np.concatenate([self.outline, *self.parts.values()])
        return points.min(axis=0), points.max(axis=0)

    @cached_property
    def sea_ground(self) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper corner (m) of the sea that is shown around a ship, with room to roll and to drift."""
        y, z, roll = self._frames[0].rows["pose"][0]
        places = complex(y, z) + np.exp(1j * roll) * (self.sea.hull @ [1.0, 1j])
        radius = 0.5 * float(np.hypot(*np.ptp(self.sea.hull, axis=0)))
        middle = np.array([places.real.mean(), places.imag.mean()])
        return self.sea.ground(np.array([middle - radius, middle + radius]))

    @cached_property
    def levers(self) -> tuple[np.ndarray, np.ndarray]:
        """Heels (k,) rad and righting levers (k,) m of the ship, with her cargo frozen as it lay at the start."""
        (vessel,) = vessels(self.static.preset)
        heel = np.radians(np.linspace(0.0, 180.0, HEELS))
        ship = vessel.ship
        return heel, righting_levers(ship.load.section, ship.body.loading, ship.load.water, heel)

    @cached_property
    def bed(self) -> Bed:
        """The only bed."""
        return Bed(self, 0, "")

    @cached_property
    def edges(self) -> Edges | None:
        """The edges of irregular grains."""
        return self.bed.edges
