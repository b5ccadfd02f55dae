"""Schedules: in what order, and on how many threads, the grains are moved. All use the same physics functions.

- per-world: each world's whole time loop on one thread, worlds in parallel; fastest for many small worlds.
- per-band: a world cut into bands, one thread per band, with a barrier after each phase; for a large world.
- per-grain: all grains in parallel, with kernel launches for every step; for graphics processors.
"""

from solvers.machine.errors import Unavailable
from solvers.machine.wide import LANES
from solvers.time.schedules.per_band import PerBand
from solvers.time.schedules.per_grain import PerGrain
from solvers.time.schedules.per_world import PerWorld

SCHEDULES = {"per-world": PerWorld, "per-band": PerBand, "per-grain": PerGrain}

# Grains per world from which bands on two threads are faster than one thread (measured).
WORTH_BANDS = 2000


def choose_schedule(wanted: str, arch: str, worlds: int, grains: int, threads: int, answering: bool = False) -> str:
    """The schedule to use: for "auto" per-grain on a graphics processor, per-band for few large worlds on the CPU.

    So a large world that is alone may have another one, with sums in another order, than among others.
    An `answering` carrier, such as a ship, responds to the load of its whole world at every step. Raises Unavailable
    for it with the per-grain schedule.
    """
    if answering:
        if wanted == "per-grain" or arch != "cpu":
            kinds = "ships and tanks on axles run per-world or per-band, on the processor"
            key = 'run.schedule = "auto"' if arch == "cpu" else 'run.arch = "cpu"'
            raise Unavailable(f"run.schedule: {kinds}; set {key}.")
        wanted = "per-world" if wanted == "auto" and not 2 * worlds <= threads else wanted
    if wanted != "auto":
        return wanted
    if arch != "cpu":
        return "per-grain"
    return "per-band" if 2 * worlds <= threads and grains >= WORTH_BANDS else "per-world"


def units_a_world(schedule: str, worlds: int, grains: int, threads: int) -> int:
    """Number of units into which a world of `grains` is cut."""
    if schedule == "per-grain":
        return max(1, grains)
    return max(1, min(threads // worlds, grains // 2)) if schedule == "per-band" else 1


def check_cut(units: int, schedule: int, vectors: int, grains: int) -> None:
    """Raise ValueError for units a world of `grains`, a schedule's number, or lanes that no simulation of these has.

    A state tells them, and arrays are made by them: one from a file could ask for any memory.
    """
    if not 1 <= units <= max(1, grains) or not 0 <= schedule < len(SCHEDULES) or vectors not in LANES:
        raise ValueError("the state is cut in a way that no schedule has")


def moved(scene) -> int:
    """Number of grains and of particles of water that are moved in a world; a liquid without particles has none."""
    return sum(matter.moved for matter in scene.matters)


def work(scene) -> int:
    """Relative cost of a step: the number of particles that move in all worlds; an empty world counts as one."""
    return max(scene.worlds, sum(scene.worlds * matter.moved // matter.substeps for matter in scene.matters))
