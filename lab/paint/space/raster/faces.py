"""Find which wall is seen in each pixel, and how far away it is."""

import numpy as np
import taichi as ti

from lab.paint.raster.base import BAND, PER_TASK, Index, Shares, Table, sort_into_bands, whole
from lab.paint.space.camera import SpaceCamera
from lab.paint.space.raster.layers import WALL, Layers, Numbers, Whole, ray_at, read_lens
from lab.paint.space.walls import Walls


def find_walls(
    layers: Layers, camera: SpaceCamera, walls: Walls, panes: bool = False, front: bool = False
) -> np.ndarray:
    """Write into the layers where walls are seen; returns their planes (m, 4) in camera coordinates: n · r = d.

    Their normals point towards the camera. panes: the panes alone, else all that are none; front: those that are not
    drawn, as one looks through them into the tank.
    """
    drawn = np.flatnonzero((walls.facing(camera.gaze.eye) != front) & (walls.pane == panes)).astype(np.int32)
    planes = _planes(camera, walls)
    if len(drawn):
        corners = camera.pixels(walls.points)
        top, bottom = (pick.reduceat(corners[:, 1], walls.first[:-1])[drawn] for pick in (np.minimum, np.maximum))
        starts, members = sort_into_bands(0.5 * (top + bottom), 0.5 * (bottom - top), len(layers.depth))
        if len(members):
            edges, rows = _edges(corners, walls.after), np.column_stack([top, bottom])
            _find(layers.depth, layers.who, starts, members, walls.first, edges, rows, drawn, planes, layers.lens)
    return planes


def _planes(camera: SpaceCamera, walls: Walls) -> np.ndarray:
    normals = walls.normals @ camera.gaze.axes.T
    seen = camera.gaze.seen(walls.points[walls.first[:-1]])
    planes = np.column_stack([normals, (normals * seen).sum(axis=1)])
    return np.where(planes[:, 3:] > 0.0, -planes, planes)  # a ray that meets a face in front has n · r < 0


def _edges(corners: np.ndarray, after: np.ndarray) -> np.ndarray:
    """Edges (n, 4) in pixels for a kernel: column and row of the start, row of the end, columns a row."""
    way = corners[after] - corners
    slope = np.divide(way[:, 0], way[:, 1], out=np.zeros(len(way)), where=np.abs(way[:, 1]) > 1e-12)
    return np.column_stack([corners, corners[after, 1], slope])


@ti.func
def _run(edges: ti.template(), first, last, y, x):
    """Whether (1 or −1) a place is inside a polygon by the even–odd rule, and the next x at which that changes."""
    inside, following = -1.0, 1e9
    for e in range(first, last):
        if (edges[e, 1] <= y) != (edges[e, 2] <= y):
            crossed = edges[e, 0] + (y - edges[e, 1]) * edges[e, 3]
            if crossed > x:
                inside, following = -inside, ti.min(following, crossed)
    return ti.Vector([inside, following])


@ti.kernel
def _find(
    depth: Shares,
    who: Whole,
    starts: Index,
    members: Index,
    first: Index,
    edges: Table,
    rows: Table,
    drawn: Index,
    planes: Table,
    numbers: Numbers,
):
    for k in range((starts.shape[0] - 1) * PER_TASK):
        if k % PER_TASK == 0:
            band, lens, width = k // PER_TASK, read_lens(numbers), depth.shape[1]
            top, bottom = band * BAND, ti.min((band + 1) * BAND, depth.shape[0])
            for entry in range(starts[band], starts[band + 1]):
                i = members[entry]
                wall = drawn[i]
                plane = ti.Vector([planes[wall, 0], planes[wall, 1], planes[wall, 2]])
                for row in range(whole(rows[i, 0], top, bottom), whole(rows[i, 1] + 1.0, top, bottom)):
                    column = 0
                    while column < width:
                        run = _run(edges, first[wall], first[wall + 1], row + 0.5, column + 0.5)
                        stop = whole(run[1] + 0.5, column + 1, width)
                        if run[0] > 0.0:
                            for pixel in range(column, stop):
                                met = ti.cast(planes[wall, 3] / plane.dot(ray_at(lens, row, pixel)), ti.f32)
                                if met < depth[row, pixel]:
                                    depth[row, pixel] = met
                                    who[row, pixel] = WALL - wall
                        column = stop
