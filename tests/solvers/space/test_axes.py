"""Both axes are equivalent: a scene turned by 90 degrees, with its gravity and motion, gives the turned result."""

from math import pi

import numpy as np
import pytest

from solvers.grains.bed.filling import radii, start_positions
from solvers.motion import Roll
from tests.oracles.held import Held
from tests.oracles.scenes import box, simulation

COUNT = 60
QUARTER = np.array([[0.0, -1.0], [1.0, 0.0]])  # counter-clockwise
FLAT = box(0.06, 0.02)  # so that turned, its cells are as many along the other axis
ROLL = Roll(0.4, 6.0, 1.0, (0.02, -0.05))
TIME = 8e-3  # s; rounding grows as the grains collide


def told(integrator):
    """What becomes of grains in a flat tank that rolls, and of the same in a tank that is turned in its own frame."""
    random = np.random.default_rng(7)
    radius, velocity = radii(COUNT, 3e-3, 0.2, random), random.normal(0.0, 0.3, (COUNT, 2))
    place, spin = start_positions(radius, FLAT, random), random.normal(0.0, 100.0, COUNT)
    context = {"stiffness_scale": 1e-3, "tangential": "mindlin", "spin": spin, "integrator": integrator}
    context |= {"start_speed": float(np.abs(velocity).max())}
    found = []
    for turn, angle in ((np.eye(2), 0.0), (QUARTER, -0.5 * pi)):  # one by one, so that they share kernels
        run = simulation(
            [place @ turn.T],
            radius,
            FLAT @ turn.T,
            velocity=velocity @ turn.T,
            motions=[[Held(angle), ROLL]],
            **context,
        )
        context["step"] = run.dt
        run.advance(round(TIME / run.dt))
        found.append((run.snapshot(), run.observe(), pressing(run)))
        run.close()
    return found


def pressing(run) -> tuple[np.ndarray, np.ndarray]:
    """Whom the contacts that press are between, in order, and their places (m) and forces (N), (k, 2, 2)."""
    found = run.pressing()
    order = np.lexsort((found.place @ [1.0, 1.0], *found.grains.T))
    return found.grains[order], np.stack([found.place, found.force], axis=1)[order]


@pytest.mark.slow  # forces, lists and loads are compared with brute force along both axes elsewhere
@pytest.mark.parametrize("integrator", ["verlet", "symplectic-euler", "gear"])
def test_a_scene_turned_by_90_degrees_moves_as_before(integrator):
    (before, rows, (whom, where)), (after, turned_rows, (turned_whom, turned_where)) = told(integrator)
    for name, nearness in (("position", 1e-12), ("velocity", 1e-8)):
        np.testing.assert_allclose(after[name], before[name] @ QUARTER.T, rtol=0.0, atol=nearness, err_msg=name)
    np.testing.assert_allclose(after["spin"], before["spin"], rtol=0.0, atol=1e-5)
    for name in ("kinetic", "rotational", "elastic", "potential", "contacts", "overlap"):
        np.testing.assert_allclose(turned_rows[name], rows[name], rtol=1e-6, err_msg=name)
    for name in ("centre_of_mass", "wall_force"):
        vector, expected = (found[name][0, :2] for found in (turned_rows, rows))
        np.testing.assert_allclose(vector, QUARTER @ expected, rtol=1e-6, err_msg=name)
    np.testing.assert_allclose(turned_rows["wall_force"][0, 2], rows["wall_force"][0, 2], rtol=1e-6)
    assert rows["contacts"][0] > 10.0
    np.testing.assert_array_equal(turned_whom, whom)
    np.testing.assert_allclose(turned_where, where @ QUARTER.T, rtol=1e-4, atol=1e-7)
