"""Build the solver's vessel from the ship, sea and waves of a preset."""

from dataclasses import replace
from functools import lru_cache
from math import inf, pi, sqrt

import numpy as np

from lab.assembly.hull_tables import hull_table_of, whole_form
from lab.assembly.roll_damping import make_damping
from lab.assembly.ship_tables import stored_table
from lab.base.errors import LabError
from lab.preset.sections import sea as seas
from lab.preset.sections import ship as ships
from lab.preset.units import show
from solvers.machine.errors import Unavailable
from solvers.motion.staggered_error import longest_step
from solvers.ship.body import NOTHING, Body, bolted
from solvers.ship.hydrostatics import metacentric_height
from solvers.ship.linear import impedance, inertia_for_roll, require_damped
from solvers.ship.loads import Floating, floating_in_waves
from solvers.ship.motion import Radiation, Rig, Ship, frozen_at, remembered, start
from solvers.ship.openings import immersion_angle
from solvers.ship.potential.memory import fit_memory
from solvers.ship.potential.radiation import Hydrodynamics
from solvers.ship.section import Immersible, Section, Stations
from solvers.ship.vessel import Vessel
from solvers.ship.water import Water
from solvers.ship.waves import Waves, jonswap, packet, pierson_moskowitz, random_sea, regular, white_noise

SLOWEST, FASTEST, FREQUENCIES = 0.08, 3.5, 48  # range of the hydrodynamic table in √(g/draught), and its length
MEMORY_ORDER = 8  # states per mode
QUARTER = 0.5 * pi  # rad: the largest angle of loll


def make_waves(given: seas.Waves | None, water: Water) -> Waves | None:
    """The waves' components, as the run meets them."""
    return None if given is None else _from_their_start(given, water).later(given.begin)


def _from_their_start(given: seas.Waves, water: Water) -> Waves:
    frequency, start = given.frequency, given.soft_start
    if given.kind == "regular":
        return regular(given.amplitude, frequency, water, start)
    if given.kind == "packet":
        return packet(given.amplitude, frequency, given.spread, water, given.time)
    if given.kind == "white-noise":
        return white_noise(given.height, frequency, given.spread, water, given.seed, start)
    if given.kind == "jonswap":
        density = jonswap(given.height, frequency, given.peakedness)
    else:
        density = pierson_moskowitz(given.height, frequency)
    return random_sea(density, frequency, water, given.seed, start)


def make_water(given: seas.Sea, gravity: float) -> Water:
    """The water of a preset's sea."""
    return Water(given.density, given.depth or inf, gravity)


@lru_cache(maxsize=8)
def make_vessel(
    given: ships.Ship, water: seas.Sea, waves: seas.Waves | None, gravity: float, wet: Body = NOTHING
) -> Vessel:
    """The ship as she floats with her cargo at the start; `wet` is the water in her tanks, as if it were frozen.

    Raises LabError if she cannot float so.
    """
    try:
        return _vessel(given, make_water(water, gravity), waves, wet)
    except Unavailable as error:
        raise LabError(f"ship: {error}") from None


def _vessel(given: ships.Ship, water: Water, sea: seas.Waves | None, wet: Body) -> Vessel:
    section, about = immersible(given), given.about
    mass = water.density * float(section.immersion(given.heave, 0.0).area)
    body = _body(given, section, mass, wet)
    roll = _rest(given, section, body, water)
    waves = make_waves(sea, water)
    table = table_of(given, water, _frequencies(given, water, waves))
    load = Floating(section, water, about)
    if waves is not None:
        rest, scattered = (given.heave, 0.0), given.excitation == "diffraction"
        load = floating_in_waves(section, water, about, waves, table, rest, scattered)
        if given.excitation == "wave-slope":
            if roll:
                raise LabError("ship.excitation: wave-slope acts by GM, which is negative here; take diffraction.")
            load = _by_slope(load, table, righting(section, body, water))
    ship = Ship(
        body,
        load,
        _radiation(given, table, sea, water.depth == inf),
        about,
        free=ships.FREEDOM[given.freedom],
        gravity=water.gravity,
        rig=_rig(given),
    )
    heave = _heave(ship, given, roll)
    if given.roll_period:
        one = table.at([2.0 * pi / given.roll_period])
        ship = replace(ship, body=inertia_for_roll(ship, section, water, heave, one, roll))
    frequency, inertia = natural_roll(ship, heave, table, roll)
    ship = replace(ship, damping=make_damping(given, section, water, frequency, inertia))
    if given.radiation == "memory":
        require_damped(ship, start(ship, heave, roll))
    limits = (-given.capsize, given.capsize) if given.capsize else (-inf, inf)
    openings = given.flooding_points
    vessel = Vessel(
        ship,
        given.hold,
        length=given.length or 1.0,
        laden=True,
        heel=given.heel or roll,
        release=given.release if given.heel or given.release or not roll else 2.0 * pi / frequency,
        limits=limits,
        handover=given.coupling_step if given.coupling == "staggered" else None,
        openings=openings,
        rest=roll,
    )
    if given.coupling == "staggered":
        _require_stable(given.coupling_step, vessel)
    return vessel


