"""A barge whose cargo slides as one heap: statics, friction work, small rolls, and the source's double counting."""

from dataclasses import replace
from math import atan, cos, pi, radians, sin, tan

import numpy as np
import pytest

from lab.studies.reproduce.ships.sliding_heap import HeapShip, box_heap, roll_with_heap, softening_lever
from solvers.ship.body import Body
from solvers.ship.cargo import relaxed_levers
from solvers.ship.hydrostatics import righting_levers
from solvers.ship.motion import RollDamping
from solvers.ship.section import Section, box
from solvers.ship.water import Water

WIDE, HIGH, DEEP, FLOOR = 0.30, 0.26, 0.111, -0.09  # m: hold, cargo, and the floor above the axis
DRAUGHT, MASS, CARGO, REPOSE, GRAVITY = 0.11, 37.4, 24.0, radians(25.0), 9.81
HEIGHT = 0.05  # m, GM
INERTIA = MASS * GRAVITY * HEIGHT / 4.9**2
HEAP = box_heap(WIDE, HIGH, DEEP, FLOOR, CARGO, REPOSE)
SHIP = HeapShip(MASS * GRAVITY, HEIGHT, softening_lever(HEIGHT, radians(70.0)), INERTIA, GRAVITY, RollDamping(), HEAP)
CENTRE = FLOOR + 0.5 * DEEP  # m, of the level cargo above the axis


def test_a_heap_that_slid_has_the_lever_of_relaxed_cargo():
    """Heeled slowly from upright: the frozen cargo's lever less the heap's moment is that of the clipped fillings."""
    section, water = box(0.34, 0.30), Water()
    loading = Body(MASS, (0.0, 0.0926), 0.0).loading
    heels = np.radians([10.0, 24.0, 30.0, 45.0, 70.0, -45.0])
    # The tank's origin is its floor's middle; so is the filling's, which leaves shifts alone to count.
    hold = Section(box(WIDE, HIGH).outline)
    relaxed = relaxed_levers(section, loading, water, heels, [(hold, WIDE * DEEP, CARGO)], REPOSE)
    moment = SHIP.cargo_moment(np.zeros(len(heels)), heels)
    found = righting_levers(section, loading, water, heels) - moment / (MASS * GRAVITY)
    assert found == pytest.approx(relaxed, abs=2e-6)
    assert np.all(moment[:2] == 0.0) and np.all(moment[2:5] > 0.0) and moment[5] < 0.0


def test_a_cycle_of_sliding_loses_the_work_of_friction():
    """Swung slowly to ± 30 deg with a repose of 25, the surface goes to ± 5 deg and back: a loop of play.

    What is lost is what the centre falls by while it slides there and back: by b² tan θ/12h along the deck and
    b² tan² θ/24h up, θ the lean, with the ship at θ + repose.
    """
    until, lean = radians(30.0), radians(5.0)
    rolls = until * np.sin(2.0 * pi * np.linspace(0.0, 2.0, 8001))
    at, moments = np.zeros(1), []
    for roll in rolls:
        at = HEAP.slid(at, np.array([roll]))
        moments.append(SHIP.cargo_moment(at, np.array([roll]))[0])
    turn = np.array(moments[4000:])
    lost = -float((0.5 * (turn[1:] + turn[:-1]) * np.diff(rolls[4000:])).sum())
    theta = np.linspace(-lean, lean, 2001)
    slope = WIDE**2 / (12.0 * DEEP) / np.cos(theta) ** 2  # of the shift by θ; up it is times tan θ
    fall = slope * (np.sin(theta + REPOSE) - np.tan(theta) * np.cos(theta + REPOSE))
    once = CARGO * GRAVITY * float((0.5 * (fall[1:] + fall[:-1]) * np.diff(theta)).sum())
    assert lost == pytest.approx(2.0 * once, rel=2e-3)


def test_closed_forms_of_a_wedge():
    """While the surface cuts both walls; also height and inertia of the level cargo about the axis."""
    assert HEAP.height == pytest.approx(CENTRE, abs=1e-9)
    assert HEAP.inertia == pytest.approx(CARGO * ((WIDE**2 + DEEP**2) / 12.0 + CENTRE**2))
    lean = 0.8 * atan(2.0 * DEEP / WIDE)
    shift = -(WIDE**2) * tan(lean) / (12.0 * DEEP), CENTRE + WIDE**2 * tan(lean) ** 2 / (24.0 * DEEP)
    wanted = cos(0.3) * shift[0] - sin(0.3) * shift[1]
    assert HEAP.arm(np.array([lean]), np.array([0.3]))[0] == pytest.approx(wanted, abs=3e-6)  # a table of half degrees


def steady(ship, amplitude, frequency):
    """Half the range (rad) of the last ten periods, after forty."""
    period = 2.0 * pi / frequency
    time, rolls = roll_with_heap(ship, np.array([amplitude]), np.array([frequency]), period / 80, 50 * period, 1.5, 5.0)
    return 0.5 * np.ptp(rolls[time > time[-1] - 10 * period, 0])


@pytest.mark.parametrize("twice", [False, True])
def test_small_rolls_are_those_of_a_linear_ship(twice):
    """|φ| = W GM A k/|K − ω² I − iωB|; twice, K gains m g times the depth of the cargo's centre, I its inertia."""
    omega, amplitude, linear = 4.4, 1e-4, 0.3
    ship = replace(SHIP, damping=RollDamping(linear), twice=twice)
    spring, inertia = MASS * GRAVITY * HEIGHT, INERTIA
    if twice:
        spring, inertia = spring - CARGO * GRAVITY * CENTRE, inertia + HEAP.inertia
    assert ship.natural_frequency == pytest.approx(np.sqrt(spring / inertia), rel=1e-6)
    wanted = (
        MASS
        * GRAVITY
        * HEIGHT
        * amplitude
        * omega**2
        / GRAVITY
        / abs(spring - omega**2 * inertia - 1j * omega * linear)
    )
    assert steady(ship, amplitude, omega) == pytest.approx(wanted, rel=2e-3)


def test_a_softening_lever_moves_the_resonance_to_lower_frequencies():
    """Free from 36 deg: ω² = ω₀² (1 − ¾ (a/φ_v)²) to first order, 4.4 rad/s of 4.9 where it vanishes at 70 deg."""
    largest = radians(36.0)
    ship = replace(SHIP, heap=None)
    state, step, crossed = np.array([largest, 0.0]), 0.002, []
    for k in range(3000):
        middle = state + 0.5 * step * np.array([state[1], ship.acceleration(state[:1], state[1:], 0.0, 0.0)[0]])
        after = state + step * np.array([middle[1], ship.acceleration(middle[:1], middle[1:], 0.0, 0.0)[0]])
        if state[0] > 0.0 >= after[0]:
            crossed.append(k * step)
        state = after
    found = 2.0 * pi / np.diff(crossed).mean()
    assert found == pytest.approx(4.9 * np.sqrt(1.0 - 0.75 * (36.0 / 70.0) ** 2), rel=0.01)


def test_a_lost_ship_is_nan_and_the_others_continue():
    waves = np.array([0.005, 0.2]), np.array([4.6, 4.6])
    _, rolls = roll_with_heap(SHIP, *waves, 0.02, 30.0, 0.5 * pi)
    assert np.isfinite(rolls[:, 0]).all() and np.isnan(rolls[-1, 1])
    _, alone = roll_with_heap(SHIP, waves[0][:1], waves[1][:1], 0.02, 30.0, 0.5 * pi)
    assert rolls[:, 0] == pytest.approx(alone[:, 0], abs=1e-12)
