"""Paint spheres in a tank in space over a picture."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from lab.paint.space.camera import SpaceCamera
from lab.paint.space.raster.edges import compose
from lab.paint.space.raster.faces import find_walls
from lab.paint.space.raster.layers import Layers
from lab.paint.space.raster.lines import edge_lines, paint_lines_in_space
from lab.paint.space.raster.occlusion import find_open_sky
from lab.paint.space.raster.panes import paint_panes
from lab.paint.space.raster.shade import Paints, shade
from lab.paint.space.raster.spheres import Spheres, find_spheres
from lab.paint.space.walls import Walls

SPARSE = 0.02  # of the camera's distance: typical size in an empty tank


@dataclass(frozen=True)
class Skin:
    """Colours of the walls, (3,) or (m, 3) of each, and of edges, in 0..255; half the thickness of edges in pixels."""

    wall: np.ndarray | tuple
    edge: tuple
    half: float = 1.0


def paint_space(
    picture: np.ndarray,
    camera: SpaceCamera,
    place: np.ndarray,
    radius: np.ndarray,
    paints: Paints,
    walls: Walls,
    skin: Skin,
    layers: Layers | None = None,
    over: Callable[[np.ndarray, Layers], None] | None = None,
) -> Layers:
    """Paint spheres (place (n, 3), radius (n,), m) and walls over a picture (h, w, 3), u8, in place.

    Spheres without a finite place are left out. Returns what is seen where, for what is drawn over it; layers: those
    of an earlier picture of this size, whose memory is used again; over: what is painted over both, seen through.
    """
    layers = layers or Layers(*picture.shape[:2])
    layers.clear(camera)
    planes = find_walls(layers, camera, walls)
    spheres = Spheres.seen(camera, place, radius)
    find_spheres(layers, spheres)
    typical = float(np.mean(radius)) if len(radius) else SPARSE * camera.gaze.distance
    balls, paint = _some(spheres.balls), _some(paints.table(spheres.which, camera.gaze.axes))
    find_open_sky(layers, balls, _some(planes), typical, camera.gaze.distance)
    tints = np.array(np.broadcast_to(np.asarray(skin.wall, dtype=float), (max(len(planes), 1), 3)))
    shade(layers, balls, _some(planes), paint, tints)
    compose(picture, layers, balls)
    if over:  # edges behind it are seen through it
        paint_lines_in_space(picture, layers, edge_lines(camera, walls, skin.half), skin.edge)
        over(picture, layers)
    paint_panes(picture, layers, camera, walls, tints)
    paint_lines_in_space(picture, layers, edge_lines(camera, walls, skin.half), skin.edge)
    return layers


def _some(rows: np.ndarray) -> np.ndarray:
    """Rows for a kernel, which cannot take an array without any."""
    return rows if len(rows) else np.zeros((1, rows.shape[1]))
