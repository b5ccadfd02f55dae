"""What a preset may say, and what comes of it.

The keys of `material` and of the motions, and the names of the contact laws, come from `solvers`: a
new motion or law in its registry is a new key or word here. Each section below is a dataclass that
`lab.preset.reader` fills, in SI.
"""

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, make_dataclass, replace
from pathlib import Path
from typing import Annotated, Literal, get_type_hints

import numpy as np
from pydantic import BaseModel, ConfigDict, model_validator

from lab.base.errors import LabError
from lab.preset.accuracy import DEFAULT, LEVELS
from lab.preset.bed_file import read_bed
from lab.preset.history import HistoryGiven, check_end, check_start, read_history
from lab.preset.outline import Point, area, rectangle, simple_polygon
from lab.preset.parts import check_parts
from lab.preset.reader import check_keys, read
from lab.preset.sections.video import Record, Video, check_video
from lab.preset.shapes import Shape, ShapeGiven, by_number, read_shapes
from lab.preset.ship import ShipGiven, WaterGiven, WavesGiven
from lab.preset.ship_checks import check_ship
from lab.preset.units import needed, show
from solvers.grains.laws import COHESION, NORMAL, ROLLING, TANGENTIAL
from solvers.grains.materials import Material
from solvers.grains.shapes.given import CONTACTS
from solvers.grains.sizes import Sizes
from solvers.machine.marks import Interval, Unit
from solvers.motion import MOTIONS
from solvers.motion.history import History
from solvers.tank.outline import top_edges
from solvers.tank.parts import Part

DENSEST = math.pi / math.sqrt(12)  # largest share of a plane that equal discs cover (Thue)
MOST_LINING = 20_000  # grains that line a tank
LEAST_RESTITUTION, LONGEST_DISSIPATION = 1e-6, 0.1  # and s: beyond these nothing rebounds that one could see
MOST_PLACES = 4e6  # of the largest grains, in a tank that is filled: its lattice is held in memory

Length = Annotated[float, Unit("m"), Interval(gt=0)]
Time = Annotated[float, Unit("s"), Interval(gt=0)]


@dataclass(frozen=True)
class TankGiven:
    """A tank as a preset gives it: width and height, or an outline; whether it has a lid and a lining of grains."""

    width: Length | None = None
    height: Length | None = None
    outline: Annotated[tuple[tuple[float, float], ...], Unit("m")] | None = None
    lid: bool = True
    roughness: Length | None = None


@dataclass(frozen=True)
class Tank:
    """The tank's outline (m) in its own frame, a simple polygon, counter-clockwise.

    `open_edges` carry no wall; edge k runs from corner k to corner k + 1. `roughness` is the diameter (m) of the fixed
    grains that line floor and sides, None where these are smooth.
    """

    outline: tuple[tuple[float, float], ...]
    open_edges: tuple[int, ...] = ()
    roughness: float | None = None

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
class GrainsGiven:
    """Spheres in a plane as a preset gives them: so many, or so deep a bed, or a file of single ones.

    Diameters are uniform in diameter·(1 ± spread), or normal with the relative standard deviation `spread`, cut at ± 3
    of these and at a tenth of the diameter, or by a table of [diameter, share], each class uniform within ± spread.
    `shares` of a table or of shapes are by number or by mass. `orientation`: by how much irregular grains are turned
    at the start (rad). `surface`, after Spandonidis (2016), section 5.3.1: `solvers/grains/filling.py` says what is
    done for it. `region`: corners (m) of the part of the tank, such as a funnel in it, in which the grains start.
    `settled_as`: round outlines may settle as discs, into the very bed that these would have.
    """

    diameter: Length | None = None
    spread: Annotated[float, Interval(ge=0, le=0.5)] = 0.0
    distribution: Literal["uniform", "normal", "table"] = "uniform"
    table: tuple[tuple[Length, Annotated[float, Interval(gt=0)]], ...] | None = None
    shares: Literal["number", "mass"] = "number"
    orientation: Annotated[float, Unit("rad")] | Literal["random"] = "random"
    count: Annotated[int, Interval(ge=1, le=1_000_000)] | None = None
    depth: Length | None = None
    surface: Literal["undisturbed", "slightly-disturbed", "disturbed"] = "slightly-disturbed"
    region: Annotated[tuple[tuple[float, float], ...], Unit("m")] | None = None
    bed: str | None = None
    reuse_bed: bool = True
    settled_as: Literal["outlines", "discs"] = "outlines"


