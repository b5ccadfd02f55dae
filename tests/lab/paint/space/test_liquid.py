"""Water in pictures of scenes in space: how thick it is, where it ends, and what it leaves alone."""

import numpy as np
import pytest

from lab.paint.painter import Camera
from lab.paint.space.camera import SpaceCamera, gaze_at
from lab.paint.space.raster.faces import find_walls
from lab.paint.space.raster.layers import FAR, Layers
from lab.paint.space.raster.liquid import _thickness, paint_liquid
from lab.paint.space.walls import prism
from solvers.machine.runtime import initialise

SIDE, LONG, DEEP, SPACING = 1.0, 0.5, 0.6, 0.05  # m
OUTLINE = np.array([[-0.5, 0.0], [0.5, 0.0], [0.5, 1.0], [-0.5, 1.0]])
TANK = prism(OUTLINE, LONG, ())


@pytest.fixture(autouse=True, scope="module")
def _taichi():
    initialise(fields=False)


def block() -> np.ndarray:
    """Places of particles that fill the tank to a depth of DEEP."""
    y, z, x = ((np.arange(round(side / SPACING)) + 0.5) * SPACING for side in (SIDE, DEEP, LONG))
    grid = np.stack(np.meshgrid(y - 0.5 * SIDE, z, x - 0.5 * LONG, indexing="ij"), axis=-1)
    return grid.reshape(-1, 3)


def camera(azimuth: float = 0.0, elevation: float = 0.0) -> SpaceCamera:
    """From far away, so that rays are nearly parallel; the tank is 200 pixels wide."""
    return SpaceCamera(gaze_at(TANK.points, azimuth, elevation, 60.0), Camera(200.0, (150.0, 150.0)))


def blank(view: SpaceCamera) -> tuple[np.ndarray, Layers]:
    """A grey picture of the empty tank's far walls, and its layers."""
    picture, layers = np.full((300, 300, 3), 200, dtype=np.uint8), Layers(300, 300)
    layers.clear(view)
    find_walls(layers, view, TANK)
    return picture, layers


@pytest.mark.parametrize(("azimuth", "thick"), [(0.0, LONG), (np.pi / 2.0, SIDE)])
def test_water_is_as_thick_as_it_is_along_the_gaze(azimuth, thick):
    view = camera(azimuth)
    _, layers = blank(view)
    found = _thickness(layers, view, block(), SPACING, view.focal * SPACING / view.gaze.distance)
    column, row = view.pixels(np.array([[0.0, 0.5 * DEEP, 0.0]]))[0].astype(int)
    around = found[row - 20 : row + 20, column - 20 : column + 20]
    assert around.mean() == pytest.approx(thick, rel=0.03) and around.std() < 0.05 * thick
    assert found[:30].max() == 0.0  # above the tank


def test_water_is_darker_the_thicker_it_is_and_ends_at_the_walls():
    """Seen from the front: red goes first; above the water and beside the tank the picture stays as it was."""
    view = camera()
    picture, layers = blank(view)
    paint_liquid(picture, layers, view, block(), SPACING, (TANK, True), 1.0)
    column, row = view.pixels(np.array([[0.0, 0.5 * DEEP, 0.0]]))[0].astype(int)
    red, _, blue = picture[row, column].astype(int)
    assert red < 200 - 60 and blue > red + 40
    above = view.pixels(np.array([[0.0, DEEP + 3.0 * SPACING, 0.0]]))[0].astype(int)[1]
    np.testing.assert_array_equal(picture[:above], 200)
    left = int(view.pixels(np.array([[-0.5, 0.5, 0.5 * LONG]]))[0, 0])
    np.testing.assert_array_equal(picture[:, : left - 1], 200)
    glass = view.gaze.seen(np.array([[0.0, 0.3, 0.5 * LONG]]))[0, 2]
    assert glass - 1e-3 <= layers.depth[row, column] <= glass + 1.6 * SPACING  # it stands against the wall in front


def test_what_is_before_the_water_hides_it():
    view = camera()
    picture, layers = blank(view)
    layers.depth[:] = 1.0  # m: something all over, far in front of the tank
    paint_liquid(picture, layers, view, block(), SPACING, (TANK, True), 1.0)
    np.testing.assert_array_equal(picture, 200)
    assert layers.depth.max() < FAR
