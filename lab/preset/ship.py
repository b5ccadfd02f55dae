"""A ship in a preset: what may be said of her, her water and waves, and the vessel that the solver is given."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import lru_cache
from math import inf, pi, radians, sqrt
from typing import Annotated, Literal

import numpy as np
from pydantic import TypeAdapter

from lab.assembly.ship_tables import stored_table
from lab.base.errors import LabError
from lab.preset.units import show
from solvers.machine.errors import Unavailable
from solvers.machine.marks import Interval, Unit
from solvers.ship.body import Body
from solvers.ship.hydrostatics import metacentric_height, turned
from solvers.ship.linear import impedance, inertia_for_roll, require_damped
from solvers.ship.loads import Floating, floating_in_waves
from solvers.ship.motion import Radiation, Rig, RollDamping, Ship, frozen_at, remembered, start
from solvers.ship.openings import immersion_angle
from solvers.ship.potential.memory import fit_memory
from solvers.ship.section import Section
from solvers.ship.vessel import Vessel
from solvers.ship.water import Water
from solvers.ship.waves import Waves, froude_factors, jonswap, packet, pierson_moskowitz, random_sea, regular

FREEDOM = {"roll": (False, False, True), "heave-roll": (False, True, True), "sway-heave-roll": (True, True, True)}
SLOWEST, FASTEST, FREQUENCIES = 0.08, 3.5, 48  # of the table, times √(g/draught), and how many
MEMORY_ORDER = 8  # states a mode
TOUCHING = 1e-9  # of the hull's size: a hold that is no farther out is in

MOST_FLAT = 200.0  # a section's breadth and draught, one over the other: panels do not resolve what is flatter
FARTHEST = 10.0  # times a hull's size: what is farther from her origin is not hers

Length = Annotated[float, Unit("m"), Interval(ge=1e-3, le=1e3)]  # of a model or a ship
Thickness = Annotated[float, Unit("m"), Interval(gt=0, le=1e3)]
AngularFrequency = Annotated[float, Unit("rad/s"), Interval(gt=0)]


@dataclass(frozen=True)
class RigGiven:
    """What holds a model, per metre of its length: masses that move along, dashpots and a spring, in sway and heave."""

    sway_mass: Annotated[float, Unit("kg/m"), Interval(ge=0)] = 0.0
    heave_mass: Annotated[float, Unit("kg/m"), Interval(ge=0)] = 0.0
    sway_damping: Annotated[float, Unit("N s/m^2"), Interval(ge=0)] = 0.0
    heave_damping: Annotated[float, Unit("N s/m^2"), Interval(ge=0)] = 0.0
    sway_spring: Annotated[float, Unit("Pa"), Interval(ge=0)] = 0.0


@dataclass(frozen=True)
class HatchGiven:
    """A hatch in the middle of the deck: how broad it is, and how high its coaming stands over the deck."""

    breadth: Length
    coaming: Length


@dataclass(frozen=True)
class ShipGiven:
    """The hull's section and how the ship floats with her cargo aboard; the tank of the preset is her hold.

    The origin of the hull's own axes is the middle of the keel of a box of `breadth` and `height`, the depth to its
    deck, or as the `outline`'s corners have it. A box may have a `hatch`; its coaming keeps water out as the sides do,
    up to its edges, which are openings. `openings`: further points, of any hull, through which she floods when they are
    under water. `deck`: how high the deck's edge is above the origin, of an `outline`; a box's is its height.
    `draught`, `gravity_height` (above the origin) and `gyradius` or `roll_period` are of ship and cargo together, as it
    lies at the start. `hold`: where the tank's origin is. `axis`: the ship's point of reference, the middle of the
    waterline unless given. Sway and heave are the motions of this point from where it is at rest (`axis_motion`), in
    equations, recordings, figures and pictures alike; they are held or not, and she is heeled about it. The source's
    model has `radiation` at the waves' frequency, and as `excitation` of roll the waves' slope. `damping` is a
    share of the critical, `quadratic_damping` per rad: φ̈ + 2 ζ ω₀ φ̇ + b φ̇|φ̇| + ω₀² φ. `repose`: how steep the cargo can
    lie, for the curve of righting levers with relaxed cargo alone; the grains of a run know nothing of it. Unless given
    it is that of the source's acetate, the first of the critical angles that it found by tilting (Spandonidis 2016,
    section 7.1). `scale`: how many times as long the ship is that she is a model of; nothing but words depends on it.
    """

    draught: Length
    gravity_height: Annotated[float, Unit("m")]
    breadth: Length | None = None
    height: Length | None = None
    outline: Annotated[tuple[tuple[float, float], ...], Unit("m")] | None = None
    gyradius: Length | None = None
    roll_period: Annotated[float, Unit("s"), Interval(gt=0)] | None = None
    hold: Annotated[tuple[float, float], Unit("m")] = (0.0, 0.0)
    axis: Annotated[tuple[float, float], Unit("m")] | None = None
    freedom: Literal[*FREEDOM] = "sway-heave-roll"
    sheet: Thickness | None = None  # thickness of the cargo's sheet; the grains' mean diameter unless given
    radiation: Literal["memory", "at-frequency", "none"] = "memory"
    excitation: Literal["diffraction", "froude-krylov", "wave-slope"] = "diffraction"
    damping: Annotated[float, Interval(ge=0, le=1)] = 0.0
    quadratic_damping: Annotated[float, Interval(ge=0)] = 0.0
    heel: Annotated[float, Unit("rad"), Interval(ge=-pi, le=pi)] = 0.0
    release: Annotated[float, Unit("s"), Interval(ge=0)] = 0.0
    capsize: Annotated[float, Unit("rad"), Interval(gt=0)] | None = 0.5 * pi
    repose: Annotated[float, Unit("rad"), Interval(ge=0, le=0.5 * pi)] = radians(25.0)
    scale: Annotated[float, Interval(gt=0)] | None = None
    rig: RigGiven = field(default_factory=RigGiven)
    hatch: HatchGiven | None = None
    openings: Annotated[tuple[tuple[float, float], ...], Unit("m")] = ()
    deck: Annotated[float, Unit("m")] | None = None

    @property
    def corners(self) -> np.ndarray:
        """The hull's outline (m, 2), m, with the hatch's coaming."""
        if self.outline is not None:
            return np.array(self.outline)
        half, port = 0.5 * self.breadth, [[-y, z] for y, z in reversed(self._coaming)]
        sides = [[-half, 0.0], [half, 0.0], [half, self.height]], [[-half, self.height]]
        return np.array([*sides[0], *self._coaming, *port, *sides[1]])

    @property
    def _coaming(self) -> list[list[float]]:
        """The corners of the hatch's coaming to starboard, from the deck up."""
        if self.hatch is None:
            return []
        half = 0.5 * self.hatch.breadth
        return [[half, self.height], [half, self.height + self.hatch.coaming]]

    @property
    def flooding_points(self) -> tuple[tuple[float, float], ...]:
        """The edges of the hatch and all other openings (m)."""
        edge = self._coaming[-1:]
        return (*((side * y, z) for side in (1.0, -1.0) for y, z in edge), *self.openings)

    @property
    def deck_height(self) -> float | None:
        """Of the deck's edge above the hull's origin (m), None where an outline's is not given."""
        return self.height if self.outline is None else self.deck

    @property
    def deck_edges(self) -> tuple[tuple[float, float], ...]:
        """Where the hull is as high as her deck, farthest to either side (m); none where that is not known."""
        if self.deck_height is None:
            return ()
        begin, end = self.corners, np.roll(self.corners, -1, axis=0)
        low, high = np.minimum(begin[:, 1], end[:, 1]), np.maximum(begin[:, 1], end[:, 1])
        level = self.deck_height
        meets = (low <= level) & (level <= high)
        share = np.divide(level - begin[:, 1], end[:, 1] - begin[:, 1], where=high > low, out=np.zeros(len(begin)))
        across = (begin[:, 0] + share * (end[:, 0] - begin[:, 0]))[meets]
        across = np.concatenate([across, end[meets & (high == low), 0]])
        return (float(across.max()), level), (float(across.min()), level)

    @property
    def about(self) -> tuple[float, float]:
        """The ship's axis in the hull's axes (m)."""
        return self.axis or (0.0, float(self.corners[:, 1].min()) + self.draught)

    @property
    def heave(self) -> float:
        """Of the hull's origin at rest (m)."""
        return -self.draught - float(self.corners[:, 1].min())