@dataclass(frozen=True)
class Grains(GrainsGiven):
    """The grains in full: `diameter` (m) is the mean, `listed` what `bed` lists: y, z, radius, v_y, v_z, ω in SI.

    The shares in `table` are by number. Of irregular grains it has the diameters and shares of all shapes.
    """

    listed: tuple[tuple[float, float, float, float, float, float], ...] = ()

    @property
    def sizes(self) -> Sizes:
        """The distribution that the diameters are drawn from."""
        classes = self.table or ((self.diameter, 1.0),)
        return Sizes(classes, self.spread, self.distribution == "normal")

    @property
    def range(self) -> tuple[float, float]:
        """Smallest and largest diameter (m) that may come."""
        if self.listed:
            radius = [grain[2] for grain in self.listed]
            return 2.0 * min(radius), 2.0 * max(radius)
        return self.sizes.range


WallGiven = make_dataclass(
    "WallGiven",
    [
        (name, hint | None, None)
        for name, hint in get_type_hints(Material, include_extras=True).items()
        if name != "density"
    ],
    frozen=True,
)


KindGiven = make_dataclass(
    "KindGiven",
    [
        ("share", Annotated[float, Interval(gt=0, lt=1)]),
        *((name, hint | None, None) for name, hint in get_type_hints(Material, include_extras=True).items()),
        ("against", WallGiven | None, None),
    ],
    frozen=True,
)


@dataclass(frozen=True)
class Kind:
    """A share of the grains, by number, that is of another material than the rest.

    `against` says how a grain of this kind touches one of the rest; None: by the mean of the two materials.
    """

    share: float
    material: Material
    against: Material | None = None


StiffnessScale = Annotated[float, Interval(gt=0, le=1)]


@dataclass(frozen=True)
class ContactGiven:
    """The contact laws, and the factor on Young's moduli that buys larger steps (None: as `run.accuracy` has it).

    `outlines`: the rule by which irregular grains touch; `nodes`: on each outline, for the rules
    that have nodes.
    """

    normal: Literal[*NORMAL] = "hertz-viscoelastic"
    tangential: Literal[*TANGENTIAL] = "haff-werner"
    rolling: Literal[*ROLLING] = "none"
    cohesion: Literal[*COHESION] = "none"
    stiffness_scale: StiffnessScale | None = None
    outlines: Literal[*CONTACTS] = "continuous"
    nodes: Annotated[int, Interval(ge=8, le=2000)] = 120


@dataclass(frozen=True)
class Contact(ContactGiven):
    """The contact laws and the stiffness in full."""

    stiffness_scale: StiffnessScale = field(kw_only=True)


@dataclass(frozen=True)
class MotionGroup:
    """What moves the tank."""

    soft_start: Annotated[float, Unit("s"), Interval(ge=0)] = 0.0

    @property
    def parts(self) -> dict[str, object]:
        """The motions in use, by name, innermost first; those of a record are the outermost."""
        named = {name: getattr(self, name) for name in MOTIONS}
        used = {name: part for name, part in named.items() if part is not None}
        recorded = self.history.motions if self.history else {}
        return used | {f"history.{name}": part for name, part in recorded.items()}


def _motions(name: str, history: type) -> type:
    """A section with every registered motion and a `history`, any of which may be left out."""
    kinds = {**MOTIONS, "history": history}
    return make_dataclass(
        name, [(key, kind | None, None) for key, kind in kinds.items()], bases=(MotionGroup,), frozen=True
    )


MotionGiven = _motions("MotionGiven", HistoryGiven)
Motion = _motions("Motion", History)


