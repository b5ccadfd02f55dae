"""Steps of several base steps: the same as steps of that length, and exact where their length changes."""

import numpy as np
import pytest

from solvers.motion import Sway
from solvers.simulation import Simulation
from tests.oracles.given import scene_of
from tests.oracles.scenes import box, material

G, RADIUS, BASE, STRETCH = 9.81, 1.5e-3, 4e-6, 4
SOFT = material(young=1e7, friction=0.4, restitution=0.5)
SKIN = 1.5e-4  # m: one that follows the speed goes by the base step, too
SLOW = pytest.mark.slow  # of schedules that another one stands for in the quick tests


def started(base: float, largest_multiple: int, schedule: str) -> Simulation:
    """Thirty grains above one another's gaps in a swayed box."""
    rng = np.random.default_rng(5)
    sites = RADIUS * np.array([(2.4 * k - 6.0, 1.2 + 2.4 * row) for row in range(5) for k in range(6)])
    place = (sites + RADIUS * rng.uniform(-0.15, 0.15, sites.shape))[None]
    sway = [[Sway(amplitude=4e-3, frequency=4.0)]]
    scene = scene_of(
        np.full((1, len(sites)), RADIUS),
        box(0.022, 0.04),
        SOFT,
        SOFT,
        tangential="mindlin",
        motions=sway,
        schedule=schedule,
        step=base,
        start_speed=1.0,
    )
    units = 2 if schedule == "per-band" else None
    return Simulation(scene, place, 1, skin=SKIN, arch="cpu", units=units, largest_multiple=largest_multiple)


@pytest.fixture
def calm(monkeypatch):
    """A scene whose grains never hurry, so that all steps have their longest length."""
    monkeypatch.setattr("solvers.grains.matter.calm_speed", lambda scene, times: 1e9)


@pytest.mark.usefixtures("calm")
@pytest.mark.slow
@pytest.mark.parametrize("schedule", ["per-world", "per-band"])
def test_steps_of_several_base_steps_are_steps_of_that_length(schedule):
    """Bit for bit, through falls, collisions and neighbour-list rebuilds."""
    found = []
    for base, largest_multiple in ((BASE, STRETCH), (STRETCH * BASE, 1)):
        run = started(base, largest_multiple, schedule)
        looks = []
        for _ in range(4):
            run.advance(largest_multiple * 1250)
            looks.append({**run.snapshot(), **run.observe()})
        assert run.time == pytest.approx(0.08)
        run.close()
        found.append(looks)
    for one, other in zip(*found, strict=True):
        assert all(np.array_equal(one[name], other[name]) for name in one)
    assert found[0][-1]["contacts"][0] > 20


@pytest.fixture(
    scope="module", params=["per-world", *(pytest.param(name, marks=SLOW) for name in ("per-band", "per-grain"))]
)
def high(request):
    """Four grains in a row in a high tank, whose steps may be four base steps long."""
    place = np.array([[[0.02 * k, RADIUS] for k in range(-2, 2)]])
    given = {"schedule": request.param, "start_speed": 2.0, "tangential": "none"}
    scene = scene_of(np.full((1, 4), RADIUS), box(0.1, 0.6), SOFT, SOFT, **given)
    units = 2 if request.param == "per-band" else None
    run = Simulation(scene, place, 1, arch="cpu", units=units, largest_multiple=STRETCH)
    yield run, place
    run.close()


def test_free_fall_is_exact_where_the_step_changes(high):
    """Leapfrog of constant acceleration is exact if each kick goes from the middle of a step to that of the next."""
    run, place = high
    limits = run.grains.calm.to_numpy()
    run.grains.calm.fill(1e9)  # grains never hurry
    run.start_clock()
    run.place(place + np.array([0.0, 0.3 - RADIUS]))
    done = 0
    for steps in (7, 1, 2, 13, 4, 3, 5000, 9):  # the last steps to each are shorter ones
        run.advance(steps)
        done += steps
        fall = 0.3 - run.snapshot()["position"][0, :, 1]
        assert fall == pytest.approx(0.5 * G * (done * run.dt) ** 2, rel=1e-12, abs=1e-16)
    run.grains.calm.from_numpy(limits)


def test_steps_are_longer_while_grains_are_slow(high):
    """Two grains may meet at twice the speed of the faster one; a quarter more is kept in hand."""
    run, place = high
    if run.scene.schedule == "per-grain":
        pytest.skip("single grains have one length of step")
    calm, never = run.grains.calm.to_numpy()  # closing speeds up to which the multiple is 2, and 4

    def multiple(speed: float) -> int:
        velocity = np.zeros((1, 4, 2))
        velocity[0, 3, 0] = speed
        run.start_clock()
        run.place(place)
        run.launch(velocity)
        run.advance(64)
        run.advance(64)
        return int(run.clock.multiple.to_numpy()[0])

    assert 2.0 > calm > never == 0.0
    assert [multiple(share * calm) for share in (0.35, 0.45, 0.0)] == [2, 1, 2]
    run.place(place + np.array([0.0, 0.1]))
    run.advance(64)
    assert run.clock.multiple.to_numpy()[0] == 2
    run.advance(int(2.0 * calm / G / run.dt))  # a fall in a single call
    assert run.clock.multiple.to_numpy()[0] == 1


@pytest.mark.slow
@pytest.mark.usefixtures("calm")
def test_a_state_continues_bit_for_bit_between_steps_of_different_length():
    run = started(BASE, STRETCH, "per-world")
    run.advance(5009)
    state = run.state()
    run.advance(4991)
    whole = run.snapshot()
    run.restore(state)
    run.advance(4991)
    cut = run.snapshot()
    run.close()
    assert all(np.array_equal(whole[name], cut[name]) for name in whole)
