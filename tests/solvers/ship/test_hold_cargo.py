"""Cargo at its angle of repose in a heeled hold: wedges of a box, fluids, a hold upside down, righting levers."""

from math import atan, cos, pi, radians, sin, tan

import numpy as np
import pytest

from solvers.machine.errors import Unavailable
from solvers.ship.cargo import filling_centre, lean, level_area, relaxed_levers
from solvers.ship.hydrostatics import Loading, metacentric_height, righting_lever, righting_levers
from solvers.ship.section import box
from solvers.ship.water import Water
from tests.oracles.hulls import lopsided

WATER = Water()
BARGE = box(0.34, 0.30)
WIDE, HIGH, DEEP = 0.30, 0.26, 0.10  # m: hold and cargo
HOLD, AREA = box(WIDE, HIGH), WIDE * DEEP
LOADED, CARGO = Loading(1000.0 * 0.34 * 0.11, (0.0, 0.0926)), 20.0


def wedge(angle: float) -> tuple[float, float]:
    """Centre of a box's filling whose surface cuts both walls, deepest to port: b² tan θ/12h, h/2 + b² tan² θ/24h."""
    slope = tan(angle)
    return -(WIDE**2) * slope / (12.0 * DEEP), 0.5 * DEEP + WIDE**2 * slope**2 / (24.0 * DEEP)


def test_cargo_shifts_only_beyond_its_angle_of_repose():
    assert lean(np.radians([0.0, 20.0, 40.0, -20.0, -40.0]), radians(25.0)) == pytest.approx(
        np.radians([0.0, 0.0, 15.0, 0.0, -15.0])
    )


def test_the_shift_of_a_wedge_has_its_closed_form():
    """As long as the surface cuts both walls; beyond that the shift is smaller."""
    until = atan(2.0 * DEEP / WIDE)
    for angle in np.linspace(-0.99, 0.99, 9) * until:
        assert filling_centre(HOLD, AREA, angle) == pytest.approx(wedge(angle), abs=1e-9)
    assert filling_centre(HOLD, AREA, 1.1 * until)[0] > wedge(1.1 * until)[0] + 3e-4


def test_a_filling_on_a_wall_and_on_the_lid():
    assert filling_centre(HOLD, AREA, pi / 2) == pytest.approx((0.5 * (AREA / HIGH - WIDE), 0.5 * HIGH))
    assert filling_centre(HOLD, AREA, pi) == pytest.approx((0.0, HIGH - 0.5 * DEEP))


def test_the_area_of_a_bed_follows_from_the_height_of_its_centre():
    assert level_area(HOLD, 0.5 * DEEP) == pytest.approx(AREA)
    hold = lopsided()
    centre = filling_centre(hold, 0.3 * hold.area, 0.0)
    assert level_area(hold, float(centre[1])) == pytest.approx(0.3 * hold.area)
    for height in (-0.01, 0.5 * HIGH + 0.01):
        with pytest.raises(Unavailable, match="filling"):
            level_area(HOLD, height)


def levers(heels, repose):
    return relaxed_levers(BARGE, LOADED, WATER, heels, [(HOLD, AREA, CARGO)], repose)


def test_righting_levers_with_relaxed_cargo():
    """As for frozen cargo up to the repose; beyond it the wedge moves the centre of gravity to the low side."""
    repose, heels = radians(25.0), np.radians([-40.0, -24.0, 10.0, 25.0, 35.0, 50.0])
    found, frozen = levers(heels, repose), righting_levers(BARGE, LOADED, WATER, heels)
    for heel, ours, without in zip(heels, found, frozen, strict=True):
        y, z = wedge(np.sign(heel) * max(abs(heel) - repose, 0.0))
        moved = y * cos(heel) - (z - 0.5 * DEEP) * sin(heel)
        assert ours == pytest.approx(without + CARGO / LOADED.mass * moved, abs=1e-9)
    assert np.all(np.abs(found[[0, 4, 5]]) < np.abs(frozen[[0, 4, 5]]) - 1e-3)


def test_a_cargo_without_repose_has_the_free_surface_of_a_fluid():
    """The free surface reduces GM by i ρ/M, i = b³/12; cargo that holds any slope is frozen."""
    small = 1e-4
    loss = CARGO / AREA * WIDE**3 / 12.0 / LOADED.mass
    found = levers(np.array([small]), 0.0)[0] / small
    assert found == pytest.approx(metacentric_height(BARGE, LOADED, WATER) - loss, rel=1e-4)
    steep = radians(80.0)
    assert levers(np.array([steep]), pi / 2)[0] == righting_lever(BARGE, LOADED, WATER, steep)
