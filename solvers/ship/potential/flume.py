"""Waves made by a flap in a flume: a train with a beginning, which disperses on its way to the model.

Near its natural frequency a lightly damped model still gains amplitude when the measurement has to stop because its own
waves return from the flap. It must then be computed in the wave train that it met, not in waves without beginning.
"""

from dataclasses import dataclass
from math import pi

import numpy as np

from solvers.ship.water import Water
from solvers.ship.waves import Waves

BAND = 0.3, 2.2  # of the flap's frequency: a train that begins over some periods has less than 0.1 % outside
QUIET = 60.0  # s by which the period of the Fourier series exceeds the train, so that it does not recur
SAMPLES = 32  # per period of the flap


@dataclass(frozen=True)
class Flap:
    """A flap hinged `hinge` (m) below the surface, `distance` (m) from the model, started over `ramp` periods."""

    hinge: float
    distance: float
    ramp: float

    def transfer(self, frequency: np.ndarray, water: Water) -> np.ndarray:
        """Ratio of wave amplitude far from the flap to stroke amplitude at the surface (Dean and Dalrymple 1991, 6.2).

        In linear theory a/S = 4 sinh kh {sinh kh − [cosh kh − cosh k(h − l)]/kl} / (sinh 2kh + 2kh), l the hinge's
        depth in water of depth h, which must be finite.
        """
        k = water.wave_number(frequency)
        depth, arm = k * water.depth, k * self.hinge
        push = np.sinh(depth) - (np.cosh(depth) - np.cosh(depth - arm)) / arm
        return 4.0 * np.sinh(depth) * push / (np.sinh(2.0 * depth) + 2.0 * depth)

    def train(self, amplitude: float, frequency: float, water: Water, duration: float) -> Waves:
        """Waves at the model, with `amplitude` (m) when steady; the flap moves from t = 0 to `duration` (s).

        The flap's stroke is a Fourier series, whose components generate waves and propagate by linear theory.
        """
        period = 2.0 * pi / frequency
        count = int(np.ceil((duration + QUIET) / period))
        time = period / SAMPLES * np.arange(count * SAMPLES)
        rise = np.clip(np.minimum(time, duration - time) / (self.ramp * period), 0.0, 1.0)
        stroke = rise * np.sin(frequency * time)
        omega = frequency / count * np.arange(1, len(time) // 2)
        part = np.conj(np.fft.rfft(stroke))[1 : len(time) // 2] * 2.0 / len(time)
        inside = (omega > BAND[0] * frequency) & (omega < BAND[1] * frequency)
        omega, part = omega[inside], part[inside]
        k = water.wave_number(omega)
        gain = amplitude * self.transfer(omega, water) / self.transfer(np.array([frequency]), water)
        return Waves(gain * part * np.exp(1j * k * self.distance), omega, k)


def fundamental(time: np.ndarray, values: np.ndarray, frequency: float) -> np.ndarray:
    """Complex amplitude c of values (n, …) at times (n,) s, fitted as mean + Re c e^(−iωt) by least squares."""
    design = np.column_stack([np.ones_like(time), np.cos(frequency * time), np.sin(frequency * time)])
    found = np.linalg.lstsq(design, np.reshape(values, (len(time), -1)))[0]
    return np.reshape(found[1] + 1j * found[2], np.shape(values)[1:])
