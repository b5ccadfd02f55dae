"""Integrators against a contact followed in high precision: order, energy, their start, and collisions."""

from functools import cache

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from solvers.simulation import Simulation
from tests.oracles.given import scene_of
from tests.oracles.scenes import box, material
from tests.solvers.grains.test_collisions import rebound

G, R = 9.81, 3e-3
SOFT = material(young=1e6, friction=0.0, dissipative_time=0.0)
LOSSY = material(young=1e6, friction=0.0, restitution=0.6)
# Worlds: a grain let go of on a floor that it never leaves, one set going there, a collision of two, a free flight.
LET_GO, LAUNCHED, COLLISION, FLIGHT = range(4)
DEEPER, KICK = (1.4, 1.15), 0.3  # times the overlap that carries the weight, and the speed that goes with it
SHARES = (20, 40, 80, 160)  # steps a period
# Of a grain let go of at rest and of one launched on the floor. Gear's derivatives above the second start at zero:
# right for a grain at rest, but the force on a launched one changes at once, which costs it all but two orders.
ORDERS = {"symplectic-euler": (1, 1), "verlet": (2, 2), "gear": (5.5, 2)}
NEAREST = {"symplectic-euler": 3e-2, "verlet": 1e-3, "gear": 1e-4}  # overlaps, at the finest step

DRIFTS = {"symplectic-euler": 2e-3, "verlet": 1e-3, "gear": 1e-2}  # of the energy of the swing


@pytest.fixture(
    scope="module",
    params=[pytest.param(name, marks=pytest.mark.slow if name != "verlet" else ()) for name in ORDERS],
)
def bench(request):
    """Four worlds of two grains under one integrator."""
    materials = [SOFT, SOFT, LOSSY, SOFT]
    place = np.tile([[0.0, R], [0.05, 0.06]], (4, 1, 1))
    scene = scene_of(
        np.full((4, 2), R),
        box(0.2, 0.1),
        materials,
        materials,
        integrator=request.param,
        start_speed=1.0,
    )
    run = Simulation(scene, place, 1, arch="cpu")
    run.usual_step = run.dt
    yield run
    run.close()


def carrying(run: Simulation) -> tuple[float, float, float]:
    """k/m (1/(s² √m)) of grain and floor, the overlap (m) that carries the weight, the period (s) of small swings."""
    k = 4.0 / 3.0 * run.scene.grains.interfaces_of[LET_GO][1].young_modulus * np.sqrt(R) / run.grains.mass[0, 0]
    overlap = (G / k) ** (2.0 / 3.0)
    return k, overlap, 2.0 * np.pi * np.sqrt(overlap / (1.5 * G))


@cache
def reference(k: float, overlap: float, speed: float, time: float) -> tuple[float, float]:
    """Overlap (m) and its rate (m/s) of ξ̈ = g − k ξ^(3/2), by DOP853 at 1e-13."""
    scale = overlap

    def motion(_, s):
        return [s[1], (G - k * (s[0] * scale) ** 1.5) / scale]

    start = [1.0, speed / scale]
    path = solve_ivp(motion, (0.0, time), start, "DOP853", rtol=1e-13, atol=1e-14)
    return path.y[0, -1] * scale, path.y[1, -1] * scale


def begin(run: Simulation, dt: float, approach: float = -0.1) -> float:
    """Put the worlds at their start, one grain at another with `approach` (m/s); returns the overlap of its weight."""
    run.dt = dt
    _, overlap, _ = carrying(run)
    place = np.tile([[0.0, 0.0], [0.05, 0.06]], (4, 1, 1))
    place[[LET_GO, LAUNCHED], 0, 1] = R - np.array(DEEPER) * overlap
    place[COLLISION, 0] = [0.05 - 2.0 * R - 1e-4, 0.06]
    place[FLIGHT, 0, 1] = 0.05
    velocity = np.zeros(place.shape)
    velocity[LAUNCHED, 0, 1] = -KICK * np.sqrt(G * overlap)
    velocity[COLLISION, 0, 0] = approach
    velocity[FLIGHT] = [[0.3, 0.2], [0.0, 0.0]]
    run.start_clock()
    run.place(place, velocity)
    return overlap


