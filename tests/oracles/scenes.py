"""Small scenes for the physics tests."""

import numpy as np

from solvers.grains.materials import Material
from solvers.machine.quantity import PLANE
from solvers.simulation import Simulation
from tests.oracles.given import scene_of


def material(**changes) -> Material:
    """Cellulose acetate of Spandonidis (2016), table 5.2, with a restitution of our own."""
    values = {"density": 1319.0, "young": 3.2e9, "poisson": 0.28, "friction": 0.25, "restitution": 0.6}
    if "dissipative_time" in changes:
        values["restitution"] = None
    return Material(**values | changes)


def box(width: float, height: float) -> np.ndarray:
    """Outline of a rectangular tank (m), its floor centred on the origin."""
    return np.array([[-width / 2, 0.0], [width / 2, 0.0], [width / 2, height], [-width / 2, height]])


def simulation(position, radius, outline, grain=None, wall=None, velocity=None, spin=None, threads=1, **scene):
    """A simulation of grains at `position` (W, n, axes) with `radius` (n,) or (W, n), moving as given."""
    position = np.asarray(position, dtype=float)
    worlds, count = position.shape[:2]
    grain = grain or material()
    velocity = np.zeros_like(position) if velocity is None else np.broadcast_to(velocity, position.shape)
    turns = (worlds, count) if position.shape[2] == PLANE else (worlds, count, 3)
    spin = np.zeros(turns) if spin is None else np.broadcast_to(spin, turns)
    scene.setdefault("start_speed", float(np.abs(velocity).max()))
    radius = np.broadcast_to(radius, (worlds, count))
    made = Simulation(scene_of(radius, outline, grain, wall or grain, **scene), position, threads)
    made.launch(np.array(velocity, dtype=float), np.array(spin, dtype=float))
    return made
