"""The bulk of some beds in one look: a smooth surface whose colour shows a field."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from lab.paint import palette
from lab.paint.bulk.colours import FIELDS
from lab.paint.colours import Colouring
from lab.paint.painter import Camera
from lab.paint.water.grid import Grid
from lab.paint.water.surface import Paints, paint_surface

if TYPE_CHECKING:
    from lab.paint.footage import Bed
    from lab.paint.water.basins import Basin

EDGE = (84, 66, 46)  # of the line along its surface
SMOOTH = 1.6  # of the points' distance: what flows is stretched, and gaps between its rows are no voids
LINE, STRONG = 0.085, 0.85  # thickness of that line in units of a page, and how strong it is


class BulkLayer:
    """Paints the bulk of beds (those without are left out) by the name of its colour; `unit`: pixels of a page's unit.

    colouring: of its field, for the colour bar; None if there is none.
    """

    def __init__(self, beds: Sequence[Bed], colour: str, unit: float) -> None:
        loose = [bed for bed in beds if bed.footage.bulk is not None]
        self.colouring: Colouring | None = FIELDS.get(colour, FIELDS["sliding"])(loose) if loose else None
        self._line = max(1.0, LINE * unit)
        self._grids: dict[tuple[Bed, Basin], Grid] = {}

    def paint(self, picture: np.ndarray, camera: Camera, bed: Bed, frame: int, under: tuple = palette.HOLD) -> None:
        """Paint a bed's bulk over a picture, in place; camera: of the tank's points; under: colour of the tank."""
        volume = bed.footage.bulk
        if volume is None:
            return
        place, own = bed.drops("bulk_position", frame), volume[bed.world]
        share = np.clip(np.nan_to_num(self.colouring.shares(bed, frame)), 0.0, 1.0)
        paints = Paints(self.colouring.table, EDGE, EDGE, EDGE, under, self._line, STRONG, False)
        for basin in bed.footage.basins:
            lifted = camera.carried(np.array([0.0, basin.lift, 0.0])) if basin.lift else camera
            grid, there = self._grid(bed, basin, lifted), basin.drops
            sums = grid.sums(place[there], own[there])
            toned = grid.sums(place[there], own[there] * share[there])
            tone = np.divide(toned, sums, out=np.zeros_like(sums), where=sums > 0.0)
            paint_surface(picture, lifted, grid, grid.level(sums), tone, paints)

    def _grid(self, bed: Bed, basin: Basin, camera: Camera) -> Grid:
        """The grid over one of a bed's tanks, kept as long as the picture's scale stays."""
        spacing = SMOOTH * float(np.sqrt(bed.footage.bulk.mean()))
        made = Grid.over(basin.outline, basin.open_edges, spacing, 1.0 / camera.scale)
        kept = self._grids.get((bed, basin))
        if kept is None or kept.distance != made.distance:
            self._grids[bed, basin] = kept = made
        return kept
