"""What is drawn over the grains: the ways that they have come, or the forces between them."""

from collections.abc import Sequence

import numpy as np

from lab.paint.footage import Bed
from lab.paint.forces.chains import THICKEST, newtons, paint_chains, typical_force
from lab.paint.page.theme import Theme
from lab.paint.painter import Camera
from lab.paint.scene.trails import paint_trails

TRAILS = 6  # frames that a trail goes back
PALE = 0.62  # how far grains under force chains go towards the colour of the empty tank


class Overlay:
    """The overlay of this kind over some beds; rows (K, F): of their frames."""

    def __init__(self, kind: str, beds: Sequence[Bed], rows: np.ndarray, theme: Theme) -> None:
        self._kind, self._rows, self._theme = kind, rows, theme
        filled = [bed for bed in beds if not bed.empty]
        self._radius = float(filled[0].radius.mean()) if filled else 0.0
        self._typical = typical_force(filled) if kind == "forces" else 0.0

    @property
    def says(self) -> str:
        """What the lines are, if it needs to be said."""
        return f"force of {newtons(self._typical)}" if self._typical else ""

    def thickness(self, camera: Camera) -> float:
        """How thick (pixels) a line of that force is; 0 if there are none. camera: of the tank's points."""
        return 2.0 * THICKEST * self._radius * camera.scale if self._typical else 0.0

    def under(self, colour: np.ndarray) -> np.ndarray:
        """The colours (n, 3) of grains below the overlay."""
        if self._kind != "forces":
            return colour
        return colour + PALE * (np.array(self._theme.hold, dtype=float) - colour)

    def paint(self, picture: np.ndarray, camera: Camera, bed: Bed, k: int, frame: int) -> None:
        """Paint the overlay of bed number k over a picture, in place; camera: of the tank's points."""
        if bed.empty:
            return
        if self._kind == "trails":
            rows = [self._rows[k][max(frame - back, 0)] for back in range(TRAILS)]
            paint_trails(picture, camera, bed, rows, self._theme.ink)
        elif self._kind == "forces":
            paint_chains(picture, camera, bed, self._rows[k][frame], self._typical, self._theme.force)
