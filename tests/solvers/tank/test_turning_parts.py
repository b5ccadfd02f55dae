"""Parts that turn: grains in a closed part that rolls do what they do in a tank that rolls so, seen from the earth."""

import numpy as np
import pytest

from solvers.grains.shapes.contour import Contour
from solvers.grains.shapes.given import Shapes
from solvers.motion.harmonic import Roll, Sway
from solvers.simulation import Simulation
from solvers.tank.parts import Body
from tests.oracles.given import scene_of
from tests.oracles.scenes import box, material

RADIUS, CENTRE = 2e-3, (0.004, 0.013)
INNER = np.array([[-0.012, 0.006], [0.012, 0.006], [0.012, 0.028], [-0.012, 0.028]])
STARTS = np.array([[[-0.008, 0.0082], [-0.001, 0.0081], [0.006, 0.0084], [-0.004, 0.0150], [0.003, 0.0210]]])
TURN, SHAKE = Roll(0.35, 4.0, centre=CENTRE), Sway(0.003, 9.0)
STEP, TIME = 4e-6, 0.08


def states(moves: bool, **how) -> tuple[np.ndarray, np.ndarray]:
    """Places (n, 2) m and velocities (n, 2) m/s over the earth at the end: in a part that `moves`, or in a tank."""
    soft, motions = material(young=2e6, friction=0.4), (TURN, SHAKE)
    rate = 2.0 * np.pi * TURN.frequency * TURN.amplitude
    given = {"tangential": "mindlin", "start_speed": 1.0, "step": STEP, **how}
    radius = np.full(STARTS.shape[:2], RADIUS)
    if moves:
        part = Body(tuple(map(tuple, INNER)), closed=True, motions=motions)
        scene = scene_of(radius, box(0.08, 0.06), soft, soft, parts=(part,), **given)
    else:  # at rest over the earth, seen from a tank that begins to move at once
        arm = STARTS - CENTRE
        drift = rate * np.stack([arm[..., 1], -arm[..., 0]], axis=-1)
        drift[..., 0] -= 2.0 * np.pi * SHAKE.frequency * SHAKE.amplitude
        given |= {"velocity": drift, "spin": np.full(radius.shape, -rate)}
        scene = scene_of(radius, INNER, soft, soft, motions=[motions], **given)
    run = Simulation(scene, STARTS, threads=1, arch="cpu")
    run.advance(round(TIME / run.dt))
    shot, pose, speed = run.snapshot(), *(run.observe()[name][0] for name in ("pose", "pose_rate"))
    place, velocity, placed = shot["position"][0], shot["velocity"][0], run.placed()
    run.close()
    if moves:
        assert placed["part_turn"][0, 0] == pytest.approx(TURN.amplitude * np.sin(2.0 * np.pi * TURN.frequency * TIME))
        return place, velocity
    c, s = np.cos(pose[2]), np.sin(pose[2])
    turned = np.array([[c, s], [-s, c]])
    arm = place @ turned
    return arm + pose[:2], velocity @ turned + speed[:2] + speed[2] * np.stack([-arm[:, 1], arm[:, 0]], axis=-1)


@pytest.mark.parametrize(
    "how",
    [
        pytest.param({}, marks=pytest.mark.slow),
        pytest.param({"schedule": "per-band"}, marks=pytest.mark.slow),
        pytest.param({"schedule": "per-grain"}, marks=pytest.mark.slow),
        pytest.param({"shapes": "continuous"}, marks=pytest.mark.slow),
        pytest.param({"shapes": "nodes"}, marks=pytest.mark.slow),
    ],
)
def test_grains_in_a_part_that_rolls_and_sways_move_as_in_such_a_tank(how):
    """Both are of second order in the step; a step of half the size halves what is left of it at least."""
    if "shapes" in how:
        which = np.zeros(STARTS.shape[:2], dtype=int)
        how = {"shapes": Shapes((Contour(1.0),), which, np.zeros(which.shape), how["shapes"])}
    (place, velocity), (seen, seen_velocity) = states(True, **how), states(False, **how)
    still = np.linalg.norm(seen - STARTS[0], axis=1)
    assert still.min() > 0.5 * RADIUS  # all were carried along
    # By nodes a contact is followed until it has gone a hundredth of the way to the next: up to 1e-2 of a radius.
    least = 1e-2 if getattr(how.get("shapes"), "contact", "") == "nodes" else 2e-3
    np.testing.assert_allclose(place, seen, atol=least * RADIUS)
    np.testing.assert_allclose(velocity, seen_velocity, atol=2.5 * least)  # m/s
