"""Bodies that float and have it hard: light ones dropped, held under and rolled over, and two that touch."""

from math import pi

import numpy as np
import pytest

from solvers.motion.contact_pairs import OF_TANK
from solvers.motion.contact_search import OTHER, OVERLAP, OWNER, PAIR
from solvers.simulation import Simulation
from tests.oracles.floating import DENSITY, account, afloat, momentum, pair, solid, weight

pytestmark = pytest.mark.slow

LIGHT = 0.02
SPEEDS = -0.5, -2.0  # m/s


@pytest.mark.parametrize(
    ("scene", "until", "heel"),
    [
        pytest.param(afloat(LIGHT, size=(0.4, 0.4), place=(0.0, 1.1), heel=0.3), 1.5, None, id="dropped"),
        pytest.param(afloat(LIGHT, size=(0.4, 0.4), place=(0.0, 0.35), heel=0.3, release=0.2), 1.5, None, id="let go"),
        pytest.param(solid(afloat(0.5, place=(0.0, 0.8), heel=pi - 0.3), 0.1), 6.0, 0.3 - pi, id="rolled over"),
    ],
)
def test_nothing_blows_up_and_the_energy_is_accounted_for(scene, until, heel):
    """0.1 % of the energy exchanged; and what stands on its head, with its centre of mass low, rights itself."""
    run = Simulation(solid(scene) if heel is None else scene, threads=2)
    try:
        missing, exchanged = account(run, until)
        found = run.observe()["body_place"][0, 0]
    finally:
        run.close()
    assert exchanged > 10.0  # J, else nothing was tried
    assert missing < 1e-3 * exchanged
    if heel is not None:
        assert (found[2] - heel + pi) % (2.0 * pi) - pi == pytest.approx(0.0, abs=np.deg2rad(5.0))


def touching(contacts) -> set[frozenset[int]]:
    """The pairs of parts that touch, or of a part and OF_TANK."""
    search = contacts.search
    pairs = search.corners.to_numpy()[search.found.to_numpy()[0, :, OVERLAP] > 0.0, PAIR].astype(int)
    return {frozenset(pair) for pair in search.places.to_numpy()[pairs][:, [OWNER, OTHER]].tolist()}


def test_two_bodies_touch_each_other_and_a_wall_and_float_at_their_draughts():
    """Momentum of water, bodies and tank to 1e-12 of Σ|F|Δt; then both draughts to half a spacing, in the mean of 2 s.

    Both go against the wall, the second faster.
    """
    run = Simulation(pair(), threads=2)
    bodies, touched, found = run.parts.bodies, set(), []
    try:
        volume = run.water.particles.read(run.water.particles.mass)[0][0].sum() / DENSITY
        run.advance(1)
        bodies.velocity[0].from_numpy(np.array([SPEEDS]))
        run.advance(1)
        run.observe()
        first, began, given, pushed = momentum(run), run.time, np.zeros(2), 0.0
        while run.time < 1.5:
            run.advance(2)
            run.observe()
            loads = run.loads()[0, :, :2]
            given, pushed = given + 2 * run.dt * loads[0], pushed + 2 * run.dt * np.abs(loads).sum()
            touched |= touching(bodies.contacts)
        lost = momentum(run) - first + given + (0.0, weight(run) * (run.time - began))
        run.advance(round(6.0 / run.dt))
        for _ in range(40):
            run.advance(round(0.05 / run.dt))
            found.append(run.observe()["body_place"][0, :, 1])
    finally:
        run.close()
    assert np.abs(lost).max() < 1e-12 * pushed
    assert {frozenset((OF_TANK, 0)), frozenset((0, 1))} <= touched
    level = (volume + 0.15 * (0.5 + 0.7)) / 2.0
    assert np.mean(found, axis=0) == pytest.approx([level, level - 0.2 * 0.3], abs=0.025)
