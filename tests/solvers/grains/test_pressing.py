"""Contact forces: in a bed at rest without friction the forces on each grain bear its weight."""

import numpy as np
import pytest

from solvers.grains.pressing import NOBODY
from solvers.grains.shapes.given import Shapes
from solvers.simulation import Simulation
from tests.oracles.given import scene_of
from tests.oracles.outlines import irregular
from tests.oracles.scenes import box, material

RADIUS, GRAVITY = 3e-3, 9.81
SMOOTH = material(friction=0.0, young=3.2e6, restitution=0.05)
COLUMNS, ROWS = 4, 3


def bed(shapes: Shapes | None = None, schedule: str = "auto", units: int | None = None) -> Simulation:
    """Grains in a narrow box, let fall in staggered rows until they all but rest: outlines rock for long."""
    row, column = np.divmod(np.arange(COLUMNS * ROWS), COLUMNS)
    place = RADIUS * np.column_stack([2.3 * (column - 1.5) + 0.4 * (row % 2), 1.3 + 2.4 * row])
    radius, tank = np.full((1, len(place)), RADIUS), box(11.0 * RADIUS, 40.0 * RADIUS)
    laws = {"tangential": "none", "normal": "hertz-dashpot"}
    scene = scene_of(radius, tank, SMOOTH, SMOOTH, shapes=shapes, schedule=schedule, **laws)
    made = Simulation(scene, place[None], threads=1, units=units)
    assert made.settle(1e-8 if shapes is None else 1e-5, 5.0)
    return made


def outlines(contact: str) -> Shapes:
    count, random = COLUMNS * ROWS, np.random.default_rng(1)
    contours = tuple(irregular(seed) for seed in range(3))
    which, angle = random.integers(3, size=(1, count)), random.uniform(0.0, 2.0 * np.pi, (1, count))
    return Shapes(contours, which, angle, contact, 200)


def weights_borne(made: Simulation) -> np.ndarray:
    """Sum of the forces on each grain, in weights of its own (n, 2)."""
    pressing = made.pressing()
    borne = np.zeros((COLUMNS * ROWS, 2))
    np.add.at(borne, pressing.grains[:, 0], pressing.force)
    mutual = pressing.grains[:, 1] != NOBODY
    np.subtract.at(borne, pressing.grains[mutual, 1], pressing.force[mutual])
    return borne / (made.grains.mass[0, :, None] * GRAVITY)


@pytest.mark.slow  # Hertz's forces in a column: `tests/lab/paint/test_forces.py`
@pytest.mark.parametrize("schedule, units", [("per-world", 1), ("per-band", 3), ("per-grain", None)])
def test_discs_bear_their_weights_with_any_lists(schedule, units):
    made = bed(None, schedule, units=units)
    assert weights_borne(made) == pytest.approx(np.tile([0.0, 1.0], (COLUMNS * ROWS, 1)), abs=0.02)
    made.close()


@pytest.mark.slow
@pytest.mark.parametrize("contact", ["continuous", "area"])  # nodes never let a bed rest
def test_irregular_grains_bear_their_weights_and_observing_changes_nothing(contact):
    made = bed(outlines(contact))
    before = made.state()
    assert weights_borne(made) == pytest.approx(np.tile([0.0, 1.0], (COLUMNS * ROWS, 1)), abs=0.1)
    pressing, place = made.pressing(), made.snapshot()["position"][0]
    away = np.hypot(*(pressing.place - place[pressing.grains[:, 0]]).T)
    assert np.all((away > 0.5 * RADIUS) & (away < 1.6 * RADIUS))
    after = made.state()
    assert all(before[name].tobytes() == after[name].tobytes() for name in before)
    made.close()


@pytest.mark.slow
def test_grains_go_by_their_own_numbers():
    made = bed()
    whole = made.pressing()
    order = np.random.default_rng(3).permutation(COLUMNS * ROWS)
    made.grains.numbering.number = made.grains.numbering.number[:, order]
    assert made.pressing().grains[:, 0].tolist() == order[whole.grains[:, 0]].tolist()
    made.close()
