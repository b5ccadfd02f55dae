"""Hulls over long times: thin walls, a minute behind closed walls, two rooms that level out."""

from math import sqrt

import numpy as np
import pytest

from solvers.fluid.given import Fluid, Water
from solvers.scene import Scene
from solvers.simulation import Simulation
from solvers.tank.parts import Body, Free, Hull, Opening
from tests.oracles.floating import NEVER, hull, rectangle
from tests.oracles.water import GRAVITY, box, lattice

pytestmark = pytest.mark.slow


@pytest.mark.parametrize("wall", [0.5, 1.0, 2.0, 4.0])
def test_the_lift_and_the_level_within_are_those_of_hydrostatics_however_thin_the_walls(wall):
    """Lift to 1 %, level to 0.02 spacings, and no particle through the wall, by count, in 3 s."""
    run = Simulation(hull(wall=wall, inside=0.3, precision="mixed"), threads=2)
    thick, lifts, levels = 0.05 * wall, [], []
    floor = 0.4 + thick

    def within() -> np.ndarray:
        place = run.snapshot()["water_position"][0]
        return (np.abs(place[:, 0]) < 0.5 - 0.5 * thick) & (place[:, 1] > floor - 0.5 * thick)

    try:
        first, mass = within(), run.observe()["room_water"][0, 0]
        run.advance(round(1.5 / run.dt))
        for _ in range(30):
            run.advance(round(0.05 / run.dt))
            rows = run.observe()
            lifts.append(rows["part_force"][0, 0, 1])
            levels.append(2.0 * (run.snapshot()["water_position"][0][first, 1].mean() - floor))
        assert (within() == first).all()
    finally:
        run.close()
    assert rows["room_water"][0, 0] == pytest.approx(mass, rel=1e-6)
    assert np.mean(lifts) == pytest.approx(1000.0 * GRAVITY * (0.6 - 0.3 * (1.0 - 2.0 * thick)), rel=0.01)
    assert np.mean(levels) == pytest.approx(0.3, abs=0.02 * 0.05)


def two_rooms(spacing: float) -> Scene:
    """Two rooms of a hull, 0.5 m wide, one with water 0.6 m deep, and a door of 50 mm at the foot between them."""
    outer, sound = rectangle((-0.53, 0.1), (0.53, 0.94)), 10.0 * sqrt(2.0 * GRAVITY * 0.6)
    rooms = rectangle((-0.51, 0.12), (-0.01, 0.92)), rectangle((0.01, 0.12), (0.51, 0.92))
    door = Opening(((0.0, 0.12), (0.0, 0.17)), 0.2)
    held = Free(1000.0, 100.0, (0.0, 0.5), NEVER)
    body = Body(outer, closed=True, free=held, hull=Hull(0.02, rooms, (door,)))
    drops = lattice(0.5, 0.6, spacing, sound, left=-0.51)
    drops["position"][..., 1] += 0.12
    water = Water(spacing=spacing, sound_speed=sound)
    return Scene(
        box(1.2, 1.0), matters=(Fluid(water, drops),), parts=(body,), gravity=GRAVITY, thickness=1.0, precision="mixed"
    )


def level_out(
    discharge: float, depth: float = 0.6, door: float = 0.05, width: float = 0.5, left: float = 0.25
) -> float:
    """Time (s) until the levels differ by `left` of the first depth: Q = C_d b √(2 g Δh), into air at first.

    While the lower level is in the door, Δh is from the upper level to its middle or to the water there, what is less.
    """
    upper, lower, time, dt = depth, 0.0, 0.0, 1e-4
    while upper - lower > left * depth:
        flow = discharge * door * sqrt(2.0 * GRAVITY * (upper - max(lower, 0.5 * door)))
        upper, lower, time = upper - dt * flow / width, lower + dt * flow / width, time + dt
    return time


def test_two_rooms_level_out_as_the_formula_says():
    """10 % of the time until a quarter of the difference is left, after which inertia tells, with a C_d of 0.6."""
    run, found = Simulation(two_rooms(0.01), threads=2), []
    try:
        whole = run.observe()["room_water"][0].sum()
        while not found or found[-1][1] > 0.25 * whole:
            assert run.time < 5.0
            run.advance(round(0.02 / run.dt))
            rows = run.observe()
            found.append((run.time - 0.2, -np.diff(rows["room_water"][0])[0]))
    finally:
        run.close()
    assert rows["room_water"][0].sum() == pytest.approx(whole, rel=1e-4)
    assert found[-1][0] == pytest.approx(level_out(0.6), rel=0.1)
