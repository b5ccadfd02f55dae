"""The schema of a preset: one model, a section a file of `lab.preset.sections`, in SI.

The keys of `material` and of the motions, and the names of the contact laws, come from `solvers`: a new motion or law
in its registry is a new key or word here. `lab.preset.reader` fills the model from tables, `lab.preset.recorded` writes
it to files and reads it back. What follows from the keys is a property; of what needs several sections, of the preset.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from operator import attrgetter
from typing import Annotated

import numpy as np

from solvers.machine import runtime  # noqa: F401 (first, since it loads Taichi faster)

# isort: split
from lab.base.errors import LabError
from lab.preset.accuracy import LEVELS, stiffness_for
from lab.preset.bed_file import check_listed_kinds
from lab.preset.fields import Of, defaults_of, walk
from lab.preset.kept.content import MATTERS
from lab.preset.reader import check_keys, read
from lab.preset.sections import materials, shapes
from lab.preset.sections.axle import Axle, check_axle
from lab.preset.sections.bodies.checks import check_hold
from lab.preset.sections.bodies.floating import WithBodies
from lab.preset.sections.bulk.checks import Bulk, check_bulk
from lab.preset.sections.contact import Contact
from lab.preset.sections.grains import Grains, check_grains, check_layers, check_room
from lab.preset.sections.materials import Kind, Wall, check_cohesion, check_dissipation, check_kinds
from lab.preset.sections.motion import Motion, check_motion
from lab.preset.sections.naval.ship_checks import check_ship
from lab.preset.sections.naval.stability import Stability, check_stability
from lab.preset.sections.parts import Part, check_parts, furnished
from lab.preset.sections.run import Run, duration_of, with_ends
from lab.preset.sections.sea import Sea, Waves
from lab.preset.sections.shapes import Shape, ShapeClass, by_number
from lab.preset.sections.ship import Ship
from lab.preset.sections.space import check_space
from lab.preset.sections.tank import FurtherTank, Tank, check_tank
from lab.preset.sections.video import Record, Video, check_video
from lab.preset.sections.water.air import Air
from lab.preset.sections.water.air_checks import check_air
from lab.preset.sections.water.checks import check_water
from lab.preset.sections.water.flow_checks import check_weight
from lab.preset.sections.water.inflow import Inlet
from lab.preset.sections.water.liquid import liquid
from lab.preset.sections.water.section import DampingZone, Gauge, Water
from lab.preset.sections.water.solids import check_solids
from lab.preset.sections.water.tanks import Pool, check_tanks, pools
from lab.preset.sections.wet.checks import check_wet, is_wet
from solvers.fluid import given as fluid
from solvers.grains.bed.sizes import Sizes
from solvers.grains.materials import Material
from solvers.machine.marks import Cheap, Doc, Interval
from solvers.tank.tank import BARE_THICKNESS
from solvers.tank.tank import Tank as SlabTank

FORMAT = 3


@dataclass(frozen=True)
class Preset(WithBodies):
    """A preset: all that may be said of an experiment, with its base and overrides merged in."""

    title: Annotated[str, Doc("What the experiment is, in a line.")]
    tank: Annotated[Tank, Doc("The tank that holds the cargo.")]
    material: Annotated[
        Material | None,
        Of("grains"),
        Doc("The material of the grains, and of the walls as far as [wall] does not differ."),
    ] = None
    grains: Annotated[Grains | None, Doc("The grains in the tank; it is empty without them.")] = None
    format: Annotated[
        int, Interval(ge=FORMAT, le=FORMAT), Doc("Format of this file; in format 3 the sea outside is [sea].")
    ] = FORMAT
    source: Annotated[str, Doc("Where the experiment comes from.")] = ""
    reports: Annotated[str, Doc("What the source reports of it.")] = ""
    based_on: Annotated[str, Doc("Name or path of the preset whose keys this one changes.")] = ""
    quick: Annotated[str, Doc("How a quick variant differs from its preset.")] = ""
    plugins: Annotated[tuple[str, ...], Doc("Files or names of plug-ins: laws, measures … of one's own.")] = ()
    wall: Annotated[Wall, Of("grains"), Doc("What of the walls' material is not as that of the grains.")] = field(
        default_factory=Wall
    )
    kinds: Annotated[
        dict[str, Kind],
        Of("grains"),
        Doc("Shares of the grains, each of another material; a key not given is as in [material]."),
    ] = field(default_factory=dict)
    shapes: Annotated[dict[str, Shape], Of("grains"), Doc("Classes of irregular grains.")] = field(default_factory=dict)
    contact: Annotated[Contact, Of("grains"), Doc("The contact laws.")] = field(default_factory=Contact)
    water: Annotated[Water | None, Doc("The water in the tank.")] = None
    air: Annotated[Air | None, Of("water"), Doc("The air over the water, in a closed tank; nothing without it.")] = None
    bulk: Annotated[Bulk | None, Doc("Loose cargo in the tanks as a continuum, in place of grains.")] = None
    gauges: Annotated[dict[str, Gauge], Of("water"), Doc("Gauges of the water's pressure and level.")] = field(
        default_factory=dict
    )
    damping: Annotated[dict[str, DampingZone], Of("water"), Doc("Zones that damp waves.")] = field(default_factory=dict)
    motion: Annotated[Motion, Doc("How the tank moves.")] = field(default_factory=Motion)
    parts: Annotated[dict[str, Part], Doc("Parts in the tank, such as gates, funnels and pistons, which may move.")] = (
        field(default_factory=dict)
    )
    ship: Annotated[Ship | None, Doc("The ship whose hold the tank is.")] = None
    tanks: Annotated[dict[str, FurtherTank], Doc("Further tanks of the ship.")] = field(default_factory=dict)
    inflow: Annotated[dict[str, Inlet], Of("water"), Doc("Openings by which water enters.")] = field(
        default_factory=dict
    )
    stability: Annotated[Stability, Doc("What criteria of stability need to know of the whole ship.")] = field(
        default_factory=Stability
    )
    axle: Annotated[Axle | None, Doc("The axle about which the tank rolls freely.")] = None
    sea: Annotated[Sea, Doc("The sea outside the ship.")] = field(default_factory=Sea)
    waves: Annotated[Waves | None, Doc("The waves of the sea, which travel to starboard.")] = None
    run: Annotated[Run, Cheap(), Doc("How the experiment is run.")] = field(default_factory=Run)
    record: Annotated[Record, Cheap(), Doc("What is written down, and how often.")] = field(default_factory=Record)
    video: Annotated[Video, Doc("How the run is filmed.")] = field(default_factory=Video)

    @property
    def matters(self) -> tuple[str, ...]:
        """The keys of the matters that the tank holds; none if it is empty."""
        return tuple(name for name in MATTERS if getattr(self, name) is not None)

    @property
    def axes(self) -> int:
        """Number of axes of the scene: two in the plane, three in space."""
        return self.tank.axes

    @property
    def wet(self) -> bool:
        """Whether grains and water are in one tank."""
        return is_wet(self)

    @property
    def faces(self) -> tuple[str, ...]:
        """Names of the faces of the tank in space whose loads are told; none in the plane, and of an empty tank."""
        return self.tank.solid.faces(np.array(self.tank.corners)) if self.tank.solid and self.matters else ()

    @cached_property
    def shape_classes(self) -> dict[str, ShapeClass]:
        """The grains of each shape; empty if all are discs. Raises LabError."""
        return shapes.shape_classes(self.shapes, self.grains.diameter, self.grains.shares) if self.shapes else {}

    @cached_property
    def classes(self) -> tuple[tuple[float, float], ...]:
        """The classes of sizes (diameter m, share by number); empty if one diameter is given."""
        if self.shapes:
            return tuple((shape.diameter, shape.share) for shape in self.shape_classes.values())
        if self.grains.table:
            return by_number(self.grains.table, self.grains.shares)
        return materials.classes_of(self.kinds, self.grains.diameter)

    @cached_property
    def mean_diameter(self) -> float:
        """Mean diameter of the grains (m)."""
        if self.grains.listed:
            return 2.0 * float(self.grains.listed.radius.mean())
        return Sizes(self.classes).mean if self.classes else self.grains.diameter

    @cached_property
    def sizes(self) -> Sizes:
        """The distribution that the diameters are drawn from, unless they are listed."""
        classes = self.classes or ((self.grains.diameter, 1.0),)
        return Sizes(classes, self.grains.spread, self.grains.normal)

    @property
    def diameters(self) -> tuple[float, float]:
        """Smallest and largest possible diameter (m)."""
        if self.grains.listed:
            radius = self.grains.listed.radius
            return 2.0 * float(radius.min()), 2.0 * float(radius.max())
        return self.sizes.range

    @cached_property
    def wall_material(self) -> Material:
        """The material of the walls."""
        return self.wall.over(self.material)

    @cached_property
    def others(self) -> dict[str, materials.Other]:
        """The materials of the kinds of grains."""
        return materials.others(self.kinds, self.material)

    @property
    def stiffness_scale(self) -> float:
        """The factor on Young's moduli: as given, else by the level of accuracy and the grains' range of masses."""
        level = LEVELS[self.run.accuracy]
        if self.contact.stiffness_scale or self.grains is None:
            return self.contact.stiffness_scale or level.stiffness_scale
        densities = [self.material.density, *(other.material.density for other in self.others.values())]
        return stiffness_for(level, self.diameters, densities)

    @cached_property
    def liquid(self) -> fluid.Water:
        """The water as the solver takes it. Raises LabError."""
        return liquid(self)

    @cached_property
    def pools(self) -> tuple[Pool, ...]:
        """The water of each tank that has some, in the axes of the first tank; the first tank's is first."""
        return pools(self)

    @cached_property
    def duration(self) -> float:
        """How long the tank moves (s): as given, else until the last motion ends. Raises LabError."""
        return duration_of(self.run, self.motion)

    @property
    def thickness(self) -> float:
        """Thickness (m) of the slab: the tank's, else the grains' mean diameter, without grains one metre.

        In space it is the tank's length.
        """
        return self.tank.along or self.tank.thickness or (self.mean_diameter if self.grains else BARE_THICKNESS)

    @property
    def a_metre(self) -> float:
        """Factor (1/m) from what is in the slab to what a metre of the ship carries of it."""
        ship = self.ship.length if self.ship and self.ship.length else 1.0
        return SlabTank(np.zeros((0, 2)), self.thickness, length=self.tank.length).share(ship)


