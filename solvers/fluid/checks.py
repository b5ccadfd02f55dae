"""State checks of water: errors that name the time, the place and the remedy."""

from collections.abc import Sequence

import numpy as np

from solvers.fluid.constants import FASTEST
from solvers.fluid.state import allowed
from solvers.machine.errors import BadState, Unavailable
from solvers.machine.quantity import DIRECTIONS, PLANE
from solvers.tank.solids.solid import Prism

CREATED = 0.1  # of the energy exchanged: what may be missing from the account before a run is stopped
LEAST = 1e-3  # Mach number of water that has so little energy that none can be missed
SQUEEZED = "use a higher air.sound_speed, or a smaller water.spacing"
REMEDY = "use a higher water.sound_speed, a smaller water.spacing, or check the motion's amplitude"
LIFTED = 'water.shifting = "delta-plus" lifts water below a surface; take "delta-plus-momentum", or none'


def suspects(matter, world: int, time: float) -> dict[str, np.ndarray]:
    """What `refuse_state` asks of the particles in a world of a `solvers.fluid.matter.WaterMatter` at `time` (s)."""
    p = matter.particles
    places, *rest = (p.read(*fields) for fields in (p.place, p.velocity, p.acceleration))
    found = p.read(p.deviation, p.eigenvalue, p.mass)
    velocity = matter.diagnostics.relative(time, places, *rest, matter.gas)[world]
    place, speed = np.stack(places, axis=-1)[world], np.linalg.norm(velocity, axis=1)
    told = {
        "place": place,
        "speed": np.where(outside(place, matter.order.grid.watched), 0.0, speed),
        **{
            name: values[world]
            for name, values in (("deviation", found[0]), ("eigenvalue", found[1]), ("gas", matter.gas))
        },
    }
    there = np.isfinite(found[2][world])  # without those that have not entered
    return {name: values[there] for name, values in told.items()}


def refuse_state(world: int, particles: dict[str, np.ndarray], time: float, sound: float) -> None:
    """Raise BadState for a world whose particles made the watch stop it at `time` (s).

    `particles` have their "place" (n, D) m, "speed" (n,) m/s relative to the tank, zero for those that have left an
    open one, "deviation" (n,) of density, "eigenvalue" (n,), and "gas" (n,), 1 for air; `sound` is c0 in m/s.
    """
    remedy = REMEDY
    place, speed, deviation = (particles[name] for name in ("place", "speed", "deviation"))
    bad = ~(np.isfinite(speed) & np.isfinite(deviation) & np.isfinite(place).all(axis=1))
    if bad.any():
        placed = bad & np.isfinite(place).all(axis=1)
        worst = (placed if placed.any() else bad).argmax()
        what, at = "the state of a particle of water is not a number", place[worst]
    elif speed.max() >= FASTEST * sound:
        worst = speed.argmax()
        what, at = f"water moves at {speed[worst]:.3g} m/s, Mach {speed[worst] / sound:.2g},", place[worst]
    else:
        worst = (np.abs(deviation) / allowed(particles["eigenvalue"])).argmax()
        whose, remedy = ("air", SQUEEZED) if particles["gas"][worst] else ("water", REMEDY)
        what, at = f"the {whose}'s density is off by {100.0 * deviation[worst]:.3g} %", place[worst]
    where = ", ".join(f"{name} = {one:.4g} m" for name, one in zip(DIRECTIONS, at, strict=False))
    raise BadState(world, f"{what} at {where}, t = {time:.4g} s; {remedy}.")


def check_water(
    rows: dict[str, np.ndarray], start: np.ndarray | float, time: float, least: float = 0.0, lifts: bool = False
) -> None:
    """Raise BadState if a particle has left a closed tank, or energy been created, as by shifting that `lifts`.

    `rows` are the quantities at `time` (s), `start` (W,) J the energy at the start, NaN if unknown. Up to `least` (J)
    does not count: as water is first set in motion, the account is a step late and most of what there is.
    """
    for w in np.flatnonzero(rows["water_escaped"] >= 0):
        raise BadState(
            w, f"particle {int(rows['water_escaped'][w])} of the water left the tank by t = {time:.4g} s; {REMEDY}."
        )
    exchanged = sum(np.abs(rows[f"water_{name}"]) for name in ("work", "viscous", "diffusive", "kinetic"))
    exchanged = exchanged + np.abs(rows.get("inflow_energy", 0.0))
    for w in np.flatnonzero(residual(rows, start) > CREATED * exchanged + 1e-3 * np.abs(start) + least):
        remedy = LIFTED if lifts else REMEDY
        raise BadState(w, f"the water has gained energy from nothing by t = {time:.4g} s; {remedy}.")


def outside(place: np.ndarray, box: tuple[np.ndarray, np.ndarray] | None) -> np.ndarray:
    """Which of the places (n, 2) m are beyond the corners of a box, where how fast they are is not looked at.

    What comes back into it, from above the tank, is looked at again. None: nothing is beyond.
    """
    if box is None:
        return np.zeros(len(place), dtype=bool)
    return ((place < box[0]) | (place > box[1])).any(axis=1)


def residual(rows: dict[str, np.ndarray], start: np.ndarray | float) -> np.ndarray:
    """Energy (W,) J that nothing accounts for: gain, losses and what walls store, less their work and what enters."""
    taken = rows["water_viscous"] + rows["water_diffusive"] + rows["water_wall_energy"]
    return rows["water_total"] + taken - rows["water_work"] - rows.get("inflow_energy", 0.0) - start


def refuse_reduced(scene) -> None:
    """Raise Unavailable, one sentence, for a `solvers.scene.Scene` in which pressures cannot be reduced."""
    water, air = scene.fluid.water, scene.fluid.water.air
    if air is None or air.reduced is None:
        return
    beside = {
        "parts": bool(scene.parts),
        "force gauges": bool(water.edges),
        "air.stiff_from": air.stiff_from > 0.0,
        'air.interface = "cohesion"': air.cohesion > 0.0,
    }
    for name, there in beside.items():
        if there:
            raise Unavailable(f"air.reduced: does not go with {name}; leave out one of the two.")


def refuse_scene(fills: Sequence[int], hold: int | None) -> None:
    """Raise Unavailable, one sentence, for a scene in which water cannot be computed.

    `fills`: how many particles of water are in each tank; `hold`: the one with grains, None without.
    """
    if hold is not None and fills[hold]:
        raise Unavailable("water: grains in water are not computed yet; give them tanks of their own.")


def refuse_space(scene) -> None:
    """Raise Unavailable, one sentence, for a scene in space with something that water has in the plane alone."""
    water = scene.fluid.water
    if scene.axes == PLANE:
        return
    plane_alone = {
        "air": bool(water.air),
        "plates": any(part.shape is None for part in scene.parts),
        "force gauges": bool(water.edges),
        "damping zones": bool(water.damping),
        "several tanks": bool(scene.more_tanks),
        "a ship or an axle": bool(scene.vessels or scene.axles),
        "grains beside it": bool(scene.grains),
        "end walls that hold it back": water.gap > 0.0,
        "a pull to a point": water.pull is not None,
        "tanks other than prisms": not isinstance(scene.solid, Prism),
    }
    for name, there in plane_alone.items():
        if there:
            raise Unavailable(f"water: {name} in space cannot be computed yet; leave tank.along out, or {name}.")