@dataclass(frozen=True)
class WaterGiven:
    """The water the ship floats in; deep unless its depth is given."""

    density: Annotated[float, Unit("kg/m^3"), Interval(ge=500, le=2000)] = 1000.0
    depth: Annotated[float, Unit("m"), Interval(ge=1e-3, le=2e4)] | None = None


@dataclass(frozen=True)
class WavesGiven:
    """Waves that travel to starboard.

    Regular: `amplitude` and `frequency`. A packet: highest, `amplitude`, at the ship at the `time`, `spread` its
    standard deviation of frequency. A random sea: `height` the significant one, `frequency` that of the peak.
    """

    frequency: AngularFrequency
    kind: Literal["regular", "packet", "jonswap", "pierson-moskowitz"] = "regular"
    amplitude: Annotated[float, Unit("m"), Interval(ge=0)] | None = None
    height: Annotated[float, Unit("m"), Interval(ge=0)] | None = None
    spread: AngularFrequency | None = None
    time: Annotated[float, Unit("s"), Interval(ge=0)] | None = None
    peakedness: Annotated[float, Interval(ge=1, le=10)] = 3.3
    seed: Annotated[int, Interval(ge=0, le=2**31 - 1)] = 1
    soft_start: Annotated[float, Unit("s"), Interval(ge=0)] = 0.0


