"""Shallow water in a rolling tank: bores, hydrostatics and forced waves against closed forms."""

import numpy as np
import pytest
from scipy.optimize import brentq

from lab.studies.reproduce.water.theory.shallow_water import ShallowTank
from lab.studies.verify.water.bore import Jump

WIDTH, DEPTH, ABOVE, GRAVITY = 0.9, 0.092, 0.47, 9.81
UPRIGHT = np.zeros(3)


def test_a_dam_breaks_into_a_bore_over_water():
    """Stoker (1957), Water Waves, sec. 10.8: the depth between bore and fan, and how far the bore has come."""
    high, low = 0.2, 0.05

    def missing(middle: float) -> float:
        fan = 2.0 * (np.sqrt(GRAVITY * high) - np.sqrt(GRAVITY * middle))
        return fan - (middle - low) * np.sqrt(0.5 * GRAVITY * (1.0 / middle + 1.0 / low))

    middle = brentq(missing, low, high)
    bore = middle * 2.0 * (np.sqrt(GRAVITY * high) - np.sqrt(GRAVITY * middle)) / (middle - low)
    tank, time = ShallowTank(2.0, high, ABOVE, GRAVITY, 800), 0.0
    state = np.array([np.where(tank.places < 0.0, high, low), np.zeros(800)])
    while time < 0.4:
        state, step = tank.stepped(state, UPRIGHT, lambda _: UPRIGHT)
        time += step
    between = (tank.places > 0.35 * bore * time) & (tank.places < 0.9 * bore * time)
    assert state[0, between] == pytest.approx(middle, rel=2e-3)
    assert tank.places[np.argmin(np.abs(state[0] - 0.5 * (middle + low)))] == pytest.approx(bore * time, abs=tank.cell)
    assert state[0].sum() * tank.cell == pytest.approx(high + low, rel=1e-12)  # two halves of one metre


def test_water_at_rest_in_a_heeled_tank_weighs_on_it():
    """The weight of the prism times the way of its centroid from the axle; the water stays at rest."""
    heel, tank = np.radians(4.0), ShallowTank(WIDTH, DEPTH, ABOVE, GRAVITY, 300)
    deep = DEPTH - tank.places * np.tan(heel)
    state, held = np.array([deep, np.zeros(300)]), np.array([heel, 0.0, 0.0])
    area, slope = WIDTH * DEPTH, np.tan(heel)
    across, up = -slope * WIDTH**3 / 12.0 / area, 0.5 * (DEPTH**2 * WIDTH + slope**2 * WIDTH**3 / 12.0) / area
    expected = -GRAVITY * area * (across * np.cos(heel) - (up - ABOVE) * np.sin(heel))
    assert tank.moment(held, state) == pytest.approx(expected, rel=1e-4)
    assert np.abs(tank.rates(held, state)[0]).max() < 1e-12  # m²/s²


def test_water_at_rest_presses_on_the_wall_by_its_depth_over_the_height():
    tank = ShallowTank(WIDTH, DEPTH, ABOVE, GRAVITY, 60)
    assert tank.wall_pressure(UPRIGHT, tank.rest(), 0.03) == pytest.approx(GRAVITY * (DEPTH - 0.03))
    assert tank.wall_pressure(UPRIGHT, tank.rest(), 0.1) == 0.0
    times, pressures = tank.followed(lambda time, order: 0.0, 0.1, lambda now, state: state[0].mean())
    assert times[0] == 0.0 and 0.0 < 0.1 - times[-1] < 0.01 and pressures == pytest.approx(DEPTH)


