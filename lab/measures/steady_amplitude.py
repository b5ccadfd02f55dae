"""How a shaken bed answers in the steady state: amplitude and phase of its centre of mass.

Least-squares fit, in the tank's frame, of the coordinate that the motion drives (y for sway and
roll, z for heave) and of z to
    c + e t + a cos(wt) + b sin(wt) + a2 cos(2wt) + b2 sin(2wt),    w = 2 pi f,
with f the driving frequency; the drift e keeps a bed that still creeps from leaking into the
oscillation. The fit covers the last half of what follows the soft start, cut to an even number of
whole periods, at least two, so that the terms do not disturb each other.

response_amplitude: sqrt(a^2 + b^2) of the driven coordinate;
response_phase: its phase less that of the tank's own recorded motion, 0 to 360 deg (180: the bed
moves against the tank, as one that stays behind does);
response_amplitude_z: sqrt(a2^2 + b2^2) of z, which rises twice a period as the bed heaps on either
side (Spandonidis 2016, 5.2.2: z at twice the frequency of y, phase close to 180 deg).
Error: half the difference between the two halves of the window, which is the bed's unsteadiness.
"""

import numpy as np

from lab.measures.motion import HARMONIC, driving, soft_start
from lab.measures.value import Value, over_worlds
from lab.recording import Recording

STILL = 1e-3  # of a grain diameter: an amplitude below it has no phase
SHORT = "the run has less than two steady periods"
FOLLOWS = "the bed follows the tank"


def applies(recording: Recording) -> bool:
    """A harmonic motion drives the tank."""
    return driving(recording) is not None


def measure(recording: Recording) -> dict[str, Value]:
    """response_amplitude, response_amplitude_z (mm) and response_phase (deg)."""
    _, settings = driving(recording)
    time = recording.series["time"]
    window = steady_window(time, soft_start(recording), settings["frequency"])
    if window is None:
        answers = np.full((3, 2, recording.worlds), np.nan, dtype=complex)
    else:
        middle = (window.start + window.stop) // 2
        parts = window, slice(window.start, middle), slice(middle, window.stop)
        answers = np.array([_answer(recording, part) for part in parts])
    missing = SHORT if window is None else FOLLOWS
    return {
        "response_amplitude": _amplitude(answers[:, 0], missing),
        "response_phase": _phase(answers[:, 0], STILL * recording.mean_diameter, missing),
        "response_amplitude_z": _amplitude(answers[:, 1], missing),
    }


def steady_window(time: np.ndarray, begin: float, frequency: float) -> slice | None:
    """Samples of the last half of time (T,) after `begin`: whole periods, even in number, or None."""
    periods = (time[-1] - begin) * frequency + 1e-9
    if periods < 2:
        return None
    kept = max(2, 2 * int(periods / 4))
    start = time[-1] - kept / frequency
    return slice(int(np.searchsorted(time, start + 1e-9 / frequency)), len(time))


def harmonics(time: np.ndarray, signal: np.ndarray, frequency: float) -> np.ndarray:
    """Complex amplitudes A (2, W) of signal (T, W) at f and 2f: Re(A1 e^(iwt) + A2 e^(2iwt))."""
    angle = 2 * np.pi * frequency * time
    waves = [wave(k * angle) for k in (1, 2) for wave in (np.cos, np.sin)]
    terms = np.stack([np.ones_like(time), time - time.mean(), *waves], axis=1)
    fit = np.linalg.lstsq(terms, signal, rcond=None)[0]
    return fit[[2, 4]] - 1j * fit[[3, 5]]


def _answer(recording: Recording, part: slice) -> np.ndarray:
    """Complex amplitudes (2, W), m: of the driven coordinate against the drive, and of z at 2f."""
    name, settings = driving(recording)
    time, frequency = recording.series["time"][part], settings["frequency"]
    centre = recording.series["centre_of_mass"][part]
    drive = harmonics(time, recording.series["pose"][part][:, :, HARMONIC[name]], frequency)[0]
    along = harmonics(time, centre[:, :, 1 if name == "heave" else 0], frequency)[0]
    height = harmonics(time, centre[:, :, 1], frequency)[1]
    return np.stack([along * np.exp(-1j * np.angle(drive)), height])


def _amplitude(answers: np.ndarray, missing: str) -> Value:
    """Size of complex answers (3, W), m, of the whole window and its halves, in mm."""
    whole, first, second = 1e3 * np.abs(answers)
    return over_worlds(whole, "mm", uncertainties=np.abs(first - second) / 2, missing=missing)


def _phase(answers: np.ndarray, still: np.ndarray, missing: str) -> Value:
    """Phase of complex answers (3, W), averaged on the circle; none for those below `still` (W,)."""
    moving = np.abs(answers[0]) > still
    whole, first, second = np.where(moving, np.angle(answers), np.nan)
    centre = np.angle(np.exp(1j * whole[moving]).sum()) % (2 * np.pi)
    phases = centre + _wrapped(whole - centre)
    errors = np.abs(_wrapped(first - second)) / 2
    return over_worlds(np.degrees(phases), "deg", uncertainties=np.degrees(errors), missing=missing)


def _wrapped(angle: np.ndarray) -> np.ndarray:
    """The same angle between -pi and pi."""
    return (angle + np.pi) % (2 * np.pi) - np.pi
