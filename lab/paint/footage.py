"""A recording for painting: read frame by frame, bed by bed."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np

from lab.base.errors import LabError, Unusable
from lab.base.trust import BEYOND
from lab.paint.cargo.looks import Stowage
from lab.paint.painter import Edges
from lab.paint.scene.bodies import bodies_of, hold_of
from lab.paint.scene.drive import drive_text
from lab.paint.scene.moves import moved_line, on_the_way
from lab.paint.sea import Rail, Sea
from lab.paint.space.scene import scene_in_space
from lab.paint.space.stance import lengths
from lab.paint.water.basins import basins_in
from lab.paint.water.pool import Pool
from lab.recording import Recording, open_recording
from lab.recording.contacts.again import Again
from lab.recording.ship_end import ends
from solvers.grains.pressing import Pressing
from solvers.grains.quantities import FRAMES
from solvers.machine.quantity import flat

RATES = {
    f"{what}position": f"{what}velocity" for what in ("", "water_", "bulk_")
}  # rates of change among the recorded quantities
LEAST = 1e-9  # share of the time between two frames
NO_GRAINS = {quantity.name: np.zeros((0, *quantity.shape)) for quantity in FRAMES}  # of an empty tank


class Footage:
    """F frames and T samples of W worlds with n grains each, in a tank with k fixed grains and P moving parts.

    time (F,) s, pose (F, W, 3) m, m, rad; series_time (T,), series_pose (T, W, 3), centre_of_mass (T, W, 2) m;
    spilled (T, W) grains, both None without grains; radius (W, n) m; kind (W, n); kinds: their names; shapes: the
    outlines of irregular grains, None if all are discs; shape_names: of their classes; outline (m, 2) m; open_edges:
    those without a wall; fixed (k, 3) y, z, radius m; parts: polylines at rest (m, 2) m by name; part (F, W, P, 2):
    their displacements, m; hold: the room of a floating hull that the grains are in, None if they are in the tank;
    matters: the keys of what the tank holds; water: its particles' volume and gauges, bulk: volumes (W, n) m² of its
    points, both None without; sea: the ship and her waves if the tank is a hold, rail: that of a tank on an axle, else
    None; space: walls, parts and where all stand of a scene in space, whose vectors are y, z, x; None in the plane;
    ends: the loss of each ship, None if not lost; cargo: which one each grain is; drive: what moves the tank, in words;
    settings: the preset's [video]; title. Raises LabError when there is no frame or no sample.
    """

    def __init__(self, recording: Recording) -> None:
        series, frames = recording.series, recording.frames
        if not len(frames["time"]) or not len(series["time"]):
            raise LabError(f"{recording.path} has no picture frames yet: let the run continue.")
        self.time, self.pose, self.part = frames["time"][:], frames["pose"][:], frames["part"][:]
        self.series_time, self.series_pose = series["time"], series["pose"]
        for values in (self.time, self.pose, self.part, self.series_time, self.series_pose):
            if not (np.abs(values) < BEYOND).all():
                raise Unusable(f"{recording.path} is damaged (invalid times or poses): record the run again.")
        self.centre_of_mass, self.spilled = series.get("centre_of_mass"), series.get("spilled")
        self.radius, self.outline, self.kind = recording.radius, recording.outline, recording.kind
        self.matters, self._series = recording.preset.matters, series
        self.water = Pool.of(recording.preset, recording.volume, recording.air_volume)
        self.bulk = recording.bulk_volume if recording.bulk_volume.size else None
        self.basins = basins_in(recording)
        self.cargo, self._preset = Stowage.of(recording.preset), recording.preset
        self.kinds = ["the rest", *recording.preset.kinds]
        self.shapes = recording.shapes
        self.shape_names = list(recording.preset.shapes) if self.shapes else ["disc"]
        self.open_edges, self.fixed, self.parts = recording.open_edges, recording.fixed, recording.parts
        self.bodies, self.hold = bodies_of(recording.preset), hold_of(recording.preset)
        self.sea, self.rail = Sea(recording.preset) if recording.preset.ship else None, None
        if recording.preset.axle:
            self.rail = Rail(recording.preset.axle, np.ptp(self.outline[:, 0]), self.series_time, series["axle_slide"])
        self.ends = ends(series)
        self.drive, self.settings = drive_text(recording.preset), recording.preset.video
        self.title = recording.preset.title or recording.name
        self.part_turn = frames["part_turn"][:] if "part_turn" in frames else np.zeros(self.part.shape[:-1])
        self.part_pitch_yaw = frames["part_pitch_yaw"][:] if "part_pitch_yaw" in frames else None
        self.space = scene_in_space(recording.preset, self)
        self.pose, self.series_pose = flat(self.pose), flat(self.series_pose)
        self._frames, self._waves = frames, frames["waves"][:] if "waves" in frames else None
        self._read: dict[str, dict[int, np.ndarray]] = {}  # the frames last read of each quantity

    @property
    def protrudes(self) -> bool:
        """Whether anything that is drawn may stand out of the tank."""
        return bool(self.open_edges or self.parts or self.rail)

    @property
    def floating(self) -> tuple[str, ...]:
        """The names of the bodies that float."""
        return self._preset.bodies

    @property
    def rooms(self) -> dict[str, int]:
        """The rooms of hulls that openings lead to: their columns among all rooms, by name."""
        return {name: k for k, name in enumerate(self._preset.rooms) if name in self._preset.open_rooms}

    @property
    def afloat(self) -> np.ndarray:
        """The corners (k, 2) m of a ship's hull and of all tanks as they are drawn."""
        return np.concatenate([self.sea.hull, *(basin.drawn for basin in self.basins)])

    @property
    def worlds(self) -> int:
        """W, the number of worlds."""
        return len(self.radius)

    def measured(self, name: str) -> np.ndarray:
        """A quantity of the series (T, W, ...)."""
        return self._series[name]

    def sea_of(self, frame: int) -> Sea | None:
        """The sea as it is in a frame."""
        if self._waves is not None:
            self.sea.waves = self._waves[frame]
        return self.sea

    def grains(self, name: str, frame: int, world: int) -> np.ndarray:
        """The values (n,) or (n, 2) of a quantity for each grain in a frame."""
        return self.drops(name, frame, world) if self.radius.size else NO_GRAINS[name]

    def drops(self, name: str, frame: float, world: int) -> np.ndarray:
        """The values (n,) or (n, 2) of a quantity for each particle of water in a frame, or between two frames."""
        first = int(frame)
        share = frame - first
        if share < LEAST or first + 1 >= len(self.time):
            return self._row(name, first)[world]
        one, two = self._row(name, first)[world], self._row(name, first + 1)[world]
        if name not in RATES:
            return one + share * (two - one)
        rates = [self._row(RATES[name], row)[world] for row in (first, first + 1)]
        return on_the_way(one, two, *rates, share, self.time[first + 1] - self.time[first])

    def pressing(self, frame: int, world: int) -> Pressing:
        """The contacts in a frame with their forces, which are found again."""
        return self._again.read(self.time[frame], self._row("position", frame), self._row("angle", frame))[world]

    @cached_property
    def _again(self) -> Again:
        return Again(self._preset, self)

    def freeze(self, frames: Callable, series: Callable) -> None:
        """Read frames and series through these functions of both from now on."""
        self._frames, self._series, self._read = frames(self._frames), series(self._series), {}
        self.__dict__.pop("_again", None)

    def close(self) -> None:
        """Free what was made to find forces."""
        if "_again" in self.__dict__:
            self._again.close()

    def _row(self, name: str, frame: int) -> np.ndarray:
        """All values of a quantity in a frame; the last two that were asked for are kept."""
        kept = self._read.setdefault(name, {})
        if frame not in kept:
            if len(kept) > 1:
                kept.pop(next(iter(kept)))
            kept[frame] = self._frames[name][frame].astype(float)
        return kept[frame]


