"""Water that stands level in a ship's rooms: its load at any heel, how she moves with it, and what flows in and out."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

from solvers.fluid.given import Fluid, Water, particles
from solvers.fluid.inflow.inlet import Inlet
from solvers.scene import Scene
from solvers.ship.body import NOTHING, Body, bolted
from solvers.ship.hydrostatics import turned
from solvers.ship.motion import rate, runge_kutta, start
from solvers.simulation import Simulation
from solvers.tank.outline import area_below, cut_off, moments
from solvers.tank.tank import Tank
from tests.oracles.water import GRAVITY, box
from tests.solvers.fluid.test_inflow import ALONG, HIGH, LENGTH, held
from tests.solvers.motion.test_water_aboard import AXIS, BARE, DEEP, HOLD, WIDE, aboard, ship

DENSITY, RESERVE = 1000.0, 5.0  # kg/m³; kg/m, of one of the ships
HOPPER = np.array([[-0.2, 0.05], [-0.1, 0.0], [0.1, 0.0], [0.2, 0.05], [0.2, 0.2], [-0.2, 0.2]])  # m
HOLE = Inlet(((-0.05, 0.0), (0.05, 0.0)), 0, ALONG, 0.5, 0.6)  # in the floor of a room, half as long as that
LAID, STEP = 0.05, 1e-3  # m, of water at the start; s
DEEPEST = 0.15  # m, of the sea over the floor of the ship that fills to its level


def standing(outline: np.ndarray, area: float, turn: float) -> tuple[float, np.ndarray]:
    """Level (m) and centroid (2,) m of an area (m²) of water in a turned room, in the earth's axes from its origin."""
    upright = turned(outline.T, turn)
    depth = brentq(lambda deep: area_below(upright, deep) - area, 1e-6, np.ptp(upright[:, 1]), xtol=1e-14)
    return upright[:, 1].min() + depth, np.array(moments(cut_off(upright, depth))[1])


def hoppers(heels: tuple[float, ...], free: bool) -> Simulation:
    """Ships with water in a hopper, let go with these heels (rad); they stay there unless they are `free`."""
    vessels = [ship(heel=heel) for heel in heels]
    vessels = [replace(one, ship=replace(one.ship, free=(free,) * 3)) for one in vessels]
    scene = aboard(vessels[0], "level", step=STEP)
    drops = np.tile(scene.fluid.particles, (len(heels), 1))
    drops["volume"][3] *= MORE
    scene = scene.holding(replace(scene.fluid, particles=drops), vessels=vessels, outline=HOPPER)
    return Simulation(replace(scene, motions=[()] * len(heels)), threads=1, arch="cpu")


HEELS, MORE = (0.02, -0.02, 0.3, -0.7, 1.2, 1.7), 1.5  # rad; times the water of the others in the fourth


@pytest.fixture(scope="module")
def heeled() -> tuple[dict[str, np.ndarray], np.ndarray, np.ndarray]:
    """Quantities, levels (W,) m and marks (W, n, 2) m at rest at these heels, the last with a side on the sea."""
    run = hoppers(HEELS, False)
    run.advance(round(0.4 / run.dt))
    run.observe()
    run.advance(1)
    found = run.observe(), run.water.level.to_numpy()[:, 0], run.snapshot()["water_position"]
    run.close()
    return found


@pytest.mark.slow
def test_its_weight_is_at_the_centroid_of_a_level_room(heeled):
    """Force, moment, level and centre to rounding, beside polygons whose area is that of the water."""
    found, levels, marks = heeled
    for w, heel in enumerate(HEELS):
        area = WIDE * DEEP * (MORE if w == 3 else 1.0)
        weight, (level, centre) = DENSITY * GRAVITY * area, standing(HOPPER, area, heel)
        assert found["wall_force"][w] == pytest.approx([*turned((0.0, -weight), -heel), -weight * centre[0]], abs=1e-7)
        assert levels[w] == pytest.approx(level, abs=1e-12)
        assert found["water_centre"][w] == pytest.approx(turned(centre, -heel), abs=1e-12)
        assert Tank(HOPPER, 1.0).holds(marks[w]).all()  # as many marks as it starts with, in the water
        assert turned(marks[w].T, heel)[:, 1].max() < level


