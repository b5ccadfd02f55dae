"""Sliding, rolling, creeping and resting under every tangential law, against closed forms."""

import numpy as np
import pytest

from solvers.grains.laws import TANGENTIAL
from solvers.grains.laws.coulomb import SLIP
from tests.oracles.scenes import box, material, simulation

G, RADIUS = 9.81, 3e-3
FRICTION, DAMPING = 0.6, 20.0
SLOPE = np.radians(20.0)
UP = np.array([np.cos(SLOPE), np.sin(SLOPE)])
CHUTE = 2 * RADIUS * 0.998  # m, width of a slot that squeezes a grain
# A floor, a slope on its right, and on its left a chute with vertical walls.
OUTLINE = np.array(
    [
        [-0.4, 0.0],
        [0.4, 0.0],
        [1.4, np.tan(SLOPE)],
        [1.4, 0.9],
        [-0.5 - CHUTE, 0.9],
        [-0.5 - CHUTE, -0.2],
        [-0.5, -0.2],
        [-0.5, 0.8],
        [-0.4, 0.8],
    ]
)
SPEED = 0.2
SLOW = ("none", "cundall-strack", "coulomb", "viscous", "haff-werner")  # laws whose code the others have in common
LAWS = [pytest.param(law, marks=pytest.mark.slow if law in SLOW else ()) for law in TANGENTIAL]


@pytest.fixture(scope="module", params=LAWS)
def slipping(request):
    """Three grains that do not meet: one slides on the floor, one starts on the slope, one is squeezed in the chute.

    World 0 has strong friction; world 1 so little that the grain on the slope slides; world 2 is world 0 with a damper
    of a quarter.
    """
    places = np.array([[-0.3, RADIUS], [0.4, 0.0] + 0.5 * UP, [-0.5 - 0.5 * CHUTE, 0.5]])
    places[1] += RADIUS * np.array([-UP[1], UP[0]])
    velocity = np.zeros((3, 3, 2))
    velocity[:, 0, 0] = SPEED
    grain = [
        material(friction=mu, shear_damping=damping)
        for mu, damping in ((FRICTION, DAMPING), (0.05, DAMPING), (FRICTION, DAMPING / 4))
    ]
    run = simulation(
        np.tile(places, (3, 1, 1)),
        RADIUS,
        OUTLINE,
        grain,
        velocity=velocity,
        tangential=request.param,
        stiffness_scale=1e-3,
    )
    states = {0.0: run.snapshot()}
    for time in (0.01, 0.1, 0.15):
        run.advance(round(time / run.dt) - run.steps)
        states[time] = run.snapshot()
    yield run, states
    run.close()


def slides_until_it_rolls(run, states) -> None:
    """A sphere set sliding rolls in the end at 5/7 of its speed, whatever the friction (Euler); before, at −μ g."""
    law, end = run.scene.grains.tangential, states[0.15]
    if law == "none":
        assert end["velocity"][0, 0, 0] == SPEED and end["spin"][0, 0] == 0.0
        return
    assert end["velocity"][0, 0, 0] == pytest.approx(5 / 7 * SPEED, rel=2e-3)
    assert end["spin"][0, 0] * RADIUS == pytest.approx(-5 / 7 * SPEED, rel=2e-3)
    if law != "viscous":
        assert states[0.1]["velocity"][1, 0, 0] == pytest.approx(SPEED - 0.05 * G * 0.1, rel=1e-3)


def rolls_down_the_slope(run, states) -> None:
    """Without slip it gains (5/7) g sin θ t; with too little friction it slides and gains g(sin θ − μ cos θ) t."""
    law = run.scene.grains.tangential
    rolls = G * np.sin(SLOPE) * (1.0 if law == "none" else 5 / 7)
    slides = {"none": rolls, "viscous": rolls}.get(law, G * (np.sin(SLOPE) - 0.05 * np.cos(SLOPE)))
    for world, pull in ((0, rolls), (1, slides)):
        faster = (states[0.1]["velocity"] - states[0.15]["velocity"])[world, 1] @ UP
        assert faster == pytest.approx(pull * 0.05, rel=3e-3), world


def test_sliding_and_rolling(slipping):
    slides_until_it_rolls(*slipping)
    rolls_down_the_slope(*slipping)


