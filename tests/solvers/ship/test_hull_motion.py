"""A hull's motion in time: free decay, small waves, energy, order, momentum, turning over, what is refused."""

from dataclasses import replace
from itertools import pairwise
from math import pi

import numpy as np
import pytest

from lab.studies.reproduce.ships.fixed_axis import roll_together
from solvers.machine.errors import BadState, Unavailable
from solvers.ship.body import Body, bolted
from solvers.ship.hydrostatics import Loading, balanced_heave, equilibrium, righting_lever
from solvers.ship.linear import inertia_for_roll, oscillations, require_damped, response
from solvers.ship.loads import Floating, floating_in_waves
from solvers.ship.motion import Radiation, Rig, RollDamping, Ship, frozen_at, remembered, sail, start
from solvers.ship.outcome import roll_limits
from solvers.ship.potential.memory import fit_memory
from solvers.ship.potential.radiation import hydrodynamics
from solvers.ship.section import box
from solvers.ship.water import Water
from solvers.ship.waves import Waves, regular
from tests.oracles.energy import energy_balance, mechanical_energy

WATER = Water()
BREADTH, DRAUGHT = 0.34, 0.11  # m, the barge of Spandonidis (2016), chapter 7
BARGE = box(BREADTH, 0.30)
LOW = box(BREADTH, 0.18)  # as deep in the water
AXIS = (0.0, DRAUGHT)
MASS = WATER.density * BREADTH * DRAUGHT
BODY = Body(MASS, (0.0, 0.0926), 0.6)
NOTHING = Radiation(np.zeros((3, 3)), np.zeros((3, 3)))
LOCKED = (False, False, True)


@pytest.fixture(scope="module")
def table():
    """The barge's, about the middle of its waterline."""
    frequency = np.concatenate([np.linspace(0.1, 12.0, 44), np.linspace(12.5, 30.0, 16)])
    return hydrodynamics(BARGE, WATER, -DRAUGHT, frequency, about=AXIS, count=80)


@pytest.fixture(scope="module")
def memory(table):
    return fit_memory(table, 8)


def floating(table, memory, body=BODY, **more):
    return Ship(body, Floating(BARGE, WATER, AXIS), remembered(table, memory), AXIS, **more)


def period(voyage, mode):
    """Mean time (s) between upward crossings of 0."""
    x, t = voyage.state[:, mode], voyage.time
    up = np.flatnonzero((x[:-1] < 0.0) & (x[1:] >= 0.0))
    return np.diff(t[up] - x[up] / (x[up + 1] - x[up]) * (t[1] - t[0])).mean()


@pytest.mark.parametrize("free", [LOCKED, pytest.param((True, True, True), marks=pytest.mark.slow)])
def test_free_roll_has_the_frequency_its_inertia_was_chosen_for(table, memory, free):
    """The inertia is chosen in the frequency domain; the period is that of Cummins' equation and fixed coefficients."""
    wanted = 4.8
    ship = floating(table, memory, free=free)
    body = inertia_for_roll(ship, BARGE, WATER, -DRAUGHT, table.at([wanted]))
    for radiation in (ship.radiation, frozen_at(table, wanted)):
        ship = replace(ship, body=body, radiation=radiation)
        voyage = sail(ship, start(ship, -DRAUGHT, 0.02), 0.02, 12.0)
        assert period(voyage, 2) == pytest.approx(2.0 * pi / wanted, rel=2e-3)
        assert np.abs(oscillations(ship, start(ship, -DRAUGHT)).imag - wanted).min() < 0.01


def test_heave_period(table, memory):
    """Alone: ω² (M + A(ω)) = ρ g B at its natural frequency, damping of order ζ² apart."""
    ship = floating(table, memory, free=(False, True, False))
    found = oscillations(ship, start(ship, -DRAUGHT))
    frequency = table.frequency
    real = WATER.density * WATER.gravity * BREADTH - frequency**2 * (MASS + table.added_mass[:, 1, 1])
    undamped = frequency[np.flatnonzero(real < 0.0)[0]]
    assert np.abs(np.abs(found) - undamped).min() < 0.15 * undamped


