"""One world of a recording as other programs are given it: what is where at each picture, in three coordinates.

The coordinates are y, z and x, in this order, as in the arrays of a recording: a right-handed system whose second axis
points up. In the plane the third one is 0.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from lab.export.things import Shape, things_of
from lab.paint.footage import Bed, Footage
from lab.paint.space.stance import carried, rotation, stances
from lab.recording import Recording
from solvers.machine.quantity import PLANE, SPACE

# What a cloud is called, the prefix of its quantities, and the owner of these
OF_CLOUDS = {
    "grains": ("", "grain"),
    "water": ("water_", "water_particle"),
    "air": ("air_", "air_particle"),
    "bulk": ("bulk_", "point"),
}
FIXED = "fixed"  # the grains of a rough wall
GIVEN = {"radius": "m", "volume": "", "kind": "1", "id": "1"}  # what a cloud has besides what frames hold, with units


@dataclass(frozen=True)
class Cloud:
    """Particles of one sort at one time: places (n, 3) m, and values (n,) or (n, 3) by name.

    Particles that have left the scene are left out: `values["id"]` tells which are there.
    """

    place: np.ndarray
    values: Mapping[str, np.ndarray]


class Stage:
    """One world of a recording, in the earth's axes or in those of its tank.

    time (F,) s; stance (F, 6): of the tank in the earth's axes, its place (m) and its turn, a vector (rad); clouds: the
    names of the sorts of particles; units: of the values of clouds by name; kinds: names of the kinds of grains.
    """

    def __init__(self, recording: Recording, footage: Footage, world: int, earth: bool = True) -> None:
        self.recording, self.world, self.earth = recording, world, earth
        self.bed, self.footage, self.time = Bed(footage, world, ""), footage, footage.time
        self.axes, self.kinds, self.title = recording.content.axes, footage.kinds, footage.title
        self.stance = stances(recording.frames["pose"][:][:, world])
        self._things = things_of(recording.preset, self.bed)
        self._volumes = {
            "grains": recording.radius,
            "water": recording.volume,
            "air": recording.air_volume,
            "bulk": recording.bulk_volume,
        }
        self.clouds = [name for name, sizes in self._volumes.items() if sizes.size]
        self.clouds += [FIXED] if len(footage.fixed) else []

    def of_tank(self) -> Stage:
        """The same in the tank's axes."""
        return Stage(self.recording, self.footage, self.world, earth=False)

    def count(self, cloud: str) -> int:
        """How many particles a sort has, those included that have left the scene."""
        return len(self.given(cloud)["id"])

    def quantities(self, cloud: str) -> dict[str, str]:
        """The recorded quantities of a cloud besides places, by the names that they are exported under."""
        prefix, owner = OF_CLOUDS.get(cloud, ("", None))
        known = self.recording.frames.quantities
        found = {name.removeprefix(prefix): name for name, one in known.items() if one.per == owner}
        return {name: full for name, full in found.items() if name != "position"}

    def units(self, cloud: str) -> dict[str, str]:
        """The units of a cloud's values by name."""
        known, found = self.recording.frames.quantities, self.quantities(cloud)
        volume = "m^3" if self.axes == SPACE else "m^2"
        given = {name: unit or volume for name, unit in GIVEN.items() if name in self.given(cloud)}
        return given | {name: known[full].unit for name, full in found.items()}

    def cloud(self, name: str, row: int) -> Cloud:
        """The particles of a sort at a picture."""
        if name == FIXED:
            values = self.given(name)
            return Cloud(self._placed(self.footage.fixed[:, :2], row), values)
        place = self._places(name, row)
        values = self.given(name) | {key: self._value(key, full, row) for key, full in self.quantities(name).items()}
        there = np.isfinite(place).all(axis=1)
        if there.all():
            return Cloud(self._placed(place, row), values)
        return Cloud(self._placed(place[there], row), {key: one[there] for key, one in values.items()})

    def shapes(self, row: int) -> dict[str, Shape]:
        """Tank, parts, hull and waterline at a picture, by name; the corners and faces of each stay the same."""
        stance = self.stance[row]
        found = {name: thing(row) for name, thing in self._things.inside.items()}
        found = {name: self._moved(shape, stance) if self.earth else shape for name, shape in found.items()}
        if self._things.waterline is not None:
            line = self._things.waterline(row, stance)
            found["waterline"] = line if self.earth else line.at((line.points - stance[:3]) @ rotation(stance[3:]))
        return found

    def _moved(self, shape: Shape, stance: np.ndarray) -> Shape:
        return shape.at(carried(shape.points, stance))

    def given(self, cloud: str) -> dict[str, np.ndarray]:
        """Radius, volume, kind and number of each particle, as far as a cloud has them."""
        if cloud == FIXED:
            return {"radius": self.footage.fixed[:, 2], "id": np.arange(len(self.footage.fixed))}
        sizes = self._volumes[cloud][self.world]
        number = {"id": np.arange(len(sizes))}
        if cloud == "grains":
            return {"radius": sizes, "kind": self.recording.kind[self.world]} | number
        round_one = np.sqrt(sizes / np.pi) if self.axes == PLANE else np.cbrt(0.75 * sizes / np.pi)
        return {"radius": round_one, "volume": sizes} | number

    def _places(self, cloud: str, row: int) -> np.ndarray:
        """Places (n, 2) or (n, 3) m in the tank; NaN where a particle has left the scene."""
        if cloud == "grains":
            return self.bed.position(row)
        return self.bed.drops(f"{OF_CLOUDS[cloud][0]}position", row)

    def _value(self, name: str, full: str, row: int) -> np.ndarray:
        """The values (n,) or (n, 3) of a quantity: directions in the axes that are asked for, angles from these."""
        values = self.bed.drops(full, row)
        if full == "angle" and values.ndim == 1:
            return values + self.bed.heel(row) + (self.stance[row, -1] if self.earth else 0.0)
        if values.ndim == 1 or not name.endswith("velocity"):
            return values
        turn = np.zeros(3)
        turn[2] = self.bed.heel(row) if full == "velocity" else 0.0
        turned = _in_space(values) @ rotation(turn).T
        return turned @ rotation(self.stance[row, 3:]).T if self.earth else turned

    def _placed(self, points: np.ndarray, row: int) -> np.ndarray:
        points = _in_space(points)
        return carried(points, self.stance[row]) if self.earth else points


def _in_space(vectors: np.ndarray) -> np.ndarray:
    """Vectors (n, 3) of those in the plane or in space."""
    if vectors.shape[1] == SPACE:
        return vectors
    return np.column_stack([vectors, np.zeros(len(vectors))])
