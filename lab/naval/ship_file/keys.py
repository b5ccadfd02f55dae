"""The keys of a ship file. x is forward from the aft perpendicular, y to starboard, z from the keel."""

from dataclasses import dataclass, field
from typing import Annotated, Literal

from solvers.machine.marks import Doc, Interval, Unit

Place = Annotated[float, Unit("m"), Interval(ge=-1e3, le=1e3)]
Size = Annotated[float, Unit("m"), Interval(gt=0, le=1e3)]
Area = Annotated[float, Unit("m^2"), Interval(ge=0, le=1e6)]
Mass = Annotated[float, Unit("t"), Interval(ge=0, le=1e7)]
Share = Annotated[float, Interval(ge=0, le=1)]
Point = Annotated[tuple[float, float, float], Unit("m"), Interval(ge=-1e3, le=1e3)]
Polygon = Annotated[tuple[tuple[Place, Place], ...], Doc("Corners y, z of a section.")]
Density = Annotated[float | Literal["salt", "fresh"], Unit("kg/m^3"), Interval(ge=500, le=2000)]
Side = Literal["as-drawn", "port", "both", "pair"]
Filling = Literal["partly-filled", "filled", "filled-as-loaded", "no-grain"]
FREE_SURFACES = "second-moment", "transfer"


@dataclass(frozen=True)
class HullKeys:
    """The hull's lines and lengths, as `cargolab hull` takes them."""

    lines: Annotated[str, Doc("File of offsets (CSV), or of a surface (STL, OBJ), or a GHS geometry file (GF).")]
    lbp: Annotated[
        Size | None, Doc("Length between perpendiculars; without it they are at her outermost stations.")
    ] = None
    ap: Annotated[Place, Doc("Place x of the aft perpendicular.")] = 0.0
    lwl: Annotated[Size | None, Doc("Length in the waterline, for the weather criterion.")] = None
    keels: Annotated[Area, Doc("Area of bilge and bar keels.")] = 0.0
    sharp: Annotated[bool, Doc("Whether her bilges are sharp.")] = False
    fair: Annotated[bool, Doc("Fair curves between the offsets of a station.")] = False
    stations: Annotated[int, Interval(ge=3, le=1001), Doc("Fewest cuts of a surface.")] = 41
    scale: Annotated[float, Interval(ge=1e-4, le=1e4), Doc("Metres in a surface's unit.")] = 1.0
    up: Annotated[Literal["y", "z"], Doc("The axis that is up in a surface's file.")] = "z"
    origin: Annotated[Point, Doc("Place in a surface's file that becomes the origin, z up.")] = (0.0, 0.0, 0.0)
    mirror: Annotated[bool, Doc("A surface is half a hull: add the other side.")] = False
    close: Annotated[bool, Doc("Close a surface's flat holes.")] = False


@dataclass(frozen=True)
class WaterKeys:
    """The sea."""

    density: Annotated[Density, Doc('Of the sea: "salt" (1025 kg/m³), "fresh" (1000 kg/m³) or a density.')] = "salt"


@dataclass(frozen=True)
class WindKeys:
    """What the weather criterion needs of her profile."""

    area: Annotated[Area, Doc("Area exposed to wind.")]
    lever: Annotated[Place, Doc("Height of its centre above half the draught.")]


@dataclass(frozen=True)
class OpeningKeys:
    """A point that must stay above water."""

    place: Annotated[Point, Doc("Its x, y, z.")]
    kind: Annotated[Literal["opening", "deck"], Doc("A downflooding opening, or a point of the deck's edge.")] = (
        "opening"
    )


@dataclass(frozen=True)
class LengthKeys:
    """A part of a compartment with one section."""

    aft: Annotated[Place, Doc("Its aft end, x.")]
    forward: Annotated[Place, Doc("Its forward end, x.")]
    section: Polygon
    forward_section: Annotated[
        Polygon | None, Doc("Corners at its forward end, as many and in the same order; it narrows straight to them.")
    ] = None


@dataclass(frozen=True)
class SpaceKeys:
    """A tank or hold: one section from `aft` to `forward`, or several `lengths`, each with its own."""

    aft: Annotated[Place | None, Doc("Its aft end, x.")] = None
    forward: Annotated[Place | None, Doc("Its forward end, x.")] = None
    section: Annotated[Polygon | None, Doc("Corners y, z of its section, y to starboard, in order round it.")] = None
    forward_section: Annotated[
        Polygon | None, Doc("Corners at its forward end, as many and in the same order; it narrows straight to them.")
    ] = None
    lengths: Annotated[
        tuple[LengthKeys, ...], Doc("Lengths with sections of their own, {aft, forward, section}, from aft to forward.")
    ] = ()
    side: Annotated[
        Side,
        Doc(
            "as-drawn; port: the mirror image of what is drawn to starboard; both: one space of section and image, "
            "which communicate; pair: two spaces, NAME-p and NAME-s."
        ),
    ] = "as-drawn"
    permeability: Annotated[Share, Interval(gt=0, le=1), Doc("Share of the moulded volume that can be filled.")] = 1.0


