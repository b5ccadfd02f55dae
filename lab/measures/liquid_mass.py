"""How water loads a tank that one harmonic motion drives: added mass and damping of the liquid, as ships count them.

Over the steady part (`steady_part`), `harmonics` is fitted to the force along the motion, or for roll to the moment
about its centre: F = −A Y'' − B Y' − C Y (Faltinsen & Timokha 2009, "Sloshing").
liquid_added_mass (sway and heave): A over the mass of the water; 1 if it moves as one with the tank, negative above its
natural frequency. liquid_added_inertia (roll, rectangular tanks): A, with C of the water's weight and of its free
surface as it lies at rest. liquid_damping: B; the work done on the water in a period is π ω B |Y|².
Error: half the difference between the two halves of the steady part.
The note has what linear theory says of a rectangular tank without friction (Graham & Rodriguez 1952,
`solvers.ship.potential.sloshing`), in which B is zero.
"""

import numpy as np

from lab.measures.driven_load import transfer, with_halves
from lab.measures.motion import driving
from lab.measures.steady import SHORT, steady_part
from lab.measures.value import Value
from lab.preset.sections.water.liquid import depth
from lab.recording import Recording
from solvers.ship.potential.sloshing import SloshingLiquid

OF = "water"
FREEDOM = {"sway": 0, "heave": 1, "roll": 2}


def applies(recording: Recording) -> bool:
    """A harmonic motion drives the tank, and it alone."""
    return driving(recording) is not None and len(recording.preset.motion.parts) == 1


def measure(recording: Recording) -> dict[str, Value]:
    """liquid_added_mass (1) or liquid_added_inertia (kg m^2), and liquid_damping (N s/m or N m s)."""
    name, settings = driving(recording)
    steady, omega = steady_part(recording, recording.series["time"]), 2.0 * np.pi * settings.frequency
    ratio = np.full((3, recording.worlds), np.nan, dtype=complex)
    if steady is not None:
        ratio = np.array([transfer(recording, part)[1] for part in steady.parts])
    preset, linear = recording.preset, rectangular(recording)
    note = ""
    if linear is not None:
        own = linear.added_mass(np.array([omega]))[0, FREEDOM[name], FREEDOM[name]]
        own = own / linear.mass if name != "roll" else own * preset.thickness
        note = f"linear theory {own:.3g}"
    found = {"liquid_damping": with_halves(-ratio.imag / omega, "N m s" if name == "roll" else "N s/m", SHORT)}
    if name != "roll":
        mass = preset.thickness * preset.water.density * recording.volume.sum(axis=1)
        return {"liquid_added_mass": with_halves(ratio.real / omega**2 / mass, "1", SHORT, note), **found}
    if linear is not None:
        moved = (ratio.real + preset.thickness * linear.stiffness()[2, 2]) / omega**2
        found = {"liquid_added_inertia": with_halves(moved, "kg m^2", SHORT, note), **found}
    return found


def rectangular(recording: Recording) -> SloshingLiquid | None:
    """The water by linear theory, about the centre of the roll if there is one; None in tanks of other shapes."""
    preset = recording.preset
    if preset.tank.outline is not None or preset.water.depth is None or preset.water.full:
        return None
    name, settings = driving(recording)
    deep = depth(preset)
    centre = (-settings.centre[0], deep - settings.centre[1]) if name == "roll" else (0.0, deep)
    return SloshingLiquid(preset.tank.width, deep, centre, preset.water.density, preset.run.gravity)
