"""Schedules: in what order, and on how many threads, the grains are moved. All use the same physics functions.

- per-world: each world's whole time loop on one thread, worlds in parallel; the fastest for small worlds and many.
- per-band: a world cut into bands, one thread a band, that wait for each other twice a step; for a large world.
- per-grain: every grain on its own, a launch a step; for graphics processors.
"""

from solvers.machine.errors import Unavailable
from solvers.time.schedules.per_band import PerBand
from solvers.time.schedules.per_grain import PerGrain
from solvers.time.schedules.per_world import PerWorld

SCHEDULES = {"per-world": PerWorld, "per-band": PerBand, "per-grain": PerGrain}

# Grains a world from which bands on two threads beat the whole on one (measured, README "Speed").
WORTH_BANDS = 2000


def choose_schedule(wanted: str, arch: str, worlds: int, grains: int, threads: int, answering: bool = False) -> str:
    """What "auto" stands for: on a graphics processor per-grain; on the CPU bands for few large worlds.

    A carrier that is `answering` follows from the load of a whole world at every step, as a ship does. Raises
    Unavailable for it on per-grain schedules.
    """
    if answering:
        if wanted == "per-grain" or arch != "cpu":
            raise Unavailable('run.schedule: ships run per-world or per-band, on the processor; set run.arch = "cpu".')
        wanted = "per-world" if wanted == "auto" and not 2 * worlds <= threads else wanted
    if wanted != "auto":
        return wanted
    if arch != "cpu":
        return "per-grain"
    return "per-band" if 2 * worlds <= threads and grains >= WORTH_BANDS else "per-world"


def units_a_world(schedule: str, worlds: int, grains: int, threads: int) -> int:
    """Into how many units a world of so many grains is cut."""
    if schedule == "per-grain":
        return grains
    return max(1, min(threads // worlds, grains // 2)) if schedule == "per-band" else 1
