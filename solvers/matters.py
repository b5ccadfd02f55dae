"""The matters that a tank may hold, a line each: what makes one from a scene, or None where the scene has none."""

from dataclasses import replace

from solvers.fluid.matter import make_water
from solvers.grains.matter import make_grains
from solvers.liquid.matter import make_liquid
from solvers.tank.matter import Matter
from solvers.tank.setting import Setting

MATTERS = (make_grains, make_water, make_liquid)


def setting_of(run) -> Setting:
    """What the matters of a `solvers.simulation.Simulation` are made in."""
    return Setting(
        arrays=run.arrays,
        worlds=run.scene.worlds,
        bands=run.units_a_world,
        per_particle=run.schedule_name == "per-grain",
        walls=run.walls,
        pieces=run.scene.pieces,
        shares=run.scene.shares,
        carrier=run.carrier,
        skin=run.skin,
        room=run.room,
        stretch=run.stretch,
        vectors=run.vectors,
        among=run.among,
    )


def made(scene, setting: Setting) -> list[Matter]:
    """The matters of a scene (`solvers.scene.Scene`). Raises Unavailable."""
    found: list[Matter] = []
    for make in MATTERS:
        matter = make(scene, replace(setting, wide=all(other.wide for other in found)))
        found += [matter] if matter else []
    return found