def _rest(given: ships.Ship, section: Immersible, body: Body, water: Water) -> float:
    """The roll (rad) at which she rests in calm water: upright, or her angle of loll. Raises LabError without one."""
    if righting(section, body, water) > 0.0:
        return 0.0
    ship = Ship(
        body,
        Floating(section, water, given.about),
        Radiation(np.zeros((3, 3)), np.zeros((3, 3))),
        given.about,
        free=ships.FREEDOM[given.freedom],
        gravity=water.gravity,
    )
    vessel, largest = Vessel(ship, given.hold), min(given.capsize or QUARTER, QUARTER)
    found = vessel.angle_of_loll(largest)
    if found is None:
        most = show(largest, "rad")
        raise LabError(f"ship.gravity_height: so high she neither stands upright nor lolls by up to {most}; lower it.")
    openings = [(side * y, z) for y, z in given.flooding_points for side in (1.0, -1.0)]  # she may loll either way
    if openings and ship.load.depths(openings, np.array(vessel.pose(NOTHING, found)), 0.0).max() > 0.0:
        lolls = show(found, "rad")
        raise LabError(f"ship.gravity_height: so high she lolls to {lolls}, with an opening under water; lower it.")
    return found


def _heave(ship: Ship, given: ships.Ship, roll: float) -> float:
    """Heave (m) of the hull's origin at rest at a roll (rad)."""
    return Vessel(ship, given.hold).heave(NOTHING, roll) if roll else given.heave


def _require_stable(step: float, vessel: Vessel) -> None:
    """Raise LabError if steps (s) that end with an extrapolated load are too long for how she swings.

    The memory of radiation is left out: it is stepped by the trapezoidal rule, which is stable with any step.
    """
    ship = vessel.ship
    plain = replace(ship, radiation=replace(ship.radiation, memory=None))
    period = replace(vessel, ship=plain).shortest_period
    longest = longest_step(period)
    if step > longest:
        raise LabError(
            f"ship.coupling_step: {1e3 * step:.4g} ms is not stable with her shortest period of {period:.3g} s; "
            f'take at most {1e3 * longest:.2g} ms, or ship.coupling = "instant".'
        )


def _body(given: ships.Ship, section: Immersible, mass: float, wet: Body) -> Body:
    """Ship and cargo of a `mass` (kg/m) together. Raises Unavailable if the water is heavier."""
    gyradius, centre = given.gyradius or 0.3 * section.size, (0.0, given.gravity_height)
    if not given.bare:
        return Body(mass, centre, mass * gyradius**2)
    own = mass - wet.mass
    if own <= 0.0:
        raise Unavailable(f"the water of {wet.mass:.4g} kg/m is heavier than the whole ship of {mass:.4g} kg/m.")
    return bolted(Body(own, centre, own * gyradius**2), wet)


def _by_slope(load: Floating, table, righting: float) -> Floating:
    """Replace the Froude–Krylov roll moment by W GM ∂ζ/∂y: eq. 7.1 of Spandonidis (2016) with r = 1."""
    change = np.zeros_like(load.excess)
    change[:, 2] = 1j * load.waves.wave_number * righting - table.at(load.waves.frequency).froude_krylov[:, 2]
    return replace(load, excess=load.excess + change)