NEEDS = {
    "regular": ("amplitude",),
    "packet": ("amplitude", "spread", "time"),
    "jonswap": ("height",),
    "pierson-moskowitz": ("height",),
}


def check_ship(ship: ShipGiven | None, waves: WavesGiven | None, moves: bool, hold: np.ndarray) -> None:
    """Raise LabError for what does not go together; `hold` is the tank's outline (m, 2), m."""
    if ship is None:
        if waves is not None:
            raise LabError("waves: there is no ship in them; add a table [ship], or leave the waves out.")
        return
    if moves:
        raise LabError("motion: a ship moves her hold herself; leave the motions out, or the ship.")
    box = ship.breadth is not None and ship.height is not None
    if box == (ship.outline is not None) or (ship.breadth is None) != (ship.height is None):
        raise LabError("ship.breadth: give breadth and height, or an outline.")
    if (ship.gyradius is None) == (ship.roll_period is None):
        raise LabError("ship.gyradius: give exactly one of gyradius and roll_period.")
    _check_hatch(ship, box)
    try:
        Section(ship.corners)
    except Unavailable as error:
        raise LabError(f"ship.outline: {error}") from None
    depth = ship.height if box else float(np.ptp(ship.corners[:, 1]))
    if ship.draught >= depth:
        raise LabError(f"ship.draught: must be less than the hull's height, {show(depth, 'm')}.")
    _check_lengths(ship, box)
    _check_openings(ship, box)
    _check_hold(ship, hold)
    if ship.release < 0.1 and ship.heel:
        raise LabError('ship.release: she is heeled until then, and not at a blow; give at least "0.1 s".')
    if waves is None:
        if ship.radiation == "at-frequency":
            raise LabError('ship.radiation: "at-frequency" takes the frequency of waves; add a table [waves].')
        return
    for name in NEEDS[waves.kind]:
        if getattr(waves, name) is None:
            raise LabError(f'waves.{name}: missing; waves.kind = "{waves.kind}" needs it.')


def _check_lengths(ship: ShipGiven, box: bool) -> None:
    """Raise LabError for lengths so far apart that nothing can be worked out from them."""
    breadth, draught = float(np.ptp(ship.corners[:, 0])), ship.draught
    if not 1.0 / MOST_FLAT <= breadth / draught <= MOST_FLAT:
        key = "ship.breadth" if box else "ship.outline"
        raise LabError(
            f"{key}: {show(breadth, 'm')} of breadth and {show(draught, 'm')} of draught are too far apart for the "
            f"hull's coefficients; keep one within {MOST_FLAT:g} times the other."
        )
    farthest = FARTHEST * float(np.ptp(ship.corners, axis=0).max())
    lengths = {"gravity_height": ship.gravity_height, "gyradius": ship.gyradius or 0.0}
    lengths |= {"axis": max(map(abs, ship.about)), "hold": max(map(abs, ship.hold))}
    for key, length in lengths.items():
        if abs(length) > farthest:
            raise LabError(f"ship.{key}: {show(length, 'm')} is more than {FARTHEST:g} times the hull's size.")


