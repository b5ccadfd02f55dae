"""Rooms of a ship: how high a volume of water stands in each, and where its centre is, at any heel and trim.

The water of a room lies level, parallel to the sea. Of a room's volume the share `permeability` can be filled. A room
that is full goes on into its air pipe, whose area is PIPE of the room's: so its pressure rises while hardly any more
water enters.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from solvers.ship.flooding.solids import Prisms, Wet

PIPE = 1e-3  # area of the air pipe over volume/height of the room
MOST_STEPS = 100  # of the search for a level
CLOSE = 1e-13  # of a room's volume: levels are found as well as that


@dataclass(frozen=True, eq=False)
class Room:
    """A room with a section (m, 2) of y, z in m from x = `aft` to `forward` (m).

    `vented`: its air has the pressure outside; else it is closed in, and goes as p V^`index`, but for what leaves by
    openings. `water` (m³) is in it at the start.
    """

    name: str
    outline: np.ndarray
    aft: float
    forward: float
    permeability: float = 1.0
    vented: bool = True
    index: float = 1.4
    water: float = 0.0


@dataclass(frozen=True, eq=False)
class Filled:
    """The water of all rooms: levels (n,) m as those of the sea, centres (n, 3) m in the turned axes."""

    level: np.ndarray
    centre: np.ndarray
    surface: np.ndarray


class Rooms:
    """All rooms of a ship; none is allowed."""

    def __init__(self, rooms: Sequence[Room]):
        self.rooms = tuple(rooms)
        self.names = tuple(one.name for one in rooms)
        self.share = np.array([one.permeability for one in rooms], dtype=float)
        self.prisms = Prisms([one.outline for one in rooms], [one.aft for one in rooms], [one.forward for one in rooms])
        self.full = self.share * self.prisms.volume
        height = np.ptp(self.prisms.corners[..., 1], axis=1)
        self._pipe = PIPE * self.full / height
        # the levels found last, near which the next ones are sought
        self._last = self.prisms.corners[..., 1].min(axis=1, initial=np.inf)

    def __len__(self) -> int:
        return len(self.rooms)

    def filled(self, volume: np.ndarray, slope: float, roll: float) -> Filled:
        """How volumes (n,) m³ lie at a slope of the surface and a roll (rad)."""
        self._last, wet = self._levels(np.clip(volume, 0.0, self.full), slope, roll)
        over = np.maximum(volume - self.full, 0.0) / self._pipe * np.hypot(1.0, slope)
        return Filled(self._last + over, wet.centre, self.share * wet.surface)

    def held(self, level: float, slope: float, roll: float) -> np.ndarray:
        """Volumes (n,) m³ of rooms that are filled up to one level (m), the sea's."""
        return self.share * self.prisms.wet(np.full(len(self), level), slope, roll).volume

    def _levels(self, volume: np.ndarray, slope: float, roll: float) -> tuple[np.ndarray, Wet]:
        """Levels (n,) m and what is below them, by Newton's method, halved where it leaves the bracket."""
        low, high = self.prisms.reach(slope, roll)
        dry, full = volume <= 0.0, volume >= self.full
        at = np.where(dry, low, np.where(full, high, np.clip(self._last, low, high)))
        for _ in range(MOST_STEPS):
            wet = self.prisms.wet(at, slope, roll)
            off = self.share * wet.volume - volume
            found = dry | full | (np.abs(off) <= CLOSE * self.full)
            if found.all():
                break
            low, high = np.where(off < 0.0, at, low), np.where(off > 0.0, at, high)
            surface = self.share * wet.surface
            step = at - off / np.where(surface > 0.0, surface, np.inf)
            step = np.where((surface > 0.0) & (step > low) & (step < high), step, 0.5 * (low + high))
            at = np.where(found, at, step)
        return at, wet
