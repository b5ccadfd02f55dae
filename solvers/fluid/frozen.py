"""Water as if it were frozen: one rigid body."""

import numpy as np

from solvers.ship.body import Body


def frozen(y: np.ndarray, z: np.ndarray, mass: np.ndarray, volume: np.ndarray) -> Body:
    """Particles at y, z (n,) m of a `mass` (n,) kg/m each, squares of a `volume` (n,) m², as one rigid body.

    A square of the area V turns about its middle with m V/6.
    """
    total = mass.sum()
    centre = float(mass @ y / total), float(mass @ z / total)
    inertia = mass @ ((y - centre[0]) ** 2 + (z - centre[1]) ** 2 + volume / 6.0)
    return Body(float(total), centre, float(inertia))