@pytest.mark.parametrize("frequency", [1.6, 5.2])  # rad/s, below and above the first mode's 3.3
def test_low_waves_in_a_tank_that_rolls_are_those_of_linear_theory(frequency):
    """η = E sin kx sin ωt with ω = k √(g D) and E = −φ₀ (g − ω² d) D k/(ω² cos ½ k b), from its own state on."""
    low, number = 1e-4, frequency / np.sqrt(GRAVITY * DEPTH)
    crest = -low * (GRAVITY - frequency**2 * ABOVE) * DEPTH * number / frequency**2 / np.cos(0.5 * number * WIDTH)

    def roll(time: float) -> np.ndarray:
        return low * np.sin(frequency * time + np.array([0.0, 0.5, 1.0]) * np.pi) * frequency ** np.arange(3)

    errors = []
    for cells in (60, 120):
        tank, time, worst = ShallowTank(WIDTH, DEPTH, ABOVE, GRAVITY, cells), 0.0, 0.0
        speed = frequency * crest / (DEPTH * number) * (np.cos(number * tank.places) - np.cos(0.5 * number * WIDTH))
        state = np.array([np.full(cells, DEPTH), DEPTH * speed])
        while time < 2.0 * np.pi / frequency:
            now = time
            state, step = tank.stepped(state, roll(now), lambda step, now=now: roll(now + step))
            time += step
            exact = crest * np.sin(number * tank.places) * np.sin(frequency * time)
            worst = max(worst, np.abs(state[0] - DEPTH - exact).max())
        errors.append(worst / np.abs(crest * np.sin(0.5 * number * WIDTH)))
    assert errors[1] < 2e-3 and errors[1] < 0.4 * errors[0]  # of second order, but for the limiter's crests


def test_water_that_rolls_slowly_follows_without_damping():
    tank, low, frequency = ShallowTank(WIDTH, DEPTH, ABOVE, GRAVITY, 60), 1e-3, 0.3

    def roll(time, order):
        ramp = low * np.array([1 - np.cos(frequency * time), frequency * np.sin(frequency * time)])
        return ramp[order] if order < 2 else low * frequency**2 * np.cos(frequency * time)

    times, moments = tank.moments(roll, 2.0 * np.pi / frequency)
    rate, angle = np.array([roll(times, 1), roll(times, 0)])
    stiff = GRAVITY * WIDTH * (WIDTH**2 / 12.0 - DEPTH * (ABOVE - 0.5 * DEPTH))  # of the weight, over ρ and length
    assert moments == pytest.approx(stiff * angle, abs=0.05 * np.abs(stiff * angle).max())
    assert abs(np.trapezoid(moments * rate, times)) < 0.01 * np.abs(stiff * angle).max() * low


def test_water_without_bores_keeps_the_energy_that_its_walls_give():
    """The sum of kinetic and potential energy over the earth gains −M φ̇, but for what finite volumes lose."""
    low, frequency, cells = 5e-3, 2.0, 150
    tank, time, given, exchanged = ShallowTank(WIDTH, DEPTH, ABOVE, GRAVITY, cells), 0.0, 0.0, 0.0

    def roll(time: float) -> np.ndarray:
        angle = 1.0 - np.cos(frequency * time), frequency * np.sin(frequency * time)
        return low * np.array([*angle, frequency**2 * np.cos(frequency * time)])

    state = tank.rest()
    start = tank.energy(roll(0.0), state)
    while time < 1.2:
        now, power = time, -tank.moment(roll(time), state) * roll(time)[1]
        state, step = tank.stepped(state, roll(now), lambda step, now=now: roll(now + step))
        time += step
        mean = 0.5 * (power - tank.moment(roll(time), state) * roll(time)[1])
        given, exchanged = given + step * mean, exchanged + step * abs(mean)
    assert tank.energy(roll(time), state) - start == pytest.approx(given, abs=5e-3 * exchanged)


def test_a_bore_loses_the_energy_of_the_jump_relations():
    """A stream against a wall, long after the start; its far end thins out without a loss (a simple wave)."""
    jump, time, energies = Jump(0.1, 0.25), 0.0, []
    tank = ShallowTank(6.0, jump.before, 0.0, GRAVITY, 600)
    state = np.array([np.full(600, jump.before), np.full(600, -jump.stream * jump.before)])
    while time < 1.0:
        energies.append((time, tank.energy(UPRIGHT, state)))
        state, step = tank.stepped(state, UPRIGHT, lambda _: UPRIGHT)
        time += step
    time, energy = np.array(energies).T
    late = time > 0.5
    assert -1000.0 * np.polyfit(time[late], energy[late], 1)[0] == pytest.approx(jump.loss, rel=0.02)
    assert state[0, 10:50] == pytest.approx(jump.after, rel=2e-3)
