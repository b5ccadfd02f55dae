"""A rigid body in the plane, and rigidly joined bodies such as a hull with frozen cargo. All per metre of length."""

from dataclasses import dataclass
from math import sqrt

import numpy as np

from solvers.ship.hydrostatics import Loading


@dataclass(frozen=True)
class Body:
    """Mass (kg/m), centre of gravity y, z (m) in the hull's frame, moment of inertia (kg m) about that centre."""

    mass: float
    centre: tuple[float, float]
    inertia: float

    @property
    def gyradius(self) -> float:
        """Radius of gyration (m) about the centre of gravity."""
        return sqrt(self.inertia / self.mass)

    @property
    def loading(self) -> Loading:
        """Mass and centre of gravity, for hydrostatics."""
        return Loading(self.mass, self.centre)


NOTHING = Body(0.0, (0.0, 0.0), 0.0)  # the cargo of an empty hold


def bolted(*bodies: Body) -> Body:
    """Rigidly joined bodies as one, by the parallel-axis theorem (Huygens and Steiner); NOTHING without any."""
    if len(bodies) < 2:
        return bodies[0] if bodies else NOTHING
    mass = np.array([body.mass for body in bodies])
    if not mass.any():
        return NOTHING
    centres = np.array([body.centre for body in bodies])
    centre = mass @ centres / mass.sum()
    apart = ((centres - centre) ** 2).sum(axis=1)
    inertia = sum(body.inertia for body in bodies) + mass @ apart
    return Body(float(mass.sum()), (float(centre[0]), float(centre[1])), float(inertia))


def frozen(y: np.ndarray, z: np.ndarray, mass: np.ndarray, volume: np.ndarray) -> Body:
    """Particles at y, z (n,) m of a `mass` (n,) kg/m each, squares of a `volume` (n,) m², as one rigid body.

    A square of the area V turns about its middle with m V/6.
    """
    total = mass.sum()
    if not total:
        return NOTHING
    centre = float(mass @ y / total), float(mass @ z / total)
    inertia = mass @ ((y - centre[0]) ** 2 + (z - centre[1]) ** 2 + volume / 6.0)
    return Body(float(total), centre, float(inertia))
