"""Plates that come down on water, and plates that abut: the account of energy, and joints that are none."""

import numpy as np
import pytest

from solvers.fluid.checks import residual
from solvers.fluid.start.parts import clear_of
from solvers.scene import Scene
from solvers.simulation import Simulation
from solvers.tank.parts import Part
from tests.oracles.water import still

WIDTH, HEIGHT, DEPTH, ROWS = 0.4, 0.4, 0.1, 20
SPACING, SPEED = DEPTH / ROWS, 1.0
GOES = {"speed": SPEED, "acceleration": 50.0}
CLEAR = Part(((-0.15, 0.35), (-0.1, 0.35)))  # of all water: two plates in each scene, for one kernel
ACROSS = ((0.0, 0.0), (0.0, HEIGHT))


def pushed(*plates: Part) -> Simulation:
    """Water beside plates that move, ten times as fast in sound as they are."""
    drops = still(WIDTH, HEIGHT, DEPTH, ROWS).drops
    drops = drops[:, clear_of(drops[0, :, :2], plates, SPACING)]
    scene: Scene = still(WIDTH, HEIGHT, DEPTH, ROWS, parts=plates, drops=drops, sound_speed=10.0 * SPEED)
    return Simulation(scene, threads=1, arch="cpu")


@pytest.mark.slow
def test_the_account_of_a_plate_that_hits_water_is_never_late():
    """Its work counts up to now, half a kick past the last one. The power of the blow grows by e^½ in a step, so that
    the trapezoidal rule errs by (½)²/12 = 2 % of the work. Without that half kick a quarter of it was missing, and the
    watch, which looks at each sample, stopped the run a spacing before the plate was at the surface.
    """
    run = pushed(Part(((-0.1, 0.12), (0.1, 0.12)), move=(0.0, -0.05), **GOES), CLEAR)
    start, most = residual(run.observe(), 0.0), 0.0
    while run.time < 0.045:
        run.advance(1)
        rows = run.observe()
        exchanged = sum(np.abs(rows[f"water_{name}"]) for name in ("work", "viscous", "diffusive", "kinetic"))
        assert np.abs(residual(rows, start)) < 0.02 * exchanged + 1e-4 * np.abs(start)
        most = max(most, float(rows["part_force"][0, 0, 1]))
    np.testing.assert_allclose(rows["part_work"].sum(axis=1), rows["water_work"])
    run.close()
    assert most > 0.1 * 1000.0 * SPEED * 10.0 * SPEED * 0.2  # a tenth of ρ c U: else it hit nothing
