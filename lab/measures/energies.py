"""How much the grains moved: the kinetic energy of the bed relative to the tank, spin included.

largest_kinetic_energy: the largest at any sample; final_kinetic_energy: at the last sample.
Error: none of their own. A peak shorter than the sampling interval may be missed.
"""

from collections.abc import Mapping

from lab.measures.drawing import BLUE, GREY, VERMILION, Sheet, band, median_band, note
from lab.measures.value import Value, over_worlds
from lab.recording import Recording

OF = "grains"


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


def draw(sheet: Sheet, recording: Recording, values: Mapping[str, Value]) -> None:
    """Energies in time: kinetic and elastic on a logarithmic scale, below the change of the potential one."""
    time, series = recording.series["time"], recording.series
    kinetic = 1e6 * (series["kinetic"] + series["rotational"])
    if not kinetic.any():
        return
    (upper,), (lower,) = sheet.panels(heights=(2, 1))
    median_band(upper, time, kinetic, BLUE, "kinetic, relative to the tank")
    median_band(upper, time, 1e6 * series["elastic"], VERMILION, "elastic")
    upper.set_yscale("log")
    upper.set_ylabel("energy (µJ)")
    note(sheet, upper, values.get("largest_kinetic_energy"), "largest kinetic energy")
    potential = 1e6 * (series["potential"] - series["potential"][0])
    band(lower, time, potential, GREY)
    lower.set_ylabel("potential,\nchange (µJ)")
    lower.set_xlabel("time (s)")
    lower.set_xlim(time[0], time[-1])


FIGURES = {"energy": draw}