def resolve(table: Mapping) -> Preset:
    """The preset of a table, with its base and overrides already merged in.

    Raises LabError, one sentence with the dotted key.
    """
    check_keys(Preset, table)
    preset = furnished(read(Preset, table))
    preset = replace(preset, motion=with_ends(preset.run, preset.motion))
    check(preset)
    return preset


def check(preset: Preset) -> None:
    """Raise LabError, one sentence, for keys that contradict each other, and for what cannot be built."""
    check_tank(preset.tank)
    _check_matters(preset)
    check_space(preset)
    check_parts(preset)
    check_hold(preset)
    if preset.grains is not None:
        _check_of_grains(preset)
    check_motion(preset.motion, preset.tank.extent)
    check_ship(preset.ship, preset.waves, bool(preset.motion.parts), preset.tank)
    check_tanks(preset)
    check_weight(preset)
    check_water(preset)
    check_bulk(preset)
    check_wet(preset)
    check_air(preset)
    others = preset.ship is not None, bool(preset.motion.parts), bool(preset.matters)
    check_axle(preset.axle, *others, duration_of(preset.run, preset.motion), max(preset.tank.extent))
    check_solids(preset)
    check_stability(preset.stability, preset.ship)
    check_video(preset.video, preset.matters, preset.axes > 2)


