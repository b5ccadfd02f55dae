"""A sphere that flies and spins freely in a tank that turns: over the earth its velocity and its spin stay."""

import numpy as np
import pytest

from solvers.motion import Roll
from solvers.tank.solids.solid import Prism
from tests.oracles.scenes import box, simulation

SIDE, RADIUS, DT, TIME = 1.0, 3e-3, 1e-4, 0.5
VELOCITY, SPIN = np.array([[0.1, -0.05, 0.2]]), np.array([[20.0, -30.0, 10.0]])  # y, z, x


def over_the_earth(vector, angle):
    """A vector (3,) of a tank that has turned about x by an angle (rad), in the earth's axes."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([c * vector[0] - s * vector[1], s * vector[0] + c * vector[1], vector[2]])


@pytest.mark.slow
def test_neither_velocity_nor_spin_change_over_the_earth():
    """Euler, centrifugal and Coriolis terms, and −φ̇ × s for the spin s relative to the tank, to second order in Δt."""
    roll = Roll(amplitude=0.4, frequency=0.7, centre=(0.0, 0.0))
    place = np.array([[0.05, 0.4, -0.1]])
    run = simulation(
        place[None], RADIUS, box(SIDE, SIDE), velocity=VELOCITY[None], spin=SPIN[None], gravity=0.0, step=DT,
        motions=[(roll,)], soft_start=0.0, solid=Prism(SIDE), tangential="mindlin",
    )  # fmt: skip
    seen = []
    for _ in range(6):
        rows, state = run.observe(), run.snapshot()
        angle, rate = rows["pose"][0, -1], rows["pose_rate"][0, -1]
        at, relative, spin = (state[name][0, 0] for name in ("position", "velocity", "spin"))
        moving = relative + rate * np.array([-at[1], at[0], 0.0])
        turning = spin + np.array([0.0, 0.0, rate])
        seen.append([over_the_earth(values, angle) for values in (at, moving, turning)])
        run.advance(round(TIME / DT / 5))
    run.arrays.release()
    where, velocity, spin = np.array(seen).swapaxes(0, 1)
    times = np.linspace(0.0, TIME, 6)[:, None]
    np.testing.assert_allclose(velocity, np.tile(velocity[0], (6, 1)), atol=1e-4)
    np.testing.assert_allclose(spin, np.tile(spin[0], (6, 1)), atol=1e-3 * np.abs(spin[0]).max())
    np.testing.assert_allclose(where, where[0] + velocity[0] * times, atol=1e-4)
    assert np.abs(spin[:, :2]).max() > 10.0