@dataclass(frozen=True)
class RunGiven:
    """How long, how often and how finely; `duration` is derived where a motion has an end."""

    duration: Time | None = None
    repeats: Annotated[int, Interval(ge=1, le=100_000)] = 1
    seed: Annotated[int, Interval(ge=0, le=2**31 - 1)] = 1
    settle: bool = True
    step: Annotated[float, Unit("s"), Interval(gt=0, le=1.0)] | Literal["auto"] = "auto"
    force_step: bool = False
    accuracy: Literal[*LEVELS] = DEFAULT
    gravity: Annotated[float, Unit("m/s^2"), Interval(gt=0)] = 9.81
    settle_limit: Time = 5.0
    rest: Annotated[float, Interval(gt=0)] = 1e-6
    threads: Annotated[int, Interval(ge=0, le=1024)] = 0
    arch: Literal["auto", "cpu", "cuda", "vulkan"] = "auto"
    schedule: Literal["auto", "per-world", "per-band", "per-grain"] = "auto"
    precision: Literal["f64", "f32", "mixed"] = "f64"
    integrator: Literal["verlet", "symplectic-euler", "gear"] = "verlet"


@dataclass(frozen=True)
class Run(RunGiven):
    """The run with its duration."""

    duration: Time = field(kw_only=True)


@dataclass(frozen=True)
class Given:
    """A whole preset as read. `based_on` has been followed by then, and names the base as people call it."""

    title: str
    tank: TankGiven
    grains: GrainsGiven
    material: Material
    source: str = ""
    reports: str = ""
    based_on: str = ""
    quick: str = ""  # how a quick variant differs from its preset
    wall: WallGiven = field(default_factory=WallGiven)
    kinds: dict[str, KindGiven] = field(default_factory=dict)
    shapes: dict[str, ShapeGiven] = field(default_factory=dict)
    contact: ContactGiven = field(default_factory=ContactGiven)
    motion: MotionGiven = field(default_factory=MotionGiven)
    parts: dict[str, Part] = field(default_factory=dict)
    ship: ShipGiven | None = None
    water: WaterGiven = field(default_factory=WaterGiven)
    waves: WavesGiven | None = None
    run: RunGiven = field(default_factory=RunGiven)
    record: Record = field(default_factory=Record)
    video: Video = field(default_factory=Video)


class Resolved(BaseModel):
    """A preset in full, in SI. To JSON and back: `model_dump_json`, `model_validate_json`."""

    model_config = ConfigDict(frozen=True)

    title: str
    source: str
    reports: str
    quick: str
    based_on: str = ""  # recordings of earlier versions do not say it
    tank: Tank
    grains: Grains
    material: Material
    wall: Material
    kinds: dict[str, Kind]
    shapes: dict[str, Shape] = {}  # recordings of earlier versions have none
    contact: Contact
    motion: Motion
    parts: dict[str, Part]
    ship: ShipGiven | None = None
    water: WaterGiven = WaterGiven()
    waves: WavesGiven | None = None
    run: Run
    record: Record
    video: Video

    @model_validator(mode="after")
    def _rebounds(self) -> "Resolved":
        """What a damaged or changed file may lack: a material that says nothing of its rebound is none."""
        given = [self.material, self.wall, *(kind.material for kind in self.kinds.values())]
        if any(material.restitution is None and material.dissipative_time is None for material in given):
            raise ValueError("a material has neither restitution nor dissipative_time")
        if any(not material.restitution_speed > 0.0 for material in given):
            raise ValueError("a material's restitution is that of no speed")
        return self


def resolve(table: Mapping) -> Resolved:
    """A preset's table, inheritance and overrides done, in full.

    Raises LabError, one sentence with the dotted key.
    """
    check_keys(Given, table)
    given = read(Given, table)
    tank = _tank(given.tank)
    (_check_shapely if given.shapes else _check_shapeless)(given)
    shapes = read_shapes(given.shapes, given.grains.diameter, given.grains.shares)
    grains = _grains(given.grains, shapes, tank, given.run.settle)
    _check_dissipation(given.material, "material", needed=True)
    _check_dissipation(given.wall, "wall", needed=False)
    _check_cohesion(given.contact.cohesion, given.material)
    motion = _motion(given.motion)
    run = Run(**{**vars(given.run), "duration": _duration(given.run, motion)})
    check_parts(given.parts, tank.outline)
    check_ship(given.ship, given.waves, bool(motion.parts), tank.outline)
    check_video(given.video)
    return Resolved(
        title=given.title,
        source=given.source,
        reports=given.reports,
        quick=given.quick,
        based_on=given.based_on,
        tank=tank,
        grains=grains,
        material=given.material,
        wall=_over(given.material, given.wall),
        kinds=_kinds(given.kinds, given.material),
        shapes=shapes,
        contact=_contact(given.contact, run),
        motion=motion,
        parts=given.parts,
        ship=given.ship,
        water=given.water,
        waves=given.waves,
        run=run,
        record=given.record,
        video=given.video,
    )