def test_small_waves_have_the_response_of_the_frequency_domain(table, memory):
    """Waves of 2 to 8 rad/s at once, small enough for linear motions, separated over their common period."""
    omega = np.arange(2.0, 8.1, 0.5)
    waves = Waves(np.full(len(omega), 2e-7 + 0j), omega, WATER.wave_number(omega), 10.0)
    load = floating_in_waves(BARGE, WATER, AXIS, waves, table, (-DRAUGHT, 0.0))
    rig = Rig(damping=np.array([40.0, 0.0, 0.0]), spring=np.array([40.0, 0.0, 0.0]))
    ship = floating(table, memory, damping=RollDamping(0.7), rig=rig)
    ship = replace(ship, load=load)
    common = 4.0 * pi
    count = 500
    interval = common / count
    state = start(ship, -DRAUGHT)
    voyage = sail(ship, state, interval, 3 * common)
    time, motion = voyage.time[-count:], voyage.state[-count:, :3] - state[:3]
    found = 2.0 / count * np.exp(1j * omega[:, None] * time) @ motion / waves.amplitude[:, None]
    wanted = response(ship, BARGE, WATER, -DRAUGHT, table.at(omega))
    assert np.abs(found) == pytest.approx(np.abs(wanted), rel=0.01)
    assert np.abs(found - wanted).max(axis=0) == pytest.approx(np.zeros(3), abs=0.01 * np.abs(wanted).max())


@pytest.mark.parametrize("diffraction", [True, False])
def test_small_waves_exert_the_tabulated_forces(table, diffraction):
    """The buoyancy on the wave slope and the rest add up to the excitation, or its Froude–Krylov part."""
    omega, amplitude, rest = 6.0, 1e-6, np.array([0.3, 0.0, 0.0])
    load = floating_in_waves(BARGE, WATER, AXIS, regular(amplitude, omega, WATER), table, (-DRAUGHT, 0.0), diffraction)
    one = table.at([omega])
    wanted = (one.excitation if diffraction else one.froude_krylov)[0] * np.exp(1j * omega**2 / WATER.gravity * 0.3)
    for time in (0.0, 0.2, 0.7):
        force = (load.force(rest, time) - load.still.force(rest, time)) / amplitude
        assert force == pytest.approx((wanted * np.exp(-1j * omega * time)).real, rel=1e-4, abs=1e-4 * abs(wanted[2]))


@pytest.mark.slow
def test_frozen_coefficients_are_exact_at_their_frequency(table):
    omega = 4.5
    load = floating_in_waves(BARGE, WATER, AXIS, regular(1e-6, omega, WATER, 4.0), table, (-DRAUGHT, 0.0))
    ship = Ship(BODY, load, frozen_at(table, omega), AXIS, RollDamping(1.5), free=LOCKED)
    count = 50
    voyage = sail(ship, start(ship, -DRAUGHT), 2.0 * pi / omega / count, 12 * 2.0 * pi / omega)
    found = 2e6 / count * np.exp(1j * omega * voyage.time[-count:]) @ voyage.roll[-count:]
    wanted = response(ship, BARGE, WATER, -DRAUGHT, table.at([omega]))[0, 2]
    assert found == pytest.approx(wanted, abs=2e-3 * abs(wanted))


def test_energy(table, memory):
    """The waves' work is the hull's energy gain, radiation and viscous loss; steady motion radiates ½ Bᵢⱼ ẋᵢ ẋⱼ."""
    omega = 4.5
    load = floating_in_waves(BARGE, WATER, AXIS, regular(0.03, omega, WATER, 2.0), table, (-DRAUGHT, 0.0))
    rig = Rig(damping=np.array([5.0, 0.0, 0.0]), spring=np.array([40.0, 0.0, 0.0]))
    ship = replace(floating(table, memory, damping=RollDamping(0.1, 0.2), rig=rig), load=load)
    count = 60
    voyage = sail(ship, start(ship, -DRAUGHT), 2.0 * pi / omega / count, 10 * 2.0 * pi / omega)
    assert np.abs(voyage.roll).max() > 0.2
    balance = energy_balance(ship, voyage)
    spent = balance.mechanical + balance.radiated + balance.viscous
    assert np.abs(balance.waves - spent).max() < 1e-3 * np.abs(balance.waves).max()
    assert balance.viscous[-1] > 0.05 * balance.waves[-1] and balance.radiated[-1] > 0.1 * balance.waves[-1]
    assert np.diff(balance.viscous).min() > -1e-6 * balance.viscous[-1]


@pytest.mark.slow
def test_radiated_power_of_a_steady_motion_follows_from_the_table(table, memory):
    """In small waves, over a period: ½ Re v* B v, B from the boundary elements."""
    omega = 4.5
    load = floating_in_waves(BARGE, WATER, AXIS, regular(1e-5, omega, WATER, 5.0), table, (-DRAUGHT, 0.0))
    rig = Rig(damping=np.array([30.0, 0.0, 0.0]), spring=np.array([40.0, 0.0, 0.0]))
    ship = replace(floating(table, memory, damping=RollDamping(1.5), rig=rig), load=load)
    count = 50
    voyage = sail(ship, start(ship, -DRAUGHT), 2.0 * pi / omega / count, 15 * 2.0 * pi / omega)
    radiated = energy_balance(ship, voyage).radiated
    velocity = 2.0 / count * np.exp(1j * omega * voyage.time[-count:]) @ voyage.state[-count:, 3:6]
    power = 0.5 * (velocity.conj() @ table.at([omega]).damping[0] @ velocity).real
    assert (radiated[-1] - radiated[-1 - count]) * omega / (2.0 * pi) == pytest.approx(power, rel=0.01)


