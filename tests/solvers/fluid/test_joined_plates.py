"""Plates that come down on water, and plates that abut: the account of energy, and joints that are none."""

import numpy as np
import pytest

from solvers.fluid.bodies.solids import is_solid, line_of, prolonging
from solvers.fluid.checks import residual
from solvers.fluid.given import Water
from solvers.fluid.start.parts import clear_of
from solvers.fluid.start.plates import packed_beside
from solvers.scene import Scene
from solvers.simulation import Simulation
from solvers.tank.parts import Body, Part
from tests.oracles.water import box, still

WIDTH, HEIGHT, DEPTH, ROWS = 0.4, 0.4, 0.1, 20
SPACING, SPEED = DEPTH / ROWS, 1.0
GOES = {"speed": SPEED, "acceleration": 50.0}
CLEAR = Part(((-0.15, 0.35), (-0.1, 0.35)))  # of all water: two plates in each scene, for one kernel
ACROSS = ((0.0, 0.0), (0.0, HEIGHT))


def pushed(*plates: Part) -> Simulation:
    """Water beside plates that move, ten times as fast in sound as they are."""
    drops = still(WIDTH, HEIGHT, DEPTH, ROWS).fluid.particles
    drops = drops[:, clear_of(drops["position"][0], plates, SPACING)]
    scene: Scene = still(WIDTH, HEIGHT, DEPTH, ROWS, parts=plates, drops=drops, sound_speed=10.0 * SPEED)
    return Simulation(scene, threads=1, arch="cpu")


def test_plates_that_touch_in_one_line_and_move_alike_are_one():
    """Whichever way they are drawn, and by way of a third; not at an angle, past a gap, on itself, or moved apart."""
    first, second, third = (
        Part(((0.0, 0.0), (0.1, 0.1))),
        Part(((0.2, 0.2), (0.1, 0.1))),
        Part(((0.2, 0.2), (0.3, 0.3))),
    )
    assert prolonging((first, third, second), SPACING).all()
    np.testing.assert_allclose(line_of((second, first, third), (0, 1, 2)), [(0.3, 0.3), (0.0, 0.0)])
    for other in (
        Part(((0.1, 0.1), (0.2, 0.1))),
        Part(((0.1 + 0.3 * SPACING, 0.1), (0.2, 0.2))),
        Part(((0.1, 0.1), (0.05, 0.05))),
        Part(((0.1, 0.1), (0.2, 0.2)), move=(0.1, 0.0), **GOES),
        Body(((0.1, 0.1), (0.2, 0.2), (0.1, 0.2)), closed=True),
    ):
        np.testing.assert_array_equal(prolonging((first, other), SPACING), np.diag([True, not is_solid(other)]))


def test_water_is_packed_beside_two_plates_that_abut_as_beside_one():
    """Before, the joint was transparent over a smoothing length to either side, and all particles lay elsewhere."""
    water, outline = Water(spacing=0.025, sound_speed=10.0), box(0.4, 0.4)
    ends, joint = ((-0.1, 0.0), (0.05, 0.2)), (-0.04, 0.08)
    whole = packed_beside(outline, 0.25, water, (Body(ends),), outline)
    halves = packed_beside(outline, 0.25, water, (Body((joint, ends[0])), Body((joint, ends[1]))), outline)
    np.testing.assert_allclose(halves.points, whole.points, atol=1e-9)


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


@pytest.mark.slow
def test_plates_that_abut_push_water_as_one_plate_does():
    """Wall particles of both halves lie where those of the whole do. A joint that leaks has a jet of 2 m/s."""
    half = 0.5 * DEPTH
    halves = (
        Part((ACROSS[0], (0.0, half)), move=(0.05, 0.0), **GOES),
        Part(((0.0, half), ACROSS[1]), move=(0.05, 0.0), **GOES),
    )
    found = []
    for plates in ((Part(ACROSS, move=(0.05, 0.0), **GOES), CLEAR), halves):
        run = pushed(*plates)
        run.advance(40)
        found.append((run.snapshot()["water_velocity"][0], run.observe()["part_force"][0, :, 0].sum()))
        run.close()
    (whole, force), (joined, forces) = found
    assert np.abs(whole).max() > 0.5 * SPEED
    np.testing.assert_allclose(joined, whole, atol=1e-6 * SPEED)
    np.testing.assert_allclose(forces, force, rtol=1e-6)