@dataclass(frozen=True)
class TankKeys(SpaceKeys):
    """A tank with a liquid."""

    density: Annotated[Density, Doc('Of its contents, kg/m³, or "salt", "fresh".')] = "salt"
    consumable: Annotated[
        bool,
        Doc("Emptied on the way: its free surface is the largest up to 98 % (IS Code, B 3.1.3), whatever the level."),
    ] = False


@dataclass(frozen=True)
class WeightKeys:
    """A fixed weight: at a point, spread evenly from `aft` to `forward`, or by a `distribution` along her."""

    vcg: Annotated[Place, Doc("Height of its centre.")]
    mass: Annotated[Mass | None, Doc("Its mass; with a distribution that of its blocks.")] = None
    lcg: Annotated[Place | None, Doc("Place x of its centre; without it the middle of aft and forward.")] = None
    tcg: Annotated[Place, Doc("Place y of its centre.")] = 0.0
    fsm: Annotated[float, Unit("t m"), Interval(ge=0, le=1e9), Doc("Moment of a free surface in it.")] = 0.0
    aft: Annotated[Place | None, Doc("Where it begins along her.")] = None
    forward: Annotated[Place | None, Doc("Where it ends along her.")] = None
    distribution: Annotated[
        tuple[tuple[Place, Place, Mass], ...], Doc("Blocks of aft end, forward end and mass, each spread evenly.")
    ] = ()


@dataclass(frozen=True)
class FillKeys:
    """What is in a tank: one of full, mass, level."""

    full: Annotated[Share | None, Doc('Share of its volume, as "95 %" or 0.95.')] = None
    mass: Annotated[Mass | None, Doc("Mass in it.")] = None
    level: Annotated[Place | None, Doc("Height z of the surface, upright.")] = None
    density: Annotated[Density | None, Doc("Of these contents, if it is not the tank's.")] = None


@dataclass(frozen=True)
class CargoKeys:
    """What is in a hold: one of full, mass, level, and what the Grain Code assumes of it."""

    stowage: Annotated[float, Unit("m^3/t"), Interval(ge=1e-3, le=100), Doc("Stowage factor.")]
    filling: Annotated[Filling, Doc("What the Grain Code assumes; no-grain: nothing.")]
    full: Annotated[Share | None, Doc("Share of the hold's volume.")] = None
    mass: Annotated[Mass | None, Doc("Mass in it.")] = None
    level: Annotated[Place | None, Doc("Height z of the trimmed surface.")] = None
    moment: Annotated[
        Annotated[float, Unit("m^4"), Interval(ge=0, le=1e7)] | None,
        Doc("Volumetric heeling moment of the grain loading manual, without its factor, in place of the computed one."),
    ] = None


@dataclass(frozen=True)
class ConditionKeys:
    """A loading condition. Tanks and holds that it does not name are empty; the ship's own weights are aboard."""

    title: Annotated[str, Doc("What it is, in a line.")] = ""
    density: Annotated[Density | None, Doc("Of the sea, if it is not that of [water].")] = None
    fills: Annotated[dict[str, FillKeys], Doc("Contents of tanks.")] = field(default_factory=dict)
    cargo: Annotated[dict[str, CargoKeys], Doc("Contents of holds.")] = field(default_factory=dict)
    weights: Annotated[dict[str, WeightKeys], Doc("Further weights.")] = field(default_factory=dict)
    wind: Annotated[WindKeys | None, Doc("Area and lever at this draught, in place of [wind].")] = None


@dataclass(frozen=True)
class ShipKeys:
    """A ship file."""

    name: Annotated[str, Doc("Her name.")]
    hull: Annotated[HullKeys, Doc("Her lines.")]
    source: Annotated[str, Doc("Where the numbers come from.")] = ""
    free_surfaces: Annotated[
        Literal[*FREE_SURFACES],
        Doc("What corrects her levers: KG raised by second moments, or the actual transfer of the liquids."),
    ] = "second-moment"
    water: Annotated[WaterKeys, Doc("The sea.")] = field(default_factory=WaterKeys)
    wind: Annotated[WindKeys | None, Doc("Her profile; without it the weather criterion is not judged.")] = None
    openings: Annotated[dict[str, OpeningKeys], Doc("Points that must stay above water.")] = field(default_factory=dict)
    tanks: Annotated[dict[str, TankKeys], Doc("Her tanks.")] = field(default_factory=dict)
    holds: Annotated[dict[str, SpaceKeys], Doc("Her holds.")] = field(default_factory=dict)
    weights: Annotated[dict[str, WeightKeys], Doc("Lightship and other fixed weights.")] = field(default_factory=dict)
    conditions: Annotated[dict[str, ConditionKeys], Doc("Loading conditions.")] = field(default_factory=dict)
