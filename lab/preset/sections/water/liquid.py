"""What follows from the keys of a preset's water: the particles' spacing, the speed of sound, and the models.

These need the tank, gravity and the motions, so that they are functions of whole presets.
"""

from dataclasses import replace
from math import sqrt
from typing import Protocol

import numpy as np

from lab.preset.accuracy import LEVELS
from lab.preset.kept.content import parted
from lab.preset.sections.motion import MotionGroup
from lab.preset.sections.parts import PartGroup
from lab.preset.sections.run import Run
from lab.preset.sections.tank import Tank
from lab.preset.sections.water.air import Air, sound_of_air
from lab.preset.sections.water.schemes import SCHEMES, Scheme
from lab.preset.sections.water.section import DampingZone, Gauge, Water
from lab.preset.sections.water.tanks import Pool, Tanked
from solvers.fluid import given
from solvers.fluid.phases.adiabatic import background
from solvers.fluid.phases.cohesion import Cohesion
from solvers.fluid.phases.reduced_pressure import ReducedPressure
from solvers.fluid.terms.damping import rate_of
from solvers.fluid.walls.layers import edge_of
from solvers.motion.frame import is_turn
from solvers.ship.water import Water as Sea
from solvers.tank.outline import moments

# Least α of water between grains: with 0.01 a soaked bed stirs itself, above 1e-6 m g d a grain, with 0.02 it rests
STILL = 0.02
IN_SPACE = 1.5  # h/Δx: 4/3 π (2 · 1.5)³ = 113 neighbours, where h = 2 Δx in the plane has 50
FRONT = 2.0  # √(gH): the front of a column that collapses (Ritter 1892)


class Wet(Tanked, Protocol):
    """The sections of a preset that the water follows from."""

    water: Water
    air: Air | None
    gauges: dict[str, Gauge]
    damping: dict[str, DampingZone]
    tank: Tank
    thickness: float
    motion: MotionGroup
    parts: dict[str, PartGroup]
    run: Run
    liquid: given.Water
    pools: tuple[Pool, ...]
    wet: bool
    soaks: bool


def distance_of_walls(preset: Wet) -> float | None:
    """How far (m) the walls before and behind are apart: the tank's length where it has one, else the slab's thickness.

    None where neither is given.
    """
    along = preset.axle.length if preset.axle else preset.tank.length
    return along or preset.tank.thickness


def liquid(preset: Wet) -> given.Water:
    """The water of a preset as the solver takes it."""
    water, scheme = preset.water, SCHEMES[preset.water.scheme]
    pressure, level, force = parted(preset.gauges)
    made = given.Water(
        spacing=spacing(preset),
        sound_speed=sound_speed(preset, scheme),
        density=water.density,
        smoothing=smoothing(preset, scheme),
        kernel=water.kernel or scheme.kernel,
        state=water.state or scheme.state,
        diffusion=water.diffusion or scheme.diffusion,
        delta=scheme.delta if water.delta is None else water.delta,
        viscosity=water.viscosity or scheme.viscosity,
        alpha=water.alpha if water.alpha is not None else _still(preset, scheme),
        kinematic=water.kinematic_viscosity or 0.0,
        slip=water.slip,
        gap=(distance_of_walls(preset) or 0.0) if water.between_walls else 0.0,
        full=water.full,
        background=water.background_pressure or 0.0,
        shifting=water.shifting,
        speed=expected_speed(preset),
        start="lattice" if preset.tank.solid else water.start,
        model=water.model,
        swing_damping=water.swing_damping,
        added_mass=water.added_mass,
        walls=water.periodic != "yz",
        periodic=(*(water.periodic or ""), *(["x"] if preset.tank.periodic else [])),
        pull=given.Pull(water.flow.pull, centre_of_flow(preset)) if water.flow and water.flow.pull else None,
        gauges=tuple(_sensor(gauge) for gauge in pressure.values()),
        levels=tuple(given.Level(gauge.y, gauge.x or 0.0) for gauge in level.values()),
        edges=tuple(_edge(gauge, preset.tank) for gauge in force.values()),
        air=_air(preset, scheme) if preset.air is not None else None,
        damping=tuple(_zone(preset, zone) for zone in preset.damping.values()),
    )
    if made.air is not None and water.background_pressure is None:
        over = max(z for _, z in preset.tank.corners) - bounds(preset)[1]
        hanging = ReducedPressure.hanging(made, preset.run.gravity, over)
        made = replace(made, background=background(made.softened.air, made, hanging))
    return made


def smoothing(preset: Wet, scheme: Scheme) -> float:
    """h/Δx: as given, else that of the scheme; in space no more than IN_SPACE, with twice the plane's neighbours."""
    if preset.water.smoothing:
        return preset.water.smoothing
    found = (preset.air and scheme.smoothing_with_air) or scheme.smoothing
    return min(found, IN_SPACE) if preset.tank.solid else found


def _still(preset: Wet, scheme: Scheme) -> float:
    """The artificial viscosity of a scheme; between grains at least as much as lets a bed rest."""
    return max(scheme.alpha, STILL) if preset.wet or preset.soaks else scheme.alpha


def _zone(preset: Wet, zone: DampingZone) -> given.DampingZone:
    """A damping zone as the solver takes it, for the group velocity of its waves in water of this depth."""
    sea, length = Sea(1.0, depth(preset), preset.run.gravity), abs(zone.end - zone.start)
    rate = rate_of(length, float(sea.group_speed(2.0 * np.pi / zone.period))) if preset.run.gravity else 0.0
    return given.DampingZone(zone.start, zone.end, rate)