@pytest.mark.slow
def test_its_surface_takes_the_moment_of_the_closed_form(heeled):
    """Of the width l, between upright walls, at a small heel beyond frozen water: ρ g l³/12 tan φ, to O(φ²)."""
    weight, upright = DENSITY * GRAVITY * WIDE * DEEP, standing(HOPPER, WIDE * DEEP, 0.0)[1]
    for w, heel in enumerate(HEELS[:2]):
        beyond = heeled[0]["wall_force"][w, 2] - weight * upright[1] * np.sin(heel)
        assert beyond == pytest.approx(DENSITY * GRAVITY * WIDE**3 / 12.0 * np.tan(heel), rel=heel**2)


@pytest.mark.slow
def test_she_moves_as_with_a_point_mass_that_stays_at_the_centroid(heeled):
    """In sway, heave and roll, beside her equations of motion with that mass bolted to her anew at each instant.

    In steps of 1 ms the leapfrog's phase is off by (ω Δt)²/24, 2e-5 of a swing of 6 rad/s in the 1.6 s shown.
    """
    run, told = hoppers((0.02, 0.1, 0.0, 0.0, 0.0, 0.0), True), []
    for _ in range(180):
        run.advance(10)
        told.append(run.observe()["pose"][:2])
    run.close()
    mass, found = DENSITY * 0.5 * WIDE * DEEP, np.array(told)
    for w, heel in enumerate((0.02, 0.1)):
        wanted = np.array(list(_sailed(mass, heel, len(found) - 30)))
        size = np.ptp(wanted, axis=0)
        assert (size > heel * np.array([0.01, 1e-3, 1.0])).all()
        assert (np.abs(found[30:, w] - wanted).max(axis=0) < 2e-5 * size).all()


def _sailed(mass: float, heel: float, count: int) -> Iterator[np.ndarray]:
    """Poses of the tank's origin every 10 ms from the second on, by Runge and Kutta's method."""
    whole = ship().ship

    def with_water(roll: float):
        centre = np.add(turned(standing(HOPPER, WIDE * DEEP, roll)[1], -roll), HOLD)
        return replace(whole, body=bolted(BARE, Body(mass, tuple(centre), 0.0)))

    upright = replace(ship(), ship=with_water(0.0))
    state = start(whole, upright.heave(NOTHING, heel), heel)
    for k in range(count):
        state = runge_kutta(lambda at, t: rate(with_water(at[2]), at, t), state, 0.3 + 0.01 * k, 0.01)
        yield state[:3] + np.array([*turned(np.subtract(HOLD, AXIS), state[2]), 0.0])


def flooding() -> Scene:
    """Ships held over the sea with water in a room whose floor has a hole: one fills to the sea's level, one empties,
    one stands so deep that her room is filled, and one is so heavy that she sinks before.
    """
    vessels = [held(keel) for keel in (-DEEPEST, LAID, -1.0, -DEEPEST)]
    body = replace(vessels[3].ship.body, mass=150.0 - RESERVE)
    vessels[3] = replace(vessels[3], ship=replace(vessels[3].ship, body=body))
    spacing = 0.0125
    start = particles(len(vessels), round(WIDE * HIGH / spacing**2))
    start["volume"] = spacing**2
    first = round(WIDE * LAID / spacing**2)
    fluid = Fluid(Water(spacing, 14.0, model="level"), start, waiting=(start.shape[1] - first,), inlets=(HOLE,))
    given = {"outline": box(WIDE, HIGH), "matters": (fluid,), "vessels": vessels, "gravity": GRAVITY}
    return Scene(**given, length=ALONG, thickness=1.0, step=STEP)


