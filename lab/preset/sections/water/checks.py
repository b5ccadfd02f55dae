"""Consistency checks of the water in a preset; each error is one sentence that names the key."""

import numpy as np

from lab.base.errors import LabError
from lab.preset.outline import area, stands_out
from lab.preset.sections.ship import Ship
from lab.preset.sections.tank import Tank
from lab.preset.sections.water import liquid
from lab.preset.sections.water.flow_checks import check_flow, check_periodic
from lab.preset.sections.water.gauge_checks import check_gauges, place_of
from lab.preset.sections.water.schemes import SCHEMES
from lab.preset.sections.water.section import Water
from lab.preset.sections.wet.states import SHARES, check_share, share_of
from lab.preset.units import needed, show
from solvers.fluid.viscosity import LAMINAR

MOST_PARTICLES = 20e6  # in a tank; what fits into the memory is checked as a scene is built


class Whole(liquid.Wet):
    """Those sections, and the ones that cannot be there beside water."""

    grains: object | None
    ship: Ship | None


COMPRESSED = 0.1  # most that water is compressed by its own weight, g H/c0²


def check_water(preset: Whole) -> None:
    """Raise LabError for water that cannot be: in company, of contradictory keys, too much, or outside of the tank."""
    water, tank = preset.water, preset.tank
    if water is None:
        return
    _check_company(preset)
    _check_models(water, preset.grains is not None)
    _check_between(preset)
    _check_given(preset)
    if water.depth is not None:
        _check_depth(water, tank)
    elif share_of(water):
        asked = liquid.spacing(preset) if water.spacing == "auto" else water.spacing  # not yet rounded to the depth
        check_share(preset, 2.0 * preset.liquid.smoothing * asked)
    else:
        _check_shape(water, tank)
    check_gauges(preset.gauges, tank)
    _check_damping(preset)
    _check_spacing(preset)
    _check_sound(preset)
    _check_background(preset)
    check_flow(preset)
    check_periodic(preset)


def _check_damping(preset: Whole) -> None:
    """Raise LabError for a damping zone that is none, is not in the tank, or is in a tank that moves."""
    low, high = (side(y for y, _ in preset.tank.corners) for side in (min, max))
    for name, zone in preset.damping.items():
        key = f"damping.{name}"
        if preset.ship is not None or preset.axle is not None or preset.motion.parts:
            raise LabError(f"{key}: a zone that damps waves stands in a tank at rest; leave out this or its motion.")
        for end in ("start", "end"):
            if not low <= getattr(zone, end) <= high:
                sides = f"from {show(low, 'm')} to {show(high, 'm')}"
                raise LabError(f"{key}.{end}: is not in the tank, which reaches {sides}.")
        if zone.start == zone.end:
            raise LabError(f"{key}.end: is where it starts; a zone needs a length, best that of a wave or more.")


def _check_company(preset: Whole) -> None:
    """Raise LabError for what is in the tank beside water, or carries it, and the solver cannot compute."""
    if preset.water.model != "sph" and preset.ship is None:
        named = preset.water.model
        raise LabError(f'water.model: "{named}" is for tanks in a ship; add a table [ship], or take "sph".')
    if preset.water.model == "level":
        _check_level_water(preset)
    if preset.air is not None and preset.ship is not None:
        raise LabError("air: air in a ship's tanks is not computed yet; leave out [air] or [ship].")
    if preset.ship is not None:
        for name in ("region", "radius"):
            if getattr(preset.water, name) is not None:
                raise LabError(f"water.{name}: a ship starts with level water; give a depth.")
    if preset.run.repeats > 1 and preset.grains is None:
        raise LabError("run.repeats: water starts without chance, so that all repeats would be the same; take one.")


def _check_level_water(preset: Whole) -> None:
    """Raise LabError for what level water knows nothing of."""
    if preset.gauges:
        raise LabError('gauges: water.model = "level" knows none; leave them out, or take "sph".')
    if preset.inflow and preset.ship.coupling == "staggered":
        raise LabError('ship.coupling: "staggered" is not stable with level water that enters; take "instant".')
    names = ["tank", *preset.tanks]
    wet = {names[pool.number] for pool in preset.pools}
    for name, part in preset.parts.items():
        if (part.tank or "tank") in wet:
            raise LabError(f'parts.{name}: water.model = "level" goes round no parts; leave it out, or take "sph".')
    for name, value in (("swing_damping", preset.water.swing_damping), ("added_mass", preset.water.added_mass)):
        if value != getattr(Water, name):
            raise LabError(f'water.{name}: has no meaning for water.model = "level"; leave it out.')


def given_of(water: Water) -> dict[str, object]:
    """What says where the water of the first tank is, by the keys that are given."""
    names = "depth", "region", "radius", *SHARES
    return {name: getattr(water, name) for name in names if getattr(water, name) is not None}


def _check_given(preset: Whole) -> None:
    """Raise LabError unless it is said where the water is."""
    given, elsewhere = given_of(preset.water), any(tank.depth is not None for tank in preset.tanks.values())
    elsewhere = elsewhere or bool(preset.inflow)
    share = share_of(preset.water)
    if share and (preset.grains is None or preset.grains.room is not None):
        raise LabError(f"water.{share[0]}: goes with grains in the water's tank; add [grains], or give water.depth.")
    if share and len(given) > 1:
        raise LabError(
            f"water.{share[0]}: give exactly one of depth, moisture and saturation (got {' and '.join(given)})."
        )
    if len(given) > 1 or not (given or elsewhere):
        got = " and ".join(given) or "none"
        raise LabError(f"water.depth: give exactly one of depth, region and radius (got {got}).")
    if ("radius" in given) != (preset.water.centre is not None):
        what = f"missing for a drop; {needed('m')}, twice" if given.get("radius") else "goes with radius; leave it out"
        raise LabError(f"water.centre: {what}.")