def _check_hatch(ship: ShipGiven, box: bool) -> None:
    """Raise LabError where a hatch has no place."""
    if ship.hatch is None:
        return
    if not box:
        raise LabError(
            "ship.hatch: goes with breadth and height; draw a coaming in the outline, its edges as openings."
        )
    if ship.hatch.breadth >= ship.breadth:
        raise LabError(f"ship.hatch.breadth: must be less than the hull's breadth, {show(ship.breadth, 'm')}.")


def _check_openings(ship: ShipGiven, box: bool) -> None:
    """Raise LabError where she floods at rest, or her deck is no deck."""
    keel, top = (float(end(ship.corners[:, 1])) for end in (np.min, np.max))
    waterline = keel + ship.draught
    for y, z in ship.openings:
        if z <= waterline:
            place = f"[{show(y, 'm')}, {show(z, 'm')}]"
            raise LabError(f"ship.openings: {place} is under water at rest; it must be above {show(waterline, 'm')}.")
    if ship.deck is None:
        return
    if box:
        raise LabError("ship.deck: the deck of a box is at its height; leave it out.")
    if not waterline < ship.deck <= top:
        between = f"{show(waterline, 'm')} and {show(top, 'm')}"
        raise LabError(f"ship.deck: must be between the waterline and the hull's top, {between}.")


def _check_hold(ship: ShipGiven, hold: np.ndarray) -> None:
    """Raise LabError where the hold stands out of the hull: a corner of it outside, or one of the hull inside."""
    hull, placed = ship.corners, hold + np.array(ship.hold)
    slack = TOUCHING * float(np.ptp(hull, axis=0).max())
    out = [corner for corner in placed if _inside(corner, hull) < -slack]
    out += [corner for corner in hull if _inside(corner, placed) > slack]
    if out:
        place = f"[{show(float(out[0][0]), 'm')}, {show(float(out[0][1]), 'm')}]"
        raise LabError(
            f"ship.hold: the tank stands out of the hull at {place}; move it, or change the hull or the tank."
        )


def _inside(point: np.ndarray, outline: np.ndarray) -> float:
    """How far (m) a point is from the edge of a polygon (m, 2); negative outside."""
    begin, along = outline, np.roll(outline, -1, axis=0) - outline
    share = np.clip(((point - begin) * along).sum(1) / (along**2).sum(1), 0.0, 1.0)
    away = float(np.hypot(*(point - begin - share[:, None] * along).T).min())
    (y, z), end = point, begin + along
    crosses = (begin[:, 1] > z) != (end[:, 1] > z)
    rise = np.where(crosses, along[:, 1], 1.0)
    right = crosses & (begin[:, 0] + (z - begin[:, 1]) / rise * along[:, 0] > y)
    return away if right.sum() % 2 else -away


def make_waves(given: WavesGiven | None, water: Water) -> Waves | None:
    """The waves' components."""
    if given is None:
        return None
    frequency, start = given.frequency, given.soft_start
    if given.kind == "regular":
        return regular(given.amplitude, frequency, water, start)
    if given.kind == "packet":
        return packet(given.amplitude, frequency, given.spread, water, given.time)
    if given.kind == "jonswap":
        density = jonswap(given.height, frequency, given.peakedness)
    else:
        density = pierson_moskowitz(given.height, frequency)
    return random_sea(density, frequency, water, given.seed, start)


def make_water(given: WaterGiven, gravity: float) -> Water:
    """The water of a preset."""
    return Water(given.density, given.depth or inf, gravity)


@lru_cache(maxsize=8)
def make_vessel(given: ShipGiven, water: WaterGiven, waves: WavesGiven | None, sheet: float, gravity: float) -> Vessel:
    """The ship, laden as she floats at the start. Raises LabError where she cannot float so."""
    try:
        return _vessel(given, make_water(water, gravity), waves, sheet)
    except Unavailable as error:
        raise LabError(f"ship: {error}") from None


