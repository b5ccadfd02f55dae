"""Renumbering of mixed grains: it changes only the order of sums, and happens only where it saves time."""

from itertools import cycle

import numpy as np
import pytest

from solvers import simulation
from solvers.grains.bed.filling import start_positions
from solvers.motion import Sway
from solvers.scene import Scene
from solvers.simulation import Simulation
from solvers.space import order as renumber
from tests.oracles.given import scene_of
from tests.oracles.scenes import box, material

COUNT, WORLDS = 120, 2


@pytest.fixture(scope="module")
def bed():
    """Radii (n,) and settled positions (n, 2) of a small bed."""
    rng = np.random.default_rng(3)
    radius = 1.5e-3 * (1.0 + 0.1 * rng.uniform(-1.0, 1.0, COUNT))
    outline = box(0.04, 0.12)
    run = Simulation(scene(radius[None]), start_positions(radius, outline, rng)[None], threads=1)
    run.settle(1e-5, 1.0)
    place = run.snapshot()["position"][0]
    run.close()
    return radius, place


def scene(radius, schedule="per-world") -> Scene:
    """Soft grains with history in a strong sway."""
    motions = [[Sway(0.02, 3.0)]] * len(radius)
    soft = material(rolling_friction=0.2)
    return scene_of(
        radius,
        box(0.04, 0.12),
        soft,
        soft,
        tangential="mindlin",
        rolling="elastic-plastic",
        stiffness_scale=1e-3,
        motions=motions,
        schedule=schedule,
        sizes=(1.35e-3, 1.65e-3),
    )


def shaken(bed, schedule="per-world", units=None) -> tuple[dict, np.ndarray]:
    """The state after 0.02 s in pieces, and how often grain numbers differ from the first."""
    radius, place = bed
    run = Simulation(scene(np.tile(radius, (WORLDS, 1)), schedule), np.tile(place, (WORLDS, 1, 1)), 1, units=units)
    for _ in range(20):
        run.advance(round(1e-3 / run.dt))
    state, numbers = run.snapshot() | run.observe(), run.matters["grains"].numbering.number
    run.close()
    return state, numbers


@pytest.fixture(scope="module")
def usual(bed):
    return shaken(bed)[0]


@pytest.mark.slow
@pytest.mark.parametrize(("schedule", "units"), [("per-world", None), ("per-band", 3), ("per-grain", None)])
def test_renumbering_changes_only_rounding(bed, usual, monkeypatch, schedule, units):
    """With history and all: contacts that rub keep their springs when their grains change numbers."""
    monkeypatch.setattr(renumber, "FEWEST", 10)
    monkeypatch.setattr(renumber, "MIXED", -1.0)
    monkeypatch.setattr(simulation, "LOOK_FOR_MIXING", 2e-3)
    state, numbers = shaken(bed, schedule, units)
    assert np.mean(numbers != np.arange(COUNT)) > 0.5
    for name in ("position", "angle", "velocity", "elastic", "contacts"):
        np.testing.assert_allclose(state[name], usual[name], rtol=1e-9, atol=1e-10, err_msg=name)


@pytest.mark.slow
def test_a_world_does_not_feel_that_another_is_renumbered(bed, usual, monkeypatch):
    """To the last bit: its lists are built when they would be without, and so are its steps chosen."""
    second_alone = cycle([False, True])
    monkeypatch.setattr(renumber, "has_mixed", lambda *_: next(second_alone))
    monkeypatch.setattr(renumber, "FEWEST", 10)
    monkeypatch.setattr(simulation, "LOOK_FOR_MIXING", 2e-3)
    state, numbers = shaken(bed)
    assert np.all(numbers[0] == np.arange(COUNT)) and np.mean(numbers[1] != np.arange(COUNT)) > 0.5
    for name in ("position", "angle", "velocity", "spin"):
        assert state[name][0].tobytes() == usual[name][0].tobytes(), name


@pytest.mark.slow
def test_small_and_unmixed_beds_are_not_renumbered(bed):
    """Renumbering saves time only in large worlds whose grains have mixed."""
    assert np.all(shaken(bed)[1] == np.arange(COUNT))
    place = np.random.default_rng(0).uniform(0.0, 1.0, (renumber.FEWEST, 2))
    assert not renumber.has_mixed(place + 4e-3, place, 1e-3 * 2.0**0.5)
    assert renumber.has_mixed(place + 6e-3, place, 1e-3 * 2.0**0.5)
    assert not renumber.has_mixed(place[1:] + 6e-3, place[1:], 1e-3)


def test_new_numbers_follow_the_positions():
    """Column by column, each from the floor up, whatever the grains' numbers were."""
    y, z = (axis.ravel() for axis in np.meshgrid(np.arange(6) * 2.0 + 0.5, np.arange(9.0), indexing="ij"))
    mixed = np.random.default_rng(1).permutation(len(y))
    order = renumber.spatial_order(np.stack([y, z], axis=1)[mixed], 1.0)
    np.testing.assert_array_equal(mixed[order], np.arange(len(y)))
