"""Gauges in films of scenes in space: rings on their walls, and depths on their lines."""

import numpy as np
import pytest

from lab.paint.film import Film, choose_look
from lab.paint.space.gauges import SpaceMarks
from lab.paint.water.pool import Pool
from solvers.fluid.given import Gauge, Level
from solvers.machine.runtime import initialise
from tests.oracles.heaps import ALONG, BOX, tilted

WIDE, HIGH = np.ptp(BOX, axis=0)
LOW = BOX.min(axis=0)
GAUGES = {
    "side": Gauge((float(BOX[:, 0].max()), float(LOW[1] + 0.5 * HIGH)), x=0.1 * ALONG, radius=0.1 * HIGH),
    "end": Gauge((float(LOW[0] + 0.5 * WIDE), float(LOW[1] + 0.4 * HIGH)), x=-0.5 * ALONG, radius=0.2 * HIGH),
}
LEVELS = {"depth": Level(float(LOW[0] + 0.4 * WIDE), 0.2 * ALONG)}
HUES = {"side": (200, 0, 0), "end": (0, 150, 0), "depth": (0, 0, 200)}


@pytest.fixture(autouse=True, scope="module")
def _taichi():
    initialise(fields=False)


@pytest.fixture(scope="module")
def camera():
    made = tilted(0.012)
    return Film([made.bed], choose_look(made, width=640, height=360)).tank_camera(0, 0)


def ratio(picture: np.ndarray, at: np.ndarray, hue: tuple) -> float:
    """The share of places (n, 2), pixels, at which a picture has a colour within two pixels."""
    near = [np.abs(picture[int(y) - 2 : int(y) + 3, int(x) - 2 : int(x) + 3].astype(int) - hue) for x, y in at]
    return float(np.mean([(one.max(axis=2) < 12).any() for one in near]))


def test_gauges_are_rings_in_their_faces_and_levels_are_dots_on_their_lines(camera):
    marks = SpaceMarks(BOX, 0.5 * ALONG, False, Pool(np.ones((1, 8)), GAUGES, LEVELS, axes=3), HUES, 12.0)
    picture = np.full((360, 640, 3), 255, dtype=np.uint8)
    marks.paint(picture, camera, {"depth": 0.5 * HIGH})
    turn = np.linspace(0.0, 2.0 * np.pi, 40)
    for name, axes in {"side": [2, 1], "end": [0, 1]}.items():
        gauge, ring = GAUGES[name], np.tile([*GAUGES[name].place, GAUGES[name].x], (len(turn), 1))
        ring[:, axes] += gauge.radius * np.column_stack([np.cos(turn), np.sin(turn)])
        assert ratio(picture, camera.pixels(ring), HUES[name]) > 0.9, name
    level = LEVELS["depth"]
    surface = camera.pixels(np.array([[level.y, LOW[1] + 0.5 * HIGH, level.x]]))
    assert ratio(picture, surface, HUES["depth"]) == 1.0
    x, y = surface[0].astype(int)
    assert (np.abs(picture[y - 1 : y + 2, x - 1 : x + 2].astype(int) - HUES["depth"]).max(axis=2) < 12).all()
