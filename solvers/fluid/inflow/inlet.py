"""An opening of a ship's hull that leads to a room, and where in that room its water comes out."""

from dataclasses import dataclass

import numpy as np

Point = tuple[float, float]


@dataclass(frozen=True)
class Inlet:
    """An opening with two `ends` (m), in the axes of the tanks, that leads to the tank of this number, the `room`.

    It takes the `share` of the room's length along the ship, which is `along` (m), and has a `discharge` coefficient
    C_d. Its water comes out at its `mouth`, on the room's wall.
    """

    ends: tuple[Point, Point]
    room: int
    along: float = 1.0
    share: float = 1.0
    discharge: float = 0.6

    @property
    def width(self) -> float:
        """Distance of its ends (m)."""
        return float(np.hypot(*np.subtract(*self.ends)))


def mouth(inlet: Inlet, outline: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Ends (2, 2) m of an opening's mouth in a room with this outline (m, 2), and the unit vector (2,) into the room.

    It is on the wall that is nearest to the opening's middle, where the feet of its ends are.
    """
    ends = np.array(inlet.ends)
    begin, along = outline, np.roll(outline, -1, axis=0) - outline
    size = (along**2).sum(axis=1)
    middle = ends.mean(axis=0)
    share = np.clip(((middle - begin) * along).sum(axis=1) / size, 0.0, 1.0)
    wall = int(np.hypot(*(middle - begin - share[:, None] * along).T).argmin())
    feet = np.clip(((ends - begin[wall]) @ along[wall]) / size[wall], 0.0, 1.0)
    inward = np.array([-along[wall, 1], along[wall, 0]]) / np.sqrt(size[wall])
    return begin[wall] + feet[:, None] * along[wall], inward