def _vessel(given: ShipGiven, water: Water, sea: WavesGiven | None, sheet: float) -> Vessel:
    section, about = Section(given.corners), given.about
    mass = water.density * float(section.immersion(given.heave, 0.0).area)
    body = Body(mass, (0.0, given.gravity_height), mass * (given.gyradius or 0.3 * section.size) ** 2)
    if metacentric_height(section, body.loading, water) <= 0.0:
        raise LabError("ship.gravity_height: so high she does not float upright; lower it.")
    waves = make_waves(sea, water)
    table = stored_table(section, water, given.heave, _frequencies(given, water, waves), about)
    load = Floating(section, water, about)
    if waves is not None:
        rest, scattered = (given.heave, 0.0), given.excitation == "diffraction"
        load = floating_in_waves(section, water, about, waves, table, rest, scattered)
        if given.excitation == "wave-slope":
            load = _by_slope(load, table, body)
    ship = Ship(
        body,
        load,
        _radiation(given, table, sea, water.depth == inf),
        about,
        free=FREEDOM[given.freedom],
        gravity=water.gravity,
    )
    ship = _with_rig(ship, given.rig)
    if given.roll_period:
        one = table.at([2.0 * pi / given.roll_period])
        ship = replace(ship, body=inertia_for_roll(ship, section, water, given.heave, one))
    ship = replace(ship, damping=_damping(given, ship, water, table))
    if given.radiation == "memory":
        require_damped(ship, start(ship, given.heave))
    limits = (-given.capsize, given.capsize) if given.capsize else (-inf, inf)
    openings = given.flooding_points
    return Vessel(ship, given.hold, sheet, True, given.heel, given.release, limits, openings=openings)


def _by_slope(load: Floating, table, body: Body) -> Floating:
    """The roll moment W GM ∂ζ/∂y in place of the Froude–Krylov one: eq. 7.1 of Spandonidis (2016) with r = 1."""
    righting = body.mass * load.water.gravity * metacentric_height(load.section, body.loading, load.water)
    change = np.zeros_like(load.excess)
    change[:, 2] = 1j * load.waves.wave_number * righting - table.at(load.waves.frequency).froude_krylov[:, 2]
    return replace(load, excess=load.excess + change)


def _with_rig(ship: Ship, given: RigGiven) -> Ship:
    rig = Rig(
        np.array([given.sway_mass, given.heave_mass, 0.0]),
        np.array([given.sway_damping, given.heave_damping, 0.0]),
        np.array([given.sway_spring, 0.0, 0.0]),
        np.array([ship.about[0], 0.0, 0.0]),
    )
    return replace(ship, rig=rig)


def _frequencies(given: ShipGiven, water: Water, waves: Waves | None) -> np.ndarray:
    """Of the table (rad/s): as far as the memory reaches, and the waves."""
    unit = sqrt(water.gravity / given.draught)
    low, high = SLOWEST * unit, FASTEST * unit
    if waves is not None:
        low, high = min(low, 0.98 * waves.frequency.min()), max(high, 1.02 * waves.frequency.max())
    return np.linspace(low, high, FREQUENCIES)


def _radiation(given: ShipGiven, table, sea: WavesGiven | None, deep: bool) -> Radiation:
    if given.radiation == "none":
        return Radiation(table.infinite_added_mass, np.zeros((3, 3)))
    if given.radiation == "at-frequency":
        return frozen_at(table, sea.frequency)
    return remembered(table, fit_memory(table, MEMORY_ORDER, deep))


def natural_roll(ship: Ship, heave: float, table) -> tuple[float, float]:
    """Angular frequency (rad/s) of roll alone about P, and the moment of inertia (kg m) with added mass there."""
    load = ship.load
    frequency = 2.0
    for _ in range(50):
        whole = impedance(ship, load.section, load.water, heave, table.at([frequency]))[0, 2, 2].real
        own = ship.inertia(0.0)[2, 2] - ship.radiation.added_mass[2, 2] + table.at([frequency]).added_mass[0, 2, 2]
        if own <= 0.0:
            raise Unavailable("her inertia in roll, added mass included, is not positive: look at her lengths' units.")
        spring = whole + frequency**2 * own
        frequency = sqrt(max(spring, 1e-9) / own)
    return frequency, float(own)


def _damping(given: ShipGiven, ship: Ship, water: Water, table) -> RollDamping:
    frequency, inertia = natural_roll(ship, given.heave, table)
    return RollDamping(2.0 * given.damping * frequency * inertia, given.quadratic_damping * inertia)


def recorded_ship(preset: Mapping) -> ShipGiven:
    """The ship of a recorded preset (all values in SI)."""
    return TypeAdapter(ShipGiven).validate_python(preset["ship"])


def axis_place(given: ShipGiven) -> str:
    """Where the ship's axis is, in words."""
    y, z = given.about
    beside = "" if y == 0.0 else f"{show(abs(y), 'm')} to {'starboard' if y > 0.0 else 'port'} of and "
    return f"{beside}{show(z, 'm')} above her origin" + ("" if given.axis else ", in the waterline")


