"""The load on each piece of the tank: its walls, a shelf, a moving part, fixed grains."""

import numpy as np
import pytest

from solvers.grains.shapes.contour import Contour
from solvers.grains.shapes.given import Shapes
from solvers.simulation import Simulation
from solvers.tank.parts import Part
from tests.oracles.given import scene_of
from tests.oracles.scenes import box, material

G, RADIUS = 9.81, 1.5e-3
CIRCLES = Shapes((Contour(1.0),), np.zeros((1, 4), dtype=int), np.zeros((1, 4)), "continuous")
HOW = {
    "discs": {},
    "bands": {"schedule": "per-band"},
    "single grains": {"schedule": "per-grain"},
    "outlines": {"shapes": CIRCLES},
}


@pytest.mark.slow  # discs in one unit: `test_load.py`
@pytest.mark.parametrize("how", HOW)
def test_each_piece_bears_the_grains_on_it(how):
    """A grain on the floor, one on a shelf, one on a fixed grain in a pocket, one that a paddle carries: its weight.

    Under rules for discs and for outlines, in one unit and in several: booked once each.
    """
    fixed, shelf = np.array([[-0.04, 0.0, 4e-3]]), Part(((0.0, 0.02), (0.02, 0.02)))
    tray = Part(
        ((0.02, 0.05), (0.022, 0.045), (0.028, 0.045), (0.03, 0.05)), move=(0.0, 0.01), speed=0.05, acceleration=20.0
    )
    place = np.array([[[-0.01, RADIUS], [0.01, 0.02 + RADIUS], [-0.04, 4e-3 + RADIUS], [0.025, 0.045 + RADIUS]]])
    weight = 4.0 / 3.0 * np.pi * RADIUS**3 * material().density * G
    soft, more = material(young=2e7), HOW[how]
    scene = scene_of(
        np.full((1, 4), RADIUS),
        box(0.1, 0.1),
        soft,
        soft,
        fixed=fixed,
        parts=(shelf, tray),
        start_speed=0.3,
        **more,
    )
    run = Simulation(scene, place, 1, arch="cpu", units=2 if "per-band" in more.values() else None)
    run.advance(round(0.02 / run.dt))
    run.observe()
    run.advance(round(0.02 / run.dt))
    whole, pieces = run.observe(), run.loads()[0]
    run.close()
    assert pieces.sum(axis=0) == pytest.approx(whole["wall_force"][0], rel=1e-12, abs=1e-15)
    walls, on_shelf, on_tray, lining = pieces
    for piece, y in ((walls, -0.01), (on_shelf, 0.01), (lining, -0.04), (on_tray, 0.025)):
        assert piece == pytest.approx([0.0, -weight, -weight * y], rel=0.02, abs=1e-3 * weight)