@dataclass(frozen=True, eq=False)
class Bed:
    """One world of a footage, and its name in a picture."""

    footage: Footage
    world: int
    name: str

    @property
    def frames(self) -> int:
        """F, the number of picture frames."""
        return len(self.footage.time)

    @property
    def pose(self) -> np.ndarray:
        """Pose of the tank (F, 3) in m, m, rad."""
        return self.footage.pose[:, self.world]

    @property
    def radius(self) -> np.ndarray:
        """Radii (n,), m."""
        return self.footage.radius[self.world]

    @property
    def empty(self) -> bool:
        """Whether there are no grains."""
        return not len(self.radius)

    @property
    def diameter(self) -> float:
        """Mean grain diameter, m."""
        return 2.0 * float(self.radius.mean())

    def depths(self, time: float) -> dict[str, float]:
        """What gauges of depth show (m) at a time (s), by name."""
        names, series = list(self.footage.water.levels), self.footage.series_time
        shown = self.footage.measured("level_depth")[:, self.world].T if names else []
        return {name: float(np.interp(time, series, one)) for name, one in zip(names, shown, strict=True)}

    @cached_property
    def edges(self) -> Edges | None:
        """The edges of irregular grains, None if all are discs."""
        shapes = self.footage.shapes
        if shapes is None:
            return None
        used, which = np.unique(shapes.which[self.world], return_inverse=True)
        return Edges.of([shapes.contours[k] for k in used], which)

    @property
    def shape(self) -> np.ndarray:
        """The class of each grain's outline (n,), an index into the footage's `shape_names`."""
        shapes = self.footage.shapes
        return shapes.kind[shapes.which[self.world]] if shapes else np.zeros(len(self.radius), dtype=int)

    def position(self, frame: int) -> np.ndarray:
        """Grain positions (n, 2), in space (n, 3), in the tank frame, m; NaN for a grain that has left the scene."""
        return self.aboard(self.footage.grains("position", frame, self.world), frame)

    def aboard(self, points: np.ndarray, frame: float) -> np.ndarray:
        """Points (n, 2) m in the axes of the grains, which may be those of a hull, where they are in the tank frame."""
        hold = self.footage.hold
        return points if hold is None else self._carried(points, hold.hull, frame)

    def heel(self, frame: float) -> float:
        """How far (rad) the axes of the grains have turned in the tank frame."""
        hold = self.footage.hold
        return 0.0 if hold is None else float(self._between(self.footage.part_turn, frame)[hold.hull])

    def speed(self, frame: int) -> np.ndarray:
        """Grain speeds (n,) relative to the tank, or to the hull in which they are, m/s."""
        return lengths(self.footage.grains("velocity", frame, self.world))

    def angle(self, frame: int) -> np.ndarray:
        """Grain angles (n,) in the tank frame, in space (n, 3) the integrals of their spins, rad."""
        return self.footage.grains("angle", frame, self.world) + self.heel(frame)

    def pressing(self, frame: float) -> Pressing:
        """The contacts with their forces in the frame next to this place in the film."""
        row = round(float(frame))
        found = self.footage.pressing(row, self.world)
        if self.footage.hold is None:
            return found
        force = moved_line(found.force, np.zeros(2), self.heel(row))
        return replace(found, place=self.aboard(found.place, row), force=force)

    def spin(self, frame: int) -> np.ndarray:
        """Grain spins (n,) relative to the tank, in space their sizes, rad/s."""
        spin = self.footage.grains("spin", frame, self.world)
        return spin if spin.ndim == 1 else lengths(spin)

    def drops(self, name: str, frame: int) -> np.ndarray:
        """The values (n,) or (n, 2) of a quantity for each particle of water."""
        return self.footage.drops(name, frame, self.world)

    def water_position(self, frame: int) -> np.ndarray:
        """Places (n, 2) of the water in the tank frame, m; NaN for what is as far away from the tank as it is large."""
        place = self.drops("water_position", frame)
        outline = np.concatenate([basin.outline for basin in self.footage.basins])
        size = np.ptp(outline, axis=0).max()
        near = (place >= outline.min(axis=0) - size) & (place <= outline.max(axis=0) + size)
        return np.where(near.all(axis=1, keepdims=True), place, np.nan)

    def _between(self, values: np.ndarray, frame: float) -> np.ndarray:
        """What values (F, W, ...) are in a frame, or between two frames."""
        first = int(frame)
        after, share = min(first + 1, len(values) - 1), frame - first
        return (1.0 - share) * values[first, self.world] + share * values[after, self.world]

    def moved(self, points: np.ndarray, number: int, frame: float) -> np.ndarray:
        """Points (m, 2) m of a part, as drawn, where they are in the tank frame in a frame."""
        moved, hold = self._carried(points, number, frame), self.footage.hold
        return self.aboard(moved, frame) if hold is not None and number in hold.parts else moved

    def _carried(self, points: np.ndarray, number: int, frame: float) -> np.ndarray:
        """Points (m, 2) m in the axes of a part where they are, in those of what carries the part."""
        shift, turn = (self._between(values, frame)[number] for values in (self.footage.part, self.footage.part_turn))
        return moved_line(points, shift, turn)

    def plates(self, frame: int) -> list[np.ndarray]:
        """The parts, and a sliding mass, as polylines (m, 2) m in the tank frame at their places in a frame."""
        lines = [self.moved(line, number, frame) for number, line in enumerate(self.footage.parts.values())]
        rail = self.footage.rail
        return lines + (
            rail.lines(self.world, float(np.interp(frame, np.arange(self.frames), self.footage.time))) if rail else []
        )


@contextmanager
def open_footage(path: Path | str, sound: bool = False) -> Iterator[Footage]:
    """Open a recording by its file or folder; `sound`: only the part before any damage. Raises LabError."""
    with open_recording(path, sound=sound) as recording:
        footage = Footage(recording)
        try:
            yield footage
        finally:
            footage.close()
