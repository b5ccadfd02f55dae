"""Roll of one ship for each metre of wave in four ways: regular waves, a packet, a random sea, and free decay."""

import numpy as np
from matplotlib.figure import Figure

from lab.measures.sea_response import MANY, met
from lab.measures.value import half_width
from lab.report.plots import BELOW, BLUE, GREEN, GREY, VERMILION, canvas
from lab.studies.reproduce.experiment import Found
from lab.studies.reproduce.figures import SIZE
from lab.studies.reproduce.runs import Outcome
from lab.studies.reproduce.ships.coupled import HIGH, LOW, ROLL, linear_response, response, roll_per_wave

REGULAR, PACKET, SEA, DECAY = "regular waves", "packet", "sea", "free decay"  # runs by their names in the claims
SWINGS = 2  # the barge's and the water's
SETTLED, EVERY = 1.0, 0.1  # s: from so long after the release on, one sample in so long a time


def swings(one: Outcome) -> list[tuple[float, float]]:
    """Natural frequencies (rad/s) and shares of critical damping of roll after a release, slowest first."""
    series, settled = one.recording.series, one.recording.preset.ship.release + SETTLED
    time = series["time"]
    every = max(1, round(EVERY / (time[1] - time[0])))
    free = time > settled
    roll = series["pose"][free, 0, ROLL][::every]
    return decaying(roll, every * float(time[1] - time[0]), SWINGS)


def decaying(record: np.ndarray, step: float, count: int) -> list[tuple[float, float]]:
    """Frequencies (rad/s) and damping ratios of so many decaying swings that a record at equal steps (s) is made of.

    They swing about a place of rest that need not be zero, nor the mean of any part of the record. By the matrix pencil
    (Hua & Sarkar 1990, IEEE Trans. Acoust. Speech Signal Process. 38, 814): of the matrix of the record's pieces, each
    a step later than the one before, the 2 `count` + 1 strongest directions are kept; what takes them a step on has
    the eigenvalues exp((−ζ ω ± i ω_d) Δt), and 1 for the place of rest. Unlike a spectrum's peak it tells swings apart
    that have died away within two periods, and their damping.
    """
    length = len(record) // 2
    pieces = np.array([record[k : k + length + 1] for k in range(len(record) - length)])
    strongest = np.linalg.svd(pieces, full_matrices=False)[2][: 2 * count + 1].T
    forward = np.linalg.eigvals(np.linalg.pinv(strongest[:-1]) @ strongest[1:])
    rates = np.log(forward.astype(complex)) / step
    return sorted((float(one.imag), float(-one.real / abs(one))) for one in rates if one.imag > 0.0)


def _swing(one: Outcome, wanted: float) -> tuple[float, float]:
    """Frequency and damping of the swing nearest to a frequency; NaN where there is none."""
    return min(swings(one), key=lambda swing: abs(swing[0] - wanted), default=(np.nan, np.nan))


def figure(found: Found) -> Figure:
    """Points of regular waves, the packet's curve, the sea's with its 95 % band, linear theory, marks of the decay."""
    drawn, axes = canvas(SIZE)
    omega, roll = linear_response(found[REGULAR][0].recording.preset)
    axes.plot(omega, roll, color=GREY, lw=1.0, ls="--", label="linear theory")
    axes.plot(*response(found[PACKET][0]), color=BLUE, lw=1.3, label=PACKET)
    heard = met(found[SEA][0].recording, 0, ROLL)
    kept, size, wide = heard.strong, np.abs(heard.ratio), half_width(1.0, MANY) * heard.error
    axes.plot(heard.frequency[kept], size[kept], color=GREEN, lw=1.3, label="random sea")
    low, high = np.maximum(size - wide, 0.0)[kept], (size + wide)[kept]
    axes.fill_between(heard.frequency[kept], low, high, color=GREEN, alpha=0.2, lw=0)
    points = [(one.recording.preset.waves.frequency, roll_per_wave(one, None)) for one in found[REGULAR]]
    axes.plot(*zip(*points, strict=True), "o", color=VERMILION, ms=5.0, label=REGULAR)
    for number, (swing, _) in enumerate(swings(found[DECAY][0])):
        axes.axvline(swing, color="k", ls=":", lw=1.0, label=None if number else "swings in free decay")
    axes.set_xlabel("wave frequency (rad/s)")
    axes.set_ylabel("roll per metre of wave (rad/m)")
    axes.set_xlim(LOW, HIGH)
    axes.set_ylim(bottom=0.0)
    drawn.legend(loc=BELOW, ncols=3)
    return drawn


NUMBERS = {
    "swing_frequency": ("rad/s", lambda one, wanted: _swing(one, wanted)[0]),
    "swing_damping": ("", lambda one, wanted: _swing(one, wanted)[1]),
}
