"""Several tanks in one hull, of different width, depth, thickness and length along the ship; one is empty."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest

from solvers.grains.shapes.given import Shapes
from solvers.ship.body import Body, bolted
from solvers.ship.loads import Floating
from solvers.ship.motion import Radiation, Ship, sail, start
from solvers.ship.section import box
from solvers.ship.vessel import Vessel
from solvers.ship.water import Water
from solvers.ship.waves import regular
from solvers.simulation import Simulation
from solvers.tank.tank import Tank
from tests.oracles.given import scene_of
from tests.oracles.outlines import ellipse
from tests.oracles.scenes import box as tank
from tests.oracles.scenes import material

AXIS, HOLD = (0.0, 0.11), (0.0, 0.02)  # m above the keel
HULL = Body(37.0, (0.004, 0.09), 0.6)
GRAIN = material(young=5e7, friction=0.6, restitution=0.3)
RADIUS, LENGTH, HEEL, RELEASE, LASTS = 0.01, 2.0, 0.006, 0.5, 2.0
SNUG = 0.9999  # of the width that a row of grains needs
PORT, BOARD, VOID = (-0.06, 0.0), (0.08, 0.03), (0.0, 0.15)  # where the tanks stand in the hold, m


def lattice(across: int, deep: int, place: tuple[float, float]) -> np.ndarray:
    """Grains from wall to wall in a triangular lattice, which does not shift at small angles (n, 2) m."""
    rows = [
        (2 * k - across + 1 + row % 2, 1.0 + np.sqrt(3.0) * row) for row in range(deep) for k in range(across - row % 2)
    ]
    return np.add(RADIUS * np.array(rows), place)


def ship() -> Vessel:
    """A barge in calm water, without memory, let go with a heel."""
    water = Water()
    load = Floating(box(0.34, 0.30), water, AXIS, regular(0.0, 4.4, water), np.zeros((1, 3)))
    radiation = Radiation(np.diag([40.0, 52.0, 0.2]), np.diag([20.0, 100.0, 0.05]))
    return Vessel(Ship(HULL, load, radiation, AXIS), HOLD, LENGTH, heel=HEEL, release=RELEASE)


@pytest.fixture(scope="module", params=["per-world", pytest.param("per-band", marks=pytest.mark.slow)])
def laden(request):
    """A simulation of two tanks with grains and one without, its bed settled."""
    wide, narrow = lattice(9, 2, PORT), lattice(5, 4, BOARD)
    tanks = (
        Tank(tank(10.0 * RADIUS * SNUG, 0.12) + BOARD, 0.03, length=0.5),
        Tank(tank(0.1, 0.05) + VOID, 0.02, length=LENGTH),
    )
    position = np.concatenate([wide, narrow])[None] + [0.0, 0.1 * RADIUS]
    scene = scene_of(
        np.full((1, len(position[0])), RADIUS),
        tank(18.0 * RADIUS * SNUG, 0.10) + PORT,
        GRAIN,
        GRAIN,
        tangential="mindlin",
        vessels=[ship()],
        thickness=0.02,
        length=1.5,
        more_tanks=tanks,
        schedule=request.param,
        step=2e-5,
    )
    made = Simulation(scene, position, 2, units=2 if request.param == "per-band" else None)
    made.settle(1e-7, 0.8)
    made.in_first = len(wide)
    yield made
    made.close()


def frozen(run: Simulation) -> Body:
    """The grains of both tanks as one body, per metre of the ship, in the tanks' axes, from their places alone."""
    place = run.snapshot()["position"][0]
    per_metre = np.where(np.arange(len(place)) < run.in_first, 1.5 / LENGTH / 0.02, 0.5 / LENGTH / 0.03)
    one = 4.0 / 3.0 * pi * RADIUS**3 * GRAIN.density
    mass = one * per_metre
    centre = (mass[:, None] * place).sum(axis=0) / mass.sum()
    apart = ((place - centre) ** 2).sum(axis=1)
    return Body(float(mass.sum()), tuple(centre), float((mass * (apart + 0.4 * RADIUS**2)).sum()))


@pytest.mark.slow
def test_a_ship_bears_the_load_of_each_tank(laden):
    """As one body of hull and both tanks' lying grains, each counted by its tank's length and thickness."""
    run, vessel, cargo = laden, laden.scene.vessels[0], frozen(laden)
    assert run.cargo()[0].mass == pytest.approx(cargo.mass)
    aboard = replace(cargo, centre=tuple(np.add(cargo.centre, HOLD)))
    whole = replace(vessel.ship, body=bolted(vessel.ship.body, aboard))
    wanted = sail(whole, start(whole, vessel.heave(aboard, HEEL), HEEL), 0.005, LASTS - RELEASE)
    alone = sail(vessel.ship, start(vessel.ship, vessel.heave(aboard, HEEL), HEEL), 0.005, LASTS - RELEASE)
    time, roll = [], []
    while run.time < LASTS:
        run.advance(500)
        time.append(run.time)
        roll.append(run.observe()["pose"][0, 2])
    later = np.array(time) > RELEASE + 0.01
    told, roll = np.array(time)[later] - RELEASE, np.array(roll)[later]
    expected = np.interp(told, wanted.time, wanted.roll)
    assert roll == pytest.approx(expected, abs=0.004 * np.ptp(expected))
    assert np.abs(np.interp(told, alone.time, alone.roll) - expected).max() > 0.05 * np.ptp(expected)


@pytest.mark.slow
def test_each_tank_bears_its_own_grains(laden):
    """The walls of each tank bear the weight of its grains, those of the empty one none."""
    run = laden
    run.observe()
    run.advance(200)
    run.observe()
    first, second, empty = run.loads()[0]
    one = 4.0 / 3.0 * pi * RADIUS**3 * GRAIN.density * run.scene.gravity
    counts = run.in_first, run.scene.grains.radius.shape[1] - run.in_first
    assert first[1] / one == pytest.approx(-counts[0], rel=0.1)
    assert second[1] / one == pytest.approx(-counts[1], rel=0.1)
    assert not empty.any()


@pytest.mark.slow
def test_outlines_move_alike_in_equal_tanks():
    """An ellipse that falls, bounces and rolls in one tank does the same in another of the hull."""
    falls = np.array([0.003, 3.0 * RADIUS])
    given = Shapes((ellipse(1.3, 1.0 / 1.3),), np.zeros((1, 2), int), np.full((1, 2), 0.4))
    scene = scene_of(
        np.full((1, 2), RADIUS),
        tank(0.1, 0.06) + PORT,
        GRAIN,
        GRAIN,
        tangential="mindlin",
        vessels=[replace(ship(), heel=0.0)],
        thickness=0.02,
        length=1.5,
        more_tanks=(Tank(tank(0.1, 0.06) + BOARD, 0.02, length=1.5),),
        shapes=given,
        step=2e-5,
    )
    run = Simulation(scene, np.stack([falls + PORT, falls + BOARD])[None], 1)
    run.advance(10_000)
    ends, angles = run.snapshot()["position"][0], run.snapshot()["angle"][0]
    run.close()
    assert ends[0, 1] < 0.6 * falls[1] and abs(angles[0] - 0.4) > 0.1  # it has fallen and turned
    np.testing.assert_allclose(ends[1] - BOARD, ends[0] - PORT, atol=1e-9)
    assert angles[1] == pytest.approx(angles[0], abs=1e-6)
