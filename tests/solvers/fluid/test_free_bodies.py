"""Bodies that float free, and hulls with rooms and openings. All have one set of kernels."""

import numpy as np
import pytest

from solvers.fluid.bodies.hulls import OPENS
from solvers.simulation import Simulation
from tests.oracles.floating import afloat, hull, momentum, weight
from tests.oracles.water import GRAVITY

HEELED = {"heel": 0.2, "place": (0.05, 0.85), "size": (0.6, 0.4)}  # dropped from above its draught, off the middle


@pytest.fixture(scope="module")
def dropped():
    """A heeled box of half the water's density, as it falls into the water: run, and its state at the start."""
    run = Simulation(afloat(0.5, **HEELED), threads=1)
    yield run, run.state()
    run.close()


@pytest.mark.slow
def test_what_water_loses_bodies_and_tank_gain(dropped):
    """Momentum is kept to 1e-12 of Σ|F|Δt, by the loads of each step; and the load is the one that was solved for."""
    run, start = dropped
    run.restore(start)
    run.advance(1)
    coupling, first, began = run.water.extrapolation.coupling, momentum(run), run.time
    given, pushed, off = np.zeros(2), 0.0, 0.0
    for _ in range(300):
        run.advance(1)
        loads = np.stack([field.to_numpy() for field in run.water.load.instant])[..., :2]  # on the tank, on the box
        forces = loads[:2].sum(axis=1)
        given += run.dt * forces[:, 0]
        pushed += run.dt * np.abs(forces).sum()
        off = max(off, np.abs(forces[:, 1] - coupling.foreseen.to_numpy()[0, 0, :2]).max() / np.abs(forces).sum())
    fell = np.array([0.0, weight(run) * (run.time - began)])
    assert np.abs(momentum(run) - first + given + fell).max() < 1e-12 * pushed
    assert off < 1e-12
    assert abs(run.observe()["body_place"][0, 0, 2]) > 0.05  # rad, else nothing was tried


@pytest.mark.slow
def test_energy_is_kept_between_water_and_body(dropped):
    """Water and body together lose what viscosity, diffusion and wall particles take: 0.1 % of what is exchanged."""
    run, start = dropped
    run.restore(start)
    totals, exchanged, work = [], 0.0, 0.0
    for _ in range(40):
        run.advance(20)
        rows = {name: values[0] for name, values in run.observe().items()}
        taken = rows["water_viscous"] + rows["water_diffusive"] + rows["water_wall_energy"]
        totals.append(rows["water_total"] + rows["body_energy"][0] + taken)
        exchanged, work = exchanged + abs(rows["body_work"][0] - work), rows["body_work"][0]
    assert exchanged > 100.0  # J, else nothing was tried
    assert np.ptp(totals) < 1e-3 * exchanged
    assert abs(rows["body_work"][0] + rows["part_work"][0]) < 1e-3 * exchanged


@pytest.mark.slow
def test_a_run_with_a_body_goes_on_bit_for_bit(dropped):
    """What is restored from the state of a step goes on as the run that was not interrupted."""
    run, start = dropped
    run.restore(start)
    run.advance(60)
    kept = run.state()
    run.advance(60)
    whole = run.state()
    run.restore(kept)
    run.advance(60)
    again = run.state()
    for name, values in whole.items():
        np.testing.assert_array_equal(values, again[name], err_msg=name)


@pytest.mark.slow
def test_a_body_far_lighter_than_what_it_displaces_is_let_go_under_water(dropped):
    """It begins with a = (ρ − ρ_b) S g/(ρ_b S + A), A from 0.5 to 2 times what it displaces, and comes up.

    With the load of the step before it is thrown about in the second step.
    """
    run, _ = dropped
    run.close()
    run, _ = dropped
    run.close()  # kernels are found only by a Taichi without arrays
    light = Simulation(afloat(0.02, size=(0.4, 0.4), place=(0.0, 0.35), release=0.05), threads=1)
    try:
        light.advance(round(0.05 / light.dt))
        held = light.observe()
        assert held["body_place"][0, 0, 1] == pytest.approx(0.35) and held["body_work"][0, 0] == 0.0
        since = light.time
        light.advance(round(0.02 / light.dt))
        speed = light.observe()["body_velocity"][0, 0, 1]
        gain = speed / (light.time - since) / 9.81
        assert 0.98 / (0.02 + 2.0) < gain < 0.98 / (0.02 + 0.5)
        light.advance(round(0.5 / light.dt))
        assert light.observe()["body_place"][0, 0, 1] > 0.7
    finally:
        light.close()


@pytest.fixture(scope="module")
def thin(dropped):
    """A hull with walls of one spacing, water within, and a hole in its side that is covered: run and its state."""
    dropped[0].close()
    run = Simulation(hull(wall=1.0, inside=0.3, hole=0.3, opens=1e9), threads=1)
    yield run, run.state()
    run.close()


@pytest.mark.slow
def test_a_thin_wall_keeps_the_water_on_either_side_apart(thin):
    """The lift is that of hydrostatics to 1 %; the mass within stays, and its level to 0.02 spacings."""
    run, start = thin
    run.restore(start)
    mass, lifts, levels = run.observe()["room_water"][0, 0], [], []
    within = np.abs(run.snapshot()["water_position"][0] - (0.0, 0.6)).max(axis=1) < 0.45
    within &= np.abs(run.snapshot()["water_position"][0][:, 1] - 0.6) < 0.16
    assert mass == pytest.approx(1000.0 * 0.3 * 0.9, rel=2e-3)
    for _ in range(20):
        run.advance(round(0.05 / run.dt))
        rows = run.observe()
        lifts.append(rows["part_force"][0, 0, 1])
        levels.append(2.0 * (run.snapshot()["water_position"][0][within, 1].mean() - 0.45))
    assert rows["room_water"][0, 0] == pytest.approx(mass, rel=1e-9)
    assert np.mean(lifts) == pytest.approx(1000.0 * GRAVITY * (0.6 * 1.0 - 0.3 * 0.9), rel=0.01)
    assert np.mean(levels) == pytest.approx(0.3, abs=0.02 * 0.05)


@pytest.mark.slow
def test_water_flows_in_by_forces_that_are_equal_and_opposite(thin):
    """Open the hole: water enters there alone, by the flow by which the room fills; momentum to 1e-12 of Σ|F|Δt.

    The hole has a wall over against it, on the room's other side.
    """
    run, start = thin
    run.restore(start)
    lines = run.water.bodies.hulls.holes
    covered = lines.to_numpy()
    opened = covered.copy()
    opened[:, OPENS] = 0.0
    lines.from_numpy(opened)
    try:
        run.advance(1)
        weighs = GRAVITY * run.water.particles.read(run.water.particles.mass)[0][0].sum()
        first, began, booked, pushed, flowed = momentum(run), run.time, run.loads() * 0.0, 0.0, 0.0
        before = run.observe()["room_water"][0, 0]
        for _ in range(100):
            run.advance(2)
            rows = run.observe()
            booked = booked + 2 * run.dt * run.loads()
            pushed += 2 * run.dt * np.abs(run.loads()[0, :, :2]).sum()
            flowed += 2 * run.dt * rows["opening_flow"][0, 0]
        lost = momentum(run) - first + booked[0, :, :2].sum(axis=0)
        lost[1] += weighs * (run.time - began)
        assert np.abs(lost).max() < 1e-12 * pushed
        assert flowed > 10.0  # kg
        assert rows["room_water"][0, 0] - before == pytest.approx(flowed, rel=0.1)
    finally:
        lines.from_numpy(covered)
