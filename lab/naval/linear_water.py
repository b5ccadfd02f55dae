"""A ship of a preset by linear theory: her response in waves, with the water in her tanks by potential flow."""

from dataclasses import replace

import numpy as np

from lab.assembly.scene import vessels
from lab.assembly.ship import hull_table
from lab.preset.schema import Preset
from solvers.ship.linear import ROLL, impedance
from solvers.ship.potential.radiation import Hydrodynamics
from solvers.ship.potential.sloshing import SloshingLiquid

APART = 0.1  # of a peak's frequency: nearer to a higher one it does not count


def by(preset: Preset, hydrodynamics: str) -> Preset:
    """The preset with the coefficients of her section, of strips, or of her hull in space."""
    return replace(preset, ship=replace(preset.ship, hydrodynamics=hydrodynamics))


def table_in_calm(preset: Preset) -> Hydrodynamics:
    """The table of a preset's ship, for each metre of her length."""
    return hull_table(preset.ship, preset.sea, preset.run.gravity)


def linear_motion(preset: Preset, omega: np.ndarray, more: float = 0.0) -> np.ndarray:
    """Complex amplitudes (n, 3) of sway, heave (m) and roll (rad) per metre of wave amplitude.

    At frequencies (n,) rad/s, of the ship's axis. Water in rectangular tanks is a `SloshingLiquid`, without damping.
    `more` (N s): roll damping beside the ship's linear one, per metre of her.
    """
    vessel = vessels(preset)[0]
    ship, given = vessel.ship, preset.ship
    table = table_in_calm(preset).at(omega)
    whole = impedance(ship, ship.load.section, ship.load.water, given.heave, table)
    tanks = [preset.tank, *preset.tanks.values()]
    for pool in preset.pools if preset.water else ():
        along = tanks[pool.number].length
        share = along / given.length if along else 1.0
        low, high = pool.polygon.min(axis=0), pool.polygon.max(axis=0)
        place = np.add([0.5 * (low[0] + high[0]), pool.level], np.subtract(given.hold, given.about))
        density = share * preset.water.density
        liquid = SloshingLiquid(float(high[0] - low[0]), pool.depth, tuple(place), density, preset.run.gravity)
        loose = -(omega[:, None, None] ** 2) * liquid.added_mass(omega) + liquid.stiffness()
        whole = whole + loose - _solid(liquid, omega)
    whole[:, ROLL, ROLL] -= 1j * omega * more
    free = np.flatnonzero(ship.free)
    found = np.zeros((len(omega), 3), complex)
    found[:, free] = np.linalg.solve(whole[:, free[:, None], free], table.excitation[:, free, None])[..., 0]
    return found


def _solid(liquid: SloshingLiquid, omega: np.ndarray) -> np.ndarray:
    """What the same liquid adds to the impedance (n, 3, 3) if it is frozen."""
    mass, (y, z) = liquid.mass, np.subtract(liquid.centre, (0.0, 0.5 * liquid.depth))
    turning = mass * ((liquid.width**2 + liquid.depth**2) / 12.0 + y * y + z * z)
    inertia = np.array([[mass, 0.0, -mass * z], [0.0, mass, mass * y], [-mass * z, mass * y, turning]])
    spring = np.zeros((3, 3))
    spring[2, 2] = -mass * liquid.gravity * z
    return -(omega[:, None, None] ** 2) * inertia + spring


def peaks(omega: np.ndarray, size: np.ndarray, least: float = 0.15) -> list[tuple[float, float]]:
    """Frequencies (rad/s) and heights of the peaks of a response that are at least `least` of the highest, in order."""
    inner = np.flatnonzero((size[1:-1] > size[:-2]) & (size[1:-1] >= size[2:])) + 1
    found: list[tuple[float, float]] = []
    for k in sorted(inner, key=lambda k: -size[k]):
        if size[k] >= least * size.max() and all(abs(omega[k] - one) > APART * one for one, _ in found):
            a, b, c = size[k - 1 : k + 2]
            shift = 0.5 * (a - c) / (a - 2.0 * b + c)
            found.append((float(omega[k] + shift * (omega[1] - omega[0])), float(b)))
    return sorted(found)
