"""How a heeled ship's free roll dies away in calm water: natural frequency, damping, and so her answer at resonance.

From the turning points of her roll, the one at the release among them, as long as swings are above NOISE of the widest:
decay_frequency: π over the mean time between crossings of the roll at rest. Error: standard error of these times.
decay_damping, decay_quadratic: ζ and b (per rad) of φ̈ + 2ζω₀φ̇ + b φ̇|φ̇| + ω₀²(φ − φ_r) = 0. In half a cycle of a
mean amplitude φ it loses ln(φ_n/φ_n+1) = π ζ_e/√(1 − ζ_e²), ζ_e = ζ + 4bφ/3π (energy of a cycle; Himeno 1981). So
averaged over a cycle (Krylov & Bogoliubov 1937) the amplitude falls to
    φ_n = φ_0 e^(−sn)/(1 + 4 b φ_0 (1 − e^(−sn))/(3 s)), s = π ζ/√(1 − ζ²)
after n half cycles, exactly for b = 0, else to second order in ζ and bφ_0: b comes out too large by 2 % at ζ = 0.1, or
at bφ_0 = 0.4. It is fitted by least squares to the widths φ_n + φ_n+1 of the swings from one turning point to the next;
the roll at rest φ_r is not in them. Error: standard error of the fit. What loose cargo and waves made take is in, too.
In waves of her own frequency a ship with these rolls 1/2ζ_e times as much as in slow ones of the same slope.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from lab.measures.drawing import BLUE, GREY, VERMILION, Sheet
from lab.measures.ship import has_ship
from lab.measures.value import Value, over_worlds
from lab.recording import Recording
from solvers.machine.quantity import ROLL

NOISE = 0.03  # of the widest swing
LEAST = 4  # swings
NEAR = 0.6  # of a half cycle to either side of a turning point, whose samples tell where it is
OFF = 0.3  # of a half cycle, by which the polynomial's turning point may lie off the sample that looks like it
BEFORE = 0.1  # the same before the record: one let go with a speed has turned a little before
ORDER = 6  # of the polynomial through them: 3e-5 of a sine's amplitude, by Chebyshev's bound
ROUNDS, SMALL, UNTOLD = 8, 1e-5, 1e-3  # of the fit: steps, for its slopes, and least singular value of the largest
LEAST_HEEL = np.radians(0.5)
PER = 0.75 * np.pi  # b over the slope of ζ_e


@dataclass(frozen=True, eq=False)
class Decay:
    """Mean `amplitude` (n,) rad and ζ_e of each half cycle; `line`: ζ and slope, `errors` their standard errors."""

    amplitude: np.ndarray
    damping: np.ndarray
    line: tuple[float, float]
    errors: tuple[float, float]
    frequency: float
    frequency_error: float


def decay(time: np.ndarray, roll: np.ndarray) -> Decay | None:
    """Of a free roll (T,) rad at times (T,) s; None for too few half cycles."""
    when, turn = turning_points(time, roll)
    if len(turn) <= LEAST:
        return None
    width = np.abs(np.diff(turn))
    lost = np.log(width[:-1] / width[1:]) / np.pi
    found, errors = _fitted(width)
    rest = float(np.mean(0.25 * (turn[:-2] + 2.0 * turn[1:-1] + turn[2:])))
    gaps = np.diff(_crossings(time, roll - rest, when))
    middle = float(gaps.mean())
    frequency = np.pi / middle
    wander = frequency * float(gaps.std(ddof=1)) / middle / np.sqrt(len(gaps))
    amplitude, damping = 0.25 * (width[:-1] + width[1:]), lost / np.sqrt(1.0 + lost**2)
    return Decay(amplitude, damping, found, errors, frequency, wander)


def amplitudes(first: float, fall: float, quadratic: float, count: int) -> np.ndarray:
    """Amplitudes (count,) rad of successive half cycles, `fall` the s of the formula above, `quadratic` b (1/rad)."""
    from scipy.special import exprel  # slow to import

    n = np.arange(count)
    return first * np.exp(-fall * n) / (1.0 + 4.0 / 3.0 * quadratic * first * n * exprel(-fall * n))


def _fitted(width: np.ndarray) -> tuple[tuple[float, float], tuple[float, float]]:
    """ζ and the slope of ζ_e over φ (1/rad), and their standard errors, from widths (n,) rad of successive swings.

    Gauss and Newton's steps without directions that the widths do not tell: swings that hardly fall have but one ζ_e.
    """
    scale = 0.5 * width[0]
    guess = np.array([1.0, float(np.log(width[0] / width[-1])) / (len(width) - 1), 0.0])

    def missed(at: np.ndarray) -> np.ndarray:
        size = amplitudes(at[0], at[1], at[2], len(width) + 1)
        return size[:-1] + size[1:] - width / scale

    for _ in range(ROUNDS):
        slopes = np.array([(missed(guess + d) - missed(guess - d)) / (2.0 * SMALL) for d in SMALL * np.eye(3)]).T
        guess = guess - np.linalg.lstsq(slopes, missed(guess), rcond=UNTOLD)[0]
    back = np.linalg.pinv(slopes, rcond=UNTOLD)
    shared = np.eye(len(width), k=1)  # an error of a turning point is in two widths
    both = 2.0 * np.eye(len(width)) + shared + shared.T
    wrong = (missed(guess) ** 2).sum() / np.trace(both - slopes @ back @ both)
    spread = wrong * back @ both @ back.T
    fall, share = guess[1] / np.pi, 1.0 + (guess[1] / np.pi) ** 2
    _, of_fall, of_slope = np.sqrt(np.diag(spread))
    found = float(fall / np.sqrt(share)), float(guess[2] / PER / scale)
    return found, (float(of_fall / np.pi / share**1.5), float(of_slope / PER / scale))


def turning_points(time: np.ndarray, roll: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Times (n,) s and rolls (n,) rad at the tops and bottoms in turn, while swings are wider than NOISE."""
    from scipy.signal import find_peaks  # slow to import

    least = NOISE * float(np.ptp(roll)) if len(roll) else 0.0
    tops = [find_peaks(way * roll, prominence=least)[0] for way in (1.0, -1.0)] if least > 0.0 else [[]]
    places = np.sort(np.concatenate(tops)).astype(int)
    if len(places) < LEAST - 1:
        return np.zeros(0), np.zeros(0)
    half = float(np.median(np.diff(time[places])))
    ends = [k for k in (0, len(time) - 1) if 0.5 < np.abs(time[places] - time[k]).min() / half < 1.5]
    turns = [_turn(time, roll, k, half) for k in sorted([*places, *ends])]
    when, turn = np.array([one for one in turns if one is not None]).T
    return when, turn


