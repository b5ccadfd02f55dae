"""The contacts of a bed in a frame of a recording as a table: who touches what, where, and how hard."""

import csv
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from io import StringIO
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

import numpy as np

from lab.assembly import touching
from lab.base.errors import NotRecorded
from lab.base.files import write_text
from lab.preset.kept.content import Content
from lab.preset.schema import Preset
from lab.recording.contacts.again import Again
from lab.recording.contacts.stress import coordination, pressures, stresses
from solvers.grains.pressing import NO_PIECE, NOBODY, Pressing
from solvers.machine.quantity import DIRECTIONS, directions

if TYPE_CHECKING:
    import xarray

GRAIN, FIXED, WALL = "grain", "fixed", "wall"  # what a grain touches, or the name of a part
COLUMNS = {  # of the table: the components, of directions those of the scene's axes, unit and label of each
    "grains": (("first", "second"), "1", "numbers of the grains that touch, from 0; -1 is none"),
    "kind": ((), "", "what the first grain touches: grain, fixed, wall, or a part by its name"),
    "place": (DIRECTIONS, "m", "place of the contact in the tank"),
    "normal": (DIRECTIONS, "1", "direction in which the first grain is pushed"),
    "overlap": ((), "m", "how far both would lie in each other"),
    "normal_force": ((), "N", "elastic force along the normal"),
}
LOST = (
    "is not recorded: it depends on how each contact came about, and a recording has places alone. Of a law without "
    "memory it is at most friction times normal_force; normal_force and overlap follow from places and are here."
)
OF_GRAINS = "stress", "pressure", "mean_stress", "number", "coordination"
NEVER = "tangential_force", "friction_force", "damping_force", "slip"


@dataclass(frozen=True)
class Contacts:
    """The k contacts of the n grains of a bed with an elastic force, at one time, in the tank's frame.

    time s, world; grains (k, 2): numbers, the second -1 where it is no movable grain; kind (k,): "grain", "fixed" (a
    grain of a rough wall), "wall" or the name of a part; place (k, axes) m; normal (k, axes): direction of the push on
    the first grain; overlap (k,) m; normal_force (k,) N, elastic: without friction, damping and cohesion.
    stress (n, axes, axes) Pa of each grain, pressing positive; pressure (n,) Pa; number (n,): contacts of each grain;
    coordination: their mean as the measure contact_number has it.
    """

    time: float
    world: int
    kind: np.ndarray
    radius: np.ndarray
    position: np.ndarray
    inside: int  # grains in the tank
    pressing: Pressing

    def __len__(self) -> int:
        return len(self.pressing.force)

    def __getattr__(self, name: str) -> object:
        if name in NEVER:
            raise NotRecorded(f"{name} {LOST}")
        raise AttributeError(f"contacts have no {name}, but {', '.join((*COLUMNS, *OF_GRAINS))}")

    @property
    def grains(self) -> np.ndarray:
        """Numbers (k, 2) of both grains, the second -1 where it is none."""
        return self.pressing.grains

    @property
    def place(self) -> np.ndarray:
        """Where they touch (k, axes), m."""
        return self.pressing.place

    @property
    def overlap(self) -> np.ndarray:
        """How far they would lie in each other (k,), m."""
        return self.pressing.overlap

    @cached_property
    def normal_force(self) -> np.ndarray:
        """The elastic force along the normal (k,), N."""
        return np.hypot.reduce(self.pressing.force, axis=1)

    @cached_property
    def normal(self) -> np.ndarray:
        """The direction (k, axes) in which the first grain is pushed."""
        return self.pressing.force / self.normal_force[:, None]

    @cached_property
    def stress(self) -> np.ndarray:
        """Mean stress (n, axes, axes) Pa in each grain (`stresses`)."""
        return stresses(self.pressing, self.position, self.radius)

    @cached_property
    def pressure(self) -> np.ndarray:
        """Mean pressure (n,) Pa in each grain (`pressures`)."""
        return pressures(self.pressing, self.position, self.radius)

    @cached_property
    def mean_stress(self) -> np.ndarray:
        """Mean stress (axes, axes) Pa over the volume of all grains; times their share of a region that of the bed."""
        volume = self.radius**3
        return (self.stress * volume[:, None, None]).sum(axis=0) / volume.sum()

    @property
    def number(self) -> np.ndarray:
        """How many contacts each grain has (n,)."""
        ends = self.grains[self.grains != NOBODY]
        return np.bincount(ends, minlength=len(self.radius))

    @property
    def coordination(self) -> float:
        """Mean coordination number of the grains in the tank; NaN without any."""
        return float(coordination(len(self), self.inside))

    def table(self) -> dict[str, np.ndarray]:
        """The columns by name, each (k,); those of several components end with _y, _z, _x, _first or _second."""
        found = {}
        for name, (parts, _, _) in COLUMNS.items():
            values = getattr(self, name)
            found |= (
                {f"{name}_{part}": column for part, column in zip(parts, values.T, strict=False)}
                if parts
                else {name: values}
            )
        return found

    def write(self, path: Path | str) -> Path:
        """Write the table as a CSV file; the units are in its first line."""
        columns, text = self.table(), StringIO()
        units = ", ".join(f"{name} {unit}" for name, (_, unit, _) in COLUMNS.items() if unit not in ("", "1"))
        text.write(f"# bed {self.world}, {self.time:.6g} s; {units}\n")
        rows = csv.writer(text, lineterminator="\n")
        rows.writerow(columns)
        rows.writerows(zip(*(_written(values) for values in columns.values()), strict=True))
        write_text(Path(path), text.getvalue())
        return Path(path)

    def labelled(self) -> "xarray.Dataset":
        """The same as arrays with named axes, units and labels, and the grains' stress, pressure and number."""
        import xarray  # imported here because it loads slowly

        found = {}
        for name, (parts, unit, label) in COLUMNS.items():
            axes = ("contact", *({"first": ("end",), "y": ("axis",)}[parts[0]] if parts else ()))
            found[name] = (axes, getattr(self, name), {"units": unit, "long_name": label})
        about = {"units": "Pa", "long_name": "mean stress in the grain, pressing positive"}
        found["stress"] = ("grain", "axis", "arm"), self.stress, about
        found["pressure"] = "grain", self.pressure, {"units": "Pa", "long_name": "mean pressure in the grain"}
        found["number"] = "grain", self.number, {"units": "1", "long_name": "contacts of the grain"}
        found["coordination"] = (), self.coordination, {"units": "1", "long_name": "mean coordination number"}
        axes = [*directions(self.position.shape[1])]
        coordinates = {"time": self.time, "world": self.world, "end": ["first", "second"], "axis": axes, "arm": axes}
        return xarray.Dataset(found, coordinates)


