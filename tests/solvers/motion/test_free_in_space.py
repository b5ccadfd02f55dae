"""A body that turns freely in space, beside Euler's equations integrated with high precision."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from solvers.simulation import Simulation
from solvers.space.turning import drawn_by
from solvers.tank.shapes import PrismShape
from tests.oracles.floating_in_space import afloat_in_space, body_of

INERTIA = np.diag([0.03, 0.02, 0.01])  # kg m², about y, z, x
RATE = np.array([0.3, 40.0, 0.2])  # rad/s: nearly about the middle axis, which is unstable
STEPS = 640, 1280


def flown(steps: int) -> tuple[np.ndarray, np.ndarray]:
    """The turn (3, 3) of a body that has fallen freely for 0.4 s, and its energy of turning (steps,) J."""
    shape = PrismShape(((-0.1, 2.9), (0.1, 2.9), (0.1, 3.1), (-0.1, 3.1)), 0.2)
    body = body_of(shape, 6.0, inertia=tuple(map(tuple, INERTIA.tolist())))
    scene = afloat_in_space((body,), (0.8, 3.5, 0.8), 0.4, 0.1, step=0.4 / steps, sound_speed=40.0)
    run = Simulation(scene, threads=1)
    bodies = run.parts.bodies
    run.advance(1)  # lets it go, half a kick behind
    for k in range(3):
        bodies.velocity[3 + k].fill(float((INERTIA @ RATE)[k]))
        bodies.place[4 + k].fill(0.0)
    bodies.place[3].fill(1.0)
    energy = []
    for _ in range(steps // 20):
        run.advance(20)
        turn = drawn_by(np.stack([field.to_numpy() for field in bodies.place[3:]], axis=-1))[0, 0]
        spin = np.array([field.to_numpy()[0, 0] for field in bodies.velocity[3:]])
        energy.append(0.5 * spin @ turn @ np.linalg.inv(INERTIA) @ turn.T @ spin)
    assert np.abs(spin - INERTIA @ RATE).max() < 1e-12 * np.linalg.norm(spin)
    run.close()
    return turn, np.array(energy)


def exact() -> np.ndarray:
    """The turn (3, 3) after 0.4 s: I ω' = I ω × ω in the body's axes, R' = R ω×."""

    def change(_, state):
        rate, turn = state[:3], state[3:].reshape(3, 3)
        gain = np.cross(INERTIA @ rate, rate) / np.diag(INERTIA)
        across = np.array([[0.0, -rate[2], rate[1]], [rate[2], 0.0, -rate[0]], [-rate[1], rate[0], 0.0]])
        return np.concatenate([gain, (turn @ across).ravel()])

    start = np.concatenate([RATE, np.eye(3).ravel()])
    return solve_ivp(change, (0.0, 0.4), start, rtol=1e-12, atol=1e-12).y[3:, -1].reshape(3, 3)


@pytest.mark.slow
def test_a_torque_free_body_tumbles_as_by_euler():
    """Its attitude converges with second order, and keeps its energy to 1e-5: ω Δt is 0.0125 with the finer steps."""
    (coarse, _), (fine, energy), right = flown(STEPS[0]), flown(STEPS[1]), exact()
    far, near = np.abs(coarse - right).max(), np.abs(fine - right).max()
    assert 3.5 < far / near < 4.5
    assert near < 0.01
    assert np.ptp(energy) < 1e-5 * energy[0]
