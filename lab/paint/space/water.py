"""The water of a bed in space: as a surface that looks like water, or its particles in the colours of a field."""

from collections.abc import Sequence

import numpy as np

from lab.paint.colours import Colouring
from lab.paint.footage import Bed
from lab.paint.space.camera import SpaceCamera
from lab.paint.space.raster.layers import Layers
from lab.paint.space.raster.liquid import paint_liquid
from lab.paint.space.raster.shade import Paints

BALL = 0.5  # of the spacing: radius of particles in the colours of a field
DARK = 0.6  # of the tank's longest side: a thickness of water that is dark


class SpaceWater:
    """The water of beds; `colouring` is that of a field, None for water that looks like water."""

    def __init__(self, beds: Sequence[Bed], colouring: Colouring | None) -> None:
        self._wet = {id(bed) for bed in beds if bed.footage.water}
        self._colouring = colouring

    def balls(self, bed: Bed, row: float, place: np.ndarray) -> tuple[np.ndarray, np.ndarray, Paints]:
        """Places, radii and looks of particles in the colours of a field; none where water looks like water."""
        if id(bed) not in self._wet or self._colouring is None:
            return np.zeros((0, 3)), np.zeros(0), Paints(np.zeros((0, 3)))
        colour = self._colouring.colours(bed, row)
        return place, np.full(len(place), BALL * bed.footage.water.spacing), Paints(colour, np.zeros(len(place)))

    def paint(self, picture: np.ndarray, layers: Layers, camera: SpaceCamera, bed: Bed, place: np.ndarray) -> None:
        """Paint the water of a bed at these places (n, 3) m as a surface over a picture, in place."""
        if id(bed) in self._wet and self._colouring is None and len(place):
            walls, spacing = bed.footage.space.walls, bed.footage.water.spacing
            deep = DARK * float(np.ptp(walls.points, axis=0).max())
            tank = walls, not bed.footage.open_edges
            paint_liquid(picture, layers, camera, place, spacing, tank, deep)
