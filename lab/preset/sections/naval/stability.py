"""What criteria of stability need to know of a whole ship, beside her section and her hold."""

from dataclasses import dataclass
from typing import Annotated, Literal

from lab.base.errors import LabError
from lab.preset.sections.ship import Ship
from solvers.machine.marks import Doc, Interval, Unit
from solvers.ship.naval.grain_code import ASSUMED

Length = Annotated[float, Unit("m"), Interval(gt=0, le=1e3)]
Area = Annotated[float, Unit("m^2"), Interval(ge=0, le=1e6)]


@dataclass(frozen=True)
class Stability:
    """The whole ship and the assumed shift of her grain, for `cargolab stability` and the sheets of criteria of runs.

    All is as large as the ship of the preset, a model's as a model; with `ship.scale` the sheets are of the full scale.
    The weather criterion is judged where area and lever of the wind are given.
    """

    length: Annotated[
        Length | None, Doc("Her length in the waterline, for the period of roll and the block; ship.length without it.")
    ] = None
    filling: Annotated[Literal[*ASSUMED], Doc("Which surface and which factor the Grain Code assumes of her hold.")] = (
        "partly-filled"
    )
    stowage: Annotated[
        Annotated[float, Unit("m^3/kg"), Interval(gt=0, le=1.0)] | None,
        Doc("Stowage factor of the cargo; as the bed of grains stows without it."),
    ] = None
    other_moment: Annotated[
        float,
        Unit("m^4"),
        Interval(ge=0),
        Doc("Volumetric heeling moment of grain in her other holds, factors included."),
    ] = 0.0
    free_surface: Annotated[
        float,
        Unit("kg m"),
        Interval(ge=0),
        Doc("Moment of free surfaces besides those of the tanks with water in the preset, taken off GM and levers."),
    ] = 0.0
    wind_area: Annotated[Area | None, Doc("Area above the water that the wind strikes from abeam.")] = None
    wind_lever: Annotated[Length | None, Doc("Height of that area's centre above half the draught.")] = None
    keel_area: Annotated[Area, Doc("Area of bilge and bar keels.")] = 0.0
    sharp_bilges: Annotated[bool, Doc("Whether her bilges are sharp.")] = False


def check_stability(given: Stability, ship: Ship | None) -> None:
    """Raise LabError for keys that lack what they go with."""
    if given == Stability():
        return
    if ship is None:
        raise LabError("stability: there is no ship to be judged; add a table [ship], or leave this out.")
    if (given.wind_area is None) != (given.wind_lever is None):
        name = "wind_area" if given.wind_area is None else "wind_lever"
        raise LabError(f"stability.{name}: missing; the weather criterion needs wind_area and wind_lever.")
    if given.length is not None and ship.length is None:
        raise LabError("ship.length: missing; the whole ship has a length, so say how many metres of section displace.")
