"""What stops a run whose bulk is no longer physical."""

from collections.abc import Mapping

import numpy as np

from solvers.machine.errors import BadState

DENSEST = 0.5  # compression of a point that no bed at rest is anywhere near


def check_bulk(rows: Mapping[str, np.ndarray], time: float) -> None:
    """Raise BadState if the quantities at `time` (s) show an unphysical state."""
    for w, escaped in enumerate(rows["bulk_escaped"]):
        if escaped >= 0.0:
            raise BadState(
                w,
                f"a point of the bulk has left the tank at {time:.4g} s, which should not happen; "
                "lower run.step or bulk.spacing",
            )
    for w, most in enumerate(rows["bulk_densest"]):
        if not most < DENSEST:
            raise BadState(
                w,
                f"the bulk is compressed by {100.0 * most:.0f} % at {time:.4g} s; "
                "raise bulk.stiffness or lower run.step",
            )


def refuse_speed(world: int, fastest: float, sound: float, time: float) -> None:
    """Raise BadState for a world that was stopped at `time` (s) since its bulk is too fast."""
    raise BadState(
        world,
        f"the bulk moves at {fastest:.3g} m/s at {time:.4g} s, more than half of its speed of sound, {sound:.3g} m/s; "
        "raise bulk.stiffness or lower run.step",
    )
