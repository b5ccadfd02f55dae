"""What stops a run of water, and what is said of it: of what has left the tank, of energy made, of what is squeezed."""

import re
from dataclasses import replace

import numpy as np
import pytest

from solvers.fluid.checks import CREATED, check_water, outside, refuse_state
from solvers.fluid.given import Water
from solvers.fluid.lists.grid import watched_box
from solvers.fluid.state import DENSEST, DENSEST_SPRAY, INSIDE
from solvers.machine.errors import BadState
from solvers.simulation import Simulation
from solvers.tank.tank import Tank
from tests.oracles.water import GRAVITY, again, box, lattice, still

SMALL = Water(spacing=5e-3, sound_speed=17.0)  # m, m/s
# In the tank, above its brim, beside it, below it, and at its wall's outside within the reach of water inside.
PLACES = np.array([[0.0, 0.1], [0.0, 0.7], [0.4, 0.1], [0.1, -0.5], [0.3 + 0.5 * SMALL.reach, 0.3]])
OPEN = Tank(box(0.6, 0.6), 1.0, (2,))


def test_water_beyond_an_open_tank_is_outside():
    np.testing.assert_array_equal(outside(PLACES, watched_box(SMALL, [OPEN])), [False, True, True, True, False])
    beside = Tank(box(0.6, 0.6) + np.array([0.6, 0.0]), 1.0)
    both = watched_box(SMALL, [OPEN, beside])
    np.testing.assert_array_equal(outside(PLACES, both), [False, True, False, True, False])


def test_nothing_is_outside_of_closed_tanks():
    assert watched_box(SMALL, [replace(OPEN, open_edges=())]) is None
    assert not outside(PLACES, None).any()


@pytest.fixture(scope="module")
def poured():
    """A drop in an open tank, and one beside it on which nothing acts but gravity."""
    drops = lattice(0.04, 0.01, 5e-3, 4.0)
    drops["position"][0, 0] = 0.2, 0.0
    scene = still(0.1, 0.05, 0.01, 2, drops=drops, open_edges=(2,), sound_speed=4.0)
    run = Simulation(replace(scene, step=scene.time_step()), threads=1, arch="cpu")
    yield run
    run.close()


@pytest.mark.slow
def test_what_has_left_an_open_tank_may_fall_as_fast_as_it_will(poured):
    poured.advance(round(0.5 / poured.dt))
    seen = poured.snapshot()
    assert seen["water_velocity"][0, 0] == pytest.approx([0.0, -0.5 * GRAVITY], abs=0.02)  # Mach 1.2
    assert seen["water_position"][0, 0, 1] == pytest.approx(-0.125 * GRAVITY, abs=0.02)
    assert np.abs(seen["water_velocity"][0, 1:]).max() < 0.5


@pytest.mark.slow
def test_what_is_in_an_open_tank_may_not(poured):
    drops = poured.scene.fluid.particles.copy()
    drops["position"][0, 0], drops["velocity"][0, 0, 1] = (0.0, 0.03), 3.0
    run = again(poured, poured.scene.holding(replace(poured.scene.fluid, particles=drops)))
    with pytest.raises(BadState, match=r"water moves at [23.]+.* m/s, Mach 0\.[67]"):
        run.advance(10)


@pytest.mark.slow
def test_what_comes_back_into_an_open_tank_is_watched_again(poured):
    """Thrown down from above the brim it is let pass until it is in the box."""
    drops = poured.scene.fluid.particles.copy()
    high = 0.05 + 2.0 * poured.scene.fluid.water.reach
    drops["position"][0, 0], drops["velocity"][0, 0, 1] = (0.0, high), -3.0
    run = again(poured, poured.scene.holding(replace(poured.scene.fluid, particles=drops)))
    run.advance(2)
    assert run.snapshot()["water_position"][0, 0, 1] < high
    with pytest.raises(BadState, match=r"water moves at [23.]+.* m/s, Mach 0\.[67].*z = 0\.0[456]"):
        run.advance(200)


