"""How lively the bed was: its kinetic energy relative to the tank, spin included.

largest_kinetic_energy: the largest at any sample; final_kinetic_energy: at the last sample.
Error: a peak shorter than the sampling interval may be missed; repeats differ by the std.
"""

from lab.measures.value import Value, over_worlds
from lab.recording import Recording


def applies(recording: Recording) -> bool:
    """Every recording has energies."""
    return True


def measure(recording: Recording) -> dict[str, Value]:
    """largest_kinetic_energy and final_kinetic_energy (µJ)."""
    kinetic = 1e6 * (recording.series["kinetic"] + recording.series["rotational"])
    return {
        "largest_kinetic_energy": over_worlds(kinetic.max(axis=0), "µJ"),
        "final_kinetic_energy": over_worlds(kinetic[-1], "µJ"),
    }