def test_a_held_load_creeps_at_the_rate_of_its_law(slipping):
    """m g/(2 γ_s) with a damper, 1e-6 m/s times m g/(2 μ F_n) on Coulomb's ramp; a spring with history holds still."""
    run, states = slipping
    law, mass = run.scene.grains.tangential, run.grains.mass[0, 0]
    k = 4 / 3 * run.scene.grains.interfaces[1].young_modulus * np.sqrt(RADIUS)
    squeeze = k * (0.002 * RADIUS) ** 1.5
    for world, damping in ((0, DAMPING), (2, DAMPING / 4)):
        down = (states[0.1]["position"] - states[0.15]["position"])[world, 2, 1] / 0.05
        if law == "none":
            assert down == pytest.approx(G * 0.125, rel=1e-3)
        elif law in ("haff-werner", "viscous"):
            assert down == pytest.approx(mass * G / (2 * damping), rel=1e-3)
        elif law == "coulomb":
            assert down == pytest.approx(SLIP * mass * G / (2 * FRICTION * squeeze), rel=1e-2)
        else:
            assert abs(down) < 1e-10
    creep_does_not_depend_on_the_step(run, states)


def creep_does_not_depend_on_the_step(run, states) -> None:
    places = states[0.0]["position"]
    run.dt *= 0.5
    run.place(places)
    down = []
    for _ in range(2):
        run.advance(round(0.05 / run.dt))
        down.append(run.snapshot()["position"][0, 2, 1])
    run.dt *= 2.0
    coarse = (states[0.1]["position"] - states[0.15]["position"])[0, 2, 1]
    if run.scene.grains.tangential != "none":
        assert down[0] - down[1] == pytest.approx(coarse, rel=1e-2, abs=1e-9)


@pytest.mark.slow
def test_column_carries_its_weight_and_rests():
    """Every contact of a column carries the weight above it, by the linear law; Hertz's is a case of verify."""
    radius, count = 1.5e-3, 12
    height = radius * (1 + 2 * np.arange(count))
    position = np.column_stack([np.zeros(count), height])[None]
    run = simulation(position, radius, box(2 * radius * 1.0001, 0.06), normal="linear", stiffness_scale=1e-3)
    assert run.settle(1e-12, 3.0)
    above = run.grains.mass[0, 0] * G * np.arange(count, 0, -1)
    z = run.snapshot()["position"][0, :, 1]
    overlap = np.array([radius - z[0], *(2 * radius - np.diff(z))])
    pair, wall = run.scene.grains.interfaces
    k = (
        4
        / 3
        * np.array([wall.young_modulus * np.sqrt(radius), *[pair.young_modulus * np.sqrt(radius / 2)] * (count - 1)])
    )
    mass = run.grains.mass[0, 0] * np.array([1.0, *[0.5] * (count - 1)])
    force = 0.8**0.8 * (k**4 * mass) ** 0.2 * overlap
    assert force == pytest.approx(above, rel=2e-3)
    run.advance(int(0.2 / run.dt))
    later = run.snapshot()["position"][0]
    assert np.abs(later[:, 1] - z).max() < 1e-6 * radius
    run.close()


@pytest.mark.slow
@pytest.mark.parametrize("law", ["haff-werner", "mindlin"])
def test_it_does_not_matter_which_of_two_grains_is_listed_first(law):
    """Two unequal grains meet off centre, wherever in a step they begin to touch: as the big and the small one number
    themselves, and the other way round. A gap before the first touch belongs to both levers alike."""
    radius, gaps = np.array([2e-3, 3e-3]), np.linspace(1e-4, 1.06e-4, 7)
    side = 0.3 * radius.sum()
    away = np.sqrt((radius.sum() + gaps) ** 2 - side**2)
    place = np.array([[[0.0, 0.05], [far, 0.05 + side]] for far in away])
    speed = np.array([[0.5, 0.0], [-0.5, 0.2]])
    both = np.concatenate([place, place[:, ::-1]])
    sizes = np.concatenate([np.tile(radius, (7, 1)), np.tile(radius[::-1], (7, 1))])
    speeds = np.concatenate([np.tile(speed, (7, 1, 1)), np.tile(speed[::-1], (7, 1, 1))])
    run = simulation(both, sizes, box(0.2, 0.2), velocity=speeds, tangential=law, gravity=0.0, stiffness_scale=1e-3)
    run.advance(round(4e-4 / run.dt))
    spin = run.snapshot()["spin"]
    run.close()
    assert np.abs(spin[:7]).min() > 1.0
    np.testing.assert_allclose(spin[7:, ::-1], spin[:7], rtol=1e-9)
