"""Settling: the matters of all worlds come to rest in the upright tank before the clock starts."""

from collections.abc import Callable

import numpy as np

from solvers.time import watch

AT_REST = -1e9  # s, a time long before any motion starts
LOOK = 0.01  # s, between two looks


def settle(run, rest: float, limit: float, tell: Callable[[float], None]) -> bool:
    """Let the matters of a `solvers.simulation.Simulation` settle, as its `settle` says."""
    run.origin = AT_REST
    for matter in run.matters.values():
        matter.ease(True)
    look = run.exchange_interval * max(1, round(LOOK / (run.exchange_interval * run.dt)))
    quiet = np.zeros(run.scene.worlds, dtype=int)
    while np.any(quiet < 2) and run.steps * run.dt < limit:
        run.advance(look)
        rows = run.observe()
        calm = np.all([matter.restlessness(rows) < rest for matter in run.matters.values()], axis=0)
        quiet = np.where(calm, quiet + 1, 0)
        run.clock.status.from_numpy(np.where(quiet < 2, watch.RUNNING, watch.WAITING).astype(np.int32))
        tell(run.steps * run.dt)
    for matter in run.matters.values():
        matter.ease(False)
    run.start_clock()
    return bool(np.all(quiet >= 2))
