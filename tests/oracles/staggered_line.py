"""A ship that rolls with water in a tank, both linear, in steps after Newmark and Bossak, and exactly.

Per moment of inertia of the ship: ẍ + 2 ζ ω₀ ẋ + ω₀² x = F with the tank's load F = −m_r ẍ + m_s ω₁² q of water that is
carried along (m_r) and that swings (m_s), q̈ + ω₁² q = −ẍ.
"""

import numpy as np
from scipy.linalg import expm

from solvers.motion.staggered_error import BETA, BOSSAK, EVEN, GAMMA, SMOOTHING, lagrange

OWN, DAMPING, CARRIED, SWINGING, TANK = 6.0, 0.05, 0.02, 0.03, 7.2  # ω₀, ζ, m_r, m_s, ω₁


def exact(step: float, lasts: float) -> np.ndarray:
    """Roll let go from 1 at times 0, step, … s."""
    mass = np.linalg.inv([[1.0 + CARRIED, 0.0], [1.0, 1.0]])
    spring = np.array([[OWN**2, -SWINGING * TANK**2], [0.0, TANK**2]])
    rate = np.block([[np.zeros((2, 2)), np.eye(2)], [-mass @ spring, -mass @ np.diag([2.0 * DAMPING * OWN, 0.0])]])
    whole, state, found = expm(step * rate), np.array([1.0, 0.0, 0.0, 0.0]), [1.0]
    for _ in range(round(lasts / step)):
        state = whole @ state
        found.append(state[0])
    return np.array(found)


def stepped(step: float, lasts: float, points: int | None, beta: float = BETA) -> np.ndarray:
    """The same in steps, with the load through the last `points` of it, or as it is at the step's end (None).

    Contents follow the smoothed pose, which is returned; with β of EVEN it is the pose itself.
    """
    b, gamma, off = BOSSAK, GAMMA, EVEN - beta
    way = np.zeros((4, 4))
    way[0, 1], way[1, 0], way[1, 2], way[2, 3] = 1.0, -(TANK**2), -1.0, 1.0
    swing = expm(step * way)
    x, v, a, now, tank = 1.0, 0.0, -(OWN**2) / (1.0 + CARRIED), -(OWN**2) / (1.0 + CARRIED), np.zeros(2)
    y, w, smooth = x, v, a
    own = 0.0 if points else CARRIED  # carried water on the ship's own side
    past, found = None, [y]
    for _ in range(round(lasts / step)):
        load = SWINGING * TANK**2 * tank[0] - CARRIED * now
        past = np.full(points or 1, load) if past is None else np.append(load, past[:-1])
        begun = x + step * v + step**2 * (0.5 - beta) * a, v + step * (1.0 - gamma) * a
        whole = (1.0 - b) * (1.0 + own) + 2.0 * DAMPING * OWN * step * gamma + OWN**2 * step**2 * beta
        force = lagrange(points) @ past if points else load + CARRIED * now
        for _ in range(1 if points else 60):
            right = force - OWN**2 * begun[0] - 2.0 * DAMPING * OWN * begun[1] - b * (1.0 + own) * a
            after = right / whole
            smoother = smooth + SMOOTHING * (after - smooth)
            end = begun[0] + step**2 * (beta * after + off * (after - smoother))
            fast = begun[1] + step * (gamma * after - off * (smoother - smooth))
            ends = np.array([6.0, -6.0, -4.0, -2.0]), np.array([-6.0, 6.0, 2.0, 4.0])  # of a cubic between poses
            first, last = (one @ [end, y, step * w, step * fast] / step**2 for one in ends)
            moved = (swing @ [*tank, first, (last - first) / step])[:2]
            force = force if points else SWINGING * TANK**2 * moved[0]
        now = (1.0 - b) * after + b * a
        x, v, a, tank = begun[0] + step**2 * beta * after, begun[1] + step * gamma * after, after, moved
        y, w, smooth = end, fast, smoother
        found.append(y)
    return np.array(found)


def steady(step: float, omega: float, points: int | None, beta: float = BETA) -> float:
    """Amplitude of roll in steps, driven by the force e^(iωt) at their ends; the load as in `stepped`.

    Newmark's averages and Bossak's equation with a_n = A zⁿ, z = e^(iωH); the water follows the motion exactly.
    """
    z, b, gamma = np.exp(1j * omega * step), BOSSAK, GAMMA
    speed = step * ((1.0 - gamma) + gamma * z) / (z - 1.0)  # over the acceleration
    way = (step * speed + step**2 * ((0.5 - beta) + beta * z)) / (z - 1.0)
    rough = 1.0 - SMOOTHING / (1.0 - (1.0 - SMOOTHING) / z)
    smooth = way + (EVEN - beta) * step**2 * rough
    now = ((1.0 - b) * z + b) / z
    load = SWINGING * TANK**2 * omega**2 / (TANK**2 - omega**2) * smooth - CARRIED * now
    ahead = lagrange(points) @ z ** -np.arange(float(points)) if points else z
    own = z * (now + 2.0 * DAMPING * OWN * speed + OWN**2 * way)
    return float(abs(z * smooth / (own - ahead * load)))
