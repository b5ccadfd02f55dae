"""Bodies that float free: momentum, energy, Archimedes, added mass, and going on from a checkpoint."""

import numpy as np
import pytest

from solvers.simulation import Simulation
from tests.oracles.floating import afloat, momentum, weight

HEELED = {"heel": 0.2, "place": (0.05, 0.85), "size": (0.6, 0.4)}  # dropped from above its draught, off the middle


@pytest.fixture(scope="module")
def dropped():
    """A heeled box of half the water's density, as it falls into the water: run, and its state at the start."""
    run = Simulation(afloat(0.5, **HEELED), threads=1)
    yield run, run.state()
    run.close()


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


def test_a_body_far_lighter_than_what_it_displaces_is_let_go_under_water(dropped):
    """It begins with a = (ρ − ρ_b) S g/(ρ_b S + A), A from 0.5 to 2 times what it displaces, and comes up.

    With the load of the step before it is thrown about in the second step.
    """
    run, _ = dropped
    run.close()
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
