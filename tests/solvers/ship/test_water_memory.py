"""Retardation and its linear system: Ogilvie's relations both ways, a known system, Cummins' equation stepped."""

import numpy as np
import pytest

from solvers.ship.hydrostatics import Loading, stiffness
from solvers.ship.potential.memory import fit_memory, retardation
from solvers.ship.potential.radiation import Hydrodynamics, hydrodynamics
from solvers.ship.section import box
from solvers.ship.water import Water
from tests.oracles.hulls import lopsided

WATER = Water()
BREADTH, DRAUGHT = 0.34, 0.11
BARGE = box(BREADTH, 0.30)
CENTRE = (0.0, 0.10)
FREQUENCIES = np.concatenate([np.linspace(0.1, 15.0, 70), np.linspace(15.5, 30.0, 20)])


@pytest.fixture(scope="module")
def barge():
    """The barge's table about its centre of gravity."""
    return hydrodynamics(BARGE, WATER, -DRAUGHT, FREQUENCIES, about=CENTRE, count=60)


def scale_of(table):
    """√(a_ii a_jj) (3, 3) of the diagonal's largest values."""
    diagonal = np.abs(np.diagonal(table, axis1=1, axis2=2)).max(axis=0)
    return np.sqrt(np.outer(diagonal, diagonal))


def test_retardation_of_a_known_function():
    """K = e^(−at) (1 − at) has K̂ = iω/(a + iω)², B = 2aω²/(a² + ω²)²."""
    a, frequency, time = 3.0, np.linspace(0.01, 300.0, 6000), np.linspace(0.0, 5.0, 60)
    damping = 2.0 * a * frequency**2 / (a**2 + frequency**2) ** 2
    found = retardation(frequency, damping[:, None, None] * np.eye(3), time)
    assert found[:, 1, 1] == pytest.approx(np.exp(-a * time) * (1.0 - a * time), abs=7e-3)
    assert found[5:, 1, 1] == pytest.approx((np.exp(-a * time) * (1.0 - a * time))[5:], abs=1e-4)
    assert np.all(found[:, 0, 1] == 0.0)


def test_ogilvies_relations_both_ways(barge):
    """K, computed from B alone, gives B again, and A(ω) with the independently computed A_∞."""
    time = np.linspace(0.0, 40.0, 6001)
    memory = retardation(barge.frequency, barge.damping, time)
    every = slice(7, 70, 8)
    omega = barge.frequency[every, None]
    step = time[1] * np.ones_like(time)
    step[[0, -1]] *= 0.5
    cosine, sine = np.cos(omega * time) * step, np.sin(omega * time) * step
    damping = np.einsum("nt,tij->nij", cosine, memory)
    infinite = barge.added_mass[every] + np.einsum("nt,tij->nij", sine, memory) / omega[:, None]
    assert np.all(np.abs(damping - barge.damping[every]) < 5e-3 * scale_of(barge.damping))
    error = np.abs(infinite - barge.infinite_added_mass)
    assert np.all(error < 0.02 * scale_of(barge.added_mass))


def synthetic():
    """A table of a known, passive memory and its K̂: two resonances shared by sway and roll, one of heave alone."""
    frequency = np.linspace(0.1, 20.0, 80)
    s = 1j * frequency
    first, second = s / (s**2 + 4.0 * s + 25.0), s / (s**2 + 6.0 * s + 64.0)
    heave = s / (s**2 + 3.0 * s + 9.0)
    shape_1, shape_2 = np.outer([2.0, 0.0, 0.5], [2.0, 0.0, 0.5]), np.outer([1.0, 0.0, -0.4], [1.0, 0.0, -0.4])
    transfer = first[:, None, None] * shape_1 + second[:, None, None] * shape_2
    transfer[:, 1, 1] = 5.0 * heave
    infinite = np.diag([3.0, 4.0, 1.0])
    added = infinite + transfer.imag / frequency[:, None, None]
    return Hydrodynamics(frequency, added, transfer.real, None, None, None, infinite), transfer


def test_a_known_memory_is_recovered():
    table, transfer = synthetic()
    system = fit_memory(table, 4)
    assert system.transfer(table.frequency) == pytest.approx(transfer, abs=1e-6)
    assert system.error.max() < 1e-6


@pytest.mark.parametrize("order", [6, 8, 11])
def test_system_of_the_barge(barge, order):
    """Stable, without a force at ω = 0, symmetric, heave on its own, and nearly passive."""
    system = fit_memory(barge, order)
    assert system.matrix.shape == (3 * order, 3 * order)
    assert np.linalg.eigvals(system.matrix).real.max() < 0.0
    transfer = system.transfer(np.linspace(0.0, 40.0, 50))
    size = scale_of(transfer)
    assert np.abs(transfer[0] / size).max() < 1e-9
    assert np.abs((transfer - transfer.transpose(0, 2, 1)) / size).max() < 1e-9
    assert np.all(transfer[:, 1, [0, 2]] == 0.0)
    assert np.diagonal(system.error).max() < {6: 0.03, 8: 0.01, 11: 0.01}[order]
    assert system.least_damping > -0.03