def righting(section: Immersible, body: Body, water: Water) -> float:
    """Righting moment per radian of a small heel (N), W GM."""
    return body.mass * water.gravity * metacentric_height(section, body.loading, water)


def immersible(given: ships.Ship) -> Immersible:
    """What floats: her section, or the stations of her whole hull if she has offsets, per metre of her length."""
    if given.offsets is None:
        return Section(given.corners)
    form = whole_form(given)
    keel = np.array([0.0, float(given.corners[:, 1].min())])
    wet = [k for k, one in enumerate(form.sections) if one is not None]
    sections = tuple(Section(form.sections[k].outline + keel) for k in wet)
    return Stations(sections, form.weights[wet] / given.length)


def _rig(given: ships.Ship) -> Rig:
    """What holds her, at rest where she is."""
    one = given.rig
    return Rig(
        np.array([one.sway_mass, one.heave_mass, 0.0]),
        np.array([one.sway_damping, one.heave_damping, 0.0]),
        np.array([one.sway_spring, 0.0, 0.0]),
        np.array([given.about[0], given.heave + given.about[1], 0.0]),
    )


def hull_table(given: ships.Ship, sea: seas.Sea, gravity: float) -> Hydrodynamics:
    """The hull's coefficients in calm water, about her axis."""
    water = make_water(sea, gravity)
    return table_of(given, water, _frequencies(given, water, None))


def table_of(given: ships.Ship, water: Water, frequency: np.ndarray) -> Hydrodynamics:
    """Coefficients per metre at frequencies (n,) rad/s, of her section or of her whole hull. Raises as those do."""
    if given.hydrodynamics == "section":
        return stored_table(Section(given.corners), water, given.heave, frequency, given.about)
    return hull_table_of(given, water, frequency)


def _frequencies(given: ships.Ship, water: Water, waves: Waves | None) -> np.ndarray:
    """Frequencies (rad/s) of the table: the range that the memory needs, and that of the waves."""
    unit = sqrt(water.gravity / given.draught)
    low, high = SLOWEST * unit, FASTEST * unit
    if waves is not None:
        low, high = min(low, 0.98 * waves.frequency.min()), max(high, 1.02 * waves.frequency.max())
    return np.linspace(low, high, FREQUENCIES)


def _radiation(given: ships.Ship, table, sea: seas.Waves | None, deep: bool) -> Radiation:
    if given.radiation == "none":
        return Radiation(table.infinite_added_mass, np.zeros((3, 3)))
    if given.radiation == "at-frequency":
        return frozen_at(table, sea.frequency)
    return remembered(table, fit_memory(table, MEMORY_ORDER, deep))


def natural_roll(ship: Ship, heave: float, table, roll: float = 0.0) -> tuple[float, float]:
    """Angular frequency (rad/s) of roll alone about P, and the moment of inertia (kg m) with added mass there.

    About a rest at a heave (m) and a roll (rad). The table is that of the upright hull; of a slower or a faster roll it
    gives the added mass at its end.
    """
    load = ship.load
    frequency = 2.0
    for _ in range(50):
        at = float(np.clip(frequency, table.frequency[0], table.frequency[-1]))
        whole = impedance(ship, load.section, load.water, heave, table.at([at]), roll)[0, 2, 2].real
        own = ship.inertia(roll)[2, 2] - ship.radiation.added_mass[2, 2] + table.at([at]).added_mass[0, 2, 2]
        if own <= 0.0:
            raise Unavailable("her inertia in roll, added mass included, is not positive: look at her lengths' units.")
        spring = whole + at**2 * own
        frequency = sqrt(max(spring, 1e-9) / own)
    return frequency, float(own)


def flooding_angles(given: ships.Ship, vessel: Vessel) -> dict[str, float | None]:
    """Heels (rad) of deck immersion and of downflooding in calm water at constant displacement, None if never."""
    load, loading = vessel.ship.load, vessel.ship.body.loading
    points = {"deck_immersion_angle": given.deck_edges, "downflooding_angle": given.flooding_points}
    return {
        name: immersion_angle(load.section, loading, load.water, edges) if edges else None
        for name, edges in points.items()
    }
