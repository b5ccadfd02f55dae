"""What stops a simulation, its message, and that all else is unchanged; and states in which somebody has changed
places in lists: no kernel uses an index outside an array."""

import re

import numpy as np
import pytest

from solvers.machine.errors import BadState
from tests.oracles.scenes import box, simulation

RADIUS = 3e-3
PLACE = np.array([[-0.02, 0.01], [0.0, 0.02], [0.02, 0.03]])
VELOCITY = np.random.default_rng(2).normal(0.0, 0.1, (3, 3, 2))
STEPS = 40


@pytest.fixture(scope="module")
def built():
    """Three worlds of three grains, built once."""
    run = simulation(np.tile(PLACE, (3, 1, 1)), RADIUS, box(0.06, 0.06), start_speed=1.0)
    run.step_of_scene = run.dt
    yield run
    run.close()


@pytest.fixture
def run(built):
    """The three worlds at their start."""
    built.dt, built.origin = built.step_of_scene, 0.0
    start(built)
    return built


def start(run, **places) -> None:
    """Put the grains back, except grain 1 of world 2, if a place is given for it."""
    position = np.tile(PLACE, (3, 1, 1))
    if places:
        position[2, 1] = places["grain"]
    run.steps = 0
    for field in (run.clock.step, run.clock.status):
        field.fill(0)
    run.place(position, VELOCITY)


def caught(action, *arguments) -> str:
    """The message of BadState: one sentence that begins with the world and has the time."""
    with pytest.raises(BadState) as error:
        action(*arguments)
    said = str(error.value)
    assert re.fullmatch(r"world \d: (?!.*\. ).*\.", said), said
    return said


def told_time(said: str) -> float:
    """The time (s) in a message."""
    return float(re.search(r"t = (\S+) s", said)[1])


@pytest.mark.slow
@pytest.mark.parametrize("grain", [0, 1, 2])
@pytest.mark.parametrize("trouble", ["not a number", "too fast"])
def test_a_bad_speed_stops_its_world_alone(run, trouble, grain):
    run.advance(STEPS)
    expected = run.snapshot()
    start(run)
    run.advance(10)
    speed = np.nan if trouble == "not a number" else 0.2 * RADIUS / run.dt
    run.grains.grains.velocity[0][1, grain] = speed
    said = caught(run.advance, STEPS - 10)
    assert said.startswith("world 1: ")
    assert trouble in said
    assert told_time(said) == pytest.approx(11 * run.dt, rel=1e-3)
    np.testing.assert_array_equal(run.clock.step.to_numpy(), [STEPS, 11, STEPS])
    state = run.snapshot()
    for name, values in state.items():
        np.testing.assert_array_equal(values[[0, 2]], expected[name][[0, 2]], err_msg=name)
    others = [k for k in range(3) if k != grain]
    assert np.all(np.isfinite(state["position"][1, others]))
    assert caught(run.advance, 1) == said


def test_the_limit_of_speed_is_a_tenth_of_a_radius_a_step(run):
    run.grains.grains.velocity[1][1, 0] = 0.098 * RADIUS / run.dt
    run.advance(1)
    run.grains.grains.velocity[1][2, 2] = 0.102 * RADIUS / run.dt
    assert caught(run.advance, 1).startswith("world 2: ")


def test_grain_by_grain_too_a_speed_that_is_no_number_is_called_so():
    alone = simulation(np.tile(PLACE, (3, 1, 1)), RADIUS, box(0.06, 0.06), start_speed=1.0, schedule="per-grain")
    alone.advance(1)
    alone.grains.grains.velocity[0][1, 2] = np.nan
    assert "not a number" in caught(alone.advance, STEPS)


@pytest.mark.parametrize("place", [[0.0, -0.02], [0.0, 0.08], [-0.05, 0.02], [0.05, 0.07]])
def test_an_escaped_grain_is_detected(run, place):
    run.advance(1)
    run.observe()
    start(run, grain=place)
    run.advance(5)
    said = caught(run.observe)
    assert said.startswith("world 2: grain 1 left the tank")
    assert told_time(said) == pytest.approx(5 * run.dt, rel=1e-3)
    np.testing.assert_allclose(run.snapshot()["position"][2, 1], place, atol=1e-4)


@pytest.mark.parametrize("against", ["grain", "wall"])
def test_deep_overlap_is_detected(run, against):
    """The limit is 0.3 radii; the step is so short that no grain moves."""
    run.dt = 1e-12
    for overlap in (0.29, 0.31):
        gap = np.array([0.0, 2.0 - overlap]) if against == "grain" else np.array([0.0, 1.0 - overlap])
        start(run, grain=RADIUS * gap + (PLACE[0] if against == "grain" else 0.0))
        run.advance(1)
        if overlap < 0.3:
            assert run.observe()["overlap"] == pytest.approx([0.0, 0.0, overlap], rel=1e-6)
        else:
            said = caught(run.observe)
            assert said.startswith("world 2: grains overlap by 31 %")
            assert told_time(said) == pytest.approx(1e-12)


def test_during_settling_the_message_has_the_settling_time(run):
    run.grains.grains.velocity[0][0, 2] = np.nan
    assert told_time(caught(run.settle, 1e-6, 1.0)) == pytest.approx(run.dt, rel=1e-3)


@pytest.fixture(scope="module")
def touching(built):
    """The same, with grains that touch one another and the floor; the simulation does not come back from there."""
    built.dt, built.origin = built.step_of_scene, 0.0
    built.start_clock()
    row = RADIUS * np.array([[-1.9999, 0.9999], [0.0, 0.9999], [1.9999, 0.9999]])
    built.place(np.tile(row, (3, 1, 1)))
    built.advance(20)
    return built


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
def test_a_list_longer_than_its_array_is_refused_without_changes(touching, kind, which, value):
    name, state = forged(touching, kind, which, value)
    before = touching.state()
    with pytest.raises(ValueError, match=f"array {name}"):
        touching.restore(state)
    after = touching.state()
    assert all(np.array_equal(before[key], after[key]) for key in before)


@pytest.mark.parametrize("value", [2_000_000_000, -1_000_000, 10_000])
@pytest.mark.parametrize("which", ["grain", "mate"])
@pytest.mark.parametrize("kind", ["pairs", "contacts"])
def test_contacts_with_invalid_indices_are_removed(touching, kind, which, value):
    _, state = forged(touching, kind, which, value)
    before, listed = touching.state(), getattr(touching.grains.lists, kind)
    touching.restore(state)
    places = getattr(listed, which).to_numpy()
    ends = {
        "grain": touching.grains.grains.stride,
        "mate": touching.grains.grains.stride if kind == "pairs" else touching.walls.features,
    }
    assert places.min() >= 0 and places.max() < ends[which] * (len(PLACE) if kind == "pairs" else 1)
    touching.restore(before)


def test_an_unchanged_state_is_accepted(touching):
    state = touching.state()
    assert touching.grains.lists.pairs.length.to_numpy().min() > 1
    touching.advance(30)
    touching.restore(state)
    after = touching.state()
    assert all(np.array_equal(state[key], after[key]) for key in state)
