"""What is seen in each pixel before it has a colour: how far away it is, and which sphere or wall it is.

A deferred picture (Deering et al. 1988): spheres and walls only say where they are; light is computed once a pixel.
Camera coordinates are right, up and depth, m. A pixel's ray goes through (x, y, 1) with x, y from its middle.
"""

import numpy as np
import taichi as ti

from lab.paint.space.camera import SpaceCamera

NOTHING, WALL = -1, -2  # in `who`: background, and the first wall; wall k is WALL − k, a sphere is its number
FAR = 1e30  # m, depth of the background

Whole = ti.types.ndarray(dtype=ti.i32, ndim=2)
Numbers = ti.types.ndarray(dtype=ti.f64, ndim=1)


class Layers:
    """Of one picture (h, w): depth m along the gaze, f32; who is seen, i32; sky: the open share, f32; shaded: colours.

    lens: see `lens_of`; panes: those of panes, once there are some. The memory is kept for pictures of one size.
    """

    def __init__(self, height: int, width: int) -> None:
        self.depth = np.empty((height, width), dtype=np.float32)
        self.who = np.empty((height, width), dtype=np.int32)
        self.sky = np.empty((height, width), dtype=np.float32)
        self.shaded = np.empty((height, width, 3), dtype=np.uint8)
        self.panes: Layers | None = None

    def clear(self, camera: SpaceCamera) -> None:
        """Begin a picture by this camera, in which nothing is seen yet."""
        self.depth[:], self.who[:], self.lens = FAR, NOTHING, lens_of(camera)


def lens_of(camera: SpaceCamera) -> np.ndarray:
    """What kernels need of a camera: focal length, and column and row of the gaze, in pixels."""
    return np.array([camera.focal, *camera.screen.offset])


@ti.func
def ray_at(lens, row, column):
    """The ray (x, y, 1) through the middle of a pixel; lens: vector of focal length⁻¹, column and row of the gaze."""
    return ti.Vector([(column + 0.5 - lens[1]) * lens[0], (lens[2] - row - 0.5) * lens[0], 1.0])


@ti.func
def read_lens(lens: ti.template()):
    """The lens as a vector, with the focal length's reciprocal; to be read once a row, since memory is slow."""
    return ti.Vector([1.0 / lens[0], lens[1], lens[2]])
