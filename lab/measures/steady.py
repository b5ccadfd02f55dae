"""The steady part of a run, when the effects of its start are gone, and what is fitted to it or averaged over it."""

from dataclasses import dataclass

import numpy as np

from lab.measures.motion import driving, is_tilt, soft_start
from lab.measures.value import Value, over_worlds
from lab.recording import Recording

STILL = 1e-3  # of a grain diameter: a smaller amplitude has no phase
BLOCKS = 8  # of a steady part without periods
LEAST_SAMPLES = 16
SHORT = "the run has less than two steady periods"


@dataclass(frozen=True)
class Steady:
    """Rows of a steady part, and the number of blocks it is cut into: whole periods, if the run has periods."""

    rows: slice
    blocks: int

    @property
    def parts(self) -> tuple[slice, slice, slice]:
        """The whole and its two halves."""
        middle = (self.rows.start + self.rows.stop) // 2
        return self.rows, slice(self.rows.start, middle), slice(middle, self.rows.stop)


def steady_part(recording: Recording, time: np.ndarray) -> Steady | None:
    """The steady part of samples at time (T,), s; None where it is too short.

    A run driven at one frequency has its `steady_window`, a tilt has none, any other run has its last half after the
    soft start.
    """
    begin, drive = soft_start(recording), driving(recording)
    if drive is not None:
        frequency = drive[1].frequency
        rows = steady_window(time, begin, frequency)
        if rows is None or rows.stop - rows.start < LEAST_SAMPLES:
            return None
        return Steady(rows, min(round((time[-1] - time[rows.start]) * frequency), (rows.stop - rows.start) // 4))
    if is_tilt(recording) or not len(time):
        return None
    start = int(np.searchsorted(time, 0.5 * (max(begin, time[0]) + time[-1])))
    return Steady(slice(start, len(time)), BLOCKS) if len(time) - start >= LEAST_SAMPLES else None


def steady_window(time: np.ndarray, begin: float, frequency: float, least: int = 2) -> slice | None:
    """Rows of the last half of time (T,), s, after `begin`, a multiple of `least` whole periods; None if too short."""
    periods = (time[-1] - begin) * frequency + 1e-9
    if periods < least:
        return None
    kept = max(least, least * int(periods / (2 * least)))
    start = time[-1] - kept / frequency
    return slice(int(np.searchsorted(time, start + 1e-9 / frequency)), len(time))


def harmonics(time: np.ndarray, signal: np.ndarray, frequency: float, orders: tuple[float, ...]) -> np.ndarray:
    """Complex amplitudes A (K, W) of signal (T, W) at orders k of the frequency: sum of Re(A_k e^(ikwt)).

    Least squares together with a constant and a drift; NaN for a signal that is not finite throughout.
    """
    angle = 2 * np.pi * frequency * time
    waves = [wave(k * angle) for k in orders for wave in (np.cos, np.sin)]
    terms = np.stack([np.ones_like(time), time - time.mean(), *waves], axis=1)
    known = np.isfinite(signal).all(axis=0)
    fit = np.linalg.lstsq(terms, np.where(known, signal, 0.0), rcond=None)[0]
    return np.where(known, fit[2::2] - 1j * fit[3::2], np.nan)


def block_error(values: np.ndarray, blocks: int) -> np.ndarray:
    """Standard error (W,) of the mean of values (T, W): of the means of blocks, taken as independent."""
    means = np.array([block.mean(axis=0) for block in np.array_split(values, blocks)])
    return means.std(axis=0, ddof=1) / np.sqrt(blocks)


def averaged(values: np.ndarray, steady: Steady, unit: str, **notes: str) -> Value:
    """The mean of values (T, W) over the steady part with its block error."""
    part = values[steady.rows]
    return over_worlds(
        part.mean(axis=0), unit, uncertainties=block_error(part, steady.blocks), kind="averaging", **notes
    )


def amplitude_value(answers: np.ndarray, unit: str, **notes: str) -> Value:
    """Size of complex answers (3, W) of the whole part and its halves; error: half the halves' difference."""
    whole, first, second = np.abs(answers)
    return over_worlds(whole, unit, uncertainties=np.abs(first - second) / 2, kind="halves", **notes)


def phase_value(answers: np.ndarray, still: np.ndarray, missing: str) -> Value:
    """Phase (deg) of complex answers (3, W), averaged on the circle; none for an amplitude below `still` (W,)."""
    moving = np.abs(answers[0]) > still
    whole, first, second = np.where(moving, np.angle(answers), np.nan)
    centre = np.angle(np.exp(1j * whole[moving]).sum()) % (2 * np.pi)
    phases = centre + _wrapped(whole - centre)
    errors = np.abs(_wrapped(first - second)) / 2
    return over_worlds(np.degrees(phases), "deg", uncertainties=np.degrees(errors), kind="halves", missing=missing)


def _wrapped(angle: np.ndarray) -> np.ndarray:
    """The same angle between -pi and pi."""
    return (angle + np.pi) % (2 * np.pi) - np.pi
