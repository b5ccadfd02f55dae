"""From a case to the solver's ship, rooms and openings."""

from dataclasses import dataclass, replace
from math import sqrt

import numpy as np

from lab.base.errors import LabError
from lab.naval.flooding.case import Case, HullShape, LoadedCase, OpeningKeys, RoomKeys, Swing
from lab.naval.flooding.checks import check_opening, check_rooms
from lab.naval.hull import read_hull
from lab.naval.surfaces.axes import Axes
from lab.preset.outline import simple_polygon
from solvers.machine.errors import Unavailable
from solvers.ship.flooding.balance import Floating, Pose
from solvers.ship.flooding.motion import Inertia
from solvers.ship.flooding.openings import SEA, Opening, circle
from solvers.ship.flooding.openings import rectangle as rectangular
from solvers.ship.flooding.residual import metacentric_height
from solvers.ship.flooding.rooms import Room, Rooms
from solvers.ship.flooding.run import Flooding
from solvers.ship.flooding.solids import Prisms, Stations
from solvers.ship.naval.form import Form
from solvers.ship.section import Section
from solvers.ship.water import Water

INDEX = {"vented": 1.0, "adiabatic": 1.4, "isothermal": 1.0}
ROUND = 16  # pieces of a quarter of a circle
STATIONS = 21  # of a hull of one section, for the edges of her deck


@dataclass(frozen=True, eq=False)
class Built:
    """A case as the solver takes it: the flooding, and her lines."""

    flooding: Flooding
    form: Form

    @property
    def ship(self) -> Floating:
        """The ship."""
        return self.flooding.ship


def build(loaded: LoadedCase) -> Built:
    """The ship of a case, ready to flood. Raises LabError, one sentence with key and remedy."""
    case = loaded.case
    try:
        form, solid = _hull(case.hull, loaded)
    except Unavailable as error:
        raise LabError(f"hull: {error}") from None
    rooms = [_room(name, keys) for name, keys in case.rooms.items()]
    if not rooms:
        raise LabError("rooms: there is none, so nothing can flood; add a table [rooms.NAME].")
    check_rooms(rooms, form, case.hull.file is None)
    rooms = _filled(rooms, case)
    openings = [_opening(name, keys, rooms, form) for name, keys in case.openings.items()]
    if not openings:
        raise LabError("openings: there is none, so no water enters; add a table [openings.NAME].")
    ship = _ship(case, solid, Rooms(rooms), form)
    start = _start(ship, case, form)
    inertia = None if case.motion is None else _inertia(case.motion, ship, start, form)
    return Built(Flooding(ship, openings, start, case.run.duration, inertia, case.run.pressure), form)


def _hull(keys: HullShape, loaded: LoadedCase) -> tuple[Form, Prisms | Stations]:
    given = [name for name in ("length", "breadth", "depth", "outline") if getattr(keys, name) is not None]
    if keys.file is not None:
        if given:
            raise LabError(f"hull.{given[0]}: goes with a hull of one section; leave it out, or hull.file.")
        axes = Axes(keys.scale, keys.up, mirror=keys.mirror, close=keys.close)
        density = loaded.case.water.density
        path = loaded.folder / keys.file
        if not path.is_file():
            raise LabError(f"hull.file: there is no file {keys.file} beside the case; look at its name.")
        form = read_hull(path, density=density, fair=keys.fair, stations=keys.stations, axes=axes).form
        return form, Stations(form)
    box = keys.breadth is not None and keys.depth is not None
    if keys.length is None or box == (keys.outline is not None):
        raise LabError("hull: give a file, or length with breadth and depth, or length with an outline.")
    if box:
        corners = _box(-0.5 * keys.breadth, 0.5 * keys.breadth, 0.0, keys.depth, keys.bilge, "hull.bilge")
    else:
        corners = _polygon(keys.outline, "hull.outline")
    section = Section(corners)
    base = float(section.outline[:, 1].min())
    x = np.linspace(0.0, keys.length, STATIONS)
    return Form(x, (section,) * STATIONS, base=base), Prisms([section.outline], [0.0], [keys.length])


def _polygon(corners, key: str) -> np.ndarray:
    try:
        return np.array(simple_polygon(corners))
    except LabError as error:
        raise LabError(f"{key}: {error}") from None


def _box(left: float, right: float, low: float, high: float, bilge: float | None, key: str) -> np.ndarray:
    """A rectangle (m, 2), its lower corners round where a radius (m) is given."""
    if bilge is None:
        return np.array([[left, low], [right, low], [right, high], [left, high]])
    if bilge > min(0.5 * (right - left), high - low):
        raise LabError(f"{key}: a radius of {bilge:.4g} m does not fit the box; make it smaller.")
    angle = np.linspace(0.0, 0.5 * np.pi, ROUND + 1)[:, None]
    arc = bilge * np.hstack([np.sin(angle), -np.cos(angle)])  # from the floor up the starboard side
    starboard = arc + np.array([right - bilge, low + bilge])
    port = (arc * [-1.0, 1.0])[::-1] + np.array([left + bilge, low + bilge])
    corners = np.concatenate([starboard, [[right, high], [left, high]], port])
    return corners[(np.abs(corners - np.roll(corners, 1, axis=0)) > 1e-12 * (high - low)).any(axis=1)]


