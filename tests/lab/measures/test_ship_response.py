"""Responses by spectra: of an oscillator in noise whose answer is known, and the sea of white noise itself."""

import numpy as np
import pytest

from lab.assembly.ship import make_waves
from lab.measures.ship_response import transfer
from lab.preset.sections.sea import Waves
from solvers.ship.water import Water

RATE, OWN, SHARE = 50.0, 5.0, 0.1  # Hz, rad/s, of critical


def oscillators(noise: float) -> tuple[np.ndarray, np.ndarray]:
    """White noise (n, 1) and the answers (n, 8) of ÿ + 2 ζ ω ẏ + ω² y = ω² x to it, each with noise of its own."""
    random, count = np.random.default_rng(3), 60000
    driven = random.normal(size=(count, 1))
    omega = 2.0 * np.pi * np.fft.rfftfreq(count, 1.0 / RATE)[:, None]
    answer = np.fft.irfft(np.fft.rfft(driven, axis=0) * known(omega), count, axis=0)
    return driven, answer + noise * answer.std() * random.normal(size=(count, 8))


def known(omega: np.ndarray) -> np.ndarray:
    """The oscillator's complex response."""
    return OWN**2 / (OWN**2 - omega**2 + 2j * SHARE * OWN * omega)


def test_an_oscillator_answers_as_it_is():
    driven, answer = oscillators(0.0)
    found = transfer(driven, answer, 1.0 / RATE, 2000)
    low = (found.frequency > 1.0) & (found.frequency < 10.0)
    assert found.size[low] == pytest.approx(np.abs(known(found.frequency[low, None])) * np.ones(8), rel=0.05)
    assert found.coherence[low].min() > 0.95


def test_the_band_holds_the_answer_as_often_as_it_says():
    """With noise 19 of 20 estimates lie within their 95 % bands, and coherence falls where noise prevails."""
    driven, answer = oscillators(3.0)
    found = transfer(driven, answer, 1.0 / RATE, 2000)
    low = (found.frequency > 1.0) & (found.frequency < 8.0)
    inside = np.abs(found.size[low] - np.abs(known(found.frequency[low, None]))) < found.error[low]
    assert 0.88 < inside.mean() < 0.99
    assert found.coherence[found.frequency > 15.0].mean() < 0.2


def test_white_noise_is_level_within_its_band():
    given = Waves(frequency=5.0, kind="white", height=0.04, spread=2.0, seed=4)
    waves = make_waves(given, Water())
    amplitudes = np.abs(waves.amplitude)
    assert 4.0 * np.sqrt((amplitudes**2 / 2.0).sum()) == pytest.approx(0.04, rel=0.02)
    inside = np.abs(waves.frequency - 5.0) <= 2.0
    assert (amplitudes[np.abs(waves.frequency - 5.0) > 2.1] == 0.0).all()
    half = (amplitudes[inside & (waves.frequency < 5.0)] ** 2).sum() / (amplitudes[inside] ** 2).sum()
    assert half == pytest.approx(0.5, abs=0.03)
