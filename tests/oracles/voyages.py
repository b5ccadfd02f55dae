"""Energies and velocities of a ship and her cargo in the earth frame, computed from a simulation."""

import numpy as np

from solvers.ship.hydrostatics import turned
from solvers.ship.motion import Ship
from tests.oracles.energy import mechanical_energy


def earth(snapshot, motion):
    """Velocities (W, n, 2) and spins (W, n) of grains in the earth's axes, `motion` (W, 9) that of the tanks."""
    phi, rate = motion[:, None, 2], motion[:, None, 5]
    y, z = np.moveaxis(snapshot["position"], -1, 0)
    u, v = np.moveaxis(snapshot["velocity"], -1, 0)
    u, v = u - rate * z, v + rate * y
    speed = np.stack([np.cos(phi) * u - np.sin(phi) * v, np.sin(phi) * u + np.cos(phi) * v], axis=-1)
    return speed + motion[:, None, 3:5], snapshot["spin"] + rate


def cargo_energy(run, snapshot, rows, motion):
    """Of the sheets (W,) J: kinetic with that of spin, potential, elastic."""
    speed, spin = earth(snapshot, motion)
    mass = run.grains.mass
    kinetic = 0.5 * (mass[..., None] * speed**2).sum((1, 2)) + 0.2 * (mass * run.scene.grains.radius**2 * spin**2).sum(
        1
    )
    return kinetic + rows["potential"] + rows["elastic"]


def hull_energy(ship: Ship, hold, tank):
    """Of a ship's hull (n,) J/m from the motion (n, 9) of her tank, whose origin is at `hold` in her own axes."""
    arm = turned(tuple(np.subtract(hold, ship.about)), tank[:, 2])
    swing = tank[:, 5:6] * np.stack([-arm[:, 1], arm[:, 0]], axis=1)
    states = np.concatenate([tank[:, :2] - arm, tank[:, 2:3], tank[:, 3:5] - swing, tank[:, 5:6]], axis=1)
    return np.array([mechanical_energy(ship, state) for state in states])