def _check_models(water: Water, in_water: bool) -> None:
    """Raise LabError for models whose numbers are missing, or numbers whose models are."""
    viscosity = water.viscosity or SCHEMES[water.scheme].viscosity
    if viscosity in LAMINAR and water.kinematic_viscosity is None:
        raise LabError(f'water.kinematic_viscosity: missing for viscosity = "{viscosity}"; {needed("m^2/s")}.')
    borne = water.between_walls or in_water
    if viscosity not in LAMINAR and water.kinematic_viscosity is not None and not borne:
        raise LabError('water.kinematic_viscosity: goes with viscosity = "laminar"; leave out either.')
    if viscosity in LAMINAR and water.alpha is not None:
        raise LabError(f'water.alpha: goes with an artificial viscosity, not with viscosity = "{viscosity}".')
    if water.diffusion == "none" and water.delta:
        raise LabError('water.delta: there is no diffusion of density with diffusion = "none".')


def _check_between(preset: Whole) -> None:
    """Raise LabError for walls before and behind whose distance, or water whose viscosity, is not known; or for air."""
    water = preset.water
    if not water.between_walls:
        return
    if water.kinematic_viscosity is None:
        raise LabError(
            f"water.kinematic_viscosity: missing; with water.between_walls that of the liquid; {needed('m^2/s')}."
        )
    if liquid.distance_of_walls(preset) is None:
        raise LabError("tank.thickness: missing; with water.between_walls it is how far those walls are apart.")
    if preset.tanks:
        raise LabError("water.between_walls: is for one tank, and here are more; leave it out.")
    if water.model != "sph":
        raise LabError(f'water.between_walls: water.model = "{water.model}" has no walls; take "sph" or leave it out.')
    if preset.air is not None:
        raise LabError("water.between_walls: is for water alone; leave out either this or [air].")


def _check_depth(water: Water, tank: Tank) -> None:
    deep, high = show(water.depth, "m"), show(tank.extent[1], "m")
    full = np.isclose(water.depth, tank.extent[1], rtol=1e-9)
    if water.depth > tank.extent[1] and not full:
        raise LabError(f"water.depth: {deep} is more than the tank's height, {high}.")
    if full and tank.lid and not water.full:
        raise LabError(f"water.depth: {deep} fills the tank up to its lid; set water.full = true, or take less.")
    if water.full and not (full and tank.lid):
        raise LabError(f"water.full: the water is {deep} deep in a tank {high} high; it must fill a tank with a lid.")


def _check_shape(water: Water, tank: Tank) -> None:
    key = "water.region" if water.region is not None else "water.radius"
    try:
        shape = water.shape
    except LabError as error:
        raise LabError(f"{key}: {error}") from None
    if shape is None:
        return
    if water.full:
        raise LabError("water.full: goes with a depth; water in a region has room to flow.")
    out = stands_out(shape, np.array(tank.corners))
    if out is not None:
        raise LabError(f"{key}: it reaches out of the tank at {place_of(out)}; keep it inside.")


def _check_spacing(preset: Whole) -> None:
    """Raise LabError for particles that are larger than the water or the tank, or too many."""
    water, (polygon, _) = preset.water, liquid.bounds(preset)
    deep, wide = liquid.depth(preset), float(np.ptp(polygon[:, 0]))
    if water.spacing != "auto" and water.spacing > min(deep, wide):
        which, size = ("deep", deep) if deep <= wide else ("wide", wide)
        raise LabError(
            f"water.spacing: particles of {show(water.spacing, 'm')} are larger than the water, which is "
            f"{show(size, 'm')} {which}."
        )
    of_all = area([tuple(point) for point in polygon.tolist()])
    if water.shape is None:
        of_all *= min(1.0, deep / float(np.ptp(polygon[:, 1])))
    size = deep if water.spacing == "auto" else water.spacing
    if of_all > MOST_PARTICLES * size**2:
        raise LabError(f"water.spacing: particles of {show(size, 'm')} are too small for so much water.")


def _check_sound(preset: Whole) -> None:
    """Raise LabError for a speed of sound at which the water's own weight would compress it visibly."""
    borne = preset.water.radius is None and "z" not in (preset.water.periodic or "")
    head = borne * preset.run.gravity * max(pool.most for pool in preset.pools)
    sound = preset.liquid.sound_speed
    if head > COMPRESSED * sound**2:
        least = show((head / COMPRESSED) ** 0.5, "m/s")
        raise LabError(
            f"water.sound_speed: at {show(sound, 'm/s')} the water's weight would compress it by more than "
            f"{100.0 * COMPRESSED:g} %; take at least {least}, better ten times the speed of the water."
        )


def _check_background(preset: Whole) -> None:
    """Raise LabError for a background pressure at a free surface, or one that compresses the water visibly."""
    pressure, sound = preset.water.background_pressure or 0.0, preset.liquid.sound_speed
    if pressure and not (preset.water.full or preset.air):
        raise LabError("water.background_pressure: goes with water.full or [air]; a free surface would be blown apart.")
    most = COMPRESSED * preset.water.density * sound**2
    if pressure > most:
        raise LabError(
            f"water.background_pressure: {show(pressure, 'Pa')} is more than a tenth of ρ c² at "
            f"{show(sound, 'm/s')}; take at most {show(most, 'Pa')}, or raise water.sound_speed."
        )
