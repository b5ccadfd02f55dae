"""Manipulated states: no kernel uses an index outside an array."""

import numpy as np
import pytest

from solvers.motion import Sway
from solvers.simulation import Simulation
from tests.oracles.given import scene_of
from tests.oracles.scenes import box, material

RADIUS, COUNT, WORLDS = 3e-3, 12, 2


@pytest.fixture(scope="module")
def run():
    """Two worlds of grains that touch one another and the floor."""
    column, row = (axis.ravel() for axis in np.meshgrid(np.arange(4), np.arange(3), indexing="ij"))
    place = np.tile(RADIUS * np.stack([1.99 * column - 3.0, 1.99 * row + 0.99], axis=1), (WORLDS, 1, 1))
    scene = scene_of(
        radius=np.full((WORLDS, COUNT), RADIUS),
        outline=box(0.05, 0.05),
        grain=material(young=4e6),
        wall=material(young=4e6),
        motions=[(Sway(0.01, 5.0),)] * WORLDS,
    )
    run = Simulation(scene, place, 1, arch="cpu")
    run.advance(20)
    yield run
    run.close()


def forged(run, kind: str, which: str, value: int) -> tuple[str, dict[str, np.ndarray]]:
    """The name of an array of a state, and the state with another number in it."""
    state = run.state()
    name = f"{kind}.{which}"
    values = state[name].copy()
    values.flat[0] = value
    return name, {**state, name: values}


@pytest.mark.parametrize("value", [2_000_000_000, -1_000_000, 10_000])
@pytest.mark.parametrize("which", ["length", "first"])
@pytest.mark.parametrize("kind", ["pairs", "contacts"])
def test_a_list_longer_than_its_array_is_refused_without_changes(run, kind, which, value):
    name, state = forged(run, kind, which, value)
    before = run.state()
    with pytest.raises(ValueError, match=f"array {name}"):
        run.restore(state)
    after = run.state()
    assert all(np.array_equal(before[key], after[key]) for key in before)


@pytest.mark.parametrize("value", [2_000_000_000, -1_000_000, 10_000])
@pytest.mark.parametrize("which", ["grain", "mate"])
@pytest.mark.parametrize("kind", ["pairs", "contacts"])
def test_contacts_with_invalid_indices_are_removed(run, kind, which, value):
    _, state = forged(run, kind, which, value)
    before, listed = run.state(), getattr(run.grains.lists, kind)
    run.restore(state)
    places = getattr(listed, which).to_numpy()
    ends = {
        "grain": run.grains.grains.stride,
        "mate": run.grains.grains.stride if kind == "pairs" else run.walls.features,
    }
    assert places.min() >= 0 and places.max() < ends[which] * (WORLDS if kind == "pairs" else 1)
    run.restore(before)


def test_an_unchanged_state_is_accepted(run):
    state = run.state()
    assert run.grains.lists.pairs.length.to_numpy().min() > 0
    run.advance(30)
    run.restore(state)
    after = run.state()
    assert all(np.array_equal(state[key], after[key]) for key in state)
