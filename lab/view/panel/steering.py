"""Steering: turn the user's settings into a motion of the tank that is smooth even if they change abruptly.

Angles and amplitudes follow the settings like a critically damped oscillator; the tilt is also limited in rate. Pose,
velocity and acceleration of the tank are continuous from piece to piece, by quintic Hermite interpolation.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from math import exp, pi

import numpy as np

from solvers.motion.steered import Steered, hermite

# Time constants (s) with which settings are followed. The tilt's is shorter, since its rate is limited already.
EASE, TILT_EASE = 0.2, 0.1
OSCILLATIONS = {"sway": 1.2, "heave": 1.2, "roll": pi}  # m/s and rad/s: largest settable speeds of oscillation
FASTEST = {"turn": 1.4 * pi, "y": 2.5, "z": 2.5}  # bounds on the resulting speeds, from which the step is chosen


@dataclass
class Follower:
    """A value that follows its goal by the closed-form solution of x″ + 2 x′/τ + (x − goal)/τ² = 0."""

    value: float
    ease: float
    rate: float = 0.0
    bend: float = 0.0  # x″

    def follow(self, goal: float, time: float) -> None:
        """Advance by `time` (s)."""
        away, fade = self.value - goal, exp(-time / self.ease)
        slope = self.rate + away / self.ease
        self.value = goal + (away + slope * time) * fade
        self.rate = (slope - (away + slope * time) / self.ease) * fade
        self.bend = -2.0 * self.rate / self.ease - (self.value - goal) / self.ease**2

    @property
    def now(self) -> np.ndarray:
        """Value, rate and acceleration."""
        return np.array([self.value, self.rate, self.bend])


class Oscillation:
    """An oscillation A sin ψ whose amplitude and frequency follow their settings."""

    def __init__(self, frequency: float) -> None:
        self.amplitude, self.omega, self.phase = Follower(0.0, EASE), Follower(2.0 * pi * frequency, EASE), 0.0

    def follow(self, amplitude: float, frequency: float, time: float) -> None:
        """Advance by `time` (s) towards an amplitude and a frequency (Hz)."""
        before = self.omega.value
        self.amplitude.follow(amplitude, time)
        self.omega.follow(2.0 * pi * frequency, time)
        self.phase += 0.5 * (before + self.omega.value) * time

    @property
    def now(self) -> np.ndarray:
        """Value, rate and acceleration."""
        (a, a1, a2), (w, w1, _) = self.amplitude.now, self.omega.now
        s, c = np.sin(self.phase), np.cos(self.phase)
        return np.array([a * s, a1 * s + a * w * c, (a2 - a * w * w) * s + (2.0 * a1 * w + a * w1) * c])


class Steering:
    """The settings of the tank's motion, by the names of `controls.CONTROLS`, and the motion that follows them."""

    def __init__(self, wanted: Mapping[str, float]) -> None:
        self.wanted = dict(wanted)
        self._goal, self._tilt = 0.0, Follower(0.0, TILT_EASE)
        self._swings = {name: Oscillation(wanted[f"{name}_frequency"]) for name in OSCILLATIONS}
        self._centre = [Follower(wanted[name], EASE) for name in ("centre_y", "centre_z")]
        self._pose = np.zeros((3, 3))  # of turn, y and z: value, rate and acceleration now

    @staticmethod
    def motions() -> tuple[Steered, ...]:
        """The motions of a scene that the user steers."""
        return tuple(Steered(coordinate, fastest) for coordinate, fastest in FASTEST.items())

    def follow(self, time: float) -> list[np.ndarray]:
        """Advance by `time` (s); returns the polynomials (6,) that the steered motions follow in that time."""
        wanted = self.wanted
        step = wanted["tilt_rate"] * time
        self._goal += float(np.clip(wanted["tilt"] - self._goal, -step, step))
        self._tilt.follow(self._goal, time)
        for name, swing in self._swings.items():
            frequency = wanted[f"{name}_frequency"]
            swing.follow(min(wanted[name], OSCILLATIONS[name] / (2.0 * pi * frequency)), frequency, time)
        for follower, name in zip(self._centre, ("centre_y", "centre_z"), strict=True):
            follower.follow(wanted[name], time)
        before, self._pose = self._pose, self._posed()
        return [hermite(time, begin, end) for begin, end in zip(before, self._pose, strict=True)]

    def _posed(self) -> np.ndarray:
        """Turn φ and position of the tank's origin, s + c − R(φ) c for rotation about the centre c, with derivatives.

        Points are complex numbers y + i z, so that R(φ) is e^(iφ).
        """
        turn = self._tilt.now + self._swings["roll"].now
        c = self._centre[0].now + 1j * self._centre[1].now
        moved = self._swings["sway"].now + 1j * self._swings["heave"].now + c
        rate, bend, direction = turn[1], turn[2], np.exp(1j * turn[0])
        moved -= direction * np.array(
            [
                c[0],
                c[1] + 1j * rate * c[0],
                c[2] + 2j * rate * c[1] + (1j * bend - rate * rate) * c[0],
            ]
        )
        return np.array([turn, moved.real, moved.imag])
