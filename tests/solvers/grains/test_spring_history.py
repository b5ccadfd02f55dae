"""Mindlin's spring in undamped oblique impacts that stick: the slip that it gives back, and how its error falls."""

from functools import cache

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.oracles.scenes import box, material, simulation

RADIUS, SPEED, ALONG = 1.5e-3, 1.0, 0.4  # m, m/s down, m/s along the wall
STICKS = 1e4  # a friction coefficient that no force here reaches
YOUNG, POISSON, DENSITY = 3.2e9, 0.28, 1319.0
MASS = 4.0 / 3.0 * np.pi * RADIUS**3 * DENSITY
HERTZ = 4.0 / 3.0 * YOUNG / (2.0 * (1.0 - POISSON**2)) * np.sqrt(RADIUS)  # k of a wall of the same material
DEEPEST = (1.25 * MASS * SPEED**2 / HERTZ) ** 0.4
RATIO = 2.0 * (1.0 - POISSON) / (2.0 - POISSON)  # k_t over the normal contact's stiffness (Mindlin 1949)
PHASES = np.linspace(0.05, 0.95, 7)  # of a step, when contact begins
INTEGRATORS = ["verlet", *(pytest.param(name, marks=pytest.mark.slow) for name in ("symplectic-euler", "gear"))]


@cache
def kept() -> float:
    """Slip after the impact over that before, of the law by itself.

    m ξ̈ = −k ξ^(3/2), m v̇ = −S, (2/5) m R² ω̇ = −ℓ S with ℓ = R − ξ/2, Ṡ = k_t (v + ℓ ω), less S |ξ̇|/(2 ξ) on the way
    back; by DOP853 at 1e-11.
    """

    def motion(_, state):
        depth, rate, along, spin, held = state
        root, lever = np.sqrt(max(depth, 0.0)), RADIUS - 0.5 * depth
        lost = 0.5 * held * rate / max(depth, 1e-30) if rate < 0.0 else 0.0
        winding = RATIO * 1.5 * HERTZ * root * (along + lever * spin) + lost
        return [rate, -HERTZ * root * depth / MASS, -held / MASS, -lever * held / (0.4 * MASS * RADIUS**2), winding]

    def parted(_, state):
        return state[0] - 1e-9 * DEEPEST if state[1] < 0.0 else 1.0

    parted.terminal, time = True, DEEPEST / SPEED
    scale = np.array([DEEPEST, SPEED, SPEED, SPEED / RADIUS, MASS * SPEED / time])
    start = [1e-12 * DEEPEST, SPEED, ALONG, 0.0, 0.0]
    path = solve_ivp(motion, (0.0, 5.0 * time), start, "DOP853", events=parted, rtol=1e-11, atol=1e-12 * scale)
    return (path.y[2, -1] + RADIUS * path.y[3, -1]) / ALONG


@pytest.fixture(scope="module", params=INTEGRATORS)
def given_back(request):
    """Slips after over that before (steps, phases) at the derived step, half and a quarter of it."""
    grain = material(restitution=1.0, friction=STICKS)
    place = np.tile([[0.0, 0.1]], (len(PHASES), 1, 1))
    laws = {"normal": "hertz", "tangential": "mindlin", "integrator": request.param}
    run = simulation(place, RADIUS, box(0.2, 0.2), grain, gravity=0.0, start_speed=SPEED, **laws)
    derived, found = run.dt, []
    for part in (1, 2, 4):
        run.dt = derived / part
        place[:, 0, 1] = RADIUS + (PHASES + 0.5) * run.dt * SPEED
        run.place(place, np.tile([[ALONG, -SPEED]], (len(PHASES), 1, 1)))
        run.advance(int(6.0 * DEEPEST / SPEED / run.dt))
        state = run.snapshot()
        found.append((state["velocity"][:, 0, 0] + RADIUS * state["spin"][:, 0]) / ALONG)
    yield np.array(found)
    run.close()


@pytest.mark.slow
def test_an_undamped_spring_returns_its_slip_at_the_derived_step(given_back):
    """Within (ω_t Δt)²/4, 1 %, wherever in a step the contact begins."""
    assert given_back[0] == pytest.approx(kept(), abs=1e-2)


@pytest.mark.slow
def test_errors_of_history_fall_faster_than_first_order(given_back):
    """A quarter of the step, a seventh of the error at most: of second order but for the last step, where k_t ends.

    Without friction's cap that step errs as Δt^(3/2), a factor of 8, for k_t ~ √ξ; of first order it would be 4.
    """
    error = np.sqrt(np.mean((given_back - kept()) ** 2, axis=1))
    assert error[0] > 7.0 * error[2]
