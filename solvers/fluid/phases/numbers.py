"""The numbers of the second phase, and of what acts between the two."""

from dataclasses import replace

from solvers.fluid.given import Water
from solvers.fluid.phases.adiabatic import Adiabatic
from solvers.fluid.phases.dispersed import ALONE, LIGHT
from solvers.fluid.phases.interfaces import INTERFACES
from solvers.fluid.phases.reduced_pressure import ReducedPressure

UNBOUNDED = 1e20  # Pa
TORN = 0.5  # of ρ_a c²: suction that air is said to bear at most; its vacuum is at 1/1.4
FASTEST = 0.5, 2.0  # Mach numbers of water and air at which a run is stopped: impacts squeeze air out

# Times the spring behind a wall's face for its mass, beside water's: air may be as fast as its sound, and water presses
# it against walls. At the longest step the frequency is 1.1 over the step, where explicit steps bear 2.
FIRMER = 12.0


def of_air(water: Water, gravity: float, numbers: dict[str, float], viscosity) -> dict[str, float]:
    """The constants of the air of a `water`, by name, beside the `numbers` of the water itself.

    Between the phases acts the harmonic mean of their viscosities, 2 μ_w μ_a/(μ_w + μ_a) (Hu & Adams 2006, eq. 18).
    `air_pace` is by what air may be faster than water before a run is stopped, inverted.
    """
    air, own = water.air, numbers["strength"]
    alone = replace(water, density=air.density, sound_speed=air.sound_speed, alpha=air.alpha, kinematic=air.kinematic)
    strength, stiffness = viscosity.strength(alone), air.density * air.sound_speed**2
    light = air.density < LIGHT * water.density
    lean_of_pressure, lean_of_speed = INTERFACES[air.interface].leans(water.density, air.density)
    return {
        "air_density": air.density,
        "air_stiffness": stiffness,
        "air_spread": water.delta * water.length * air.sound_speed,
        "air_strength": strength,
        "both_strength": 2.0 * own * strength / max(own + strength, 1e-300),
        "hydrostatic": ReducedPressure.weight(water, gravity) / water.sound_speed**2,
        "air_hydrostatic": (gravity if air.reduced is None else 0.0) / air.sound_speed**2,
        "air_packing": ALONE,
        "least": 0.0 if light else -UNBOUNDED,  # Pa, with the background's
        "air_thinnest": float(Adiabatic.deviation(-min(water.background / stiffness, TORN))) if light else -1.0,
        "air_keeping": numbers["keeping"] * air.sound_speed / water.sound_speed,
        "air_hard": FIRMER * numbers["hard"] * stiffness / numbers["stiffness"],
        "lean_of_pressure": lean_of_pressure,
        "lean_of_speed": lean_of_speed,
        "tension": air.tension,
        "cohesion": air.cohesion,
        "air_pace": FASTEST[0] * water.sound_speed / (FASTEST[1] * air.sound_speed),
    } | ReducedPressure.numbers(water)
