"""What a preset may say, and what comes of it.

The keys of `material` and of the motions, and the names of the contact laws, come from `solvers`: a
new motion or law in its registry is a new key or word here. Each section below is a dataclass that
`lab.reader` fills, in SI.
"""

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, make_dataclass, replace
from typing import Annotated, Literal, get_type_hints

from pydantic import BaseModel, ConfigDict

from lab.errors import LabError
from lab.outline import Point, area, rectangle, simple_polygon
from lab.reader import check_keys, read
from lab.units import show
from solvers.laws import NORMAL, TANGENTIAL
from solvers.materials import Material
from solvers.motions import MOTIONS
from solvers.quantity import Interval, Unit

DENSEST = math.pi / math.sqrt(12)  # largest share of a plane that equal discs cover (Thue)

Length = Annotated[float, Unit("m"), Interval(gt=0)]
Time = Annotated[float, Unit("s"), Interval(gt=0)]
Rate = Annotated[float, Unit("Hz"), Interval(gt=0)]


@dataclass(frozen=True)
class TankGiven:
    """A tank as a preset gives it: width and height, or an outline."""

    width: Length | None = None
    height: Length | None = None
    outline: Annotated[tuple[tuple[float, float], ...], Unit("m")] | None = None


@dataclass(frozen=True)
class Tank:
    """The tank's outline (m) in its own frame, a simple polygon, counter-clockwise."""

    outline: tuple[tuple[float, float], ...]

    @property
    def width(self) -> float:
        """Largest extent sideways (m)."""
        across = [y for y, _ in self.outline]
        return max(across) - min(across)

    @property
    def height(self) -> float:
        """Largest extent upwards (m)."""
        upwards = [z for _, z in self.outline]
        return max(upwards) - min(upwards)


@dataclass(frozen=True)
class Grains:
    """Spheres in a plane, diameters uniform in diameter·(1 ± spread): so many, or so deep a bed."""

    diameter: Length
    spread: Annotated[float, Interval(ge=0, le=0.5)] = 0.0
    count: Annotated[int, Interval(ge=1, le=1_000_000)] | None = None
    depth: Length | None = None


WallGiven = make_dataclass(
    "WallGiven",
    [
        (name, hint | None, None)
        for name, hint in get_type_hints(Material, include_extras=True).items()
        if name != "density"
    ],
    frozen=True,
)


@dataclass(frozen=True)
class Contact:
    """The contact laws, and the factor on Young's moduli that buys larger steps."""

    normal: Literal[*NORMAL] = "hertz-viscoelastic"
    tangential: Literal[*TANGENTIAL] = "haff-werner"
    stiffness_scale: Annotated[float, Interval(gt=0, le=1)] = 1.0


@dataclass(frozen=True)
class MotionGroup:
    """What moves the tank."""

    soft_start: Annotated[float, Unit("s"), Interval(ge=0)] = 0.0

    @property
    def parts(self) -> dict[str, object]:
        """The motions in use, by name, innermost first."""
        named = {name: getattr(self, name) for name in MOTIONS}
        return {name: part for name, part in named.items() if part is not None}


Motion = make_dataclass(
    "Motion",
    [(name, kind | None, None) for name, kind in MOTIONS.items()],
    bases=(MotionGroup,),
    frozen=True,
)


@dataclass(frozen=True)
class Run:
    """How long, how often and how finely; `duration` is derived where a motion has an end."""

    duration: Time | None = None
    repeats: Annotated[int, Interval(ge=1, le=100_000)] = 1
    seed: Annotated[int, Interval(ge=0, le=2**31 - 1)] = 1
    step: Time | Literal["auto"] = "auto"
    force_step: bool = False
    gravity: Annotated[float, Unit("m/s^2"), Interval(gt=0)] = 9.81
    settle_limit: Time = 5.0
    rest: Annotated[float, Interval(gt=0)] = 1e-6
    threads: Annotated[int, Interval(ge=0, le=1024)] = 0


@dataclass(frozen=True)
class Record:
    """How often the series and the frames are sampled."""

    series_rate: Rate = 100.0
    picture_rate: Rate = 25.0


@dataclass(frozen=True)
class Video:
    """The picture's size in pixels, what colours the grains, whose frame, the playback speed."""

    width: Annotated[int, Interval(ge=320, le=7680)] = 1280
    height: Annotated[int, Interval(ge=180, le=4320)] = 720
    colour: Literal["speed", "displacement", "layer"] = "speed"
    frame: Literal["tank", "earth"] = "tank"
    speed: Annotated[float, Interval(gt=0)] = 1.0