@pytest.mark.parametrize(
    ("gas", "said"), [(1.0, r"air's density.*air\.sound_speed"), (0.0, r"water's density.*water\.sound_speed")]
)
def test_what_is_squeezed_is_named(gas, said):
    particles = {
        "place": PLACES,
        "speed": np.zeros(5),
        "deviation": np.array([0.0, 0.1, 30.0, 0.0, 0.0]),
        "eigenvalue": np.ones(5),
    }
    with pytest.raises(BadState, match=said):
        refuse_state(0, {**particles, "gas": np.full(5, gas)}, 1.5, 17.0)


SOUND = {
    "escaped": -1.0,
    "work": 4.0,
    "viscous": 3.0,
    "diffusive": 2.0,
    "kinetic": 1.0,
    "wall_energy": 0.5,
    "total": 100.0,
}
START = 100.0 + 3.0 + 2.0 + 0.5 - 4.0  # J, of which all of that is accounted for


def observed(**changes: float) -> dict[str, np.ndarray]:
    """What is observed of two worlds, the second of which has these changes."""
    return {f"water_{name}": np.array([value, changes.get(name, value)]) for name, value in SOUND.items()}


def refused(action, *arguments) -> str:
    """The message of BadState: one sentence on the second world, with the time and the remedy."""
    with pytest.raises(BadState) as error:
        action(*arguments)
    said = str(error.value)
    assert error.value.world == 1 and "t = 1.5 s" in said and "water.sound_speed" in said
    assert re.fullmatch(r"world 1: (?!.*\. ).*\.", said), said
    return said


def test_water_that_is_sound_goes_on():
    check_water(observed(), START, 1.5)
    check_water(observed(total=60.0), START, 1.5)  # energy that is lost is told by the account, and stops nothing


def test_a_particle_outside_stops_the_run():
    assert refused(check_water, observed(escaped=37.0), START, 1.5).startswith("world 1: particle 37 of the water left")
    assert refused(check_water, observed(escaped=0.0), np.nan, 1.5).startswith("world 1: particle 0 of the water left")


def test_energy_from_nothing_stops_the_run():
    """A tenth of what is exchanged, a thousandth of what there is and what is let pass by may be missing, no more."""
    most = CREATED * (4.0 + 3.0 + 2.0 + 1.0) + 1e-3 * START
    check_water(observed(total=100.0 + 0.99 * most), START, 1.5)
    more = observed(total=100.0 + 1.01 * most)
    assert "gained energy from nothing" in refused(check_water, more, START, 1.5)
    check_water(more, START, 1.5, 0.02 * most)
    check_water(more, np.nan, 1.5)  # the start is unknown
    with pytest.raises(BadState, match=r"t = 1.5 s; water\.shifting = .*delta-plus-momentum"):
        check_water(more, START, 1.5, 0.0, lifts=True)


def test_what_is_no_number_stops_the_run():
    """It is told where, by a neighbour that still has a place if it has none itself."""
    fine = {
        "place": PLACES,
        "speed": np.zeros(5),
        "deviation": np.zeros(5),
        "eigenvalue": np.ones(5),
        "gas": np.zeros(5),
    }
    for name in ("place", "speed", "deviation"):
        broken = {key: values.copy() for key, values in fine.items()}
        broken[name][2] = np.nan
        said = refused(refuse_state, 1, broken, 1.5, 17.0)
        assert "not a number" in said and ("nan" in said) == (name == "place")
    broken["place"][1] = np.nan
    assert "y = 0.4 m, z = 0.1 m" in refused(refuse_state, 1, broken, 1.5, 17.0)


@pytest.mark.parametrize(("whose", "other"), [("within", "spray"), ("spray", "within")])
def test_spray_and_the_surface_may_be_squeezed_more_than_water_within(whose, other):
    """The one is named that is farthest beyond what it may be, not the one that is squeezed most."""
    span, most = {"within": 1.0, "spray": 0.5 * INSIDE}, {"within": DENSEST, "spray": DENSEST_SPRAY}
    deviation = np.array([0.0, 0.0, 1.01 * most[whose], 0.0, 0.9 * most[other]])
    spans = np.array([1.0, 1.0, span[whose], 1.0, span[other]])
    fine = {"place": PLACES, "speed": np.zeros(5), "gas": np.zeros(5)}
    said = refused(refuse_state, 1, {**fine, "deviation": deviation, "eigenvalue": spans}, 1.5, 17.0)
    assert f"off by {101.0 * most[whose]:.3g} % at y = 0.4 m" in said
