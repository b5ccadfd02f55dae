"""The air over the water, as a preset gives it."""

from dataclasses import dataclass
from typing import Annotated, Literal

from solvers.fluid.phases.interfaces import INTERFACES
from solvers.machine.marks import Doc, Interval, Unit, Usual

REAL_SOUND = 343.0  # m/s, of air at 20 °C


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
    stiff_from: Annotated[
        Annotated[float, Unit("s"), Interval(gt=0)] | None,
        Doc(
            "Time from which the air has this speed of sound. Until then it is soft, with the water's speed of sound, "
            "and steps are as long as the water's; without it the air is the same throughout."
        ),
    ] = None
    alpha: Annotated[
        Annotated[float, Interval(ge=0, le=1)] | None,
        Doc("Strength of the air's artificial viscosity; the water's without it."),
    ] = None
    kinematic_viscosity: Annotated[
        Annotated[float, Unit("m^2/s"), Interval(gt=0)] | None,
        Doc('Viscosity of the air, for water.viscosity = "laminar-stress".'),
    ] = None
    surface_tension: Annotated[
        Annotated[float, Unit("N/m"), Interval(ge=0)],
        Usual(0.0, 0.1, "N/m"),
        Doc("Tension of the surface between water and air; 0.072 N/m of clean water."),
    ] = 0.0
    reduced: Annotated[
        bool,
        Doc(
            "Whether the pressures between particles are over those of this fluid at rest, as one needs that is nearly "
            "as heavy as the water; gauges show the whole."
        ),
    ] = False
    interface: Annotated[
        Literal[*INTERFACES] | None,
        Doc("What acts between water and air, see `solvers.fluid.phases.interfaces`; by default the scheme's."),
    ] = None


def sound_of_air(air: Air, sound: float) -> float:
    """Speed of sound (m/s) of the air over water with a speed of sound (m/s)."""
    return {"equal": sound, "real": REAL_SOUND}.get(air.sound_speed, air.sound_speed)