def test_order_four(table, memory):
    """Errors of heave, sway, roll fall sixteenfold with half the interval."""
    load = floating_in_waves(BARGE, WATER, AXIS, regular(0.01, 4.5, WATER, 2.0), table, (-DRAUGHT, 0.0))
    ship = replace(floating(table, memory, damping=RollDamping(0.3)), load=load)
    ends = [sail(ship, start(ship, -DRAUGHT, 0.1), dt, 1.6).state[-1, :6] for dt in (0.05, 0.025, 0.0125, 0.00625)]
    steps = [np.linalg.norm(a - b) for a, b in pairwise(ends)]
    assert steps[0] / steps[1] == pytest.approx(16.0, rel=0.3)
    assert steps[1] / steps[2] == pytest.approx(16.0, rel=0.2)


def test_momentum_without_water():
    """About a point that is not the centre of gravity: that centre falls freely and the spin stays."""
    ship = Ship(BODY, Floating(BARGE, Water(density=0.0), (0.1, 0.3)), NOTHING, (0.1, 0.3))
    state = start(ship, 0.5, 0.3, np.array([0.4, 0.2, 3.0]))
    voyage = sail(ship, state, 0.01, 2.0)
    lever = np.array([ship.lever(roll) for roll in voyage.roll])
    centre, t = voyage.state[:, :2] + lever, voyage.time
    swing = voyage.state[0, 5] * np.array([-lever[0, 1], lever[0, 0]])
    velocity = voyage.state[0, 3:5] + swing
    path = centre[0] + velocity * t[:, None] - 0.5 * 9.81 * np.column_stack([0.0 * t, t**2])
    assert centre == pytest.approx(path, abs=1e-7)
    assert voyage.state[:, 5] == pytest.approx(np.full(len(t), 3.0), abs=1e-8)


def test_pendulum_on_a_fixed_axis():
    """Dry: 2π √((I + m l²)/(m g l)), and 1 + φ²/16 longer."""
    ship = Ship(BODY, Floating(BARGE, Water(density=0.0), (0.0, 0.4)), NOTHING, (0.0, 0.4), free=LOCKED)
    arm = 0.4 - BODY.centre[1]
    exact = 2.0 * pi * np.sqrt((BODY.inertia + MASS * arm**2) / (MASS * 9.81 * arm)) * (1.0 + 0.1**2 / 16.0)
    voyage = sail(ship, start(ship, 0.0, 0.1), 0.02, 6.0)
    assert period(voyage, 2) == pytest.approx(exact, rel=1e-4)
    assert np.all(voyage.state[:, :2] == voyage.state[0, :2])


def test_roll_through_180_degrees():
    """A hull that turns over again and again: the motion is smooth and its energy is conserved without losses."""
    ship = Ship(BODY, Floating(BARGE, WATER, AXIS), Radiation(np.diag([40.0, 50.0, 0.2]), np.zeros((3, 3))), AXIS)
    heave = balanced_heave(BARGE, BODY.loading, WATER, 2.5)
    voyage = sail(ship, start(ship, heave, 2.5, np.array([0.1, 0.0, 5.0])), 0.004, 1.5)
    assert voyage.roll.max() > pi + 0.5
    energy = np.array([mechanical_energy(ship, state) for state in voyage.state[::20]])
    kinetic = 0.5 * voyage.state[0, 3:6] @ ship.inertia(2.5) @ voyage.state[0, 3:6]
    assert np.ptp(energy) < 1e-4 * kinetic
    assert np.abs(np.diff(voyage.state[:, 3:6], axis=0)).max() < 0.4


def test_run_with_too_long_an_interval_is_stopped(table, memory):
    with pytest.raises(BadState, match="ran away"):
        sail(floating(table, memory), start(floating(table, memory), -DRAUGHT, 0.1), 0.8, 400.0)