def errors(run: Simulation, share: int) -> np.ndarray:
    """Of the two swinging grains, errors of place (overlaps) after 1.3 periods."""
    k, overlap, period = carrying(run)
    begin(run, period / share)
    run.advance(13 * share // 10)
    z = run.snapshot()["position"][[LET_GO, LAUNCHED], 0, 1]
    speeds = 0.0, KICK * np.sqrt(G * overlap)
    expected = [reference(k, deep * overlap, speed, run.time)[0] for deep, speed in zip(DEEPER, speeds, strict=True)]
    return np.abs(R - z - expected) / overlap


def test_order_on_a_smooth_contact(bench):
    """Halving the step divides the error by two to the order."""
    found = np.array([errors(bench, share) for share in SHARES])
    orders = np.log2(found[:-1] / found[1:])
    assert orders[-1] == pytest.approx(ORDERS[bench.scene.grains.integrator], abs=0.2, rel=0.1)
    assert found[-1].max() < NEAREST[bench.scene.grains.integrator]


def test_energy_of_a_lasting_contact(bench):
    """Over 400 periods Verlet and symplectic Euler swing on, and Gear's energy drifts little."""
    k, overlap, period = carrying(bench)
    begin(bench, period / 40)
    energies = []
    for _ in range(10):
        energies.append(0.0)
        for _ in range(40):
            bench.advance(1)
            state = bench.snapshot()
            z, v = state["position"][LET_GO, 0, 1], state["velocity"][LET_GO, 0, 1]
            energies[-1] += (0.5 * v**2 + G * z + 0.4 * k * (R - z) ** 2.5) / 40
        bench.advance(40 * 39)
    rest = G * (R - overlap) + 0.4 * k * overlap**2.5
    drift = (np.array(energies) - energies[0]) / (energies[0] - rest)
    assert np.abs(drift).max() < DRIFTS[bench.scene.grains.integrator]


def test_collision_and_flight(bench):
    """The restitution at the derived step, and a parabola: exact for Verlet and Gear, a half step early for Euler's.

    Symplectic Euler's restitution is of first order where energy is lost: it has to be as near with half the step.
    """
    first_order = bench.scene.grains.integrator == "symplectic-euler"
    begin(bench, bench.usual_step * (0.5 if first_order else 1.0), approach=1.0)
    bench.advance(round(0.03 / bench.dt))
    state, time = bench.snapshot(), bench.time
    pair, mass = bench.scene.grains.interfaces_of[COLLISION][0], 0.5 * bench.grains.mass[0, 0]
    k = 4.0 / 3.0 * pair.young_modulus * np.sqrt(0.5 * R)
    e = rebound(0.5, 1.5 * pair.dissipative_time * (k / mass) ** 0.4)[0]
    away = np.diff(state["velocity"][COLLISION, :, 0])[0]
    assert away == pytest.approx(e, rel=2e-3)
    fall = np.array([0.3, 0.2]) * time + [0.0, -0.5 * G * time**2]
    early = {"symplectic-euler": 0.5 * G * time * bench.dt}.get(bench.scene.grains.integrator, 0.0)
    assert state["position"][FLIGHT, 0] == pytest.approx(np.array([0.0, 0.05 - early]) + fall, abs=1e-12)
    assert state["velocity"][FLIGHT, 0] == pytest.approx([0.3, 0.2 - G * time], abs=1e-11)


def test_a_launch_in_mid_flight_starts_anew(bench):
    """The first step after a launch knows nothing of what went before: the same flight from the same place."""
    begin(bench, bench.usual_step, approach=1.0)
    bench.advance(500)
    here, dt = bench.snapshot()["position"][FLIGHT, 0], bench.dt
    velocity = np.zeros((4, 2, 2))
    velocity[FLIGHT, 0] = [-0.4, 0.5]
    bench.launch(velocity)
    bench.advance(500)
    time = 500 * dt
    early = 0.5 * G * time * dt if bench.scene.grains.integrator == "symplectic-euler" else 0.0
    expected = here + np.array([-0.4, 0.5]) * time + [0.0, -0.5 * G * time**2 - early]
    assert bench.snapshot()["position"][FLIGHT, 0] == pytest.approx(expected, abs=1e-12)