@dataclass(frozen=True)
class Given:
    """A whole preset as read. `based_on` has been followed by then."""

    title: str
    tank: TankGiven
    grains: Grains
    material: Material
    source: str = ""
    reports: str = ""
    based_on: str = ""
    wall: WallGiven = field(default_factory=WallGiven)
    contact: Contact = field(default_factory=Contact)
    motion: Motion = field(default_factory=Motion)
    run: Run = field(default_factory=Run)
    record: Record = field(default_factory=Record)
    video: Video = field(default_factory=Video)


class Resolved(BaseModel):
    """A preset in full, in SI. To JSON and back: `model_dump_json`, `model_validate_json`."""

    model_config = ConfigDict(frozen=True)

    title: str
    source: str
    reports: str
    tank: Tank
    grains: Grains
    material: Material
    wall: Material
    contact: Contact
    motion: Motion
    run: Run
    record: Record
    video: Video


def resolve(table: Mapping) -> Resolved:
    """A preset's table, inheritance and overrides done, in full.

    Raises LabError, one sentence with the dotted key.
    """
    check_keys(Given, table)
    given = read(Given, table)
    tank = _tank(given.tank)
    _check_grains(given.grains, tank)
    _check_dissipation(given.material, "material", needed=True)
    _check_dissipation(given.wall, "wall", needed=False)
    _check_video(given.video)
    return Resolved(
        title=given.title,
        source=given.source,
        reports=given.reports,
        tank=tank,
        grains=given.grains,
        material=given.material,
        wall=_wall(given.wall, given.material),
        contact=given.contact,
        motion=given.motion,
        run=replace(given.run, duration=_duration(given)),
        record=given.record,
        video=given.video,
    )


def _tank(given: TankGiven) -> Tank:
    sides = {"width": given.width, "height": given.height}
    if given.outline is not None:
        if any(sides.values()):
            raise LabError("tank.outline: give either an outline or a width and a height, not both.")
        try:
            return Tank(simple_polygon(given.outline))
        except LabError as error:
            raise LabError(f"tank.outline: {error}") from None
    for name, side in sides.items():
        if side is None:
            raise LabError(f"tank.{name}: missing; give width and height, or an outline.")
    return Tank(rectangle(given.width, given.height))


def _check_grains(grains: Grains, tank: Tank) -> None:
    if (grains.count is None) == (grains.depth is None):
        got = "neither" if grains.count is None else "both"
        raise LabError(f"grains.depth: give exactly one of depth and count (got {got}).")
    largest = grains.diameter * (1 + grains.spread)
    if largest >= min(tank.width, tank.height):
        size = show(largest, "m")
        raise LabError(f"grains.diameter: grains of up to {size} do not fit into the tank.")
    if grains.depth is None:
        _check_room(grains, tank.outline)
    elif grains.depth >= tank.height:
        raise LabError(
            f"grains.depth: {show(grains.depth, 'm')} must be less than the tank's height, {show(tank.height, 'm')}."
        )
    elif grains.depth < grains.diameter:
        raise LabError(f"grains.depth: {show(grains.depth, 'm')} is less than one grain, {show(grains.diameter, 'm')}.")


def _check_room(grains: Grains, outline: tuple[Point, ...]) -> None:
    """Raise LabError for more grains than the tank has room for in the densest lattice."""
    mean_square = grains.diameter * grains.diameter * (1 + grains.spread * grains.spread / 3)
    if grains.count * math.pi / 4 * mean_square > DENSEST * area(outline):
        raise LabError(f"grains.count: {grains.count} grains do not fit into the tank.")


def _check_dissipation(material: Material | WallGiven, section: str, needed: bool) -> None:
    given = [material.restitution, material.dissipative_time]
    if None not in given:
        raise LabError(f"{section}.restitution: give restitution or dissipative_time, not both.")
    if needed and given == [None, None]:
        raise LabError(f"{section}.restitution: missing; give restitution or dissipative_time.")


def _check_video(video: Video) -> None:
    for name in ("width", "height"):
        if getattr(video, name) % 2:
            raise LabError(f"video.{name}: must be even for H.264 (got {getattr(video, name)}).")


def _wall(given: WallGiven, material: Material) -> Material:
    """The wall's material: what is not given is the grains'."""
    own = {name: value for name, value in asdict(given).items() if value is not None}
    if "restitution" in own:
        own["dissipative_time"] = None
    elif "dissipative_time" in own:
        own["restitution"] = None
    return replace(material, **own)


def _duration(given: Given) -> float:
    """The run's duration (s): as given, else until the last motion that has an end is over."""
    if given.run.duration is not None:
        return given.run.duration
    parts = given.motion.parts.values()
    try:
        derived = max((part.duration() for part in parts), default=0.0)
    except ArithmeticError:
        derived = math.inf
    if not 0.0 < derived < math.inf:
        raise LabError('run.duration: missing, and no motion has an end of its own; give e.g. "8 s".')
    return derived