def _written(values: np.ndarray) -> list[str]:
    return [f"{value:.7g}" if isinstance(value, float) else str(value) for value in values.tolist()]


class Read(touching.Recorded, Protocol):
    """What contacts are found from; fields as in `lab.recording.Recording`."""

    path: Path
    content: Content
    preset: Preset
    worlds: int
    series: Mapping[str, np.ndarray]
    frames: Mapping[str, np.ndarray]


def again_of(recording: Read) -> Again:
    """What finds the contacts of a recording again. Raises NotRecorded where it has no grains."""
    if "grains" not in recording.content.matters:
        raise NotRecorded(f"{recording.path}: no contacts, since there are no grains; a preset with [grains] has some.")
    return Again(recording.preset, recording)


def contacts_of(recording: Read, again: Again, frame: int, world: int) -> Contacts:
    """The contacts of a bed in a frame. Raises NotRecorded for one that is not there."""
    frames = recording.frames
    if not len(frames["time"]):
        raise NotRecorded(f"{recording.path}: no picture frame yet, from which contacts are found; let the run go on.")
    if not 0 <= world < recording.worlds:
        raise NotRecorded(f"{recording.path}: no bed {world}; its beds are 0 to {recording.worlds - 1} (run.repeats).")
    time, position = float(frames["time"][frame]), frames["position"][frame].astype(float)
    pressing = again.read(time, position, frames["angle"][frame].astype(float))[world]
    samples = recording.series["time"]
    at = int(np.searchsorted(samples, time, side="right")) - 1 if len(samples) else -1
    spilled = float(recording.series["spilled"][max(at, 0), world]) if len(samples) else 0.0
    of_grain = np.where(pressing.grains[:, 1] == NOBODY, FIXED, GRAIN)
    of_piece = np.array([WALL, *touching.parts_met(recording.preset)])[
        np.maximum(pressing.piece, 0)
    ]  # the scene has one tank
    kind = np.where(pressing.piece == NO_PIECE, of_grain, of_piece)
    inside = recording.radius.shape[1] - int(spilled)
    return Contacts(time, world, kind, np.asarray(recording.radius[world]), position[world], inside, pressing)
