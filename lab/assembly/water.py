"""The water of a scene, and its particles at rest, from a preset."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from lab.base.errors import LabError
from lab.preset.schema import Preset
from lab.preset.sections.bodies.hulls import depths_of, rooms_of
from lab.preset.sections.parts import parts_of
from lab.preset.sections.water.inflow import inlets_of
from lab.preset.sections.water.liquid import bounds, centre_of_flow
from lab.preset.sections.water.tanks import Pool, outline_at
from lab.preset.sections.wet.states import share_of, state
from solvers.fluid.given import Fluid, Water
from solvers.fluid.given import particles as particles_of_water
from solvers.fluid.phases.reduced_pressure import ReducedPressure
from solvers.fluid.start.air import air_above, air_round, with_air
from solvers.fluid.start.flow import compressed, stirred, torsion, vortex_pressure, vortices
from solvers.fluid.start.packing import below
from solvers.fluid.start.parts import clear_of, free_share
from solvers.fluid.start.plates import is_slanted
from solvers.fluid.start.rest import at_rest, hydrostatic_deviation, uncompressed
from solvers.fluid.start.support import depths
from solvers.fluid.timestep import steps_of_water
from solvers.machine.quantity import PLANE, SPACE
from solvers.mixture.given import Mixture
from solvers.scene import Scene
from solvers.ship.body import Body, bolted
from solvers.tank.outline import moments
from solvers.tank.parts import Part
from solvers.tank.shapes import PrismShape
from solvers.tank.tank import Tank

VISCOSITY = 1.0e-6  # m²/s, kinematic viscosity of water at 20 °C
PACKED = 0.84  # share of the plane that settled discs fill


def fluid_of(preset: Preset) -> Fluid | None:
    """The fluid of a scene, the same in all repeats; None without water. Raises LabError.

    Its density is that without pressure (`uncompressed`): the preset's is that of the water as it starts, in the mean.
    """
    if preset.water is None:
        return None
    in_tank = {pool.number: drops_of(preset, pool) for pool in preset.pools}
    water, start = preset.liquid, np.concatenate([*in_tank.values()])
    if water.model == "sph" and len(start):  # else particles are not compressed
        share = np.concatenate([np.full(len(filling), _along(preset, number)) for number, filling in in_tank.items()])
        wet = ~start["gas"]
        water = replace(water, density=uncompressed(start[wet], water.density, share[wet]))
    waiting = {pool.number: waiting_in(preset, pool) for pool in preset.pools}
    start = np.concatenate([np.concatenate([in_tank[number], waiting[number]]) for number in in_tank])
    numbers = range(1 + len(preset.tanks))
    fills, more = (tuple(len(one.get(number, ())) for number in numbers) for one in (in_tank, waiting))
    fills = tuple(map(sum, zip(fills, more, strict=True))) if len(fills) > 1 else ()
    entering = {"waiting": more, "inlets": inlets_of(preset)} if preset.inflow else {}
    return Fluid(water, np.tile(start, (preset.run.repeats, 1)), fills, **entering)


def waiting_in(preset: Preset, pool: Pool) -> np.ndarray:
    """The particles (n,) that may enter a tank: so many as fill it, each a square, for now in its middle."""
    axes = SPACE if preset.tank.solid else PLANE
    found = particles_of_water(pool.places(preset.liquid.spacing), axes=axes)
    found["volume"], found["position"][:, :PLANE] = preset.liquid.spacing**axes, pool.polygon.mean(axis=0)
    return found


def drops_of(preset: Preset, pool: Pool | None = None) -> np.ndarray:
    """The particles (n,) of the water in a tank, by default the first. Raises LabError if none fits in."""
    pool = pool or preset.pools[0]
    water = preset.liquid
    if not pool.depth:
        return particles_of_water(0)
    parts = [part for part in parts_of(preset) if part.tank == pool.number and not part.sieve]
    slanted = water.start == "packed" and any(map(is_slanted, parts)) and not water.periodic
    beside = parts if slanted or preset.tank.solid else []
    if (parts and not beside) or water.periodic:  # a lattice is cut off at bodies and upright plates, or goes on across
        water = replace(water, start="lattice")
    borne = preset.water.radius is None and "z" not in water.periodic
    try:
        gravity = preset.run.gravity if borne else 0.0
        place = beside, outline_at(preset, pool.number), preset.tank.along
        drops = at_rest(pool.polygon, pool.level, water, gravity, *place)
        if preset.water.flow:
            _set_going(preset, drops)
        elif preset.water.region is not None:
            _let_go(preset, drops, parts)
        if water.air:
            return with_air(drops, _air_of(preset, water))
    except ValueError as error:
        raise LabError(f"water.spacing: {error}; take smaller particles.") from None
    if parts and not beside:
        drops = _cut_off(preset, pool, drops, parts)
    return np.concatenate([drops, *in_rooms(preset, pool.number, water)])


def in_rooms(preset: Preset, tank: int, water: Water) -> list[np.ndarray]:
    """The particles (n,) of the water at rest in each room of the hulls in a tank. Raises LabError."""
    found = []
    for (name, part), solved in zip(preset.parts.items(), parts_of(preset), strict=True):
        corners, depths_in = rooms_of(part), depths_of(part)
        for number, room in enumerate(corners if solved.tank == tank else ()):
            if depths_in[room] > 0.0:
                try:
                    found.append(_in_room(solved.hull.rooms[number], depths_in[room], water, preset.run.gravity))
                except ValueError as error:
                    key = f"parts.{name}.rooms.{room}.depth"
                    raise LabError(f"{key}: {error}; take smaller particles.") from None
    return found


def _in_room(room: Sequence | PrismShape, depth: float, water: Water, gravity: float) -> np.ndarray:
    """The particles (n,) of water of a depth (m) at rest in a room of a hull. Raises ValueError if none fits in."""
    prism = room if isinstance(room, PrismShape) else None
    corners = prism.polygon if prism else np.array(room)
    level = corners[:, 1].min() + depth
    found = at_rest(corners, level, replace(water, start="lattice"), gravity, along=prism.along if prism else None)
    if prism:
        found["position"][:, 2] += prism.middle
    return found


def _set_going(preset: Preset, drops: np.ndarray) -> None:
    """Give particles (n,) the velocities and the pressure of the flow that they start with."""
    flow, water, place = preset.water.flow, preset.liquid, drops["position"]
    if flow.free:
        drops["velocity"] = stirred(place - centre_of_flow(preset), flow.strain, flow.rotation)
        rate = flow.strain**2 - flow.rotation**2 + flow.pull**2
        pressure = rate * torsion(bounds(preset)[0], place)
    else:
        place, sides = place - np.array(preset.tank.corners).min(axis=0), np.array(preset.tank.extent)
        drops["velocity"] = flow.vortices * vortices(place, sides)
        pressure = flow.vortices**2 * vortex_pressure(place, sides)
    drops["deviation"] = compressed(pressure, water)


def _air_of(preset: Preset, water: Water) -> np.ndarray:
    """The particles (n,) of the air, which fills what the water leaves of the tank."""
    tank, (polygon, level) = np.array(preset.tank.corners), bounds(preset)
    if preset.water.shape is None:
        return air_above(tank, level, water, preset.run.gravity)
    return air_round(tank, polygon, water, preset.run.gravity)


def _let_go(preset: Preset, drops: np.ndarray, parts: Sequence[Part]) -> None:
    """Give each of the particles (n,) of a region the density of its depth, none where it stands on nothing."""
    water, (polygon, level), place = preset.liquid, bounds(preset), drops["position"]
    tank = Tank(np.array(preset.tank.corners), preset.thickness, preset.tank.open_edges)
    depth, weight = (
        depths(place, polygon, level, tank, parts, water.spacing),
        ReducedPressure.weight(water, preset.run.gravity),
    )
    drops["deviation"] = hydrostatic_deviation(depth, weight, water.sound_speed, water.state)


def _cut_off(preset: Preset, pool: Pool, drops: np.ndarray, parts: Sequence[Part]) -> np.ndarray:
    """Those of the particles (n,) of a lattice that parts leave free."""
    water, polygon, level = preset.liquid, pool.polygon, pool.level
    whole = drops["volume"].sum()
    drops = drops[clear_of(drops["position"], parts, water.spacing)]
    if not len(drops):
        raise LabError("parts: they leave no room for the water.")
    drops["volume"] *= whole * free_share(polygon, level, parts, water.spacing) / drops["volume"].sum()
    return drops


def water_aboard(preset: Preset) -> Body:
    """The water in a ship's tanks as if it were frozen, per metre of her length, in the hull's axes."""
    bodies = []
    for pool in preset.pools if preset.water and preset.ship else ():
        if not pool.depth:
            continue
        share = _along(preset, pool.number)
        area, centre, turning = moments(below(pool.polygon, pool.level))
        mass = share * preset.water.density * area
        place = np.add(centre, preset.ship.hold)
        bodies.append(Body(mass, (float(place[0]), float(place[1])), mass * turning / area))
    return bolted(*bodies)


def _along(preset: Preset, number: int) -> float:
    """Which share of a ship's length the tank of this number has; 1 where it is as long as she, and without a ship."""
    tank = [preset.tank, *preset.tanks.values()][number]
    return tank.length / preset.ship.length if preset.ship and tank.length else 1.0