def _tank(given: TankGiven) -> Tank:
    outline = np.array(_outline(given))
    open_edges = () if given.lid else top_edges(outline)
    if not given.lid and not open_edges:
        raise LabError("tank.lid: this outline has no edge along its top to leave open; leave lid out.")
    tank = Tank(tuple(map(tuple, outline.tolist())), open_edges, given.roughness)
    check_lining(tank)
    return tank


def check_lining(tank: Tank) -> None:
    """Raise LabError for grains that are too large or too many to line a tank."""
    if tank.roughness is None:
        return
    outline, size = np.array(tank.outline), show(tank.roughness, "m")
    around = float(np.hypot(*(outline - np.roll(outline, 1, axis=0)).T).sum())
    if tank.roughness > 0.25 * min(tank.height, tank.width):
        raise LabError(f"tank.roughness: grains of {size} are too large to line the tank.")
    if around > MOST_LINING * tank.roughness:
        raise LabError(f"tank.roughness: more than {MOST_LINING} grains of {size} go around.")


def _outline(given: TankGiven) -> tuple[Point, ...]:
    sides = {"width": given.width, "height": given.height}
    if given.outline is not None:
        if any(sides.values()):
            raise LabError("tank.outline: give either an outline or a width and a height, not both.")
        try:
            return simple_polygon(given.outline)
        except LabError as error:
            raise LabError(f"tank.outline: {error}") from None
    for name, side in sides.items():
        if side is None:
            raise LabError(f"tank.{name}: missing; give width and height, or an outline.")
    return rectangle(given.width, given.height)


def _check_shapeless(given: Given) -> None:
    """Raise LabError for what goes with irregular grains alone, where there are none."""
    said = (
        ("grains.orientation", given.grains.orientation, GrainsGiven.orientation),
        ("grains.settled_as", given.grains.settled_as, GrainsGiven.settled_as),
        ("contact.outlines", given.contact.outlines, ContactGiven.outlines),
        ("contact.nodes", given.contact.nodes, ContactGiven.nodes),
    )
    for key, value, default in said:
        if value != default:
            raise LabError(f"{key}: goes with irregular grains; add a table [shapes.NAME], or leave this out.")


def _check_shapely(given: Given) -> None:
    """Raise LabError for what goes with round grains alone, where there are others."""
    if given.kinds:
        raise LabError("kinds: irregular grains are of one material; leave out the kinds, or the shapes.")
    if given.contact.cohesion != "none":
        raise LabError("contact.cohesion: no liquid between irregular grains yet; leave it out, or the shapes.")
    if given.grains.bed is not None:
        raise LabError("grains.bed: lists round grains; leave out the file, or the shapes.")
    if given.grains.table is not None:
        raise LabError("grains.table: shapes have diameters of their own; give these as shapes.NAME.diameter.")
    if given.grains.settled_as == "discs" and not all(shape.round for shape in given.shapes.values()):
        raise LabError("grains.settled_as: discs stand for round outlines only; leave it out, or the descriptors.")
    if given.grains.settled_as == "discs" and not given.run.settle:
        raise LabError("grains.settled_as: without run.settle no bed is settled; leave out either.")
    if given.grains.surface == "undisturbed":
        raise LabError(
            "grains.surface: an undisturbed surface is levelled with round grains; take slightly-disturbed or "
            "disturbed, or leave out the shapes."
        )


