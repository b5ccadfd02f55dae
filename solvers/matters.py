"""The matters that a tank may hold, a line each: what a scene says of one, what bounds its step, and what makes it."""

from collections.abc import Callable
from dataclasses import replace

from solvers.bulk.given import Bulk
from solvers.bulk.matter import make_bulk
from solvers.bulk.timestep import limits_of_bulk
from solvers.fluid.given import Fluid
from solvers.fluid.making import make_water
from solvers.fluid.timestep import limits_of_water
from solvers.grains.given import Grains
from solvers.grains.making import make_grains
from solvers.grains.timestep import limits_of_grains
from solvers.liquid.matter import make_liquid
from solvers.machine.limit import Limit
from solvers.mixture.exchange import make_exchange
from solvers.tank.context import Context
from solvers.tank.given import Given
from solvers.tank.matter import Matter

__all__ = ["MATTERS", "context_of", "limits_of", "made", "make_exchange"]

# In the order in which their phases act: the bounds on a step of a scene in which particles meet at a speed (m/s), and
# what makes a matter of a scene, or None where another one does.
MATTERS: dict[type[Given], tuple[Callable[..., list[Limit]], tuple[Callable[..., Matter | None], ...]]] = {
    Grains: (limits_of_grains, (make_grains,)),
    Fluid: (limits_of_water, (make_water, make_liquid)),
    Bulk: (limits_of_bulk, (make_bulk,)),
}


def limits_of(scene, closing: float) -> list[Limit]:
    """Bounds on the step of the matters of a scene (`solvers.scene.Scene`), which meet at up to `closing` (m/s)."""
    return [limit for kind, (limits, _) in MATTERS.items() if scene.of(kind) for limit in limits(scene, closing)]


def context_of(run) -> Context:
    """What the matters of a `solvers.simulation.Simulation` are made in."""
    return Context(
        arrays=run.arrays,
        worlds=run.scene.worlds,
        axes=run.scene.axes,
        bands=run.units_a_world,
        per_particle=run.schedule_name == "per-grain",
        walls=run.walls,
        parts=run.parts,
        pieces=run.scene.pieces,
        shares=run.scene.shares,
        carrier=run.carrier,
        skin=run.skin,
        room=run.room,
        largest_multiple=run.largest_multiple,
        vectors=run.vectors,
        among=run.among,
    )


def made(scene, context: Context) -> list[Matter]:
    """The matters of a scene (`solvers.scene.Scene`). Raises Unavailable."""
    found: list[Matter] = []
    for make in (make for kind, (_, makes) in MATTERS.items() if scene.of(kind) for make in makes):
        matter = make(scene, replace(context, wide=all(other.wide for other in found)))
        found += [matter] if matter else []
    return found