@pytest.fixture(scope="module")
def flooded() -> Iterator[tuple[Simulation, list]]:
    """These ships, for 3 s."""
    run, rows = Simulation(flooding(), threads=1, arch="cpu"), []
    for _ in range(60):
        run.advance(round(0.05 / run.dt))
        rows.append(run.observe() | {"time": run.time})
    yield run, rows
    run.close()


# √(H − h) of the head H − h over a hole under water falls evenly, by K a second (Torricelli 1643)
K = HOLE.discharge * HOLE.share * HOLE.width * np.sqrt(2.0 * GRAVITY) / (2.0 * WIDE)
EULER = 2.0 * K**2 * 3.0 * STEP  # m, bound on the error of the level: (dh)″ = 2 K² is constant, over 3 s


def test_a_room_fills_to_the_level_of_the_sea(flooded):
    """By the closed form of a drowned hole, within the error of Euler's steps; then it stands at the sea's level."""
    for row in flooded[1]:
        head = max(np.sqrt(DEEPEST - LAID) - K * row["time"], 0.0) ** 2
        deep = LAID + row["inflow_volume"][0, 0] / (WIDE * ALONG)
        assert deep == pytest.approx(DEEPEST - head, abs=EULER)
    assert flooded[0].water.level.to_numpy()[0, 0] == pytest.approx(DEEPEST, abs=EULER)


def test_a_room_empties_and_is_not_emptied_further(flooded):
    rates = []
    for row in flooded[1]:
        wanted = max(np.sqrt(LAID) - K * row["time"], 0.0) ** 2
        assert LAID + row["inflow_volume"][1, 0] / (WIDE * ALONG) == pytest.approx(wanted, abs=EULER)
        rates.append(row["inflow_rate"][1, 0])
    assert min(rates) < -1e-3 and rates[-1] == 0.0
    assert row["inflow_volume"][1, 0] == pytest.approx(-LAID * WIDE * ALONG, rel=1e-12)
    assert np.isnan(row["water_centre"][1]).all()


def test_a_full_room_takes_no_more(flooded):
    """Its water is a weight in the room's middle, and marks fill it."""
    run, rows = flooded
    assert rows[-1]["inflow_volume"][2, 0] == pytest.approx((HIGH - LAID) * WIDE * ALONG, rel=1e-9)
    assert rows[-1]["inflow_rate"][2, 0] == 0.0
    assert rows[-1]["wall_force"][2] == pytest.approx([0.0, -DENSITY * GRAVITY * WIDE * HIGH, 0.0], rel=1e-9, abs=1e-6)
    marks = run.snapshot()["water_position"][..., 0]
    assert np.isfinite(marks[2]).all() and np.isnan(marks[1]).all()


def test_she_sinks_once_more_has_entered_than_she_can_bear(flooded):
    """At the time of the closed form, to what the error of Euler's steps is worth there."""
    grown = RESERVE * LENGTH / (DENSITY * WIDE * ALONG)  # m, of the level
    before, after = np.sqrt(DEEPEST - LAID), np.sqrt(DEEPEST - LAID - grown)
    sunk = flooded[1][-1]["sunk"]
    assert sunk[3] == pytest.approx((before - after) / K, abs=EULER / (2.0 * K * after) + STEP)
    assert (sunk[:3] == -1.0).all()


def test_a_run_goes_on_bit_for_bit(flooded):
    """While water flows in and out, as one that was not interrupted; and from the start again."""
    run, rows = flooded
    run.start_clock()
    run.place(np.zeros((4, 0, 2)))
    run.advance(300)
    kept = run.state()
    run.advance(200)
    wanted = run.state()
    run.restore(kept)
    run.advance(200)
    found = run.state()
    assert (found["liquid.inflow.entered"] != kept["liquid.inflow.entered"])[:3].all()
    for name, values in wanted.items():
        np.testing.assert_array_equal(found[name], values, err_msg=name)
    again = next(row for row in rows if row["time"] == pytest.approx(0.5))
    assert run.observe()["inflow_volume"] == pytest.approx(again["inflow_volume"], rel=1e-12)
