"""From a preset to water's particles: the pressure with which they begin, and what they weigh."""

import numpy as np

from lab.assembly.water import drops_of
from lab.preset.schema import resolve
from solvers.fluid.given import EXCESS, Z

BLOCK = [["-200 mm", "300 mm"], ["0 mm", "300 mm"], ["0 mm", "400 mm"], ["-200 mm", "400 mm"]]
COLUMN = [["-200 mm", "0 mm"], ["0 mm", "0 mm"], ["0 mm", "300 mm"], ["-200 mm", "300 mm"]]


def wet(**water) -> object:
    tank = {"width": "400 mm", "height": "400 mm"}
    run = {"duration": "1 s", "gravity": "10 m/s^2", "settle": False}
    return resolve({"format": 3, "title": "water", "tank": tank, "water": {"spacing": "10 mm"} | water, "run": run})


def test_a_block_that_is_let_go_under_a_lid_has_no_pressure_and_a_column_its_weights():
    """The block falls freely; the column stands, and begins as hydrostatics has it."""
    assert not drops_of(wet(region=BLOCK))[:, EXCESS].any()
    drops = drops_of(wet(region=COLUMN, sound_speed="40 m/s"))
    np.testing.assert_allclose(40.0**2 * np.log1p(drops[:, EXCESS]), 10.0 * (0.3 - drops[:, Z]), rtol=1e-9)
