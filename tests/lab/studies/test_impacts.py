"""Cundall and Strack's and Mindlin's springs at a wall, in the solver and integrated on their own."""

import numpy as np
import pytest

from lab.studies.verify.impacts.law import Bodies, Impact, Normal, Shear
from lab.studies.verify.references import damping_of, dissipative_time, hertz_stiffness, sphere_mass
from lab.studies.verify.scenes import ACETATE, WEIGHTLESS, Setup, again, grain, simulated
from solvers.space.impact import damping_ratio_for

RADIUS, SPEED, FRICTION = 1.5e-3, 1.0, 0.25
SLIPS = FRICTION * np.array([0.5, 1.5, 2.5, 3.5, 5.0, 8.0])  # m/s along the wall
PHASES = (np.arange(16) + 0.5) / 16.0  # of a step, when contact begins
MASS = sphere_mass(RADIUS, ACETATE["density"])
HERTZ = hertz_stiffness(ACETATE["young"], ACETATE["poisson"], RADIUS)
SPRING = 0.8 * HERTZ * (1.25 * MASS * SPEED**2 / HERTZ) ** 0.2  # as deep as Hertz's contact at this speed
RATIO = 2.0 * (1.0 - ACETATE["poisson"]) / (2.0 - ACETATE["poisson"])  # k_t over k (Mindlin 1949)


def by_itself(normal: str, tangential: str, e: float) -> np.ndarray:
    """Slip after each impact, by the laws as they are written."""
    time = dissipative_time(damping_of(e), MASS, HERTZ, SPEED)
    pressing = Normal(HERTZ, 1.5 * time * HERTZ)
    if normal == "linear":
        ratio = damping_ratio_for(e) if e < 1.0 else 0.0
        pressing = Normal(SPRING, 2.0 * ratio * np.sqrt(SPRING * MASS), 1.0, 0.0)
    spring = (1.5 * RATIO * HERTZ, 0.5) if tangential == "mindlin" else (RATIO * SPRING, 0.0)
    impact = Impact(Bodies(RADIUS, MASS), pressing, Shear(FRICTION, *spring, time))
    found = np.array([impact.meet(along, SPEED) for along in SLIPS])
    return found[:, 0] + RADIUS * found[:, 2]


def in_the_solver(normal: str, tangential: str, e: float, integrator: str, parts: tuple[int, ...]) -> np.ndarray:
    """Slips (parts, PHASES, n) after the impacts at the derived step and parts of it."""
    rows = [grain(0.02 * k, RADIUS, RADIUS, along, -SPEED) for k, along in enumerate(SLIPS)]
    material = ACETATE | {"restitution": e, "restitution_speed": SPEED, "friction": FRICTION}
    laws = {"normal": normal, "tangential": tangential}
    run = {"gravity": WEIGHTLESS, "integrator": integrator}
    found = []
    with simulated(Setup(np.array(rows), material, {"width": 0.3, "height": 0.1}, contact=laws, run=run)) as sim:
        start, derived = sim.snapshot(), sim.dt
        for part in parts:
            for phase in PHASES:
                place = start["position"].copy()
                place[..., 1] = RADIUS + (phase + 0.5) * SPEED * derived / part
                again(sim, place, derived / part, start["velocity"], start["spin"])
                sim.advance(int(3e-4 * part / derived))
                state = sim.snapshot()
                found.append(state["velocity"][0, :, 0] + RADIUS * state["spin"][0])
    return np.array(found).reshape(len(parts), len(PHASES), -1)


@pytest.mark.parametrize(
    ("normal", "tangential", "integrator"),
    [
        pytest.param("linear", "cundall-strack", "verlet", marks=pytest.mark.slow),
        pytest.param("hertz-viscoelastic", "cundall-strack", "verlet", marks=pytest.mark.slow),
        pytest.param("hertz-viscoelastic", "mindlin", "verlet", marks=pytest.mark.slow),
        pytest.param("linear", "cundall-strack", "gear", marks=pytest.mark.slow),
        pytest.param("hertz-viscoelastic", "mindlin", "gear", marks=pytest.mark.slow),
    ],
)
# Quick ones, without loss, are in `tests/solvers/grains/test_spring_history.py`, too.
@pytest.mark.parametrize("e", [0.6, *(pytest.param(e, marks=pytest.mark.slow) for e in (1.0, 0.1))])
def test_slip_after_an_impact_is_that_of_the_law(normal, tangential, integrator, e):
    """Within 1 % of the slip before, root mean square over the moments in a step at which contact begins, sticking and
    sliding; by 1.5 % at the worst moment; and far less at a quarter.

    A linear dashpot's force jumps where grains touch, and friction's cap with it: that step errs as Δt.
    """
    expected = by_itself(normal, tangential, e)
    error = np.abs(in_the_solver(normal, tangential, e, integrator, (1, 4)) - expected) / SLIPS
    assert np.sqrt((error[0] ** 2).mean(axis=0)).max() < 1e-2
    assert error[0].max() < 1.5e-2
    falls = 2.0 if normal == "linear" and e < 1.0 else 6.0
    assert error[1].max() < max(1e-4, error[0].max() / falls)
