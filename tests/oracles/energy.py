"""The energy balance of a floating hull: its energy, the waves' work, radiation and viscous losses (J/m, W/m)."""

from dataclasses import dataclass

import numpy as np

from solvers.ship.hydrostatics import potential_energy, turned
from solvers.ship.loads import Floating
from solvers.ship.motion import Ship, Voyage


def mechanical_energy(ship: Ship, state: np.ndarray) -> float:
    """Motion, added mass included, and weight, calm water and springs; the ship's load is `Floating`."""
    pose, velocity = state[:3], state[3:6]
    load: Floating = ship.load
    heave = pose[1] - turned(ship.about, pose[2])[1]
    height = float(potential_energy(load.section, ship.body.loading, load.water, heave, pose[2]))
    spring = 0.5 * ship.rig.spring @ (pose - ship.rig.rest) ** 2
    return float(0.5 * velocity @ ship.inertia(pose[2]) @ velocity + height + spring)


@dataclass(frozen=True, eq=False)
class EnergyBalance:
    """Since the start, at each time (n,) J/m: waves' work = gain in `mechanical` + `radiated` + `viscous`."""

    waves: np.ndarray
    mechanical: np.ndarray
    radiated: np.ndarray
    viscous: np.ndarray


def energy_balance(ship: Ship, voyage: Voyage) -> EnergyBalance:
    """Works along a voyage by Simpson's rule."""
    from scipy.integrate import cumulative_simpson  # slow to import

    powers = np.array([_powers(ship, s, t) for s, t in zip(voyage.state, voyage.time, strict=True)])
    waves, radiated, viscous = cumulative_simpson(powers.T, x=voyage.time, initial=0.0)
    energy = np.array([mechanical_energy(ship, state) for state in voyage.state])
    return EnergyBalance(waves, energy - energy[0], radiated, viscous)


def _powers(ship: Ship, state: np.ndarray, time: float) -> tuple[float, float, float]:
    """Of the waves (all that calm water would not do), of radiation and of viscosity (W/m)."""
    velocity = state[3:6]
    waves = ship.load.force(state[:3], time) - ship.load.still.force(state[:3], time)
    return waves @ velocity, ship.radiated(state) @ velocity, ship.viscous(velocity) @ velocity