def test_a_run_may_begin_at_a_later_time(table, memory):
    """A start one wave period later gives the same motion; half a period later the first force has the other sign."""
    omega = 4.5
    load = floating_in_waves(BARGE, WATER, AXIS, regular(1e-3, omega, WATER), table, (-DRAUGHT, 0.0))
    ship = replace(floating(table, memory), load=load)
    begins = [2.0 * pi / omega * periods for periods in (0.0, 1.0, 0.5)]
    first, same, opposite = (sail(ship, start(ship, -DRAUGHT), 0.02, 0.6, begin=begin) for begin in begins)
    assert same.roll == pytest.approx(first.roll, abs=1e-12) and np.abs(first.roll).max() > 1e-5
    assert opposite.roll == pytest.approx(-first.roll, abs=0.02 * np.abs(first.roll).max())
    assert same.time == pytest.approx(first.time + begins[1])
    limits = (-0.5 * np.abs(first.roll).max(), 0.5 * np.abs(first.roll).max())
    ends = [sail(ship, start(ship, -DRAUGHT), 0.02, 0.6, limits, begin).capsized for begin in begins[:2]]
    assert ends[1] == pytest.approx(ends[0] + begins[1])


def test_ships_rolling_together_move_as_each_one_alone(table):
    """Two waves, two dampings, about the axis; the third ship, undamped in high waves, is lost, the others continue."""
    ships = []
    for omega, amplitude, damping in ((4.5, 0.01, (0.1, 0.2)), (4.7, 0.01, (0.3, 0.0)), (5.4, 0.06, (0.0, 0.0))):
        load = floating_in_waves(BARGE, WATER, AXIS, regular(amplitude, omega, WATER, 2.0), table, (-DRAUGHT, 0.0))
        load = replace(load, excess=load.excess + np.array([0.0, 0.0, 150.0j]))
        ships.append(Ship(BODY, load, frozen_at(table, omega), AXIS, RollDamping(*damping), free=LOCKED))
    time, rolls = roll_together(ships, -DRAUGHT, 0.03, 9.0, 1.0)
    for ship, roll in zip(ships, rolls.T, strict=True):
        alone = sail(ship, start(ship, -DRAUGHT), 0.03, 9.0, (-1.0, 1.0))
        until = len(time) if alone.capsized is None else len(alone.time) - 1
        assert roll[:until] == pytest.approx(alone.roll[:until], abs=1e-12)
        assert np.isnan(roll[until:]).all()
    assert np.abs(rolls[-1, :2]).min() > 0.01 and np.isnan(rolls[-1, 2])


def test_a_memory_that_adds_energy_is_refused(table, memory):
    """The fitted memory passes; one that adds energy at the roll's frequency does not, nor one without roll terms."""
    ship = floating(table, memory, free=LOCKED)
    require_damped(ship, start(ship, -DRAUGHT))
    driving = replace(memory, exit=memory.exit - np.outer([0.0, 0.0, 0.05], memory.entry[:, 2]))
    worse = replace(ship, radiation=remembered(table, driving))
    with pytest.raises(Unavailable, match="drives the hull"):
        require_damped(worse, start(ship, -DRAUGHT))
    require_damped(replace(worse, damping=RollDamping(1.0)), start(ship, -DRAUGHT))


def test_frozen_cargo_is_part_of_the_rigid_body(table, memory):
    """As part of the body, or as a load with its weight and inertial forces."""
    hull, cargo = Body(14.0, (0.01, 0.13), 0.3), Body(MASS - 14.0, (-0.01, 0.06), 0.2)
    whole = bolted(hull, cargo)
    assert whole.mass == pytest.approx(MASS)
    apart = 14.0 * (MASS - 14.0) / MASS * (0.02**2 + 0.07**2)
    assert whole.inertia == pytest.approx(0.5 + apart)
    swapped = bolted(cargo, hull)
    assert (swapped.centre, swapped.inertia) == (pytest.approx(whole.centre), pytest.approx(whole.inertia))


def test_limits_of_roll():
    """Symmetric, at the angle of vanishing stability or the given limit; for a heeled hull its own side is nearer."""
    loading = Loading(MASS, (0.0, 0.11))
    low, high = roll_limits(LOW, loading, WATER)
    assert low == pytest.approx(-high, rel=1e-6) and 0.5 < high < 0.5 * pi
    assert righting_lever(LOW, loading, WATER, high) == pytest.approx(0.0, abs=1e-9)
    assert roll_limits(LOW, loading, WATER, 0.4) == pytest.approx((-0.4, 0.4))
    heeled = roll_limits(LOW, Loading(MASS, (-0.005, 0.11)), WATER)
    assert heeled[0] < low and 0.0 < heeled[1] < high
    assert roll_limits(BARGE, BODY.loading, WATER)[1] == pytest.approx(pi)  # so deep a closed box always rights


def test_limits_of_a_hull_with_a_loll():
    """Outwards from the angle of loll on either side; upright, where the lever is zero, the hull does not capsize."""
    tender = Loading(MASS, (0.0, 0.146))
    loll = equilibrium(LOW, tender, WATER, 0.02)[1]
    low, high = roll_limits(LOW, tender, WATER)
    assert 0.05 < loll < high and low == pytest.approx(-high, rel=1e-6)
