"""A case of flooding as a user writes it: a TOML file with units, in the form of presets.

Places are in the hull's own axes: x forward, y to starboard, z up.
"""

import tomllib
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Literal

from lab.base.errors import LabError
from lab.base.files import read_bytes
from lab.preset.reader import check_keys, read
from lab.preset.units import quoted, shown_path
from solvers.machine.marks import Doc, Interval, Unit
from solvers.ship.flooding.air import PRESSURE

LARGEST = 1_000_000  # bytes of a file
CASES = Path(__file__).with_name("cases")  # the lab's own

Length = Annotated[float, Unit("m"), Interval(gt=0, le=1e3)]
Place = Annotated[float, Unit("m"), Interval(ge=-1e3, le=1e3)]
Range = Annotated[tuple[float, float], Unit("m")]
Point = Annotated[tuple[float, float, float], Unit("m")]
Outline = Annotated[tuple[tuple[float, float], ...], Unit("m")]
Mass = Annotated[float, Unit("kg"), Interval(gt=0)]
Angle = Annotated[float, Unit("rad")]
Time = Annotated[float, Unit("s"), Interval(ge=0)]


@dataclass(frozen=True)
class HullShape:
    """The watertight hull: a `file` of offsets (CSV) or a surface (STL), or a section all along `length`.

    The section is a box of `breadth` and `depth`, or an `outline`; it begins at x = 0, its keel is at z = 0.
    """

    file: Annotated[str | None, Doc("A table of offsets or an STL file, as `cargolab hull` reads them.")] = None
    length: Annotated[Length | None, Doc("Length of a hull of one section.")] = None
    breadth: Annotated[Length | None, Doc("Breadth of a box.")] = None
    depth: Annotated[Length | None, Doc("Depth of a box, from keel to deck.")] = None
    bilge: Annotated[Length | None, Doc("Radius of a box's bilges.")] = None
    outline: Annotated[Outline | None, Doc("Corners y, z of the section, in place of breadth and depth.")] = None
    fair: Annotated[bool, Doc("Fair curves between the offsets of a station.")] = False
    scale: Annotated[float, Interval(gt=0), Doc("Metres in a surface's unit.")] = 1.0
    up: Annotated[Literal["y", "z"], Doc("The axis that is up in a surface's file.")] = "z"
    mirror: Annotated[bool, Doc("A surface is half a hull: add the other side.")] = False
    close: Annotated[bool, Doc("Close a surface's flat holes.")] = False
    stations: Annotated[int, Interval(ge=3, le=1001), Doc("Fewest cuts of a surface.")] = 41


@dataclass(frozen=True)
class Sea:
    """The calm water that she floats in."""

    density: Annotated[float, Unit("kg/m^3"), Interval(ge=500, le=2000), Doc("Density of the water.")] = 1025.0
    gravity: Annotated[float, Unit("m/s^2"), Interval(gt=0, le=100), Doc("Gravity.")] = 9.81


@dataclass(frozen=True)
class Weight:
    """The ship without the water in her rooms: mass or draught, centre of gravity, what she may do."""

    vcg: Annotated[Place, Doc("Height of her centre of gravity, KG.")]
    mass: Annotated[Mass | None, Doc("Her mass; or give `draught`.")] = None
    draught: Annotated[Length | None, Doc("Her even draught before she floods, in place of `mass`.")] = None
    lcg: Annotated[Place | None, Doc("Place x of G; without it she floats on an even keel before she floods.")] = None
    tcg: Annotated[Place, Doc("Place y of G, to starboard.")] = 0.0
    trims: Annotated[bool, Doc("Whether she trims freely.")] = True
    lolls: Annotated[Literal["starboard", "port"], Doc("To which side she falls if she cannot stand upright.")] = (
        "starboard"
    )
    capsize: Annotated[Angle, Interval(gt=0, le=1.5707963267948966), Doc("Heel beyond which she is lost.")] = (
        1.5707963267948966
    )
    kind: Annotated[Literal["cargo", "passenger"], Doc("Which limits of heel the factor s has.")] = "cargo"


@dataclass(frozen=True)
class RoomKeys:
    """A room: a box by `along`, `across` and `height`, or an `outline` all along."""

    along: Annotated[Range, Doc("From which x to which.")]
    across: Annotated[Range | None, Doc("From which y to which, of a box.")] = None
    height: Annotated[Range | None, Doc("From which z to which, of a box.")] = None
    bilge: Annotated[Length | None, Doc("Radius of a box's lower corners.")] = None
    outline: Annotated[Outline | None, Doc("Corners y, z of its section, in place of `across` and `height`.")] = None
    permeability: Annotated[float, Interval(gt=0, le=1), Doc("Share of it that water can fill.")] = 1.0
    air: Annotated[
        Literal["vented", "adiabatic", "isothermal"],
        Doc("Whether its air leaves freely, or is pressed together without or with giving off its heat."),
    ] = "vented"
    level: Annotated[Place | None, Doc("Height z of water in it at the start, as she lies upright.")] = None


