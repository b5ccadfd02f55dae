"""How many contacts a grain has: the mean coordination number Z = 2 contacts / grains of the grains in the tank.

A contact with a wall, a fixed grain or a moving part counts twice, as one between two grains does, although only one of
its ends is a movable grain. So Z is larger than the mean number of neighbours by the number of wall contacts divided by
the number of grains: a few per cent in a bed some twenty grains wide and deep.

contact_number_start: of the settled bed, at the first sample; no error of its own.
contact_number: mean over the steady part (`steady_part`; a tilt has none). Error: standard error of the
means of blocks, each a driving period if the tank is driven.
"""

from collections.abc import Mapping

import numpy as np

from lab.measures.drawing import BLUE, VERMILION, Sheet, band, level, mean_label
from lab.measures.steady import averaged, steady_part
from lab.measures.value import Value, over_worlds
from lab.recording import Recording
from lab.recording.contacts.stress import coordination

OF = "grains"
EMPTY = "no grain is left in the tank"


def applies(recording: Recording) -> bool:
    """Grains have touched."""
    return bool(recording.series["contacts"].any())


def measure(recording: Recording) -> dict[str, Value]:
    """contact_number_start and, of a steady part, contact_number."""
    number = contact_number(recording)
    found = {"contact_number_start": over_worlds(number[0], "1", missing=EMPTY)}
    steady = steady_part(recording, recording.series["time"])
    if steady is not None:
        found["contact_number"] = averaged(number, steady, "1", missing=EMPTY)
    return found


def contact_number(recording: Recording) -> np.ndarray:
    """Mean coordination number (T, W); NaN for an empty tank."""
    grains = recording.radius.shape[1] - recording.series["spilled"]
    return coordination(recording.series["contacts"], grains)


def draw(sheet: Sheet, recording: Recording, values: Mapping[str, Value]) -> None:
    """The mean coordination number in time."""
    ((axes,),) = sheet.panels()
    time, worlds = recording.series["time"], recording.worlds
    band(axes, time, contact_number(recording), BLUE, mean_label(worlds) if worlds > 1 else None)
    axes.set_xlabel("time (s)")
    axes.set_xlim(time[0], time[-1])
    axes.set_ylabel("contacts of a grain")
    steady = steady_part(recording, time)
    if steady is not None:
        span = time[steady.rows.start], time[-1]
        level(sheet, axes, values.get("contact_number"), "mean of the steady part", VERMILION, span)


FIGURES = {"contacts": draw}
