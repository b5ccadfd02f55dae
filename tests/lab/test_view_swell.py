"""Waves under a hand: they grow and die away softly, and change their length only where there are none."""

import numpy as np
import pytest

from lab.presets import load
from lab.view.controls import offered
from lab.view.swell import CALM, Swell

PIECE = 0.01  # s


@pytest.fixture(scope="module")
def preset():
    return load("ship/barge-3dof").resolved


def follow(swell: Swell, seconds: float) -> np.ndarray:
    """Amplitude, frequency and wave number (k, 3) piece by piece."""
    found = []
    for _ in range(round(seconds / PIECE)):
        vessel = swell.follow(PIECE)
        if vessel is not None:
            waves = vessel.ship.load.waves
            assert waves.amplitude[0].real == pytest.approx(max(swell.now[0], 0.0))
            assert waves.frequency[0] == swell.now[1]
        found.append(swell.now)
    return np.array(found)


def test_a_ship_offers_her_waves_and_no_motion_of_the_tank(preset):
    assert {"wave_amplitude", "wave_frequency", "friction"} <= offered(preset).keys()
    assert not {"tilt", "sway", "gravity"} & offered(preset).keys()


def test_nothing_wanted_the_waves_stay_as_they_are(preset):
    assert Swell(preset).follow(PIECE) is None


def test_waves_grow_softly_to_what_is_wanted(preset):
    swell = Swell(preset)
    swell.wanted["wave_amplitude"] = 0.035
    height = follow(swell, 8.0)[:, 0]
    assert height[0] == pytest.approx(preset.waves.amplitude, abs=1e-4)
    assert np.abs(np.diff(height)).max() < 1e-3
    assert np.all(np.diff(height) >= -1e-12)
    assert height[-1] == pytest.approx(0.035, abs=1e-6)


def test_another_frequency_comes_where_the_old_waves_have_died_away(preset):
    swell = Swell(preset)
    swell.wanted["wave_frequency"] = 6.0
    height, frequency, number = follow(swell, 14.0).T
    change = int(np.flatnonzero(np.diff(frequency))[0])
    assert height[change] < 1.1 * CALM
    assert (frequency[0], frequency[-1]) == (preset.waves.frequency, 6.0)
    assert number[-1] == pytest.approx(6.0**2 / 9.81, rel=1e-6)  # deep water
    assert height[-1] == pytest.approx(preset.waves.amplitude, abs=1e-6)