def _grains(given: GrainsGiven, shapes: Mapping[str, Shape], tank: Tank, settle: bool) -> Grains:
    """The grains in full, all sizes known; a file of grains takes the place of all that says how a bed is made."""
    if given.surface != "slightly-disturbed" and not settle:
        raise LabError(f"grains.surface: a bed is {given.surface} by how it settles; leave run.settle true.")
    if given.bed is not None:
        return _listed_grains(given, tank, settle)
    if (given.distribution == "table") != (given.table is not None):
        got = "no table" if given.table is None else f'distribution = "{given.distribution}"'
        raise LabError(f'grains.table: goes with distribution = "table" (got {got}).')
    if given.table is None and given.diameter is None and not shapes:
        raise LabError(f"grains.diameter: missing; {needed('m')}.")
    if given.table == ():
        raise LabError('grains.table: at least one class is needed, e.g. [["6 mm", 0.352], ["8 mm", 0.648]].')
    if given.shares == "mass" and given.table is None and not shapes:
        raise LabError("grains.shares: goes with shapes, or with a table of sizes.")
    grains = Grains(**asdict(given))
    classes = tuple((shape.diameter, shape.share) for shape in shapes.values())
    if grains.table is not None:
        classes = by_number(grains.table, grains.shares)
    if classes:
        grains = replace(grains, table=classes, diameter=Sizes(classes).mean)
    if grains.region is not None:
        grains = replace(grains, region=_region(grains))
    check_grains(grains, tank, _size_key(grains, shapes))
    return grains


def _size_key(grains: Grains, shapes: Mapping[str, Shape]) -> str:
    """The key that says how large the largest grains are."""
    if shapes:
        return f"shapes.{max(shapes, key=lambda name: shapes[name].diameter)}.diameter"
    return "grains.diameter" if grains.table is None else "grains.table"


def _region(grains: Grains) -> tuple[Point, ...]:
    """The corners of the region that the grains start in."""
    if grains.depth is not None:
        raise LabError("grains.region: goes with a count of grains; a depth would fill the whole tank.")
    if grains.surface != "slightly-disturbed":
        raise LabError("grains.region: grains in a region settle as they lie; leave grains.surface out.")
    try:
        return simple_polygon(grains.region)
    except LabError as error:
        raise LabError(f"grains.region: {error}") from None


def _listed_grains(given: GrainsGiven, tank: Tank, settle: bool) -> Grains:
    if given.surface != "slightly-disturbed":
        raise LabError("grains.surface: says how a bed is poured, but grains.bed lists its grains; leave one out.")
    listed = read_bed(given.bed, tank.outline, moving=not settle)
    mean = 2.0 * sum(grain[2] for grain in listed) / len(listed)
    return Grains(diameter=mean, count=len(listed), bed=Path(given.bed).name, reuse_bed=given.reuse_bed, listed=listed)


def check_grains(grains: Grains, tank: Tank, size_key: str) -> None:
    """Raise LabError for grains that do not fit, or of which there would be too many; size_key says how large."""
    if (grains.count is None) == (grains.depth is None):
        got = "neither" if grains.count is None else "both"
        raise LabError(f"grains.depth: give exactly one of depth and count (got {got}).")
    largest = grains.range[1]
    if largest >= min(tank.width, tank.height):
        raise LabError(f"{size_key}: grains of up to {show(largest, 'm')} do not fit into the tank.")
    if tank.width * tank.height > MOST_PLACES * largest**2:
        raise LabError(f"{size_key}: grains of up to {show(largest, 'm')} are too small for so large a tank.")
    height = show(tank.height, "m")
    if grains.depth is None:
        _check_room(grains, grains.region or tank.outline)
    elif grains.depth > tank.height and tank.open_edges:
        raise LabError(f"grains.depth: {show(grains.depth, 'm')} is more than the tank's height, {height}.")
    elif grains.depth >= tank.height and not tank.open_edges:
        raise LabError(f"grains.depth: {show(grains.depth, 'm')} must be less than the tank's height, {height}.")
    elif grains.depth < grains.diameter:
        raise LabError(f"grains.depth: {show(grains.depth, 'm')} is less than one grain, {show(grains.diameter, 'm')}.")


