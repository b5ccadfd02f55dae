"""Panes: faces that tint what is seen through them."""

import numpy as np
import taichi as ti

from lab.paint.raster.base import Picture, Shares, Table, colour_of, mix, row_of
from lab.paint.space.camera import SpaceCamera
from lab.paint.space.raster.faces import find_walls
from lab.paint.space.raster.layers import WALL, Layers, Whole
from lab.paint.space.walls import Walls

TINT = 0.45  # of the pane's colour in what is seen through it


def paint_panes(picture: np.ndarray, layers: Layers, camera: SpaceCamera, walls: Walls, tints: np.ndarray) -> None:
    """Paint the panes among walls over a picture, in place; tints (m, 3): of the walls, 0..255."""
    if walls.pane.any():
        layers.panes = layers.panes or Layers(*layers.depth.shape)
        layers.panes.clear(camera)
        find_walls(layers.panes, camera, walls, panes=True)
        _tint(picture, layers.depth, layers.panes.depth, layers.panes.who, tints)


@ti.kernel
def _tint(picture: Picture, depth: Shares, pane: Shares, who: Whole, tints: Table):
    for row in range(depth.shape[0]):
        for column in range(depth.shape[1]):
            if who[row, column] <= WALL and pane[row, column] < depth[row, column]:
                change = row_of(tints, WALL - who[row, column]) - colour_of(picture, row, column)
                mix(picture, row, column, TINT * change)
