"""Loose grains in a room of a body that moves freely: what one gains the other loses."""

from dataclasses import replace

import numpy as np
import pytest

from solvers.machine.errors import Unavailable
from solvers.motion.harmonic import Sway
from solvers.scene import Scene
from solvers.simulation import Simulation
from solvers.tank.parts import Part
from solvers.tank.tank import Tank
from tests.oracles.aboard import PLACES, RADIUS, ROOM, SHELF, THICKNESS, YOUNG, dry, together
from tests.oracles.water import GRAVITY, box

THROWN = np.array([[(0.1, 1.0), (0.9, -0.3), (0.6, 0.5), (-0.8, 0.6)]])  # m/s
STEPS, SPIN = 4000, 3.0  # rad/s


@pytest.mark.slow  # it compiles two simulations
def test_in_a_body_that_is_held_grains_do_as_in_a_tank_at_rest():
    held = Simulation(dry(release=9.0), PLACES, 1)
    held.advance(STEPS)
    found, told = held.snapshot(), held.observe()
    held.close()
    still = Simulation(replace(dry(), outline=ROOM, parts=(replace(SHELF, tank=0),), more_tanks=()), PLACES, 1)
    still.advance(STEPS)
    expected, rows = still.snapshot(), still.observe()
    still.close()
    assert np.abs(found["velocity"]).max() > 0.01 and rows["wall_force"][0, 1] < 0.0
    for name, values in expected.items():
        np.testing.assert_allclose(found[name], values, rtol=1e-12, atol=1e-15, err_msg=name)
    for name in ("wall_force", "potential", "kinetic", "centre_of_mass"):
        np.testing.assert_allclose(told[name], rows[name], rtol=1e-12, atol=1e-15, err_msg=name)


@pytest.fixture(scope="module")
def run():
    """A body that is let go at once."""
    made = Simulation(dry(), PLACES, 1)
    yield made
    made.close()


def anew(run: Simulation, thrown: float = 1.0, spin: float = SPIN, **changes) -> dict[str, np.ndarray]:
    """Begin anew with the grains thrown, and after a step the body turning (rad/s): `together` then."""
    scene = dry(**changes)
    run.dt, run.longest_step = scene.time_step(), scene.longest_step(1.0)
    run.alter(scene)
    run.start_clock()
    run.place(PLACES, thrown * THROWN)
    run.advance(1)
    run.parts.bodies.velocity[2].from_numpy(np.full((1, 1), spin))
    return together(run)


def loads(run: Simulation) -> np.ndarray:
    """Sizes (pieces, 3) of the loads in the last step."""
    return sum(
        np.stack([np.abs(field.to_numpy()[0, :5]) for field in load.instant]).T for load in run.parts.bodies.loads
    )


@pytest.mark.slow
def test_grains_in_a_body_that_falls_have_no_weight(run):
    anew(run, thrown=0.0, spin=0.0)
    run.advance(STEPS - 1)
    place, body = run.snapshot()["position"], run.observe()["body_place"][0, 0]
    np.testing.assert_allclose(place, PLACES, atol=1e-12)
    assert body == pytest.approx([0.02, 1.06 - 0.5 * GRAVITY * run.time**2, 0.0], abs=1e-12)


@pytest.mark.slow
def test_body_and_grains_keep_their_momentum_and_fall_as_one(run):
    """Momentum to 1e-12 of Σ|F|Δt, by whatever bears the grains' load; the centre falls by g t²/2, to second order."""
    before, began, pushed, each = anew(run), run.time, 0.0, np.zeros(5)
    for _ in range(STEPS):
        run.advance(1)
        pushed += loads(run)[:, :2].sum() * run.dt
        each += loads(run)[:, 1]
    after, lasts = together(run), run.time - began
    fell = np.array([0.0, GRAVITY * lasts])
    assert (each > 0.0).tolist() == [False, True, False, True, True]  # the room, the shelf, the fixed grain
    assert abs(run.observe()["body_place"][0, 0, 2]) > 0.1
    assert np.abs(after["momentum"] - before["momentum"] + before["mass"] * fell).max() < 1e-12 * pushed
    way = before["momentum"] / before["mass"] * lasts - 0.5 * fell * lasts
    # Velocities are those of the middle of steps, places taken half-way along: off by (ω Δt)²/8 of an arm of 0.1 m
    off = 0.1 * (SPIN * run.dt) ** 2
    assert after["centre"] - before["centre"] == pytest.approx(way, abs=off)


