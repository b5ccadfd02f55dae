"""Transfer functions from a sea, on a made oscillator that one knows, and the bands on its noise."""

import numpy as np

from lab.measures.sea_response import SEGMENTS, transfer
from solvers.ship.water import Water
from solvers.ship.waves import jonswap, random_sea

PEAK, NATURAL, DAMPING = 4.0, 5.0, 0.1  # rad/s and of the critical
TIME = np.arange(0.0, 900.0, 0.1)


def oscillator(omega):
    """Answer of ẍ + 2ζω₀ẋ + ω₀² x = ω₀² ζ_w to waves as e^(−iωt), per metre."""
    return 1.0 / (1.0 - (omega / NATURAL) ** 2 - 2j * DAMPING * omega / NATURAL)


def sea(seed):
    """Elevation and the oscillator's exact steady answer, both (T,)."""
    waves = random_sea(jonswap(0.1, PEAK), PEAK, Water(), seed)
    moving = waves.amplitude * np.exp(-1j * waves.frequency * TIME[:, None])
    return moving.sum(axis=1).real, (moving @ oscillator(waves.frequency)).real


def test_an_oscillator_is_found_again():
    """Its own transfer function to 5 %, in phase to 0.1 rad, and all coherent."""
    wave, answer = sea(1)
    found = transfer(TIME, wave, answer)
    exact = oscillator(found.frequency)
    kept = found.strong
    assert np.abs(np.abs(found.ratio[kept]) / np.abs(exact[kept]) - 1.0).max() < 0.05
    assert np.abs(np.angle(found.ratio[kept] / exact[kept].conj())).max() < 0.1  # e^(−iωt) against e^(iωt)
    assert found.coherence[kept].min() > 0.99


def test_densities_hold_the_variance():
    wave, answer = sea(2)
    found = transfer(TIME, wave, answer)
    step = found.frequency[1] - found.frequency[0]
    for density, series in ((found.wave, wave), (found.answer, answer)):
        assert abs(density.sum() * step / series.var() - 1.0) < 0.05


def test_bands_hold_the_truth_as_often_as_they_say():
    """With noise as strong as the answer, 95 % bands hold the exact value at 90 to 99 % of the lines of eight seas."""
    inside, coherence = [], []
    for seed in range(8):
        wave, answer = sea(seed)
        noise = np.random.default_rng(seed).normal(size=len(TIME)) * answer.std()
        found = transfer(TIME, wave, answer + noise)
        kept = found.strong & (found.coherence > 0.3)  # the formula is of first order
        error = np.abs(np.abs(found.ratio) - np.abs(oscillator(found.frequency)))
        inside.append((error <= 1.96 * found.error)[kept])
        coherence.append(found.coherence[kept])
    assert 0.90 < np.concatenate(inside).mean() < 0.99
    assert np.concatenate(coherence).mean() < 0.995


def test_two_records_that_have_nothing_in_common():
    """Their coherence is that of chance, 1/n on the average."""
    random = np.random.default_rng(3)
    found = transfer(TIME, *random.normal(size=(2, len(TIME))))
    assert abs(found.coherence.mean() * found.pieces - 1.0) < 0.1
    assert SEGMENTS * 0.9 < found.pieces < SEGMENTS
