"""Steered waves: they grow and decay smoothly, and change their frequency only in calm water."""

from dataclasses import replace

import numpy as np
import pytest

from lab.assembly.ship import make_water, make_waves
from lab.paint.sea import Sea
from lab.preset.find import load
from lab.view.panel.controls import offered
from lab.view.panel.sea_controls import CALM, RandomSea, RegularSea, sea_controls_of

PIECE = 0.01  # s


@pytest.fixture(scope="module")
def preset():
    return load("ship/barge-3dof").resolved


def follow(sea_controls: RegularSea, seconds: float) -> np.ndarray:
    """Amplitude, frequency and wave number (k, 3) piece by piece."""
    found = []
    for _ in range(round(seconds / PIECE)):
        vessel = sea_controls.follow(PIECE)
        if vessel is not None:
            waves = vessel.ship.load.waves
            assert waves.amplitude[0].real == pytest.approx(max(sea_controls.now[0], 0.0))
            assert waves.frequency[0] == sea_controls.now[1]
        found.append(sea_controls.now)
    return np.array(found)


def test_a_ship_offers_her_waves_and_no_motion_of_the_tank(preset):
    assert {"wave_amplitude", "wave_frequency", "friction"} <= offered(preset).keys()
    assert not {"tilt", "sway", "gravity"} & offered(preset).keys()


def test_without_settings_the_waves_stay_unchanged(preset):
    assert RegularSea(preset).follow(PIECE) is None


def test_waves_grow_smoothly_to_the_setting(preset):
    sea_controls = RegularSea(preset)
    sea_controls.wanted["wave_amplitude"] = 0.035
    height = follow(sea_controls, 8.0)[:, 0]
    assert height[0] == pytest.approx(preset.waves.amplitude, abs=1e-4)
    assert np.abs(np.diff(height)).max() < 1e-3
    assert np.all(np.diff(height) >= -1e-12)
    assert height[-1] == pytest.approx(0.035, abs=1e-6)


def test_a_new_frequency_acts_after_the_old_waves_have_decayed(preset):
    sea_controls = RegularSea(preset)
    sea_controls.wanted["wave_frequency"] = 6.0
    height, frequency, number = follow(sea_controls, 14.0).T
    change = int(np.flatnonzero(np.diff(frequency))[0])
    assert height[change] < 1.1 * CALM
    assert (frequency[0], frequency[-1]) == (preset.waves.frequency, 6.0)
    assert number[-1] == pytest.approx(6.0**2 / 9.81, rel=1e-6)  # deep water
    assert height[-1] == pytest.approx(preset.waves.amplitude, abs=1e-6)


@pytest.fixture(scope="module")
def at_sea():
    return load("ship/irregular-sea").resolved


def test_a_random_sea_offers_its_height_and_calm_water_nothing(at_sea):
    waves = {name for name in offered(at_sea) if name.startswith("wave_")}
    assert waves == {"wave_height"}
    assert sea_controls_of(replace(at_sea, waves=None)) is None


def test_all_components_of_a_random_sea_grow_smoothly_in_proportion(at_sea):
    sea_controls, given = RandomSea(at_sea), make_waves(at_sea.waves, make_water(at_sea.sea, 9.81))
    assert sea_controls.follow(PIECE) is None
    sea_controls.wanted["wave_height"] = 2.0 * at_sea.waves.height
    found = [sea_controls.follow(PIECE) for _ in range(round(12.0 / PIECE))]
    assert found[-1] is None
    seas = [vessel.ship.load.waves for vessel in found if vessel]
    grown = np.array([np.abs(sea.amplitude).sum() for sea in seas]) / np.abs(given.amplitude).sum()
    assert np.all(np.diff(grown) >= 0.0)
    assert np.diff(grown, prepend=1.0).max() < 0.02
    assert seas[-1].amplitude == pytest.approx(2.0 * given.amplitude, rel=1e-5)
    assert np.array_equal(seas[-1].frequency, given.frequency)


@pytest.mark.parametrize(("name", "wanted"), [("at_sea", "wave_height"), ("preset", "wave_amplitude")])
def test_the_sea_that_is_painted_is_the_one_that_the_ship_meets(name, wanted, request):
    given = request.getfixturevalue(name)
    sea_controls = sea_controls_of(given)
    sea_controls.wanted[wanted] *= 0.5
    vessel = [sea_controls.follow(PIECE) for _ in range(20)][-1]
    painted, place = Sea(given), np.linspace(-1.0, 1.0, 7)
    painted.waves = sea_controls.now
    assert painted.elevation(place, 9.0) == pytest.approx(vessel.ship.load.waves.elevation(place, np.full(7, 9.0)))
