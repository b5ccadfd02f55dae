"""State checks of water: errors that name the time, the place and the remedy."""

import numpy as np

from solvers.fluid.constants import FASTEST
from solvers.fluid.given import Water
from solvers.machine.errors import BadState

CREATED = 0.1  # of the energy exchanged: what may be missing from the account before a run is stopped
REMEDY = "use a higher water.sound_speed, a smaller water.spacing, or check the motion's amplitude"


def refuse_state(world: int, place: np.ndarray, speed: np.ndarray, excess: np.ndarray, time: float, sound: float):
    """Raise BadState for a world whose particles, at `place` (n, 2) m, made the watch stop it at `time` (s).

    `speed` (n,) m/s is that relative to the tank, `excess` (n,) the relative excess of density, `sound` c0 in m/s.
    """
    bad = ~(np.isfinite(speed) & np.isfinite(excess) & np.isfinite(place).all(axis=1))
    if bad.any():
        what, at = "the state of a particle of water is not a number", place[bad.argmax()]
    elif speed.max() >= FASTEST * sound:
        worst = speed.argmax()
        what, at = f"water moves at {speed[worst]:.3g} m/s, Mach {speed[worst] / sound:.2g},", place[worst]
    else:
        worst = np.abs(excess).argmax()
        what, at = f"the water's density is off by {100.0 * excess[worst]:.3g} %", place[worst]
    raise BadState(world, f"{what} at y = {at[0]:.4g} m, z = {at[1]:.4g} m, t = {time:.4g} s; {REMEDY}.")


def check_water(rows: dict[str, np.ndarray], start: np.ndarray | float, time: float) -> None:
    """Raise BadState if a particle has left a closed tank, or if energy has been created.

    `rows` are the quantities at `time` (s), `start` (W,) J the energy at the start, NaN if unknown.
    """
    for w in np.flatnonzero(rows["water_escaped"] >= 0):
        raise BadState(
            w, f"particle {int(rows['water_escaped'][w])} of the water left the tank by t = {time:.4g} s; {REMEDY}."
        )
    exchanged = np.abs(rows["water_work"]) + rows["water_viscous"] + rows["water_diffusive"] + rows["water_kinetic"]
    for w in np.flatnonzero(residual(rows, start) > CREATED * exchanged + 1e-3 * np.abs(start)):
        raise BadState(w, f"the water has gained energy from nothing by t = {time:.4g} s; {REMEDY}.")


def residual(rows: dict[str, np.ndarray], start: np.ndarray | float) -> np.ndarray:
    """Energy (W,) J that nothing accounts for: gain, losses and what dummies hold, less the work of the walls."""
    taken = rows["water_viscous"] + rows["water_diffusive"] + rows["water_held"]
    return rows["water_total"] + taken - rows["water_work"] - start


def refuse_scene(water: Water, tanks: int, vessels: bool, parts: int) -> str:
    """Why a scene with water cannot be run, in a sentence; empty if it can."""
    if vessels:
        return "water: water in a ship's hold is not computed yet; leave out [ship] or [water]."
    if tanks > 1 or parts:
        return "water: tanks of water have no parts, and stand alone; leave out [parts] or [water]."
    return ""