def most_drops(preset: Preset) -> int:
    """Number of particles of water and air in a world, rounded up, before any is made; 0 without water."""
    if preset.water is None:
        return 0
    if preset.air is not None:
        size = np.ptp(np.array(preset.tank.corners), axis=0) / preset.liquid.spacing
        return int(np.prod(np.ceil(size + 1.0)))
    size, count = preset.liquid.spacing, 0
    for pool in preset.pools:
        count += int(np.ceil(np.ptp(pool.polygon[:, 0]) / size + 1.0) * np.ceil(pool.most / size + 1.0))
    return count * int(np.ceil(preset.tank.along / size + 1.0)) if preset.tank.solid else count


def volumes_of(scene: Scene) -> np.ndarray:
    """Volumes (W, n) m³, in the plane m², of the particles of water of a scene; n is 0 without water."""
    return scene.fluid.particles["volume"][:, : scene.fluid.wet] if scene.fluid else np.zeros((scene.worlds, 0))


def air_volumes_of(scene: Scene) -> np.ndarray:
    """As `volumes_of`, of the particles of air."""
    return scene.fluid.particles["volume"][:, scene.fluid.wet :] if scene.fluid else np.zeros((scene.worlds, 0))


def updates(scene: Scene, steps: int) -> int:
    """How often particles are moved, one by one, in so many base steps of all worlds."""
    at_once = sum(matter.count for matter in scene.matters if matter is not scene.fluid)
    in_water = steps_of_water(scene, steps) * scene.particles if scene.fluid else 0
    return scene.worlds * (at_once * steps + in_water)


