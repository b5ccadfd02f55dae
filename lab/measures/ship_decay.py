"""How a heeled ship's free roll dies away in calm water: natural frequency, damping, and so her answer at resonance.

From the extremes φ_n of her roll about its last mean, after the release, as long as they are above NOISE of the first:
decay_frequency: π over the mean time between crossings of the mean. Error: standard error of these times.
decay_damping, decay_quadratic: ζ and b (per rad) of φ̈ + 2ζω₀φ̇ + b φ̇|φ̇| + ω₀²φ = 0. In half a cycle of a mean amplitude
φ it loses ln(φ_n/φ_n+1) = π ζ_e/√(1 − ζ_e²), ζ_e = ζ + 4bφ/3π (energy of a cycle; Himeno 1981); a straight line through
ζ_e over φ. Error: half the 68 % interval of that line's numbers. What loose cargo and waves made take is in them, too.
In waves of her own frequency a ship with these rolls 1/2ζ_e times as much as in slow ones of the same slope.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from lab.measures.drawing import BLUE, GREY, VERMILION, Sheet
from lab.measures.ship import has_ship
from lab.measures.value import Value, over_worlds
from lab.recording import Recording

NOISE = 0.03  # of the first extreme
LEAST = 4  # half cycles
TAIL = 0.2  # of the record after the release, whose mean is the roll at rest
LEAST_HEEL = np.radians(0.5)


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
    swing = roll - roll[-max(2, int(TAIL * len(roll))) :].mean()
    change = np.flatnonzero(swing[:-1] * swing[1:] < 0.0)
    crossing = time[change] + swing[change] / (swing[change] - swing[change + 1]) * (time[change + 1] - time[change])
    pieces = list(zip(change[:-1] + 1, change[1:] + 1, strict=True))
    extremes = np.array([_extreme(swing[a:b]) for a, b in pieces])
    if len(extremes) <= LEAST:
        return None
    kept = int(np.argmax(np.append(extremes, 0.0) < NOISE * extremes[0]))
    extremes = extremes[:kept]
    if kept <= LEAST or not (extremes > 0.0).all():
        return None
    lost = np.log(extremes[:-1] / extremes[1:]) / np.pi
    damping, amplitude = lost / np.sqrt(1.0 + lost**2), 0.5 * (extremes[:-1] + extremes[1:])
    line, covariance = np.polyfit(amplitude, damping, 1, cov=True)
    gaps = np.diff(crossing[: kept + 1])
    middle = float(gaps.mean())
    frequency = np.pi / middle
    error = frequency * float(gaps.std(ddof=1)) / middle / np.sqrt(len(gaps))
    wrong = np.sqrt(np.diag(covariance))
    return Decay(amplitude, damping, (line[1], line[0]), (wrong[1], wrong[0]), frequency, error)


def _extreme(piece: np.ndarray) -> float:
    """The largest size of a half cycle, by a parabola through the largest sample and its neighbours."""
    size = np.abs(piece)
    k = int(np.argmax(size))
    if not 0 < k < len(size) - 1:
        return float(size[k])
    a, b, c = size[k - 1 : k + 2]
    bend = a - 2.0 * b + c
    return float(b - 0.125 * (a - c) ** 2 / bend) if bend < 0.0 else float(b)


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
    return time[rows], recording.series["pose"][rows, world, 2]


def _row(found: Decay | None) -> list[float]:
    if found is None:
        return [np.nan] * 6
    per = 0.75 * np.pi  # b over the line's slope
    (linear, slope), (of_linear, of_slope) = found.line, found.errors
    return [found.frequency, found.frequency_error, linear, of_linear, per * slope, per * of_slope]


def draw(sheet: Sheet, recording: Recording, values: Mapping[str, Value]) -> None:
    """Share of critical damping of each half cycle over its amplitude, and the line through it, of the first ship."""
    found = decay(*_free(recording, 0))
    if found is None:
        return
    ((axes,),) = sheet.panels()
    degrees = np.degrees(found.amplitude)
    axes.plot(degrees, 100.0 * found.damping, "o", ms=4, color=BLUE, label="half cycles")
    ends = np.array([0.0, 1.05 * found.amplitude.max()])
    axes.plot(np.degrees(ends), 100.0 * (found.line[0] + found.line[1] * ends), color=VERMILION, label="line")
    axes.axhline(0.0, color=GREY, lw=0.6)
    axes.set_xlim(0.0, float(np.degrees(ends[1])))
    axes.set_xlabel("amplitude of roll (deg)")
    axes.set_ylabel("damping (% of the critical)")


FIGURES = {"decay": draw}
