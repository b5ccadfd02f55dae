"""State checks of grains: unphysical states of a world, and errors that name the remedy."""

import numpy as np

from solvers.machine.errors import BadState

# Largest displacement in a step, in radii of the smallest grain: beyond it the step does not resolve a collision.
FASTEST_STEP = 0.1
DEEPEST_OVERLAP = 0.3  # radii, beyond elastic contact


def refuse_speed(world: int, velocity: np.ndarray, time: float, dt: float) -> None:
    """Raise BadState for a world whose grains, with velocities (n, axes) m/s at `time` (s), are too fast for dt (s)."""
    speed = np.linalg.norm(velocity, axis=1).max()
    what = f"a grain moves at {speed:.3g} m/s" if np.isfinite(speed) else "a grain's speed is not a number"
    raise BadState(
        world,
        f"{what} at t = {time:.4g} s, too fast for the step of {dt:.3g} s; "
        "use a smaller run.step or check the motion's amplitude.",
    )


def check_state(deepest: np.ndarray, escaped: np.ndarray, time: float) -> None:
    """Raise BadState if a grain has left the tank or an overlap is far beyond elastic contact.

    `deepest` (W,) is the largest overlap in radii, `escaped` (W,) the index of a grain outside the walls or −1.
    """
    for w in np.flatnonzero(escaped >= 0):
        raise BadState(
            w,
            f"grain {escaped[w]} left the tank by t = {time:.4g} s; "
            "use a smaller run.step or a larger contact.stiffness_scale.",
        )
    for w in np.flatnonzero(~(deepest <= DEEPEST_OVERLAP)):
        raise BadState(
            w,
            f"grains overlap by {100 * deepest[w]:.3g} % of a radius at t = {time:.4g} s, "
            "too soft for these impacts; use a larger contact.stiffness_scale.",
        )