def test_system_has_the_barges_retardation(barge):
    """In the time domain: two routes from the table to K, except at the shortest times the table cannot resolve."""
    time = np.linspace(0.1, 4.0, 79)
    wanted, found = retardation(barge.frequency, barge.damping, time), fit_memory(barge, 8).retardation(time)
    error = np.abs(wanted - found).max(axis=0)
    assert np.all(error < 0.03 * scale_of(wanted))


@pytest.mark.slow
def test_modes_of_an_asymmetric_hull_share_their_poles():
    table = hydrodynamics(lopsided(), WATER, -0.1, np.linspace(0.2, 20.0, 50), about=(0.01, 0.12), count=50)
    system = fit_memory(table, 8)
    assert np.all(system.transfer(np.array([5.0]))[0] != 0.0)
    assert system.error.max() < 0.03


def test_cummins_equation_has_the_response_of_the_frequency_domain(barge):
    """RK4 over Cummins' equation with the system against (−ω²(M + A) − iωB + C) x = X, BEM's coefficients: 1 %."""
    mass = WATER.density * BREADTH * DRAUGHT
    inertia = np.diag([mass, mass, mass * 0.13**2])
    spring = stiffness(BARGE, Loading(mass, CENTRE), WATER, -DRAUGHT, 0.0) + np.diag([60.0, 0.0, 0.0])
    viscous = np.diag([5.0, 5.0, 0.3])
    system = fit_memory(barge, 8)
    for omega in (2.5, 4.6):
        one = barge.at([omega])
        impedance = -(omega**2) * (inertia + one.added_mass[0]) - 1j * omega * (one.damping[0] + viscous) + spring
        wanted = np.linalg.solve(impedance, one.excitation[0])
        found = steady_motion(inertia + barge.infinite_added_mass, viscous, spring, system, omega, one.excitation[0])
        assert np.abs(found - wanted) == pytest.approx(np.zeros(3), abs=0.01 * np.abs(wanted).max())
        assert np.abs(found) == pytest.approx(np.abs(wanted), rel=0.01)


def steady_motion(inertia, viscous, spring, system, omega, force):
    """Complex amplitudes (3,) after the transient, by least squares over the last of many cycles."""
    states = len(system.matrix)
    inverse = np.linalg.inv(inertia)
    flow = np.zeros((6 + states, 6 + states))
    flow[:3, 3:6] = np.eye(3)
    flow[3:6, :3], flow[3:6, 3:6], flow[3:6, 6:] = -inverse @ spring, -inverse @ viscous, -inverse @ system.exit
    flow[6:, 3:6], flow[6:, 6:] = system.entry, system.matrix
    steps = 60
    step = 2.0 * np.pi / omega / steps
    drive = np.zeros(6 + states, complex)
    drive[3:6] = inverse @ force

    def rate(state, time):
        return flow @ state + (drive * np.exp(-1j * omega * time)).real * min(1.0, time / 10.0)

    state, last = np.zeros(6 + states), []
    cycles = int(max(60.0, 25.0 * omega))
    for k in range(cycles * steps):
        t = k * step
        if k >= (cycles - 1) * steps:
            last.append((t, *state[:3]))
        first = rate(state, t)
        second = rate(state + 0.5 * step * first, t + 0.5 * step)
        third = rate(state + 0.5 * step * second, t + 0.5 * step)
        fourth = rate(state + step * third, t + step)
        state = state + step / 6.0 * (first + 2.0 * second + 2.0 * third + fourth)
    last = np.array(last)
    return 2.0 * np.exp(1j * omega * last[:, 0]) @ last[:, 1:] / steps


def test_memory_in_water_of_finite_depth():
    """Slow heave radiates long waves, K̂(0) = ρ b² √(g h)/2h: a piston in shallow water on each of two sides."""
    depth, water = 1.0, Water(depth=1.0)
    table = hydrodynamics(box(0.4, 0.3), water, -0.2, np.linspace(0.4, 24.0, 40), about=(0.0, 0.1), count=40)
    memory = fit_memory(table, 8, deep=False)
    assert memory.error.max() < 0.01
    piston = water.density * 0.4**2 * np.sqrt(9.81 * depth) / (2.0 * depth)
    assert memory.transfer(np.zeros(1))[0, 1, 1].real == pytest.approx(piston, rel=0.05)
    assert fit_memory(table, 8).error.max() > 10.0 * memory.error.max()
