"""Waves: dispersion, the sums, spectra and their statistics, scaling."""

from math import inf, pi

import numpy as np
import pytest
from scipy.integrate import quad

from solvers.ship.water import Water
from solvers.ship.waves import froude_factors, jonswap, packet, pierson_moskowitz, random_sea, regular, soft_start

WATER = Water()
FREQUENCIES = np.geomspace(1e-3, 100.0, 60)


@pytest.mark.parametrize("depth", [inf, 100.0, 1.0, 0.1])
def test_dispersion(depth):
    water = Water(depth=depth)
    k = water.wave_number(FREQUENCIES)
    assert water.gravity * k * np.tanh(k * depth) == pytest.approx(FREQUENCIES**2, rel=1e-12, abs=0.0)
    step = 1e-4
    slope = (
        2.0
        * step
        * FREQUENCIES
        / (water.wave_number((1 + step) * FREQUENCIES) - water.wave_number((1 - step) * FREQUENCIES))
    )
    assert water.group_speed(FREQUENCIES) == pytest.approx(slope, rel=1e-6)
    assert water.wave_number(0.0) == 0.0


def test_long_waves_travel_with_the_root_of_depth():
    water = Water(depth=0.4)
    assert water.group_speed(0.01) == pytest.approx(np.sqrt(water.gravity * 0.4), rel=1e-5)


def test_regular_wave():
    """A crest at y = 0 at t = 0 that travels to starboard at ω/k; the slope is that of the surface."""
    wave = regular(0.02, 4.5, WATER)
    k = 4.5**2 / 9.81
    y, time = np.linspace(-1.0, 1.0, 21)[:, None], np.linspace(0.0, 5.0, 17)
    assert wave.elevation(y, time) == pytest.approx(0.02 * np.cos(k * y - 4.5 * time), abs=1e-12)
    assert wave.elevation(0.3, 0.3 * k / 4.5) == pytest.approx(0.02)
    h = 1e-5
    rise = (wave.elevation(y + h, time) - wave.elevation(y - h, time)) / (2.0 * h)
    assert wave.slope(y, time) == pytest.approx(rise, abs=1e-8)


def test_soft_start():
    """Eq. F.1 at its ends and in its middle; zero slope at both ends, so that there is no impulse."""
    time = np.array([-1.0, 0.0, 1.0, 2.0, 3.0])
    assert soft_start(time, 2.0) == pytest.approx([0.0, 0.0, np.exp(1.0 - 4.0 / 3.0), 1.0, 1.0])
    assert np.all(soft_start(time, 0.0) == 1.0)
    h = 1e-4
    for end in (0.0, 2.0):
        assert abs(soft_start(end + h, 2.0) - soft_start(end - h, 2.0)) < 1e-3 * h
    assert np.all(np.diff(soft_start(np.linspace(0.0, 2.0, 50), 2.0)) >= 0.0)
    late, start = regular(0.02, 4.5, WATER, soft_start=6.0), 1.7
    plain = regular(0.02, 4.5, WATER)
    assert late.elevation(0.1, start) == pytest.approx(soft_start(start, 6.0) * plain.elevation(0.1, start))


def test_force_is_that_of_each_component():
    """Re Σ X a e^(i(ky − ωt)) by hand, two components with phases, and none in the other modes."""
    wave = packet(0.02, 4.0, 0.5, WATER, time=3.0, y=0.4, count=2)
    excitation = np.array([[100.0 - 20.0j, 0.0, 2.0j], [50.0, 0.0, -1.0]])
    y, t = 0.2, 1.3
    amplitude = wave.amplitude * np.exp(1j * (wave.wave_number * y - wave.frequency * t))
    by_hand = [(excitation[0] * amplitude[0]).real[m] + (excitation[1] * amplitude[1]).real[m] for m in range(3)]
    assert wave.force(excitation, y, t) == pytest.approx(np.array(by_hand), rel=1e-12, abs=0.0)
    assert wave.force(excitation, y, np.array([t, 2 * t])).shape == (2, 3)


@pytest.mark.parametrize("depth", [inf, 0.5])
def test_packet_focuses_and_travels_with_the_group(depth):
    water = Water(depth=depth)
    waves = packet(0.03, 5.0, 0.4, water, time=25.0, y=1.0)
    assert waves.elevation(1.0, 25.0) == pytest.approx(0.03)
    y = np.linspace(-40.0, 40.0, 4001)
    assert waves.elevation(y, 25.0).max() == pytest.approx(0.03)
    early = waves.elevation(y, 5.0) ** 2
    middle = (y * early).sum() / early.sum()
    assert 1.0 - middle == pytest.approx(20.0 * float(water.group_speed(5.0)), rel=0.05)
    assert early.max() < 0.9 * 0.03**2


