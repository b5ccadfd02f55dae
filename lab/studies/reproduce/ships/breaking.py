"""Whether water in a ship's tank breaks, and what is lost in it, over the last waves of a run."""

import numpy as np

from lab.studies.reproduce.runs import Outcome

CYCLES = 10  # waves
WIDE, APART = 2.0, 2.0  # spacings: width of a column, and the gap in it that is air
FUNDAMENTAL, FROZEN = "roll_fundamental", "frozen_amplitude"


def roll_over_frozen(one: Outcome, _: object) -> float:
    """Amplitude of roll over that of the same ship whose water is frozen; a run of water has no beds that scatter."""
    return one[FUNDAMENTAL].value / one[FROZEN].value


def lost_a_wave(one: Outcome, _: object) -> float:
    """Energy that viscosity and diffusion take in one wave, over the water's mean kinetic energy in the tank."""
    series, last, period = one.recording.series, *_last(one, one.recording.series["time"])
    time, lost = series["time"][last], (series["water_viscous"] + series["water_diffusive"])[last, 0]
    return float((lost[-1] - lost[0]) / (time[-1] - time[0]) * period / series["water_kinetic"][last, 0].mean())


def overturned(one: Outcome, _: object) -> float:
    """Share of the time in which water lies over air in the tank: a crest that falls over, or drops above the surface.

    So it is where in a column WIDE spacings wide a particle is more than APART spacings above the next one below it.
    """
    recording = one.recording
    last, _ = _last(one, recording.frames["time"][:])
    spacing, place = recording.preset.water.spacing, recording.frames["water_position"]
    return float(np.mean([has_air_below(place[k, 0].astype(float), spacing) for k in np.flatnonzero(last)]))


def has_air_below(place: np.ndarray, spacing: float) -> bool:
    """Whether some of the particles at `place` (n, 2) m are over air."""
    column = np.floor(place[:, 0] / (WIDE * spacing)).astype(int)
    order = np.lexsort((place[:, 1], column))
    same, gap = np.diff(column[order]) == 0, np.diff(place[order, 1])
    return bool((gap[same] > APART * spacing).any())


def _last(one: Outcome, time: np.ndarray) -> tuple[np.ndarray, float]:
    """Which of the times (n,) are of the last CYCLES waves, and their period (s)."""
    period = 2.0 * np.pi / one.recording.preset.waves.frequency
    return time > time[-1] - CYCLES * period, period


NUMBERS = {
    "roll_over_frozen": ("", roll_over_frozen),
    "lost_a_wave": ("", lost_a_wave),
    "overturned": ("", overturned),
}
