"""The largest roll in a given time from records of it: maxima of blocks by Gumbel, maxima of half cycles by Weibull.

Gumbel (1958): of blocks of a length t the largest is at most x with a probability exp(−exp(−(x − μ)/β)). In a time T it
is on average μ + β (ln(T/t) + 0.5772). μ and β are of maximum likelihood. How (μ̂ − μ)/β̂ and β̂/β scatter does not depend
on μ and β (Lawless 2003), so that intervals follow from simulated samples and hold for any number of blocks.

Weibull (1951): the largest |roll − mean| between two crossings of the mean exceeds x with a probability
exp(−(x/a)^k), also by maximum likelihood; k = 2 is Rayleigh's distribution, that of a Gaussian record of a narrow band.
The largest of N in the time T is a (ln N)^(1/k) most often. Its interval is from resampled pieces of PIECE half cycles,
as rolls come in groups (block bootstrap, Künsch 1989).

Nothing is told of fewer than LEAST blocks, of blocks of fewer than ROLLS rolls, of fewer than PEAKS half cycles, or of
a time more than FAR times all records together.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import log, pi

import numpy as np

from solvers.ship.damping.random_roll import EULER

LEAST, ROLLS, PEAKS, FAR = 10, 10, 400, 10.0
PIECE = 20  # half cycles
SAMPLES, RESAMPLED, SEED = 2000, 400, 20  # simulated samples, resampled records
OF_DEVIATION, NEWTON = 6.0**0.5 / pi, 8  # first β, of the standard deviation, and steps from it
LEVEL = 0.95  # of intervals
SURE = 0.95  # probability of the level that is told beside the mean


@dataclass(frozen=True)
class Level:
    """A level (of the record's unit) with its interval of 95 %."""

    value: float
    low: float
    high: float


@dataclass(frozen=True, eq=False)
class Gumbel:
    """μ and β of maxima (n,) of blocks."""

    place: float
    scale: float
    maxima: np.ndarray

    def at(self, reduced: float) -> Level:
        """μ + β y at a reduced variate y, with its interval."""
        place, scale = _pivots(len(self.maxima)).T
        off = (reduced - place - reduced * scale) / scale
        low, high = np.quantile(off, [0.5 - 0.5 * LEVEL, 0.5 + 0.5 * LEVEL])
        value = self.place + reduced * self.scale
        return Level(value, value + float(low) * self.scale, value + float(high) * self.scale)

    def mean(self, blocks: float) -> Level:
        """The mean of the largest in so many blocks."""
        return self.at(log(blocks) + EULER)

    def sure(self, blocks: float) -> Level:
        """What the largest in so many blocks stays below with the probability SURE."""
        return self.at(log(blocks) - log(-log(SURE)))


def fit_gumbel(maxima: Sequence[float]) -> Gumbel:
    """By maximum likelihood, from maxima (n,) that are not all alike."""
    maxima = np.asarray(maxima, dtype=float)
    place, scale = _likeliest(maxima[None])[0]
    return Gumbel(float(place), float(scale), maxima)


@lru_cache(maxsize=8)
def _pivots(count: int) -> np.ndarray:
    """μ̂ and β̂ (SAMPLES, 2) of samples of so many numbers of the standard distribution."""
    return _likeliest(np.random.default_rng(SEED).gumbel(size=(SAMPLES, count)))


def _likeliest(samples: np.ndarray) -> np.ndarray:
    """μ and β (m, 2) of samples (m, n): β = mean(x) − Σ x e^(−x/β)/Σ e^(−x/β), by Newton's method."""
    least = samples.min(axis=1)
    x = samples - least[:, None]
    mean, scale = x.mean(axis=1), x.std(axis=1) * OF_DEVIATION
    for _ in range(NEWTON):
        weight = np.exp(-x / scale[:, None])
        weight /= weight.sum(axis=1, keepdims=True)
        light = (x * weight).sum(axis=1)
        slope = 1.0 + ((x * x * weight).sum(axis=1) - light**2) / scale**2
        scale = np.maximum(scale + (mean - light - scale) / slope, 0.1 * scale)
    place = least - scale * np.log(np.exp(-x / scale[:, None]).mean(axis=1))
    return np.stack([place, scale], axis=1)


def fit_weibull(peaks: np.ndarray) -> tuple[float, float]:
    """Scale a and shape k of peaks (n,) > 0: as −ln x is Gumbel's, with μ = −ln a and β = 1/k."""
    place, scale = _likeliest(-np.log(np.asarray(peaks, dtype=float))[None])[0]
    return float(np.exp(-place)), float(1.0 / scale)


def weibull_largest(peaks: np.ndarray, count: float) -> Level:
    """a (ln N)^(1/k) of `count` half cycles, with its interval from resampled pieces of the peaks (n,)."""
    scale, shape = fit_weibull(peaks)
    pieces = len(peaks) // PIECE
    cut = np.asarray(peaks)[: pieces * PIECE].reshape(pieces, PIECE)
    chosen = np.random.default_rng(SEED).integers(0, pieces, size=(RESAMPLED, pieces))
    drawn = cut[chosen].reshape(len(chosen), -1)
    places, scales = _likeliest(-np.log(drawn)).T
    levels = np.exp(-places) * log(count) ** scales
    low, high = np.quantile(levels, [0.5 - 0.5 * LEVEL, 0.5 + 0.5 * LEVEL])
    return Level(scale * log(count) ** (1.0 / shape), float(low), float(high))


def half_cycles(roll: np.ndarray) -> np.ndarray:
    """The largest |roll − mean| (n,) between crossings of the mean of a record (T,), the ends left out."""
    swing = roll - roll.mean()
    crossing = np.flatnonzero(np.diff(np.signbit(swing))) + 1
    if len(crossing) < 2:
        return np.zeros(0)
    return np.maximum.reduceat(np.abs(swing), crossing)[:-1]


def block_maxima(time: np.ndarray, roll: np.ndarray, length: float) -> np.ndarray:
    """The largest |roll| in each whole block of a length (s) of a record (T,)."""
    count = int((time[-1] - time[0]) / length * (1.0 + 1e-9))
    which = np.minimum(((time - time[0]) / length).astype(int), count)
    return np.array([np.abs(roll[which == k]).max() for k in range(count)])
