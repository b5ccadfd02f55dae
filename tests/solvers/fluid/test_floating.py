"""Bodies that float for long: Archimedes, a square that rolls to its corner, a swayed tank, a minute, decay of roll."""

from dataclasses import replace

import numpy as np
import pytest

from solvers.fluid.given import DampingZone
from solvers.fluid.terms.damping import rate_of
from solvers.motion.harmonic import Sway
from solvers.ship.potential.memory import retardation
from solvers.ship.potential.radiation import hydrodynamics
from solvers.ship.section import Section
from solvers.ship.water import Water
from solvers.simulation import Simulation
from tests.oracles.floating import DENSITY, afloat, hull, solid
from tests.oracles.water import GRAVITY

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


def test_a_box_stands_for_a_minute_where_it_floats():
    """The box of SPHinXsys, 1 m wide and 700 kg, with its centre of mass so low that it is stable.

    Its draught stays 0.7 m to half a spacing, it goes aside by less than a spacing, and comes to rest.
    """
    run = Simulation(
        solid(afloat(0.7, size=(1.0, 1.0), tank=(3.0, 3.4), depth=2.0, precision="mixed"), 0.25), threads=2
    )
    drawn, found = run.observe()["body_place"][0, 0], []
    try:
        while run.time < 60.0:
            run.advance(round(0.2 / run.dt))
            rows = run.observe()
            found.append(rows["body_place"][0, 0] - drawn)
    finally:
        run.close()
    sway, heave, heel = np.abs(found).max(axis=0)
    assert heave < 0.025 and sway < 0.05 and np.rad2deg(heel) < 0.2
    assert np.abs(rows["body_velocity"][0, 0]).max() < 1e-3


def test_no_water_gets_through_the_walls_of_a_floating_hull_in_a_minute():
    """Walls of one spacing, water within; by count, and she stays where she floats to a spacing."""
    scene = hull(wall=1.0, inside=0.3, precision="mixed")
    mass = DENSITY * (0.6 - 0.3 * 0.9)
    afloat_now = replace(scene.parts[0].free, mass=mass, inertia=mass / 6.0, centre=(0.0, 0.7), release=0.0)
    run = Simulation(replace(scene, parts=(replace(scene.parts[0], free=afloat_now),)), threads=2)

    def within() -> np.ndarray:
        place, body = run.snapshot()["water_position"][0], run.observe()["body_place"][0, 0]
        off = place - body[:2]
        return (np.abs(off[:, 0]) < 0.475) & (off[:, 1] > -0.275)

    try:
        first, drawn = within(), run.observe()["body_place"][0, 0]
        run.advance(round(60.0 / run.dt))
        assert (within() == first).all()
        assert np.abs(run.observe()["body_place"][0, 0] - drawn)[:2].max() < 0.05
    finally:
        run.close()


BREADTH, DRAUGHT, CENTRE, INERTIA, DEPTH, HEEL, HELD = 1.0, 0.4, 0.25, 49.0, 1.2, 0.1, 1.0


def linear_roll(until: float, dt: float = 5e-3) -> tuple[np.ndarray, np.ndarray]:
    """Times (s) and heels (rad) of the box, let go, by Cummins' equation in sway, heave and roll about its centre."""
    half, deck = 0.5 * BREADTH, DRAUGHT
    section = Section(np.array([[-half, -DRAUGHT], [half, -DRAUGHT], [half, deck], [-half, deck]]))
    waves = np.linspace(0.3, 14.0, 50)
    table = hydrodynamics(section, Water(DENSITY, DEPTH, GRAVITY), 0.0, waves, about=(0.0, CENTRE - DRAUGHT), count=80)
    mass = DENSITY * BREADTH * DRAUGHT
    height = 0.5 * DRAUGHT + BREADTH**2 / (12.0 * DRAUGHT) - CENTRE  # GM
    inverse = np.linalg.inv(np.diag([mass, mass, INERTIA]) + table.infinite_added_mass)
    spring = np.diag([0.0, DENSITY * GRAVITY * BREADTH, mass * GRAVITY * height])
    time = np.arange(0.0, until, dt)
    memory = retardation(waves, table.damping, time)
    x, v = np.zeros((len(time), 3)), np.zeros((len(time), 3))
    x[0, 2] = HEEL
    for n in range(len(time) - 1):
        past = np.einsum("tij,tj->i", memory[1 : n + 1], v[n - 1 :: -1][:n]) if n else 0.0
        force = -spring @ x[n] - dt * (past + 0.5 * memory[0] @ v[n])
        v[n + 1] = v[n] + dt * inverse @ force
        x[n + 1] = x[n] + dt * v[n + 1]
    return time, x[:, 2]


def three_periods(time: np.ndarray, heel: np.ndarray) -> float:
    """A third of the time (s) from the first crossing of zero to the seventh."""
    at = np.flatnonzero(np.sign(heel[1:]) != np.sign(heel[:-1]))
    crossed = time[at] - heel[at] * (time[at + 1] - time[at]) / (heel[at + 1] - heel[at])
    return (crossed[6] - crossed[0]) / 3.0


def test_roll_decays_with_the_period_of_linear_radiation():
    """3 % of three periods, between zones that take the waves.

    If the box were broader by 0.1 spacings a side for the water, the period would be 1.2 % shorter; at 0.1 rad the
    righting lever of vertical sides is 0.7 % more than linear, which shortens it by a quarter of a per cent.
    """
    speed = float(Water(DENSITY, DEPTH, GRAVITY).group_speed(2.0 * np.pi / 2.0))
    beaches = tuple(DampingZone(4.0 * side, 8.0 * side, rate_of(4.0, speed)) for side in (-1.0, 1.0))
    given = {"heel": HEEL, "release": HELD, "damping": beaches, "sound_speed": 35.0, "precision": "mixed"}
    scene = solid(afloat(0.5, (BREADTH, 2.0 * DRAUGHT), (16.0, 2.2), DEPTH, place=(0.0, DEPTH), **given), CENTRE)
    body = scene.parts[0]
    run = Simulation(replace(scene, parts=(replace(body, free=replace(body.free, inertia=INERTIA)),)), threads=2)
    found = []
    try:
        run.advance(round(HELD / run.dt))
        while run.time < HELD + 6.8:
            run.advance(round(0.02 / run.dt))
            found.append((run.time - HELD, HEEL + run.observe()["body_place"][0, 0, 2]))
    finally:
        run.close()
    assert three_periods(*np.array(found).T) == pytest.approx(three_periods(*linear_roll(7.0)), rel=0.03)