def _check_room(grains: Grains, outline: tuple[Point, ...]) -> None:
    """Raise LabError for more grains than the tank has room for in the densest lattice."""
    if grains.count * math.pi / 4 * grains.sizes.mean_square > DENSEST * area(outline):
        room = "region" if grains.region else "tank"
        raise LabError(f"grains.count: {grains.count} grains do not fit into the {room}.")


def _check_dissipation(material: Material | WallGiven, section: str, needed: bool) -> None:
    given = [material.restitution, material.dissipative_time]
    if None not in given:
        raise LabError(f"{section}.restitution: give restitution or dissipative_time, not both.")
    if needed and given == [None, None]:
        raise LabError(f"{section}.restitution: missing; give restitution or dissipative_time.")
    if (material.restitution or 1.0) < LEAST_RESTITUTION:
        raise LabError(f"{section}.restitution: must be at least {LEAST_RESTITUTION:g} (got {material.restitution:g}).")
    if (material.dissipative_time or 0.0) > LONGEST_DISSIPATION:
        longest = show(LONGEST_DISSIPATION, "s")
        raise LabError(f"{section}.dissipative_time: must be at most {longest}, far past where no grain rebounds.")


def _check_cohesion(law: str, material: Material) -> None:
    """Raise LabError where a law of cohesion lacks what it needs; walls and other kinds of grains inherit it."""
    for name in COHESION[law].needs:
        if getattr(material, name) is None:
            example = {"humidity": "70 %", "bridge_volume": "0.002 mm^3"}[name]
            raise LabError(f'material.{name}: missing; contact.cohesion = "{law}" needs it, e.g. "{example}".')


def _kinds(given: Mapping[str, KindGiven], material: Material) -> dict[str, Kind]:
    """The kinds of grains beside those of `material`."""
    kinds = {}
    for name, kind in given.items():
        _check_dissipation(kind, f"kinds.{name}", needed=False)
        own, against = _over(material, kind), None
        if kind.against is not None:
            _check_dissipation(kind.against, f"kinds.{name}.against", needed=False)
            against = _over(own, kind.against)
        elif (own.restitution is None) != (material.restitution is None):
            raise LabError(
                f"kinds.{name}.against: missing; a restitution and a dissipative time have no mean, so say how this "
                "kind touches the rest."
            )
        kinds[name] = Kind(kind.share, own, against)
    total = sum(kind.share for kind in kinds.values())
    if total >= 1.0:
        raise LabError(
            f"kinds.{next(iter(kinds))}.share: the shares add up to {total:.3g}; keep them below 1 together."
        )
    if len({own.material.restitution is None for own in kinds.values()}) > 1:
        raise LabError("kinds: give all of them a restitution, or all a dissipative time.")
    return kinds


def _over(material: Material, given: object) -> Material:
    """A material with what is given in place of its own."""
    names = {name for name in asdict(material)}
    own = {name: value for name, value in asdict(given).items() if name in names and value is not None}
    if "restitution" in own:
        own["dissipative_time"] = None
    elif "dissipative_time" in own:
        own["restitution"] = None
    return replace(material, **own)


def _motion(given: MotionGiven) -> Motion:
    """The motions in full, a record read from its file."""
    kept = {name: getattr(given, name) for name in ("soft_start", *MOTIONS)}
    if given.history is None:
        return Motion(**kept)
    history = read_history(given.history)
    check_start(history, given.soft_start)
    return Motion(**kept, history=history)


def _contact(given: ContactGiven, run: Run) -> Contact:
    """The contact laws, the stiffness by the level of accuracy where it is not given."""
    scale = given.stiffness_scale or LEVELS[run.accuracy].stiffness_scale
    return Contact(**{**vars(given), "stiffness_scale": scale})


def _duration(run: RunGiven, motion: Motion) -> float:
    """The run's duration (s): as given, else until the last motion that has an end is over."""
    try:
        derived = run.duration or max((part.duration() for part in motion.parts.values()), default=0.0)
    except ArithmeticError:
        derived = math.inf
    if not 0.0 < derived < math.inf:
        raise LabError('run.duration: missing, and no motion has an end of its own; give e.g. "8 s".')
    if motion.history:
        check_end(motion.history, derived)
    return derived
