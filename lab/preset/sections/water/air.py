"""The air over the water, as a preset gives it, its checks, and what the solver takes of it."""

from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np

from lab.base.errors import LabError
from lab.preset.units import needed, show
from solvers.fluid.phases.adiabatic import GAMMA
from solvers.fluid.phases.interfaces import INTERFACES
from solvers.machine.marks import Doc, Interval, Unit, Usual

REAL_SOUND = 343.0  # m/s, of air at 20 °C
SLOWEST = 0.5  # of the air's speed of sound: what its own weight may lift over its height, √(0.4 g H)


@dataclass(frozen=True)
class Air:
    """The air over the water, a second phase of the fluid; it fills a closed tank.

    Its particles are as far apart as those of the water. At rest its pressure is that outside, at the water's surface.
    """

    density: Annotated[float, Unit("kg/m^3"), Interval(gt=0), Doc("Density at rest.")] = 1.2
    sound_speed: Annotated[
        Annotated[float, Unit("m/s"), Interval(gt=0)] | Literal["equal", "real"],
        Doc(
            "Speed of sound: equal to that of the water, which is cheap, but leaves trapped air much too soft; or "
            "real, 343 m/s, with as much shorter steps; or a number."
        ),
    ] = "equal"
    alpha: Annotated[
        Annotated[float, Interval(ge=0, le=1)] | None,
        Doc("Strength of the air's artificial viscosity; the water's without it."),
    ] = None
    kinematic_viscosity: Annotated[
        Annotated[float, Unit("m^2/s"), Interval(gt=0)] | None,
        Doc('Viscosity of the air, for water.viscosity = "laminar".'),
    ] = None
    background: Annotated[
        Annotated[float, Unit("Pa"), Interval(ge=0)],
        Doc("Pressure added in sums over particles alone; it presses the air's particles into gaps."),
    ] = 0.0
    surface_tension: Annotated[
        Annotated[float, Unit("N/m"), Interval(ge=0)],
        Usual(0.0, 0.1),
        Doc("Tension of the surface between water and air; 0.072 N/m of clean water."),
    ] = 0.0
    interface: Annotated[
        Literal[*INTERFACES], Doc("What acts between water and air, see `solvers.fluid.phases.interfaces`.")
    ] = "weighted"


def sound_of_air(air: Air, sound: float) -> float:
    """Speed of sound (m/s) of the air over water with a speed of sound (m/s)."""
    return {"equal": sound, "real": REAL_SOUND}.get(air.sound_speed, air.sound_speed)


def check_air(preset) -> None:
    """Raise LabError for air that cannot be: in an open tank, over water that leaves it no room, beside parts."""
    from lab.preset.sections.water.liquid import depth, liquid

    air, water, tank = preset.air, preset.water, preset.tank
    if air is None:
        return
    if tank.open_edges:
        raise LabError("air: it fills closed tanks; give the tank a lid (tank.lid = true), or leave out [air].")
    if water.full:
        raise LabError("air: the water fills the tank (water.full), so that there is none; leave out either.")
    if preset.parts:
        raise LabError("air: parts in water with air are not computed yet; leave out [parts] or [air].")
    if water.shifting == "delta-plus-momentum":
        raise LabError(
            'water.shifting: "delta-plus-momentum" is for water alone; take "delta-plus", or leave out [air].'
        )
    laminar = liquid(preset).viscosity == "laminar"
    if laminar and air.kinematic_viscosity is None:
        raise LabError(f'air.kinematic_viscosity: missing for water.viscosity = "laminar"; {needed("m^2/s")}.')
    if air.kinematic_viscosity is not None and not laminar:
        raise LabError('air.kinematic_viscosity: goes with water.viscosity = "laminar"; leave out either.')
    if laminar and air.alpha is not None:
        raise LabError('air.alpha: goes with an artificial viscosity, not with water.viscosity = "laminar".')
    if air.density > water.density:
        raise LabError(f"air.density: {show(air.density, 'kg/m^3')} is more than that of the water; take less.")
    room = tank.extent[1] - (depth(preset) if water.region is None else 0.0)
    if room < liquid(preset).spacing:
        raise LabError(
            "air: the water leaves it no room of a particle's height; take less water, or smaller particles."
        )
    slow = float(np.sqrt((GAMMA - 1.0) * preset.run.gravity * room)) / SLOWEST
    sound = sound_of_air(air, liquid(preset).sound_speed)
    if sound < slow:
        raise LabError(
            f"air.sound_speed: air of {show(sound, 'm/s')} would be compressed by its own weight; take at least "
            f"{show(slow, 'm/s')}."
        )