def _check_matters(preset: Preset) -> None:
    """Raise LabError for a key that says something of a matter that the tank does not hold."""
    for key, taken in walk(Preset):
        if not taken.of or set(taken.of) & set(preset.matters):
            continue
        section, _, name = key.rpartition(".")
        table = attrgetter(section)(preset) if section else preset
        if getattr(table, name) != defaults_of(type(table))[name]:
            remedy = f"set {key} = false" if taken.below or taken.optional else "leave this out"
            what, there = " or ".join(taken.of), "is none" if taken.of == ("water",) else "are none"
            raise LabError(f"{key}: goes with {what}, and there {there}; add a table [{taken.of[0]}], or {remedy}.")


def _check_of_grains(preset: Preset) -> None:
    """Raise LabError for keys that contradict each other in what is said of the grains."""
    if preset.material is None:
        read(Material, {}, "material")  # says which key is missing
    shapes.check_shapes(preset)
    settle = preset.run.settles
    check_grains(preset.grains, bool(preset.shape_classes), settle)
    check_layers(preset.grains, preset.kinds)
    sizes = preset.sizes, preset.mean_diameter, preset.hold, shapes.size_key(preset)
    check_room(preset.grains, *sizes, settle, preset.stiffness_scale)
    check_dissipation(preset.material, "material", needed=True)
    check_dissipation(preset.wall, "wall", needed=False)
    check_cohesion(preset.contact.cohesion, preset.material)
    check_kinds(preset.kinds, preset.material)
    if preset.grains.listed:
        check_listed_kinds(preset.grains.listed, len(preset.kinds))
