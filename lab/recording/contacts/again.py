"""Contact forces of the frames of a recording, found again from the places and angles that it holds.

They are the elastic forces along the normals, of which a recording with places in 32 bits tells all: an overlap follows
from places, radii and outlines. Friction and damping depend on what happened between two frames and are left out, as is
what a law remembers of earlier loading.
"""

import numpy as np

from lab.assembly.touching import Recorded, touching
from lab.base.errors import LabError
from lab.preset.schema import Preset
from solvers.grains.pressing import UNTOUCHED, Pressing
from solvers.machine.errors import BadState
from solvers.machine.quantity import PLANE
from solvers.simulation import Simulation

KEPT = 3  # frames whose forces are kept
APART, AWAY = 4.0, 10.0  # of grains that are gone: distance over the largest radius, and from the tank over its size


class Again:
    """The forces in all worlds of a recording of a preset."""

    def __init__(self, preset: Preset, recorded: Recorded) -> None:
        self._scene = touching(preset, recorded)
        self._simulation: Simulation | None = None
        self._kept: dict[float, list[Pressing]] = {}

    def read(self, time: float, position: np.ndarray, angle: np.ndarray) -> list[Pressing]:
        """The forces in each world at a time (s), at which grains have a `position` (W, n, axes) m and an `angle`.

        Grains without a finite place touch nothing.
        """
        if time not in self._kept:
            while len(self._kept) >= KEPT:
                self._kept.pop(next(iter(self._kept)))
            self._kept[time] = self._found(time, position, angle)
        return self._kept[time]

    def close(self) -> None:
        """Free the arrays."""
        if self._simulation:
            self._simulation.close()
            self._simulation = None

    def _found(self, time: float, position: np.ndarray, angle: np.ndarray) -> list[Pressing]:
        place, count = self._set_aside(position), self._scene.worlds
        if not place.size:
            return [UNTOUCHED] * count
        if self._simulation is None:
            self._simulation = Simulation(self._scene, place)
        made = self._simulation
        if self._scene.grains.shapes:
            made.grains.grains.start_angle = angle
        made.origin = time - made.time  # for the places of moving parts
        made.place(place)
        try:
            made.advance(1)  # makes the lists; the step is so short that nothing moves
        except BadState:
            raise LabError(f"Forces cannot be found at {time:.4g} s: grains lie in each other.") from None
        return [made.pressing(w) for w in range(count)]

    def _set_aside(self, position: np.ndarray) -> np.ndarray:
        """The places (W, n, axes) m, of grains that are gone far from the tank and from each other."""
        gone = ~np.isfinite(position).all(axis=2)
        if not gone.any():
            return position
        outline, away = self._scene.outline, np.eye(position.shape[2])[0]
        steps = np.arange(position.shape[1]) * APART * self._scene.grains.radius.max()
        high = np.pad(outline.max(axis=0) + AWAY * np.ptp(outline, axis=0), (0, position.shape[2] - PLANE))
        return np.where(gone[..., None], high + steps[:, None] * away, position)