def _air(preset: Wet, scheme: Scheme) -> given.Air:
    """The air of a preset as the solver takes it."""
    air, alpha = preset.air, scheme.alpha if preset.water.alpha is None else preset.water.alpha
    acts, heavy, sound = interface(preset), preset.water.density, sound_speed(preset, scheme)
    return given.Air(
        density=air.density,
        sound_speed=sound_of_air(air, sound),
        alpha=alpha if air.alpha is None else air.alpha,
        kinematic=air.kinematic_viscosity or 0.0,
        tension=air.surface_tension,
        interface=acts,
        cohesion=Cohesion.pull(heavy, air.density, preset.run.gravity, depth(preset)) if acts == "cohesion" else 0.0,
        soft_speed=0.0 if air.stiff_from is None else sound,
        stiff_from=air.stiff_from or 0.0,
        reduced=float(bounds(preset)[1]) if air.reduced else None,
    )


def interface(preset: Wet) -> str:
    """What acts between water and air, by name: the preset's own, or that of its scheme."""
    return preset.air.interface or SCHEMES[preset.water.scheme].interface


def _sensor(gauge: Gauge) -> given.Gauge:
    """A pressure gauge as the solver takes it."""
    return given.Gauge(gauge.place, gauge.length, gauge.response, gauge.x or 0.0, gauge.radius)


def _edge(gauge: Gauge, tank: Tank) -> int:
    """The edge of the tank that is nearest to a gauge, by its first corner."""
    return int(edge_of(np.array([gauge.place]), np.array(tank.corners))[0])


def bounds(preset: Wet) -> tuple[np.ndarray, float]:
    """The polygon (m, 2) m, counter-clockwise, that the first tank's water fills up to a level (m), and this level."""
    first = preset.pools[0]
    return first.polygon, first.level


def depth(preset: Wet) -> float:
    """Depth (m) of the first tank's water, or height of its region; of a room that is empty at first its height."""
    return preset.pools[0].depth or preset.pools[0].most


def layers(preset: Wet) -> int:
    """How many particles make up the depth."""
    wanted, deep = preset.water.spacing, depth(preset)
    return usual_layers(preset) if wanted == "auto" else max(1, round(deep / wanted))


def usual_layers(preset: Wet) -> int:
    """How many particles make up the depth by the level of accuracy: in space half as many as in the plane."""
    found = LEVELS[preset.run.accuracy].layers
    return found // 2 if preset.tank.solid else found


def spacing(preset: Wet) -> float:
    """Distance (m) of the particles: the nearest to the one that is asked for that divides the depth."""
    return depth(preset) / layers(preset)


def expected_speed(preset: Wet) -> float:
    """The highest speed (m/s) to be expected: of long waves, √(gH), of a column that collapses, 2 √(gH), of its
    own flow at first, of the tank.

    H is the height of the water's surface over the tank's lowest point, that of the deepest tank. Water in a room of a
    hull, and what may enter a ship's, is as a column that may collapse.
    """
    height = max(pool.depth for pool in preset.pools)
    if preset.water.shape is not None:
        height = max(height, bounds(preset)[1] - min(z for _, z in preset.tank.corners))
    wave = sqrt(preset.run.gravity * height) * (1.0 if preset.water.shape is None else FRONT)
    parts = preset.parts.values()
    rooms = [room.depth for part in parts for room in part.rooms.values()]
    rooms += [pool.most for pool in preset.pools if pool.open]
    falls = (FRONT * sqrt(preset.run.gravity * high) for high in rooms)
    return max([wave, flow_speed(preset), tank_speed(preset), *(part.fastest() for part in parts), *falls])


def centre_of_flow(preset: Wet) -> tuple[float, float]:
    """The point (m) that water is strained from, turns about and is pulled to."""
    return preset.water.flow.centre or preset.water.centre or moments(bounds(preset)[0])[1]


def flow_speed(preset: Wet) -> float:
    """Bound (m/s) on the speed of the water by the flow that it starts with: of that farthest out, of each part."""
    flow, corners = preset.water.flow, bounds(preset)[0]
    if flow is None:
        return 0.0
    if not flow.free:
        width, height = preset.tank.extent
        return flow.vortices * max(1.0, height / width)
    farthest = float(np.hypot(*(corners - centre_of_flow(preset)).T).max())
    return farthest * (abs(flow.strain) + abs(flow.rotation) + flow.pull)


def tank_speed(preset: Wet) -> float:
    """Bound (m/s) on the speed of any point of the tank by its motions, each alone."""
    corners, fastest, solid = np.array(preset.tank.corners), 0.0, preset.tank.solid
    half = solid.half(corners) if solid else 0.0
    for motion in preset.motion.parts.values():
        lever = 1.0
        if motion.coordinate == "turn":
            lever = float(np.linalg.norm(corners - np.asarray(motion.centre), axis=1).max())
        elif is_turn(motion.coordinate):  # about y or z, through a point of z and x, or of y and x
            across = np.abs(corners[:, 1 if motion.coordinate == "pitch" else 0] - motion.centre[0]).max()
            lever = float(np.hypot(across, half + abs(motion.centre[1])))
        fastest = max(fastest, lever * motion.fastest(preset.motion.soft_start))
    return fastest


def sound_speed(preset: Wet, scheme: Scheme) -> float:
    """Speed of sound (m/s): as given, that of the scheme, or so many times the expected speed."""
    if preset.water.sound_speed != "auto":
        return preset.water.sound_speed
    return scheme.sound or scheme.mach * expected_speed(preset)
