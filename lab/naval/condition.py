"""The condition of a preset's ship as a loading manual states it, at the full scale if the preset has one."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from math import inf, nan
from typing import NamedTuple

import numpy as np

from lab.assembly.grains import grain_count
from lab.assembly.hull_tables import whole_form
from lab.assembly.ship import flooding_angles
from lab.base.errors import LabError
from lab.naval.free_surfaces import FreeSurface, free_surfaces
from lab.preset.kept.content import FIRST
from lab.preset.schema import Preset
from lab.preset.sections.bulk.beds import beds_of
from lab.preset.sections.naval.stability import Stability
from lab.preset.sections.ship import Ship
from lab.preset.sections.water.tanks import outline_of
from solvers.machine.errors import Unavailable
from solvers.ship.naval.curve import Levers
from solvers.ship.naval.form import TONNE, Form, Hydrostatics, prism
from solvers.ship.naval.grain_code import ASSUMED, heeling_arm, straight_line
from solvers.ship.naval.holds import Hold
from solvers.ship.naval.weather import Exposed
from solvers.ship.section import Section
from solvers.ship.vessel import Vessel
from solvers.ship.water import Water

HEELS = np.radians(np.arange(-60.0, 91.0))


@dataclass(frozen=True, eq=False)
class Cargo:
    """The grain in the hold: level of its surface above the keel (m), volume (m³), mass (t)."""

    level: float
    volume: float
    mass: float

    @property
    def stowage(self) -> float:
        """Stowage factor (m³/t) of the bed."""
        return self.volume / self.mass


class Stowed(NamedTuple):
    """A hold by its name in the preset, the level (m) of the grain in it, and its volume (m³)."""

    name: str
    hold: Hold
    level: float
    volume: float


@dataclass(frozen=True, eq=False)
class Condition:
    """A ship in calm water: form, displacement (t), centre of gravity (m), angles (rad) of deck edge and flooding.

    The angles are infinite for points that never go under, None where the preset gives no points.

    All lengths are `scale` times those of the preset; `gravity_height` is KG without free surfaces, whose moment (t m)
    is apart: `tanks`, as large as in the preset, are in it. G lies `aside` (m) of the middle, towards the `side` that
    she is judged on. With `lines` her form is that of offsets, else of one section all along. `repose` (rad) is the
    cargo's. `hold` and `cargo` are None without grain; `stowed` is what each of her holds has of it, the first one's
    included.
    """

    form: Form
    water: Water
    draught: float
    displacement: float
    gravity_height: float
    aside: float
    side: str
    free_surface: float
    tanks: list[FreeSurface]
    deck_edge_angle: float | None
    flooding: float | None
    length: float
    scale: float
    lines: bool
    given: Stability
    repose: float
    hold: Hold | None = None
    cargo: Cargo | None = None
    stowed: tuple[Stowed, ...] = ()

    @cached_property
    def hydrostatics(self) -> Hydrostatics:
        """Particulars at her draught."""
        return self.form.hydrostatics(self.draught, self.water)

    @property
    def fluid_height(self) -> float:
        """KG (m) raised by the free surfaces: KG + moment / Δ."""
        return self.gravity_height + self.free_surface / self.displacement

    @property
    def solid_gm(self) -> float:
        """GM (m) as if all that is liquid were frozen."""
        return self.hydrostatics.km - self.gravity_height

    @property
    def metacentric_height(self) -> float:
        """GM (m) after correction for free surfaces, "fluid"."""
        return self.hydrostatics.km - self.fluid_height

    @cached_property
    def levers(self) -> Levers:
        """Righting levers (m) over `HEELS` to the `side` that she is judged on, corrected for free surfaces."""
        way = 1.0 if self.side == "port" else -1.0  # the hull's own heels are positive to port
        gravity = -way * self.aside, self.fluid_height
        return Levers(HEELS, way * self.form.righting_levers(self.displacement, self.water, way * HEELS, gravity))

    @property
    def block(self) -> float:
        """Block coefficient with her length in the waterline, at most 1."""
        return min(1.0, self.hydrostatics.volume / (self.length * self.hydrostatics.breadth * self.draught))

    @property
    def exposed(self) -> Exposed | None:
        """What the weather criterion needs; None without area and lever of the wind."""
        if self.given.wind_area is None:
            return None
        return Exposed(
            self.length,
            self.hydrostatics.breadth,
            self.draught,
            self.fluid_height,
            self.displacement,
            self.block,
            self.metacentric_height,
            self.given.wind_area * self.scale**2,
            self.given.wind_lever * self.scale,
            self.given.keel_area * self.scale**2,
            self.given.sharp_bilges,
            self.water.gravity,
        )

    @property
    def stowage(self) -> float:
        """Stowage factor (m³/t): as given, else as the bed stows."""
        return self.given.stowage * TONNE if self.given.stowage else self.cargo.stowage

    @property
    def assumed_moment(self) -> float:
        """Volumetric heeling moment (m⁴) of the assumed shift in her holds, without the factor for the vertical."""
        return self.moment_at(ASSUMED[self.given.filling].surface)

    def moment_at(self, surface: float) -> float:
        """Volumetric heeling moment (m⁴) of the cargo with a surface at an angle (rad) in each hold."""
        return sum(one.hold.volumetric_moment(one.volume, surface) for one in self.stowed)

    @property
    def assumed_arm(self) -> float:
        """λ0 (m) of the assumed shift, that in other holds included."""
        moment = self.assumed_moment * ASSUMED[self.given.filling].factor + self.given.other_moment * self.scale**4
        return heeling_arm(moment, self.stowage, self.displacement)

    @property
    def assumed(self) -> Callable[[np.ndarray], np.ndarray] | None:
        """The heeling arm (m) of the shift that the Grain Code assumes; None without grain."""
        return straight_line(self.assumed_arm) if self.cargo else None


def condition(preset: Preset, vessel: Vessel, level: float | None = None, mass: float | None = None) -> Condition:
    """The condition of a preset's ship, `vessel`, at the full scale.

    level: height (m, the tank's axes) of the level filling of [tank], mass: of all grain in a metre of her (kg/m); as
    the preset says without them. Raises LabError for a ship that cannot be judged.
    """
    ship, given, scale = preset.ship, preset.stability, preset.ship.scale or 1.0
    load = vessel.ship.load
    length = (ship.length or 1.0) * scale
    try:
        form = _form(ship, scale)
        angles = flooding_angles(ship, vessel)
        stowed, cargo = _stowed(preset, scale, level, mass)
    except Unavailable as error:
        raise LabError(f"stability: {error}") from None
    keel = float(ship.corners[:, 1].min())
    body, tanks = vessel.ship.body, free_surfaces(preset)
    moment = given.free_surface + sum(tank.moment for tank in tanks)
    return Condition(
        form,
        load.water,
        ship.draught * scale,
        body.mass * scale**2 * length / TONNE,
        (body.centre[1] - keel) * scale,
        abs(body.centre[0]) * scale,
        "port" if body.centre[0] < 0.0 else "starboard",
        moment * scale**4 / TONNE,
        tanks,
        _angle(angles["deck_immersion_angle"], ship.deck_edges),
        _angle(angles["downflooding_angle"], ship.flooding_points),
        (given.length or ship.length or 1.0) * scale,
        scale,
        ship.offsets is not None,
        given,
        ship.repose,
        stowed[0].hold if stowed else None,
        cargo,
        stowed,
    )


def _form(ship: Ship, scale: float) -> Form:
    """Her whole hull `scale` times as large: by her offsets, or her section all along."""
    if ship.offsets is None:
        return prism(Section(ship.corners * scale), (ship.length or 1.0) * scale)
    form = whole_form(ship)
    sections = tuple(None if one is None else Section(one.outline * scale) for one in form.sections)
    return Form(form.x * scale, sections, ship.length * scale)


def _angle(found: float | None, points: tuple) -> float | None:
    """The angle (rad) at which points go under: infinite for never, None without points."""
    return (inf if found is None else found) if points else None


def _stowed(
    preset: Preset, scale: float, level: float | None, mass: float | None
) -> tuple[tuple[Stowed, ...], Cargo | None]:
    """The holds with their levels and volumes, heights from the keel, and the grain in them; none without grain."""
    if preset.grains is None and preset.bulk is None:
        return (), None
    ship = preset.ship
    shift, whole = np.array(ship.hold) - [0.0, float(ship.corners[:, 1].min())], ship.length or 1.0
    found = []
    for name, outline, long, height in _holds(preset, level):
        hold = Hold(Section((outline + shift) * scale), (long or whole) * scale)
        if height is None:
            return (Stowed(name, hold, nan, 0.0),), None
        filling = hold.filled_to((height + shift[1]) * scale)
        found.append(Stowed(name, hold, filling.level, min(filling.volume, hold.volume * (1.0 - 1e-9))))
    mass = mass_of(preset) if mass is None else mass
    volume = sum(one.volume for one in found)
    return tuple(found), Cargo(found[0].level, volume, mass * whole * scale**3 / TONNE)


def _holds(preset: Preset, level: float | None) -> Iterator[tuple[str, np.ndarray, float | None, float | None]]:
    """Name, outline (m, 2) m, length (m) and level (m) of each hold, heights as those of [tank]."""
    first = level_of(preset) if level is None else level
    yield FIRST, np.array(preset.tank.corners), preset.tank.length, first
    for name, tank in preset.tanks.items() if preset.bulk else ():
        outline = outline_of(preset, tank)
        yield name, outline, tank.length, float(outline[:, 1].min()) + tank.depth


def level_of(preset: Preset) -> float | None:
    """Height (m, the tank's axes) of the level filling that the preset asks for; None where only a run tells it."""
    depth = (preset.grains or preset.bulk).depth
    return None if depth is None else float(np.array(preset.tank.corners)[:, 1].min()) + depth


def mass_of(preset: Preset) -> float:
    """Mass (kg) a metre of the ship of the preset's grains, spheres of the mean cube of their diameters, or bulk."""
    if preset.bulk:
        return preset.bulk.density * sum(bed.area * bed.along for bed in beds_of(preset)) / (preset.ship.length or 1.0)
    mean_cube = preset.mean_diameter**3 * (1.0 + preset.grains.spread**2)  # of a uniform spread
    return preset.a_metre * grain_count(preset) * np.pi / 6.0 * preset.material.density * mean_cube
