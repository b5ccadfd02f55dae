"""The longest step of the bulk: sound must not cross a cell in it."""

from solvers.bulk.given import Bulk
from solvers.machine.limit import Limit

COURANT = 0.5


def limits_of_bulk(scene, closing: float = 0.0) -> list[Limit]:
    """Bounds on the step of the bulk of a `solvers.scene.Scene`."""
    bulk = scene.of(Bulk)
    sound, cell = bulk.material.sound_speed, bulk.grid.smallest
    reason = f"{COURANT:g} of the time in which sound crosses a cell of {cell:.3g} m at {sound:.3g} m/s"
    return [Limit(COURANT * cell / sound, reason, firm=True)]