def _turn(time: np.ndarray, roll: np.ndarray, k: int, half: float) -> tuple[float, float] | None:
    """Time and roll of the turning point near a sample, half a cycle lasting `half` (s); None where there is none.

    By the polynomial of least squares through the samples around, at least as many as it has coefficients.
    """
    at = (time - time[k]) / half
    wide = max(NEAR, float(np.sort(np.abs(at))[min(ORDER, len(at) - 1)]))
    rows = np.abs(at) <= wide
    curve = np.polynomial.Polynomial.fit(at[rows], roll[rows], min(ORDER, int(rows.sum()) - 1))
    roots = curve.deriv().roots()
    real = roots.real[(np.abs(roots.imag) < 1e-6) & (np.abs(roots.real) < OFF)]
    real = real[(real > at[0] - BEFORE) & (real < at[-1])]
    if not len(real):
        return None
    best = float(real[np.argmin(np.abs(real))])
    return float(time[k]) + half * best, float(curve(best))


def _crossings(time: np.ndarray, swing: np.ndarray, when: np.ndarray) -> np.ndarray:
    """The time (s) at which a swing (T,) rad first crosses zero after each but the last turning point."""
    change = np.flatnonzero(swing[:-1] * swing[1:] < 0.0)
    crossing = time[change] + swing[change] / (swing[change] - swing[change + 1]) * (time[change + 1] - time[change])
    first = np.searchsorted(crossing, when)
    last = np.append(crossing, np.inf)[first]
    return last[:-1][last[:-1] < when[1:]]


def applies(recording: Recording) -> bool:
    """A ship is let go heeled, in calm water."""
    if not has_ship(recording):
        return False
    waves = recording.preset.waves
    calm = waves is None or not (waves.amplitude or waves.height)
    return calm and abs(recording.preset.ship.heel) > LEAST_HEEL


def measure(recording: Recording) -> dict[str, Value]:
    """decay_frequency (rad/s), decay_damping and decay_quadratic (1/rad)."""
    rows = [_row(decay(*_free(recording, world))) for world in range(recording.worlds)]
    frequency, wander, linear, of_linear, quadratic, of_quadratic = np.array(rows).T
    missing = "too few swings"
    return {
        "decay_frequency": over_worlds(frequency, "rad/s", uncertainties=wander, kind="cycles", missing=missing),
        "decay_damping": over_worlds(linear, "", uncertainties=of_linear, kind="fit", missing=missing),
        "decay_quadratic": over_worlds(quadratic, "1/rad", uncertainties=of_quadratic, kind="fit", missing=missing),
    }


def _free(recording: Recording, world: int) -> tuple[np.ndarray, np.ndarray]:
    """Time (s) and roll (rad) after the release."""
    time = recording.series["time"]
    rows = time >= recording.preset.ship.release
    return time[rows], recording.series["pose"][rows, world, ROLL]


def _row(found: Decay | None) -> list[float]:
    if found is None:
        return [np.nan] * 6
    (linear, slope), (of_linear, of_slope) = found.line, found.errors
    return [found.frequency, found.frequency_error, linear, of_linear, PER * slope, PER * of_slope]


def draw(sheet: Sheet, recording: Recording, values: Mapping[str, Value]) -> None:
    """Share of critical damping of each half cycle over its amplitude, and the line of the fit, of the first ship."""
    found = decay(*_free(recording, 0))
    if found is None:
        return
    ((axes,),) = sheet.panels()
    degrees = np.degrees(found.amplitude)
    axes.plot(degrees, 100.0 * found.damping, "o", ms=4, color=BLUE, label="half cycles")
    ends = np.array([0.0, 1.05 * found.amplitude.max()])
    axes.plot(np.degrees(ends), 100.0 * (found.line[0] + found.line[1] * ends), color=VERMILION, label="fit")
    axes.axhline(0.0, color=GREY, lw=0.6)
    axes.set_xlim(0.0, float(np.degrees(ends[1])))
    axes.set_xlabel("amplitude of roll (deg)")
    axes.set_ylabel("damping (% of the critical)")


FIGURES = {"decay": draw}
