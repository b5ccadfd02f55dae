"""A wave train from a flap: its height, its arrival, and the ratio of wave height to stroke."""

import numpy as np
import pytest

from solvers.ship.potential.flume import Flap, fundamental
from solvers.ship.water import Water

WATER = Water(depth=1.0)
FLAP = Flap(0.9, 7.0, 5.0)
AMPLITUDE, FREQUENCY = 0.012, 5.194
PERIOD = 2.0 * np.pi / FREQUENCY
TRAVEL = FLAP.distance / float(WATER.group_speed(FREQUENCY))


@pytest.fixture(scope="module")
def heights():
    """Times (s) and amplitudes (m) at the model, one per period."""
    waves = FLAP.train(AMPLITUDE, FREQUENCY, WATER, 40.0)
    middle = np.arange(PERIOD, 30.0, 0.5 * PERIOD)
    found = []
    for when in middle:
        time = when + PERIOD * np.linspace(-0.5, 0.5, 200)
        found.append(abs(fundamental(time, waves.elevation(0.0, time), FREQUENCY)))
    return middle, np.array(found)


def test_the_wave_train_arrives_with_the_group_speed(heights):
    """Calm before, half the height when the middle of the ramp arrives, the full height after the ramp."""
    time, found = heights
    assert found[time < 0.5 * TRAVEL].max() < 0.03 * AMPLITUDE
    half = time[np.flatnonzero(found > 0.5 * AMPLITUDE)[0]]
    assert half == pytest.approx(TRAVEL + 2.5 * PERIOD, abs=0.5 * PERIOD)
    steady = (time > TRAVEL + 8.0 * PERIOD) & (time < TRAVEL + 15.0 * PERIOD)
    assert found[steady] == pytest.approx(np.full(steady.sum(), AMPLITUDE), rel=0.03)


def test_a_flap_in_shallow_and_in_deep_water():
    """Galvin (1964): hinged at the bottom of shallow water a/S is kh/2; in deep water it tends to 2 (1 − 1/kl)."""
    flap, slow, fast = Flap(1.0, 7.0, 5.0), np.array([0.1]), np.array([15.0])
    assert flap.transfer(slow, WATER) == pytest.approx(0.5 * WATER.wave_number(slow), rel=0.01)
    assert flap.transfer(fast, WATER) == pytest.approx(2.0 * (1.0 - 1.0 / WATER.wave_number(fast)), rel=1e-3)


def test_fundamental_over_any_window():
    """Amplitude and phase of Re c e^(−iωt) plus a mean, from a window that is not a whole number of periods."""
    time = np.linspace(1.0, 1.0 + 2.3 * PERIOD, 400)
    wave = 0.3 + np.column_stack([2.0 * np.cos(FREQUENCY * time), 3.0 * np.sin(FREQUENCY * time)])
    assert fundamental(time, wave, FREQUENCY) == pytest.approx(np.array([2.0, 3.0j]))
