"""Where the power goes that regular waves put into a ship: means over the last ten periods, for a metre of her length.

wave_power: what the waves put into her. radiated_power, viscous_power: what goes into radiated waves and into friction
of the water. granular_power: what her loose cargo takes, and loses in its contacts once the motion is steady.
In a steady motion the first is the sum of the others. Error: none of their own; none for a ship that was lost.
"""

from collections.abc import Mapping

import numpy as np

from lab.measures.drawing import BLUE, GREEN, GREY, VERMILION, Sheet, band
from lab.measures.ship import has_ship, wave_frequency
from lab.measures.value import Value, over_worlds
from lab.recording import Recording
from lab.recording.ship_end import ends
from solvers.ship.outcome import CYCLES

NAMES = "wave_power", "radiated_power", "viscous_power", "granular_power"
COLOURS = BLUE, GREEN, GREY, VERMILION
SIGNS = 1.0, 1.0, 1.0, -1.0  # the cargo's work on her is recorded, its power is what it takes


def applies(recording: Recording) -> bool:
    """There is a ship in regular waves."""
    return has_ship(recording) and wave_frequency(recording) is not None


def measure(recording: Recording) -> dict[str, Value]:
    """wave_power, radiated_power, viscous_power and granular_power (mW/m)."""
    time, works = recording.series["time"], recording.series["ship_works"]
    begin = np.searchsorted(time, time[-1] - CYCLES * 2.0 * np.pi / wave_frequency(recording))
    power = 1e3 * (works[-1] - works[begin]) / max(time[-1] - time[begin], 1e-9) * SIGNS
    power[[end is not None for end in ends(recording.series)]] = np.nan
    names = _names(recording)
    return {name: over_worlds(power[:, k], "mW/m", missing="no steady motion") for k, name in enumerate(names)}


def _names(recording: Recording) -> tuple[str, ...]:
    """The names of the powers, in the order of `ship_works`; without cargo it takes none."""
    return NAMES if recording.preset.matters else NAMES[:-1]


def draw(sheet: Sheet, recording: Recording, values: Mapping[str, Value]) -> None:
    """The work that the waves have done on a ship, and where it went, in time; the mean powers are in the legend."""
    ((axes,),) = sheet.panels(columns=1)
    time, works = recording.series["time"], recording.series["ship_works"] * SIGNS
    for k, (name, colour) in enumerate(zip(_names(recording), COLOURS, strict=False)):
        value = values.get(name)
        found = f" {sheet.words(value)}" if value is not None and value.value is not None else ""
        band(axes, time, works[..., k], colour, f"{name.replace('_', ' ')}{found}")
    axes.set_xlabel("time (s)")
    axes.set_xlim(time[0], time[-1])
    axes.set_ylabel("work since the start (J/m)")


FIGURES = {"power": draw}
