"""Where the bed's centre of mass went, in the tank's frame (y to starboard, z up).

final_shift_y, final_shift_z: displacement from the settled bed at t = 0 to the last sample;
final_shift: the same length in y, counted in the world's mean grain diameter d;
largest_shift: the largest distance from the settled centre of mass at any time.
In an open tank they are of the grains that have not spilled.
Error: the positions are those of the simulation, without noise; what repeats do not share is the
std over the worlds. The last sample of a shaken bed catches it at one phase of its motion.
"""

import numpy as np

from lab.measures.value import Value, over_worlds
from lab.recording import Recording


def applies(recording: Recording) -> bool:
    """Every recording has a centre of mass."""
    return True


def measure(recording: Recording) -> dict[str, Value]:
    """final_shift_y and _z (mm), final_shift (d), largest_shift (mm)."""
    centre = recording.series["centre_of_mass"]
    moved = centre - centre[0]
    final = moved[-1]
    largest = np.fmax.reduce(np.hypot(*np.moveaxis(moved, 2, 0)))
    notes = {"missing": "no grain is left in the tank"}
    if len(recording.open_edges):
        notes["note"] = "of the grains still in the tank"
    return {
        "final_shift_y": over_worlds(1e3 * final[:, 0], "mm", **notes),
        "final_shift_z": over_worlds(1e3 * final[:, 1], "mm", **notes),
        "final_shift": over_worlds(final[:, 0] / recording.mean_diameter, "d", **notes),
        "largest_shift": over_worlds(1e3 * largest, "mm", **notes),
    }
