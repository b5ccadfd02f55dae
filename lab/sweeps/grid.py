"""The definition of a sweep, a preset at every point of a grid of values of its keys, and the file that stores it."""

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import product
from pathlib import Path

import numpy as np

from lab.assembly.grains import grain_count
from lab.assembly.water import most_drops
from lab.base.errors import LabError
from lab.base.files import write_text
from lab.preset.find import LoadedPreset, load
from lab.preset.recorded import resolved_from, to_table
from lab.runs.alike import alike, apart
from lab.sweeps.axes import point_fails, values
from lab.sweeps.request import SWEEP as FILE_NAME

FORMAT = "cargo-shift-lab sweep 1"
MOST_POINTS = 100_000


@dataclass(frozen=True)
class Sweep:
    """A sweep: the preset's name, the values of each swept key, the preset at each point of the grid.

    The last key changes fastest.
    """

    name: str
    axes: dict[str, list]
    points: list[LoadedPreset] = field(repr=False)

    @property
    def settings(self) -> list[dict[str, object]]:
        """The values of the swept keys at each point."""
        return [dict(zip(self.axes, chosen, strict=True)) for chosen in product(*self.axes.values())]

    def cost(self, number: int) -> float:
        """Relative cost of a point: model time (s) times number of particles, an empty tank counting as one."""
        preset = self.points[number].resolved
        return preset.duration * preset.run.repeats * max(1, grain_count(preset) + most_drops(preset))

    def differs_from(self, other: "Sweep") -> str:
        """In what the other sweep has other points, in words; "" where in nothing.

        Be it of an earlier version, which wrote what it derived.
        """
        if self.name != other.name:
            return f"of {self.name}"
        if self.axes != other.axes:
            return f"of other values of {', '.join(self.axes)}"
        pairs = [(one.resolved, two.resolved) for one, two in zip(self.points, other.points, strict=True)]
        return next((f"with another {apart(*pair)}" for pair in pairs if not alike(*pair)), "")

    def write(self, folder: Path) -> None:
        """Write the definition to the sweep's folder. Raises LabError."""
        points = [{"given": point.given_text, "resolved": to_table(point.resolved)} for point in self.points]
        content = {"format": FORMAT, "preset": self.name, "axes": self.axes, "points": points}
        path = folder / FILE_NAME
        try:
            folder.mkdir(parents=True, exist_ok=True)
            write_text(path, json.dumps(content, indent=1))
        except OSError as error:
            raise LabError(f"{folder} cannot be written ({error.strerror}): choose another folder.") from error


def define_sweep(name: str | Path, axes: Mapping[str, str | Sequence], overrides: Mapping | None = None) -> Sweep:
    """The sweep of a preset over `axes`: for each key a text (see `lab.sweeps.axes`) or a sequence of values.

    Raises LabError if a point is not a valid preset.
    """
    listed = {key: values(key, given) if isinstance(given, str) else _plain(given) for key, given in axes.items()}
    fixed = {key: found[0] for key, found in listed.items() if len(found) == 1}
    swept = {key: found for key, found in listed.items() if len(found) != 1}
    if not swept or not all(swept.values()):
        raise LabError("a sweep needs a key with several values, e.g. --set motion.sway.frequency=0.5:2:7Hz.")
    count = math.prod(map(len, swept.values()))
    if count > MOST_POINTS:
        raise LabError(f"the sweep has {count} points, more than {MOST_POINTS}: take fewer values.")
    points = []
    for chosen in product(*swept.values()):
        setting = dict(zip(swept, chosen, strict=True))
        try:
            points.append(load(name, {**(overrides or {}), **fixed, **setting}))
        except LabError as error:
            raise LabError(point_fails(setting, error)) from None
    return Sweep(points[0].name, swept, points)


def _plain(numbers: Sequence) -> list:
    """The values as Python numbers; numpy's types cannot be written to the file."""
    return [value.item() if isinstance(value, np.generic) else value for value in numbers]


def read_sweep(folder: Path) -> Sweep:
    """The sweep that a folder holds. Raises LabError."""
    path = folder / FILE_NAME
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
        if content["format"] != FORMAT:
            raise LabError(f"{path} was written by another version: sweep again in another folder.")
        name, axes = content["preset"], dict(content["axes"])
        if not isinstance(name, str) or not axes or not all(isinstance(found, list) for found in axes.values()):
            raise ValueError("no preset, or no values of its keys")
        if not 1 < math.prod(map(len, axes.values())) == len(content["points"]) <= MOST_POINTS:
            raise ValueError("the number of points does not match the values")
        points = [
            LoadedPreset(name, str(point["given"]), resolved_from(point["resolved"])) for point in content["points"]
        ]
        return Sweep(name, axes, points)
    except OSError as error:
        raise LabError(f"{path} cannot be read ({error.strerror}): name the folder of a sweep.") from error
    except (ValueError, KeyError, TypeError, RecursionError) as error:
        raise LabError(f"{path} is damaged: sweep again in another folder.") from error