@dataclass(frozen=True)
class OpeningKeys:
    """An opening `between` two rooms, or a room and the "sea": a rectangle, a circle, or an `area` at one height."""

    between: Annotated[tuple[str, str], Doc('Names of the two rooms, or of a room and "sea".')]
    at: Annotated[Point, Doc("Its centre x, y, z.")]
    face: Annotated[
        Literal["side", "bulkhead", "deck"],
        Doc("How it lies: in the ship's side, across her as in a bulkhead, or level as in deck and bottom."),
    ]
    width: Annotated[Length | None, Doc("Width of a rectangle, level; in a deck along her.")] = None
    height: Annotated[Length | None, Doc("Height of a rectangle; in a deck its breadth across her.")] = None
    diameter: Annotated[Length | None, Doc("Diameter of a circle.")] = None
    area: Annotated[
        Annotated[float, Unit("m^2"), Interval(gt=0, le=1e4)] | None, Doc("Area of a square, in place of its sides.")
    ] = None
    discharge: Annotated[float, Interval(gt=0, le=1), Doc("Coefficient of discharge C_d.")] = 0.6
    opens: Annotated[Time | None, Doc("When it opens; false: by itself never.")] = 0.0
    leak: Annotated[float, Interval(ge=0, le=1), Doc("Share of its area that leaks while it is closed.")] = 0.0
    leak_head: Annotated[float, Unit("m"), Interval(ge=0), Doc("Head from which on it leaks.")] = 0.0
    collapse: Annotated[Length | None, Doc("Head at which it gives way while it is closed.")] = None


@dataclass(frozen=True)
class Swing:
    """Heave and roll with added mass and drag; without this table she lies at rest at each moment."""

    gyradius: Annotated[Length, Doc("Gyradius of roll about G, without water.")]
    added_mass: Annotated[Mass, Doc("Added mass in heave.")]
    added_inertia: Annotated[float, Interval(ge=0), Doc("Added inertia in roll, of that about G.")] = 0.3
    drag: Annotated[float, Interval(ge=0), Doc("Coefficient of drag C_D in heave, of length times breadth.")] = 1.0
    damping: Annotated[float, Interval(ge=0, le=1), Doc("Damping of roll, of critical.")] = 0.05
    release: Annotated[
        Annotated[float, Unit("m"), Interval(ge=0, le=1e3)] | None,
        Doc("Draught at which she is let go; as she floats without it."),
    ] = None
    heel: Annotated[Angle, Doc("Heel at which she is let go, positive starboard down.")] = 0.0


@dataclass(frozen=True)
class RunKeys:
    """How long she is looked at."""

    duration: Annotated[float, Unit("s"), Interval(gt=0), Doc("How long.")]
    pressure: Annotated[float, Unit("Pa"), Interval(gt=0), Doc("Pressure of the air outside.")] = PRESSURE


@dataclass(frozen=True)
class Case:
    """A ship with rooms and openings, and how long she floods."""

    title: Annotated[str, Doc("What the case is, in a line.")]
    hull: Annotated[HullShape, Doc("The watertight hull.")]
    ship: Annotated[Weight, Doc("The ship without the water in her rooms.")]
    run: Annotated[RunKeys, Doc("How long she is looked at.")]
    rooms: Annotated[dict[str, RoomKeys], Doc("The rooms.")] = field(default_factory=dict)
    openings: Annotated[dict[str, OpeningKeys], Doc("The openings.")] = field(default_factory=dict)
    water: Annotated[Sea, Doc("The sea.")] = field(default_factory=Sea)
    motion: Annotated[Swing | None, Doc("Heave and roll, where she sinks fast.")] = None
    source: Annotated[str, Doc("Where the case comes from.")] = ""


@dataclass(frozen=True)
class LoadedCase:
    """A case, its name, its text, and the folder that files in it are relative to."""

    name: str
    text: str
    case: Case
    folder: Path


def examples() -> list[str]:
    """Names of the cases that come with the lab."""
    return sorted(path.stem for path in CASES.glob("*.toml"))


def load_case(given: str | Path, overrides: dict | None = None) -> LoadedCase:
    """The case of a file, or one of the lab's own by name; `overrides`: dotted keys. Raises LabError."""
    path = Path(given)
    own = CASES / f"{given}.toml"
    if str(given) in examples():
        path = own
    try:
        content = read_bytes(path, LARGEST + 1)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or "no file has such a name"
        raise LabError(
            f"{shown_path(given)}: cannot be read ({reason}); give a TOML file, or one of {', '.join(examples())}."
        ) from None
    if content is None or len(content) > LARGEST:
        raise LabError(f"{shown_path(given)}: is not a file of a case; give a TOML file.")
    try:
        text = content.decode("utf-8-sig")
        table = tomllib.loads(text)
    except (UnicodeDecodeError, tomllib.TOMLDecodeError, ValueError, RecursionError) as error:
        raise LabError(f"{path.name}: not valid TOML: {error}.") from None
    return LoadedCase(path.stem, text, _case(table, overrides or {}), path.parent)


def _case(table: dict, overrides: dict) -> Case:
    for dotted, value in overrides.items():
        *way, last = dotted.split(".")
        inner = table
        for key in way:
            inner = inner.setdefault(key, {})
            if not isinstance(inner, dict):
                raise LabError(f"--set {quoted(dotted)}: {key} is no table; look at the key.")
        inner[last] = value
    check_keys(Case, table)
    return read(Case, table)
