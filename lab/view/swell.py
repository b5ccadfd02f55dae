"""Regular waves under a hand: they grow and die away softly, and come with another frequency only once they have."""

from dataclasses import replace

import numpy as np

from lab.schema import Resolved
from lab.ship import make_vessel
from lab.view.helm import Follower
from solvers.ship.vessel import Vessel

EASE = 0.5  # s
CALM = 1e-4  # m: waves so low may change their frequency
STEADY = 1e-7  # m and m/s: what is nearer its goal is there


class Swell:
    """The waves that a ship's experiment meets; `wanted` is a hand's amplitude (m) and frequency (rad/s)."""

    def __init__(self, preset: Resolved) -> None:
        self._preset = preset
        self.wanted = {"wave_amplitude": preset.waves.amplitude, "wave_frequency": preset.waves.frequency}
        self._frequency, self._vessel = preset.waves.frequency, self._make(preset.waves.frequency)
        self._height = Follower(preset.waves.amplitude, EASE)

    @property
    def now(self) -> np.ndarray:
        """Amplitude (m), frequency (rad/s) and wave number (1/m)."""
        waves = self._vessel.ship.load.waves
        return np.array([self._height.value, self._frequency, waves.wave_number[0]])

    def follow(self, time: float) -> Vessel | None:
        """Go on for so long (s); gives the ship in the waves of then, None where they stay as they are."""
        other = self.wanted["wave_frequency"] != self._frequency
        goal = 0.0 if other else self.wanted["wave_amplitude"]
        if other and self._height.value < CALM:
            self._frequency = self.wanted["wave_frequency"]
            self._vessel = self._make(self._frequency)
        elif abs(self._height.value - goal) < STEADY and abs(self._height.rate) < STEADY:
            return None
        self._height.follow(goal, time)
        ship = self._vessel.ship
        waves = replace(ship.load.waves, amplitude=np.array([max(self._height.value, 0.0)], complex))
        return replace(self._vessel, ship=replace(ship, load=replace(ship.load, waves=waves)))

    def _make(self, frequency: float) -> Vessel:
        """The ship in waves of this frequency, of some height."""
        preset = self._preset
        waves = replace(preset.waves, amplitude=1.0, frequency=frequency)
        sheet = preset.ship.sheet or preset.grains.diameter
        return make_vessel(preset.ship, preset.water, waves, sheet, preset.run.gravity)