def _room(name: str, keys: RoomKeys) -> Room:
    key = f"rooms.{name}"
    if name == SEA:
        raise LabError(f"{key}: a room cannot be called sea, which is outside; give it another name.")
    for part in ("along", "across", "height"):
        span = getattr(keys, part)
        if span is not None and not span[0] < span[1]:
            raise LabError(f"{key}.{part}: must rise from the first to the second; change their order.")
    box = keys.across is not None and keys.height is not None
    if box == (keys.outline is not None):
        raise LabError(f"{key}: give across and height, or an outline.")
    if box:
        (left, right), (low, high) = keys.across, keys.height
        outline = _box(left, right, low, high, keys.bilge, f"{key}.bilge")
    else:
        outline = _polygon(keys.outline, f"{key}.outline")
    vented = keys.air == "vented"
    return Room(name, outline, *keys.along, keys.permeability, vented, INDEX[keys.air])


def _filled(rooms: list[Room], case: Case) -> list[Room]:
    """The rooms with the water that is in them at the start."""
    empty, found = Rooms(rooms), []
    for k, room in enumerate(rooms):
        level = case.rooms[room.name].level
        low, high = float(room.outline[:, 1].min()), float(room.outline[:, 1].max())
        if level is not None and not low <= level <= high:
            raise LabError(f"rooms.{room.name}.level: must be from {low:.4g} to {high:.4g} m, the room's height.")
        water = 0.0 if level is None else float(empty.held(level, 0.0, 0.0)[k])
        found.append(replace(room, water=water))
    return found


def _opening(name: str, keys: OpeningKeys, rooms: list[Room], form: Form) -> Opening:
    key = f"openings.{name}"
    sides = keys.width is not None and keys.height is not None
    if sides + (keys.diameter is not None) + (keys.area is not None) != 1:
        raise LabError(f"{key}: give width and height, or a diameter, or an area, one of the three.")
    if keys.diameter is not None:
        corners = circle(keys.at, keys.diameter, keys.face)
    else:
        side = sqrt(keys.area) if keys.area else 0.0
        corners = rectangular(keys.at, keys.width or side, keys.height or side, keys.face)
    check_opening(name, keys, corners, rooms, form)
    return Opening(name, keys.between, corners, keys.discharge, keys.opens, keys.leak, keys.leak_head, keys.collapse)


def _ship(case: Case, solid, rooms: Rooms, form: Form) -> Floating:
    """The ship, on an even keel before she floods unless her lcg says otherwise."""
    keys, water = case.ship, Water(case.water.density, gravity=case.water.gravity)
    if (keys.mass is None) == (keys.draught is None):
        raise LabError("ship: give mass or draught, one of them.")
    aboard = np.array([room.water for room in rooms.rooms])
    held = rooms.filled(aboard, 0.0, 0.0)
    side = 1 if keys.lolls == "port" else -1
    plain = Floating(solid, rooms, keys.mass or 1.0, np.array([0.0, keys.tcg, keys.vcg]), water, keys.trims, side)
    plain = replace(plain, capsize=keys.capsize)
    if keys.draught is not None:
        depth = float(solid.reach(0.0, 0.0)[1][0]) - form.base
        if not keys.draught < depth:
            raise LabError(f"ship.draught: must be less than the hull's depth of {depth:.4g} m; make it smaller.")
        wet = solid.wet(np.array([form.base + keys.draught]), 0.0, 0.0)
        mass = water.density * (float(wet.volume[0]) - aboard.sum())
        if mass <= 0.0:
            raise LabError("ship.draught: the water in her rooms weighs more than she displaces; make it larger.")
        plain = replace(plain, mass=mass)
    if plain.sinks(aboard):
        most = water.density * (solid.volume[0] - aboard.sum())
        raise LabError(f"ship.mass: {plain.mass:.4g} kg do not float: her hull carries {most:.4g} kg; make it smaller.")
    if keys.lcg is not None:
        lcg = keys.lcg
    else:
        even = replace(plain, trims=False).at_heel(aboard, 0.0, Pose(form.base))
        whole = plain.wet(even).moment[0, 0] * water.density - water.density * aboard @ held.centre[:, 0]
        lcg = float(whole) / plain.mass
    return replace(plain, centre=np.array([lcg, keys.tcg, keys.vcg]))


def _start(ship: Floating, case: Case, form: Form) -> Pose:
    """How she lies, or is let go, when she begins to flood."""
    aboard = np.array([room.water for room in ship.rooms.rooms])
    near = replace(ship, trims=False).at_heel(aboard, 0.0, Pose(form.base))
    rest = ship.rest(aboard, near)
    if rest is None:
        raise LabError("ship.vcg: she capsizes before she floods: her centre of gravity is too high; lower it.")
    if case.motion is None:
        return rest
    roll = -case.motion.heel if case.motion.heel else rest.roll
    if case.motion.release is None:
        return ship.at_heel(aboard, roll, rest)
    return Pose(form.base + case.motion.release, rest.slope, roll)


def _inertia(keys: Swing, ship: Floating, start: Pose, form: Form) -> Inertia:
    """Added mass, inertia, drag and damping; the damping is of her roll before she floods."""
    roll = ship.mass * keys.gyradius**2 * (1.0 + keys.added_inertia)
    breadth = max(float(np.ptp(one.outline[:, 0])) for one in form.sections if one is not None)
    aboard = np.array([room.water for room in ship.rooms.rooms])
    upright = ship.at_heel(aboard, start.roll, start)
    height = abs(metacentric_height(ship, aboard, upright))
    damping = 2.0 * keys.damping * sqrt(roll * ship.mass * ship.water.gravity * height)
    return Inertia(keys.added_mass, roll, float(np.ptp(form.x)) * breadth, keys.drag, damping)