@pytest.mark.slow
def test_moment_of_momentum_is_kept_to_second_order(run):
    """About the common centre of mass, without weight."""
    off = []
    for dt in (2e-5, 1e-5):
        before = anew(run, gravity=0.0, dt=dt)
        run.advance(round(0.06 / dt))
        after = together(run)
        off.append(abs(after["moment"] - before["moment"]) / abs(before["moment"]))
    assert off[0] < (SPIN * 2e-5) ** 2
    assert off[1] < off[0] / 3.0 or off[0] < 1e-12


@pytest.mark.slow
def test_energy_of_body_and_grains_is_kept_without_losses(run):
    """A Hertzian collision is as an oscillation of half a period t_c, whose energy is told to (π Δt/t_c)²/12."""
    before, dt = anew(run, gravity=0.0, material={"friction": 0.0, "restitution": 1.0}), 2e-5
    mass, stiff, speed = 1319.0 * 4.0 / 3.0 * np.pi * RADIUS**3, YOUNG / 2.0 / (1.0 - 0.28**2), 2.0
    lasts = 2.87 * (mass**2 / (RADIUS * stiff**2 * speed)) ** 0.2
    bound, apart = before["kinetic"] * (np.pi * dt / lasts) ** 2 / 12.0, 0
    for _ in range(100):
        run.advance(STEPS // 100)
        if run.observe()["elastic"][0] == 0.0:
            apart += 1
            assert together(run)["kinetic"] == pytest.approx(before["kinetic"], abs=bound)
    assert apart > 20


@pytest.mark.slow
def test_a_run_with_grains_aboard_goes_on_bit_for_bit(run):
    anew(run)
    run.advance(1500)
    kept = run.state()
    run.advance(1500)
    whole = run.state()
    run.restore(kept)
    run.advance(1500)
    again = run.state()
    for name, values in whole.items():
        np.testing.assert_array_equal(values, again[name], err_msg=name)


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"parts": (Part(((0.0, 1.0), (0.1, 1.0))),)}, "does not float free"),
        ({"more_tanks": (Tank(ROOM, THICKNESS, aboard=7),)}, "does not float free"),
        ({"motions": [[Sway(0.1, 1.0)]]}, "needs all other tanks at rest"),
        ({"more_tanks": (Tank(ROOM, THICKNESS, (2,), aboard=0),)}, "must be closed"),
        ({"more_tanks": (Tank(ROOM, 2.0 * THICKNESS, aboard=0),)}, "as thick as"),
        ({"more_tanks": (Tank(ROOM, THICKNESS, aboard=0), Tank(ROOM, THICKNESS, aboard=1))}, "the same one"),
        ({"integrator": "gear"}, "verlet"),
    ],
)
def test_what_cannot_be_aboard_is_refused(changes, says):
    with pytest.raises(Unavailable, match=says):
        Simulation(dry(**changes), PLACES, 1)


def test_a_scene_that_is_refused_as_it_is_made_leaves_the_next_one_alone():
    with pytest.raises(Unavailable):
        Simulation(dry(more_tanks=(Tank(ROOM, THICKNESS, aboard=7),)), PLACES, 1)
    empty = Simulation(Scene(box(1.0, 1.0), motions=[[Sway(0.1, 1.0)]], step=1e-3), threads=1)
    empty.advance(10)
    assert empty.time == pytest.approx(0.01)
    empty.close()
