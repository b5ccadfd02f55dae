"""A tank: its outline in the carrier's axes, its thickness, and the length of ship that it stands for."""

from dataclasses import dataclass

import numpy as np

BARE_THICKNESS = 1.0  # m, of a tank without grains unless it is given


@dataclass(frozen=True, eq=False)
class Tank:
    """A tank of a world in the plane.

    `outline` (m, 2) m in its carrier's axes is a simple polygon, counter-clockwise; `open_edges` are its edges without
    a wall, by their first corners. The world is a slab of `thickness` (m): forces are those on the slab. Along a ship
    the tank is `length` (m) long, None: as long as the ship. Its contents are the particles inside the outline.

    One that is `aboard` a part, by its number, is a room of that body: its outline is in the axes in which the part is
    drawn, and moves with it.
    """

    outline: np.ndarray
    thickness: float
    open_edges: tuple[int, ...] = ()
    length: float | None = None
    aboard: int | None = None

    @property
    def along(self) -> float:
        """Its length along the ship (m), 1 if it is as long as she."""
        return 1.0 if self.length is None else self.length

    def share(self, whole: float) -> float:
        """Factor (1/m) from a force on the slab (N) to force per metre of a ship `whole` m long (N/m)."""
        return (1.0 if self.length is None else self.length / whole) / self.thickness

    def holds(self, points: np.ndarray) -> np.ndarray:
        """Which of the points (n, 2) m lie in the tank, (n,), by the even–odd rule."""
        (ay, az), (by, bz) = self.outline.T, np.roll(self.outline, -1, axis=0).T
        y, z = points[:, :1], points[:, 1:]
        with np.errstate(divide="ignore", invalid="ignore"):
            left = y < ay + (z - az) / (bz - az) * (by - ay)
        return np.count_nonzero(((az > z) != (bz > z)) & left, axis=1) % 2 == 1
