"""One preset, one result: on any number of threads, with any other worlds, with any skin of the lists.

That is of one schedule, and among worlds whose tanks are as fast. By bands, which the schedule auto has for a large bed
that is alone, sums are in another order; from the highest speed of a launch follows how early pairs are listed.
"""

import os
import subprocess
import sys
from math import pi
from pathlib import Path

import numpy as np
import pytest

from solvers.grains.bed.filling import radii, start_positions
from solvers.motion import Tilt
from solvers.simulation import Simulation
from tests.oracles.given import scene_of
from tests.oracles.scenes import box, material

WORLDS, COUNT = 3, 80
STEP = 2e-5
EARLY, ALL = 2_200, 10_000  # steps: 0.044 s, grains have fallen on others; 0.2 s, the tank tilts by 30°


def run(worlds=range(WORLDS), looks=(ALL,), threads=1, skin=None) -> list[dict[str, np.ndarray]]:
    """The states after so many steps of these worlds, each with its own start and its own angle to tilt to.

    All have grains of the same sizes: a scene takes the lists' cells from its largest grain and, where it is not told,
    the skin and the dissipative time from the mean one.
    """
    outline = box(0.04, 0.06)
    radius = radii(COUNT, 3e-3, 0.2, np.random.default_rng(1))
    start = np.array([start_positions(radius, outline, np.random.default_rng(seed)) for seed in worlds])
    motions = [[Tilt(3.0, (25 + 5 * w) * pi / 180, ease=0.02)] for w in worlds]
    scene = scene_of(
        np.tile(radius, (len(worlds), 1)),
        outline,
        material(dissipative_time=1e-6),
        material(dissipative_time=2e-6, friction=0.4),
        tangential="mindlin",
        stiffness_scale=1e-3,
        motions=motions,
        step=STEP,
    )
    made, states = Simulation(scene, start, threads, skin), []
    for steps in np.diff(looks, prepend=0):
        made.advance(int(steps))
        states.append(made.snapshot())
    made.close()
    return states


def assert_same_bits(one: dict[str, np.ndarray], other: dict[str, np.ndarray]) -> None:
    assert one.keys() == other.keys()
    for name in one:
        assert one[name].tobytes() == np.ascontiguousarray(other[name]).tobytes(), name


@pytest.fixture(scope="module")
def batch():
    """All worlds on one thread, early and at the end."""
    early, last = run(looks=(EARLY, ALL))
    assert np.ptp(last["position"][:, :, 0], axis=1).min() > 0.02, "the beds are to lie in the tank"
    assert np.abs(last["angle"]).max(axis=1).min() > 1.0, "the grains are to turn"
    return early, last


@pytest.mark.slow
def test_another_process_on_two_threads_gives_the_same_bits(batch, tmp_path):
    file = tmp_path / "state.npz"
    here = "import numpy; from tests.solvers.time.test_reproducible import run"
    code = f"{here}; numpy.savez({str(file)!r}, **run(threads=2)[-1])"
    environment = os.environ | {"PYTHONPATH": str(Path(__file__).parents[3])}
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=200, env=environment)
    assert done.returncode == 0, done.stderr[-2000:]
    with np.load(file) as state:
        assert_same_bits(batch[-1], dict(state))


@pytest.mark.slow
def test_a_world_alone_moves_as_among_others(batch):
    (alone,) = run(worlds=range(1))
    assert_same_bits(alone, {name: values[:1] for name, values in batch[-1].items()})


@pytest.mark.slow
def test_the_lists_skin_changes_only_rounding(batch):
    """Rounding grows with the impacts, to 4e-12 and 8e-12 with other skins on one processor."""
    (state,) = run(looks=(EARLY,), skin=1e-4)
    for name, values in batch[0].items():
        assert np.abs(state[name] - values).max() <= 1e-10 * np.abs(values).max(), name
