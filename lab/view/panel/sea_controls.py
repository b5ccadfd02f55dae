"""Waves that the user changes: they grow and decay smoothly."""

from dataclasses import replace

import numpy as np

from lab.assembly.ship import make_vessel
from lab.preset.schema import Preset
from lab.view.panel.steering import Follower
from solvers.ship.vessel import Vessel

EASE = 0.5  # s
CALM = 1e-4  # m: below this amplitude the frequency may change
STEADY = 1e-7  # m and m/s: within this distance the goal counts as reached
RANDOM = "jonswap", "pierson-moskowitz", "white-noise"


class RegularSea:
    """Regular waves; a new frequency takes effect only once they have died away.

    `wanted`: the user's amplitude (m) and frequency (rad/s).
    """

    def __init__(self, preset: Preset) -> None:
        self._preset = preset
        self.wanted = {"wave_amplitude": preset.waves.amplitude, "wave_frequency": preset.waves.frequency}
        self._frequency = preset.waves.frequency
        self._vessel = _afloat(preset, amplitude=1.0)
        self._height = Follower(preset.waves.amplitude, EASE)

    @property
    def now(self) -> np.ndarray:
        """Amplitude (m), frequency (rad/s) and wave number (1/m)."""
        waves = self._vessel.ship.load.waves
        return np.array([self._height.value, self._frequency, waves.wave_number[0]])

    def follow(self, time: float) -> Vessel | None:
        """Advance by `time` (s); returns the ship in the new waves, None if they have not changed."""
        other = self.wanted["wave_frequency"] != self._frequency
        goal = 0.0 if other else self.wanted["wave_amplitude"]
        if other and self._height.value < CALM:
            self._frequency = self.wanted["wave_frequency"]
            self._vessel = _afloat(self._preset, amplitude=1.0, frequency=self._frequency)
        elif _is_there(self._height, goal):
            return None
        self._height.follow(goal, time)
        return _raised(self._vessel, self._height)


class RandomSea:
    """A random sea; `wanted` is the user's significant height (m), to which all components are proportional."""

    def __init__(self, preset: Preset) -> None:
        self.wanted = {"wave_height": preset.waves.height}
        self._vessel = _afloat(preset, height=1.0)
        self._height = Follower(preset.waves.height, EASE)

    @property
    def now(self) -> np.ndarray:
        """Significant height (m), and NaN twice, since its components differ in frequency and wave number."""
        return np.array([self._height.value, np.nan, np.nan])

    def follow(self, time: float) -> Vessel | None:
        """Advance by `time` (s); returns the ship in the new sea, None if it has not changed."""
        if _is_there(self._height, self.wanted["wave_height"]):
            return None
        self._height.follow(self.wanted["wave_height"], time)
        return _raised(self._vessel, self._height)


def sea_controls_of(preset: Preset) -> RegularSea | RandomSea | None:
    """The steerable waves of a preset, None if it has none."""
    kind = preset.waves.kind if preset.ship and preset.waves else ""
    return RegularSea(preset) if kind == "regular" else RandomSea(preset) if kind in RANDOM else None


def _afloat(preset: Preset, **changes: float) -> Vessel:
    """The ship in other waves."""
    return make_vessel(preset.ship, preset.sea, replace(preset.waves, **changes), preset.run.gravity)


def _raised(vessel: Vessel, height: Follower) -> Vessel:
    """Scale the waves of a ship, given for a height of 1 m, to this height."""
    load = vessel.ship.load
    waves = replace(load.waves, amplitude=max(height.value, 0.0) * load.waves.amplitude)
    return replace(vessel, ship=replace(vessel.ship, load=replace(load, waves=waves)))


def _is_there(height: Follower, goal: float) -> bool:
    return abs(height.value - goal) < STEADY and abs(height.rate) < STEADY