def axis_motion(ship: ShipGiven, pose: np.ndarray) -> np.ndarray:
    """Sway, heave (m) of the ship's axis from where it is at rest, and roll (rad), from the tank's poses (…, 3).

    This, and nothing else, is what sway and heave of a ship are, wherever the lab tells of them.
    """
    arm = turned(tuple(np.subtract(ship.hold, ship.about)), pose[..., 2])
    rest = np.array([ship.about[0], ship.heave + ship.about[1]])
    return np.concatenate([pose[..., :2] - arm - rest, pose[..., 2:]], axis=-1)


def flooding_angles(given: ShipGiven, vessel: Vessel) -> dict[str, float | None]:
    """Heels (rad) of deck immersion and of downflooding in calm water at constant displacement, None where none is."""
    load, loading = vessel.ship.load, vessel.ship.body.loading
    points = {"deck_immersion_angle": given.deck_edges, "downflooding_angle": given.flooding_points}
    return {
        name: immersion_angle(load.section, loading, load.water, edges) if edges else None
        for name, edges in points.items()
    }


def describe(given: ShipGiven, vessel: Vessel, waves: WavesGiven | None, every: float) -> list[tuple[str, str]]:
    """Rows of words on a ship: balance, roll, what the water does; `every` (s) its forces are stepped."""
    ship, body = vessel.ship, vessel.ship.body
    water, memory = ship.load.water, ship.radiation.memory
    height = metacentric_height(ship.load.section, body.loading, water)
    rows = [
        ("with her cargo", f"{body.mass:.4g} kg/m, GM {show(height, 'm')}, gyradius {show(body.gyradius, 'm')}"),
        (
            "cargo's sheet",
            f"{show(vessel.thickness, 'm')} thick: its load counts {1.0 / vessel.thickness:.4g} times a metre",
        ),
        ("free in", given.freedom.replace("-", ", ") + f", about her axis, {axis_place(given)}"),
        (
            "viscous roll damping",
            f"{ship.damping.linear:.3g} N s φ̇ and {ship.damping.quadratic:.3g} N s^2 φ̇|φ̇|, a metre",
        ),
        ("radiation", _radiated(given, memory)),
        ("water's forces", f"every {show(every, 's')}; the cargo's at each step"),
    ]
    if waves is not None:
        rows += [("excitation", given.excitation), ("waves", _sea(waves, water))]
    if given.capsize:
        rows.append(("capsized", f"beyond {show(given.capsize, 'rad')}"))
    rows += [
        (name.replace("_", " "), f"{show(angle, 'rad')}, in calm water at constant displacement")
        for name, angle in flooding_angles(given, vessel).items()
        if angle is not None
    ]
    rows.append(("her cargo's repose", f"{show(given.repose, 'rad')}, in the curve of righting levers alone"))
    if given.scale:
        rows.append((f"full scale 1:{given.scale:g}", _full_scale(given, waves)))
    return rows


def _radiated(given: ShipGiven, memory) -> str:
    if memory is None:
        return {"none": "none, added mass alone", "at-frequency": "that of the waves' frequency"}[given.radiation]
    worst = 100.0 * float(memory.error.max())
    return f"memory of {len(memory.matrix)} states, off the tables by {worst:.2g} % at most (rms)"


def _sea(waves: WavesGiven, water: Water) -> str:
    period, number = 2.0 * pi / waves.frequency, float(water.wave_number(waves.frequency))
    size = waves.height if waves.amplitude is None else waves.amplitude
    steep = f", {show(2.0 * pi / number, 'm')} long" if number else ""
    return f"{waves.kind}, {show(size, 'm')}, {show(period, 's')}{steep}"


def _full_scale(given: ShipGiven, waves: WavesGiven | None) -> str:
    """What the run means for a ship so many times as long (Froude's law)."""
    factor = froude_factors(given.scale)
    words = [f"draught {show(given.draught * factor['length'], 'm')}", f"times {factor['time']:.3g} as long"]
    if waves is not None:
        size = waves.height if waves.amplitude is None else waves.amplitude
        words.append(f"waves of {show(size * factor['length'], 'm')}")
        words.append(f"every {show(2.0 * pi / waves.frequency * factor['time'], 's')}")
    return ", ".join(words)
