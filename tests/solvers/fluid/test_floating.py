"""Bodies that float for long: Archimedes, a square that rolls to its corner, a tank that is swayed."""

import numpy as np
import pytest

from solvers.motion.harmonic import Sway
from solvers.simulation import Simulation
from tests.oracles.floating import afloat

pytestmark = pytest.mark.slow


@pytest.mark.parametrize("ratio", [0.1, 0.5, 0.9])
def test_a_box_floats_as_deep_as_its_mass_says(ratio):
    """In the mean over the last of three seconds to half a spacing, also with a draught of two spacings; upright."""
    spacing = 0.025 if ratio == 0.1 else 0.05
    run = Simulation(afloat(ratio, spacing=spacing, precision="mixed"), threads=2)
    drawn, found = run.observe()["body_place"][0, 0], []
    try:
        run.advance(round(2.0 / run.dt))
        for _ in range(20):
            run.advance(round(0.05 / run.dt))
            found.append(run.observe()["body_place"][0, 0] - drawn)
    finally:
        run.close()
    sway, heave, heel = np.mean(found, axis=0)
    assert abs(heave) < 0.5 * spacing and abs(sway) < spacing
    assert abs(np.rad2deg(heel)) < 0.5


def test_a_square_of_half_the_density_rolls_from_its_side_to_its_corner():
    """It is stable at 45 deg alone: on its side GM is B (1/6 + 1/4 − 1/2) = −B/12. To 3 deg after 12 s."""
    heel = 0.1
    run = Simulation(
        afloat(0.5, size=(1.0, 1.0), tank=(3.0, 2.6), depth=1.6, heel=heel, place=(0.0, 1.6), precision="mixed"),
        threads=2,
    )
    found = []
    try:
        run.advance(round(10.0 / run.dt))
        for _ in range(20):
            run.advance(round(0.1 / run.dt))
            found.append(run.observe()["body_place"][0, 0, 2])
    finally:
        run.close()
    assert np.rad2deg(heel + np.mean(found)) == pytest.approx(45.0, abs=3.0)


def test_a_body_in_a_tank_that_is_swayed_goes_with_the_water():
    """A tank that moves evenly moves nothing in it: after a sway has gone over into rest, the box is where it was.

    Fast against the water's own periods, so that box and water are left behind together: to half a spacing.
    """
    sway = Sway(amplitude=0.05, frequency=4.0)
    still = afloat(0.5, precision="mixed")
    moved = afloat(0.5, precision="mixed", motions=[(sway,)], soft_start=0.25)
    places = []
    for scene in (still, moved):
        run = Simulation(scene, threads=2)
        try:
            run.advance(round(1.0 / run.dt))
            rows = run.observe()
            places.append(rows["body_place"][0, 0] + (*rows["pose"][0][:2], 0.0))
        finally:
            run.close()
    assert np.abs(places[1] - places[0])[:2].max() < 0.05
