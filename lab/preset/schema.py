"""The schema of a preset, and its resolution into complete SI values.

The keys of `material` and of the motions, and the names of the contact laws, come from `solvers`: a new motion or law
in its registry is a new key or word here. Each section is a dataclass in a file of `lab.preset.sections`;
`lab.preset.reader` fills it, in SI.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field

from pydantic import BaseModel, ConfigDict, model_validator

from lab.base.errors import LabError
from lab.preset.reader import check_keys, read
from lab.preset.sections.contact import Contact, ContactGiven, full_contact
from lab.preset.sections.grains import Grains, GrainsGiven, full_grains
from lab.preset.sections.materials import (
    Kind,
    KindGiven,
    WallGiven,
    check_cohesion,
    check_dissipation,
    full_kinds,
    over,
)
from lab.preset.sections.motion import Motion, MotionGiven, full_motion
from lab.preset.sections.parts import check_parts
from lab.preset.sections.run import Run, RunGiven, duration_of
from lab.preset.sections.shapes import Shape, ShapeGiven, read_shapes
from lab.preset.sections.ship_checks import check_ship
from lab.preset.sections.tank import Tank, TankGiven, full_tank
from lab.preset.sections.video import Record, Video, check_video
from lab.preset.ship import ShipGiven, WaterGiven, WavesGiven
from solvers.grains.materials import Material
from solvers.tank.parts import Part


@dataclass(frozen=True)
class Given:
    """A whole preset as read, after its base has been merged in; `based_on` only names the base."""

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
    """A preset with all values filled in, in SI. To JSON and back: `model_dump_json`, `model_validate_json`."""

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
        """Raise ValueError for a material without its rebound values, as a damaged or edited file may have."""
        given = [self.material, self.wall, *(kind.material for kind in self.kinds.values())]
        if any(material.restitution is None and material.dissipative_time is None for material in given):
            raise ValueError("a material has neither restitution nor dissipative_time")
        if any(not material.restitution_speed > 0.0 for material in given):
            raise ValueError("a material's restitution is that of no speed")
        return self


def resolve(table: Mapping) -> Resolved:
    """Resolve a preset's table, with its base and overrides already merged in.

    Raises LabError, one sentence with the dotted key.
    """
    check_keys(Given, table)
    given = read(Given, table)
    tank = full_tank(given.tank)
    (_check_shapely if given.shapes else _check_shapeless)(given)
    shapes = read_shapes(given.shapes, given.grains.diameter, given.grains.shares)
    grains = full_grains(given.grains, shapes, tank, given.run.settle)
    check_dissipation(given.material, "material", needed=True)
    check_dissipation(given.wall, "wall", needed=False)
    check_cohesion(given.contact.cohesion, given.material)
    motion = full_motion(given.motion)
    run = Run(**{**vars(given.run), "duration": duration_of(given.run, motion)})
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
        wall=over(given.material, given.wall),
        kinds=full_kinds(given.kinds, given.material),
        shapes=shapes,
        contact=full_contact(given.contact, run.accuracy),
        motion=motion,
        parts=given.parts,
        ship=given.ship,
        water=given.water,
        waves=given.waves,
        run=run,
        record=given.record,
        video=given.video,
    )


def _check_shapeless(given: Given) -> None:
    """Raise LabError for settings that need irregular grains if there are none."""
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
    """Raise LabError for settings that need discs if the grains are irregular."""
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