@pytest.mark.parametrize("spectrum", [pierson_moskowitz(0.08, 5.0), jonswap(0.08, 5.0), jonswap(0.08, 5.0, 7.0)])
def test_spectra_have_the_given_height_and_peak(spectrum):
    energy = sum(
        quad(lambda w: float(spectrum(w)), a, b)[0] for a, b in [(0.5, 4.0), (4.0, 5.0), (5.0, 8.0), (8.0, 500.0)]
    )
    assert energy == pytest.approx(0.08**2 / 16.0, rel=1e-5)
    omega = np.linspace(2.0, 10.0, 16001)
    assert omega[spectrum(omega).argmax()] == pytest.approx(5.0, rel=1e-3)


def test_jonswap_without_a_peak_is_pierson_and_moskowitz():
    omega = np.linspace(2.0, 20.0, 50)
    assert jonswap(0.08, 5.0, 1.0)(omega) == pytest.approx(pierson_moskowitz(0.08, 5.0)(omega), rel=1e-6, abs=0.0)
    ratio = jonswap(0.08, 5.0, 3.3)(np.array([5.0])) / jonswap(0.08, 5.0, 1.0)(np.array([5.0]))
    assert ratio == pytest.approx(3.3 * 0.658, rel=0.01)  # 1 − 0.287 ln γ (DNV-RP-C205)


def test_the_peak_of_jonswap_is_steeper_before_it_than_behind():
    """Its enhancement γ^exp(−(ω/ω_p − 1)²/2σ²) has fallen to γ^exp(−½) at 7 % below ω_p and at 9 % above."""
    sides = 5.0 * np.array([0.93, 1.0, 1.09])
    enhanced = jonswap(0.08, 5.0, 3.3)(sides) / pierson_moskowitz(0.08, 5.0)(sides)
    assert enhanced[[0, 2]] / enhanced[1] == pytest.approx(3.3 ** (np.exp(-0.5) - 1.0) * np.ones(2), rel=1e-9)


def test_random_sea():
    """Half an hour: variance H_s²/16, zero-crossing period 2π √(m0/m2), kurtosis of a Gaussian; no recurrence."""
    spectrum = jonswap(0.08, 5.0)
    sea = random_sea(spectrum, 5.0, WATER, seed=3)
    time = np.arange(0.0, 1800.0, 0.1)
    height = sea.elevation(0.0, time)
    assert height.var() == pytest.approx(0.08**2 / 16.0, rel=0.03)
    second = quad(lambda w: float(w**2 * spectrum(w)), 2.5, 25.0, limit=200)[0]
    rising = np.count_nonzero((height[:-1] < 0.0) & (height[1:] >= 0.0))
    assert 1800.0 / rising == pytest.approx(2.0 * pi * np.sqrt(0.08**2 / 16.0 / second), rel=0.03)
    assert (height**4).mean() / height.var() ** 2 == pytest.approx(3.0, abs=0.25)
    half = len(height) // 2
    assert abs(np.corrcoef(height[:half], height[half:])[0, 1]) < 0.1


def test_a_seed_defines_a_sea():
    spectrum = pierson_moskowitz(0.05, 4.0)
    one, same, other = (random_sea(spectrum, 4.0, WATER, seed) for seed in (1, 1, 2))
    assert np.array_equal(one.amplitude, same.amplitude) and np.array_equal(one.frequency, same.frequency)
    assert not np.allclose(one.frequency, other.frequency)
    assert (np.abs(one.amplitude) ** 2).sum() / 2.0 == pytest.approx(0.05**2 / 16.0, rel=3e-3)


def test_froude_scaling():
    """The scaled quantities are consistent and give the source's example: 1:100, 0.4 to 1 Hz and 3 cm (appendix C)."""
    f = froude_factors(100.0)
    assert np.array([0.4, 1.0]) * f["frequency"] == pytest.approx([0.04, 0.1])
    assert 0.03 * f["length"] == pytest.approx(3.0)
    assert f["frequency"] * np.sqrt(f["length"]) == pytest.approx(1.0)
    assert f["speed"] == pytest.approx(f["length"] / f["time"])
    assert f["force"] == pytest.approx(f["mass"] * f["acceleration"])
    assert f["moment"] == pytest.approx(f["force"] * f["length"])
    assert f["inertia"] * f["angle"] / f["time"] ** 2 == pytest.approx(f["moment"])
    assert f["energy"] == pytest.approx(f["mass"] * f["speed"] ** 2)
