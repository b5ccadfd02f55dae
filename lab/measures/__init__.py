"""What is measured on a recording: one file for each measure, with its numbers, their errors and its figures.

A measure is a module with
- a docstring that defines each number and says where its error comes from;
- `OF`, if it measures a matter: the matter's key; it is left out of recordings that lack the matter;
- `applies(recording) -> bool`: whether it can be measured on this recording;
- `measure(recording) -> dict[str, Value]`: its numbers by name;
- `FIGURES`, if it has any: by the name of the figure's file a function `draw(sheet, recording, values)`. It draws on
  panels that it asks of the sheet (`lab.measures.drawing`), and asks for none where there is nothing to show. `values`
  is everything that was measured on the recording, by name.
A new measure is such a file and a line in MEASURES: its numbers and figures appear in the report of every run on which
it can be measured.
"""

from types import ModuleType

from lab.measures import (
    axle_roll,
    bulk_shift,
    centre_of_mass,
    collapse,
    contact_number,
    critical_angle,
    drum,
    energies,
    face_forces,
    floating,
    flow_rate,
    force_impulse,
    force_peaks,
    free_flow,
    free_water,
    gauge_impulse,
    gauge_peaks,
    gauge_statistics,
    heap_angle,
    hysteresis,
    inflow,
    level_crests,
    liquid_mass,
    onset,
    own,
    packing,
    pore_pressure,
    run_up,
    sea_response,
    settlement,
    ship_decay,
    ship_frozen,
    ship_grain,
    ship_power,
    ship_roll,
    ship_stability,
    ship_unevenness,
    sliding_friction,
    sloshing_frequency,
    spectrum,
    spilled,
    steady_amplitude,
    surface_slope,
    swelling,
    top_altitude,
    wall_force,
    water_residual,
    wave,
)
from lab.measures.value import Measures
from lab.recording import Recording

# In the order in which a report shows their numbers and figures.
MEASURES = (
    ship_roll,
    inflow,
    ship_frozen,
    ship_stability,
    ship_grain,
    ship_unevenness,
    ship_power,
    sea_response,
    ship_decay,
    axle_roll,
    floating,
    heap_angle,
    flow_rate,
    spilled,
    drum,
    critical_angle,
    surface_slope,
    hysteresis,
    steady_amplitude,
    spectrum,
    wave,
    swelling,
    top_altitude,
    centre_of_mass,
    bulk_shift,
    collapse,
    onset,
    settlement,
    sliding_friction,
    pore_pressure,
    free_water,
    wall_force,
    face_forces,
    packing,
    contact_number,
    energies,
    free_flow,
    gauge_peaks,
    gauge_impulse,
    force_peaks,
    force_impulse,
    level_crests,
    run_up,
    gauge_statistics,
    sloshing_frequency,
    liquid_mass,
    water_residual,
)


def measure_all(recording: Recording) -> Measures:
    """Every number that can be measured on this recording, by name. Raises LabError if damaged."""
    found = Measures()
    if not len(recording.series["time"]):
        return found
    for measure in applicable(recording):
        found |= measure.measure(recording)
    return found


def applicable(recording: Recording) -> list[ModuleType | own.OwnMeasure]:
    """The measures that can be made on this recording, in their order."""
    held = ("", *recording.preset.matters)
    known = (*MEASURES, *own.OWN.values())
    return [measure for measure in known if getattr(measure, "OF", "") in held and measure.applies(recording)]