def particles(scene: Scene) -> int:
    """Number of grains and of particles of water and air in a world."""
    return sum(matter.count for matter in scene.matters)


def mixture_of(preset: Preset) -> Mixture | None:
    """How the grains of a preset and the water of their tank act on each other; None where they do not meet."""
    if not (preset.wet or preset.soaks):
        return None
    finer = preset.mean_diameter / preset.grains.true_size if preset.grains.true_size else 1.0
    drag = preset.water.drag or Mixture.drag
    level = None if share_of(preset.water) or preset.soaks else float(bounds(preset)[1])
    given = preset.water.kinematic_viscosity or VISCOSITY, finer, level, preset.water.saturation
    return Mixture(drag, *given)


def soaked_by(preset: Preset, scene: Scene) -> Fluid:
    """The fluid of a scene with the water of a preset's moisture, whose particles share it evenly in each world.

    Its mass is m_w = M/(1 − M) m_g. Of a saturation, or a depth, their number alone is known before the bed has
    settled.
    """
    fluid, moisture = scene.fluid, preset.water.moisture
    if moisture is None and preset.water.saturation is None:
        return soaked(scene)
    tank, wet = scene.tanks[scene.hold], state(preset)
    heavy = (4.0 / 3.0 * np.pi * scene.grains.radius**3 * scene.grains.density).sum(axis=1)
    mass = heavy.mean() * wet.moisture / (1.0 - wet.moisture) * np.ones(scene.worlds)
    if moisture is not None:
        mass = heavy * moisture / (1.0 - moisture)
    area = mass / (fluid.water.density * tank.thickness)
    count = max(1, round(float(area.mean()) / fluid.water.spacing**2))
    found = fluid.particles[:, :count].copy()
    found["volume"] = area[:, None] / found.shape[1]
    return replace(fluid, particles=found)


def soaked(scene: Scene) -> Fluid:
    """The fluid of a scene with about as many particles as there is water between its grains.

    How much water that is follows from the bed, once it has settled; the particles then share it evenly.
    """
    fluid, there = scene.fluid, int(scene.fluid.present.sum())
    if not there:  # all of it waits to enter
        return fluid
    drops = fluid.particles[0, :there]["volume"].sum()
    discs = float((np.pi * scene.grains.radius**2).sum(axis=1).mean())
    solid = float(scene.grains.solid.mean()) / scene.tanks[scene.hold].thickness
    under_water = min(1.0, drops * PACKED / discs)
    left = max(drops - under_water * solid, 0.1 * drops)
    count = max(1, round(there * left / drops))
    kept = np.concatenate([fluid.particles[:, :count], fluid.particles[:, there:]], axis=1)
    return replace(fluid, particles=kept, in_tanks=(kept.shape[1],) if fluid.in_tanks else ())
