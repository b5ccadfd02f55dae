"""The water of some beds in one look: a smooth surface with spray above it, or each particle as a disc."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from lab.paint import palette
from lab.paint.colours import Colouring
from lab.paint.painter import Camera, paint_grains, paint_strokes, to_discs
from lab.paint.water.air import BY_ITSELF, colouring_of_air, paint_air
from lab.paint.water.colours import SEEN_THROUGH, field
from lab.paint.water.foam import foam, ramp
from lab.paint.water.grid import Grid, sampled
from lab.paint.water.surface import Paints, paint_surface

if TYPE_CHECKING:
    from lab.paint.footage import Bed
    from lab.paint.water.basins import Basin

LIT, DEEP, EDGE, FOAM = (118, 178, 222), (44, 106, 168), (22, 72, 124), (222, 238, 248)
SPRAY = (150, 196, 230)  # of drops in the air, which foam would let vanish before the empty tank
FIELD_EDGE = (40, 46, 56)  # of the line around a field
LINE = 0.085  # thickness of the line along the surface, in units of a page
STRONG = 0.85  # of that line
WITHIN, APART = 0.62, 0.46  # levels at a particle: above, it is part of the surface; below, it is a drop of its own
TABLE, THICK = (14, 62, 150), 1.3  # of the line along the surface of water in a bed, over the line of water alone
SMALL = 0.4  # of their radii: grains in water whose field is shown
DISC = 0.46  # radius of a particle painted as a disc, over the distance of the particles


class WaterLayer:
    """Paints the water of beds (those without are left out) by the name of its colour; `unit`: pixels of a page's unit.

    colouring: of a field, for the colour bar; None for water that looks like water, or if there is none.
    """

    def __init__(self, beds: Sequence[Bed], colour: str, unit: float) -> None:
        wet = [bed for bed in beds if bed.footage.water]
        self._discs = colour == "particles"
        self.colouring: Colouring | None = field(colour, wet) if wet else None
        self._air = colouring_of_air(colour, wet, self.colouring) if wet else None
        if colour == BY_ITSELF:
            self.colouring = self._air
        self._plain = colour == BY_ITSELF or not self.colouring  # water looks like water
        self._line = max(1.0, LINE * unit)
        self._grids: dict[tuple[Bed, Basin], Grid] = {}
        porous = any(bed.footage.water.porous for bed in wet)
        self.grain_size = SMALL if porous and colour in SEEN_THROUGH else 1.0

    def paint(self, picture: np.ndarray, camera: Camera, bed: Bed, frame: int, under: tuple = palette.HOLD) -> None:
        """Paint a bed's water over a picture, in place; camera: of the tank's points; under: colour of the tank."""
        if not bed.footage.water:
            return
        for basin in bed.footage.basins:
            lifted = camera.carried(np.array([0.0, basin.lift, 0.0])) if basin.lift else camera
            self._paint_basin(picture, lifted, bed, frame, basin, under)

    def _paint_basin(
        self, picture: np.ndarray, camera: Camera, bed: Bed, frame: int, basin: Basin, under: tuple
    ) -> None:
        """Paint the water of one tank."""
        place = bed.water_position(frame)
        there = np.zeros(len(place), dtype=bool)
        there[basin.drops] = np.isfinite(place[basin.drops]).all(axis=1)
        if not there.any():
            return
        place = place[there]
        volume = np.broadcast_to(bed.footage.water.volume[bed.world], there.shape)[there]
        if bed.footage.water.porous:
            volume = volume / bed.drops("water_porosity", frame)[there]
        if self._discs:
            size = np.full(len(place), DISC * bed.footage.water.spacing)
            _paint_discs(picture, camera, place, size, self.colouring.colours(bed, frame)[there])
            return
        grid = self._grid(bed, basin, camera)
        if self._air and bed.footage.water.air.size:
            paint_air(picture, camera, grid, bed, frame, self._air, under)
        sums = grid.sums(place, volume)
        level = grid.level(sums)
        reached = sampled(level, grid.nodes(place))
        if not self._plain:
            share = np.clip(np.nan_to_num(self.colouring.shares(bed, frame)[there]), 0.0, 1.0)
            colour = self.colouring.colours(bed, frame)[there]
        else:
            velocity, pool = bed.drops("water_velocity", frame)[there], bed.footage.water
            share = foam(place, velocity, reached, pool.spacing, float(np.ptp(basin.outline[:, 1])))
            colour = np.array(LIT) + ramp(reached, (WITHIN, APART))[:, None] * (np.array(SPRAY) - LIT)
        apart = np.sqrt(ramp(reached, (WITHIN, APART)))
        drops = apart > 0.0
        _paint_discs(picture, camera, place[drops], (apart * np.sqrt(volume / np.pi))[drops], colour[drops])
        paint_surface(picture, camera, grid, level, _toned(grid, sums, place, volume, share), self._paints(under))

    def paint_table(self, picture: np.ndarray, camera: Camera, bed: Bed, frame: int) -> None:
        """Paint the surface of water between grains, over these, as a line."""
        pool = bed.footage.water
        if not (pool and pool.tabled) or self._discs:
            return
        for basin in bed.footage.basins:
            place = bed.water_position(frame)
            there = np.isfinite(place).all(axis=1)
            grid = self._grid(bed, basin, camera)
            volume = pool.volume[bed.world][there] / bed.drops("water_porosity", frame)[there]
            line = camera.pixels(grid.surface(grid.level(grid.sums(place[there], volume)), pool.spacing))
            half = np.full(len(line) - 1, 0.5 * THICK * self._line)
            paint_strokes(picture, np.column_stack([line[:-1], half, line[1:], half]), TABLE)

    def _grid(self, bed: Bed, basin: Basin, camera: Camera) -> Grid:
        """The grid over a bed's tank, kept as long as the picture's scale stays."""
        made = Grid.over(basin.outline, basin.open_edges, bed.footage.water.spacing, 1.0 / camera.scale)
        kept = self._grids.get((bed, basin))
        if kept is None or kept.distance != made.distance:
            self._grids[bed, basin] = kept = made
        return kept

    def _paints(self, under: tuple) -> Paints:
        if not self._plain:
            return Paints(self.colouring.table, LIT, DEEP, FIELD_EDGE, under, self._line, STRONG, False)
        return Paints(np.array([FOAM]), LIT, DEEP, EDGE, under, self._line, STRONG, True)


def _paint_discs(picture: np.ndarray, camera: Camera, place: np.ndarray, size: np.ndarray, colour: np.ndarray) -> None:
    """Paint discs (n) of these radii (m) and colours (n, 3), without marks."""
    paint_grains(picture, to_discs(camera, place, size, np.zeros(len(place))), colour, colour)


def _toned(grid: Grid, sums: np.ndarray, place: np.ndarray, volume: np.ndarray, share: np.ndarray) -> np.ndarray:
    """The mean of the particles' shares about each node, Σ V W share / Σ V W; 0 where there is no water."""
    some = share > 0.0
    if not some.any():
        return np.zeros_like(sums)
    found = grid.sums(place[some], (volume * share)[some])
    return np.divide(found, sums, out=np.zeros_like(sums), where=sums > 0.0)
