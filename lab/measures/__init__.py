"""What is measured on a recording, one file a measure; a new one is a file and a line in MEASURES.

A measure is a module with `applies(recording) -> bool` and `measure(recording) -> dict[str, Value]`;
its docstring defines each number and says where its error comes from.
"""

from lab.measures import (
    centre_of_mass,
    contact_number,
    critical_angle,
    energies,
    flow_rate,
    heap_angle,
    hysteresis,
    ship_roll,
    spectrum,
    spilled,
    steady_amplitude,
    surface_slope,
    swelling,
    top_altitude,
    wall_force,
    wave,
)
from lab.measures.value import Value
from lab.recording import Recording

# In the order in which a summary shows them.
MEASURES = (
    ship_roll,
    heap_angle,
    flow_rate,
    spilled,
    critical_angle,
    surface_slope,
    hysteresis,
    steady_amplitude,
    spectrum,
    wave,
    swelling,
    top_altitude,
    centre_of_mass,
    wall_force,
    contact_number,
    energies,
)


def measure_all(recording: Recording) -> dict[str, Value]:
    """Every number that can be measured on this recording, by name. Raises LabError if damaged."""
    found: dict[str, Value] = {}
    if not len(recording.series["time"]):
        return found
    for measure in MEASURES:
        if measure.applies(recording):
            found |= measure.measure(recording)
    return found
