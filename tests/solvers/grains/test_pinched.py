"""A small disc between a large one and the floor, whose friction may take energy and never makes any."""

import numpy as np
import pytest

from solvers.grains.laws import TANGENTIAL
from solvers.grains.materials import hertz_stiffness
from tests.oracles.scenes import box, material, simulation

SMALL, SPEED, FRICTION = 0.5e-3, 0.7, 0.3  # m, m/s along y and down, 1
STEEL = {"density": 7850.0, "young": 2.1e11, "poisson": 0.3, "friction": FRICTION}
# Radius of the large disc (mm), the angle of its contact from the vertical, twice the wedge's (deg), and restitution.
# A wedge of up to atan μ, 16.7°, holds the small disc: both contacts stick, and bear tan(angle/2) of their pressure.
PINCHES = np.array([(4.0, 20.2, 1.0), (4.0, 20.2, 0.9), (2.0, 15.0, 1.0), (2.0, 25.0, 0.9), (6.0, 20.0, 1.0)])
GAP, LASTS = 0.1e-3, 4e-4  # m, s: until after the large disc has been thrown back
FINE = 1e-8  # s, a step that resolves γ_s: γ_s Δt < 0.2 (2/7) m
RESOLVED = ("haff-werner", "viscous")
LAWS = [
    pytest.param(law, marks=() if law == "haff-werner" else pytest.mark.slow) for law in TANGENTIAL if law != "none"
]


@pytest.fixture(scope="module", params=LAWS)
def pinched(request):
    """A simulation of all PINCHES, a world each, with where and how fast they start."""
    large, angle = 1e-3 * PINCHES[:, 0], np.radians(PINCHES[:, 1])
    away = (SMALL + large + GAP)[:, None] * np.column_stack([-np.sin(angle), np.cos(angle)])
    places = np.stack([np.tile([0.0, SMALL], (len(PINCHES), 1)), away + np.array([0.0, SMALL])], axis=1)
    velocity = np.zeros_like(places)
    velocity[:, 1] = SPEED, -SPEED
    grain = [material(**STEEL, restitution=e) for e in PINCHES[:, 2]]
    radius = np.column_stack([np.full(len(PINCHES), SMALL), large])
    laws = {"tangential": request.param, "stiffness_scale": 0.2, "gravity": 0.0}
    run = simulation(places, radius, box(0.06, 0.04), grain, velocity=velocity, **laws)
    yield run, places, velocity
    run.close()


def played(run, places, velocity, step: float) -> tuple[np.ndarray, np.ndarray]:
    """Energies (looks, W) J, kinetic and elastic, along the pinch with a step (s); and the largest overlaps (W,) m."""
    usual, run.dt = run.dt, step
    run.place(places, velocity, np.zeros(places.shape[:2]))
    rows = [run.observe()]
    for _ in range(200):
        run.advance(round(LASTS / 200 / step))
        rows.append(run.observe())
    run.dt = usual
    energy = np.array([row["kinetic"] + row["rotational"] + row["elastic"] for row in rows])
    return energy, SMALL * np.max([row["overlap"] for row in rows], axis=0)


def held(run, overlap: np.ndarray, share: np.ndarray | float) -> np.ndarray:
    """Energy (W,) J that the split dampers of both contacts may hold at these overlaps (m): (share F_n Δt)²/(0.4 m_t).

    The small disc's contact with the floor is the stiffer, and that with the large disc has the smaller m_t.
    """
    force = hertz_stiffness(run.scene.grains.interfaces[1].young_modulus, SMALL) * overlap**1.5
    mass = 2.0 / 7.0 / (1.0 / run.grains.mass).sum(axis=1)
    return 2.0 * (share * force * run.dt) ** 2 / (0.4 * mass)


@pytest.mark.slow
def test_the_energy_of_a_pinch_never_rises(pinched):
    """But by what the dampers hold, and by the work of one step, by which springs with history are told late."""
    run = pinched[0]
    energy, overlap = played(*pinched, run.dt)
    assert overlap.min() > 0.01 * SMALL, "the small disc is to be pinched"
    force = hertz_stiffness(run.scene.grains.interfaces[1].young_modulus, SMALL) * overlap**1.5
    late = FRICTION * force * np.sqrt(2.0) * SPEED * run.dt
    rises = (energy - np.minimum.accumulate(energy)).max(axis=0)
    assert np.all(rises <= held(run, overlap, np.tan(np.radians(PINCHES[:, 1] / 2))) + late), rises / energy[0]


@pytest.mark.slow
def test_a_pinch_loses_what_its_law_takes(pinched):
    """What the dampers held is lost beyond it, and no more: at most the Coulomb cap's."""
    run = pinched[0]
    if run.scene.grains.tangential not in RESOLVED:
        return
    (coarse, overlap), (fine, _) = played(*pinched, run.dt), played(*pinched, FINE)
    lost, right = (energy[0] - energy[-1] for energy in (coarse, fine))
    assert np.all(np.abs(lost - right) <= held(run, overlap, FRICTION)), (lost / coarse[0], right / coarse[0])
