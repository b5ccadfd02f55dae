"""A ship in a preset: what may be said of her, her water and waves, and the vessel that the solver is given."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import lru_cache
from math import inf, pi, radians, sqrt
from typing import Annotated, Literal

import numpy as np
from pydantic import TypeAdapter

from lab.errors import LabError
from lab.ship_tables import stored_table
from lab.units import show
from solvers.errors import Unavailable
from solvers.quantity import Interval, Unit
from solvers.ship.body import Body
from solvers.ship.hydrostatics import metacentric_height, turned
from solvers.ship.linear import impedance, inertia_for_roll, require_damped
from solvers.ship.loads import Floating, floating_in_waves
from solvers.ship.memory import fit_memory
from solvers.ship.motion import Radiation, Rig, RollDamping, Ship, frozen_at, remembered, start
from solvers.ship.section import Section
from solvers.ship.vessel import Vessel
from solvers.ship.water import Water
from solvers.ship.waves import Waves, froude_factors, jonswap, packet, pierson_moskowitz, random_sea, regular

FREEDOM = {"roll": (False, False, True), "heave-roll": (False, True, True), "sway-heave-roll": (True, True, True)}
SLOWEST, FASTEST, FREQUENCIES = 0.08, 3.5, 48  # of the table, times √(g/draught), and how many
MEMORY_ORDER = 8  # states a mode

Length = Annotated[float, Unit("m"), Interval(gt=0)]
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
class ShipGiven:
    """The hull's section and how the ship floats with her cargo aboard; the tank of the preset is her hold.

    The origin of the hull's own axes is the middle of the keel of a box of `breadth` and `height`, or as the
    `outline`'s corners have it. `draught`, `gravity_height` (above that origin) and `gyradius` or `roll_period` are of
    ship and cargo together, as it lies at the start. `hold`: where the tank's origin is. `axis`: the point whose sway
    and heave are held, or not, and about which she then rolls; the middle of the waterline unless given. The source's
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
    sheet: Length | None = None  # thickness of the cargo's sheet; the grains' mean diameter unless given
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

    @property
    def corners(self) -> np.ndarray:
        """The hull's outline (m, 2), m."""
        if self.outline is not None:
            return np.array(self.outline)
        half = 0.5 * self.breadth
        return np.array([[-half, 0.0], [half, 0.0], [half, self.height], [-half, self.height]])

    @property
    def about(self) -> tuple[float, float]:
        """The point of the hull whose motion is stepped."""
        return self.axis or (0.0, float(self.corners[:, 1].min()) + self.draught)

    @property
    def heave(self) -> float:
        """Of the hull's origin at rest (m)."""
        return -self.draught - float(self.corners[:, 1].min())


@dataclass(frozen=True)
class WaterGiven:
    """The water the ship floats in; deep unless its depth is given."""

    density: Annotated[float, Unit("kg/m^3"), Interval(gt=0)] = 1000.0
    depth: Length | None = None


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


def check_ship(ship: ShipGiven | None, waves: WavesGiven | None, moves: bool) -> None:
    """Raise LabError for what does not go together."""
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
    try:
        Section(ship.corners)
    except Unavailable as error:
        raise LabError(f"ship.outline: {error}") from None
    depth = float(np.ptp(ship.corners[:, 1]))
    if ship.draught >= depth:
        raise LabError(f"ship.draught: must be less than the hull's height, {show(depth, 'm')}.")
    if ship.release < 0.1 and ship.heel:
        raise LabError('ship.release: she is heeled until then, and not at a blow; give at least "0.1 s".')
    if waves is None:
        if ship.radiation == "at-frequency":
            raise LabError('ship.radiation: "at-frequency" takes the frequency of waves; add a table [waves].')
        return
    for name in NEEDS[waves.kind]:
        if getattr(waves, name) is None:
            raise LabError(f'waves.{name}: missing; waves.kind = "{waves.kind}" needs it.')


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
    return Vessel(ship, given.hold, sheet, True, given.heel, given.release, limits)


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
        spring = whole + frequency**2 * own
        frequency = sqrt(max(spring, 1e-9) / own)
    return frequency, float(own)


def _damping(given: ShipGiven, ship: Ship, water: Water, table) -> RollDamping:
    frequency, inertia = natural_roll(ship, given.heave, table)
    return RollDamping(2.0 * given.damping * frequency * inertia, given.quadratic_damping * inertia)


def recorded_ship(preset: Mapping) -> ShipGiven:
    """The ship of a recorded preset (all values in SI)."""
    return TypeAdapter(ShipGiven).validate_python(preset["ship"])


def axis_motion(ship: ShipGiven, pose: np.ndarray) -> np.ndarray:
    """Sway, heave (m) of the ship's axis from where it is at rest, and roll (rad), from the tank's poses (…, 3)."""
    arm = turned(tuple(np.subtract(ship.hold, ship.about)), pose[..., 2])
    rest = np.array([ship.about[0], ship.heave + ship.about[1]])
    return np.concatenate([pose[..., :2] - arm - rest, pose[..., 2:]], axis=-1)


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
        ("free in", given.freedom.replace("-", ", ") + f", about {show(given.about[1], 'm')} above her origin"),
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
