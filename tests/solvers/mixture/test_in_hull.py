"""Grains in the water in a hull that floats: momentum of all three, and what they do in a tank at rest."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest

from lab.studies.verify.wet.scenes import SIZE, SPACING
from solvers.fluid.timestep import longest_pace
from solvers.machine.errors import Unavailable
from solvers.simulation import Simulation
from tests.oracles.aboard import masses, together
from tests.oracles.water import GRAVITY
from tests.oracles.wet_hull import NEVER, PACE, PLACES, WALL, WIDE, in_hull, in_tank, run_of

RATE = 2.0  # rad/s


@pytest.fixture(scope="module")
def run() -> Iterator[Simulation]:
    """A hull that floats with grains that sink in the water in her, and a hole through which more flows in."""
    made = run_of(*in_hull(places=PLACES - [0.0, 0.06]))
    made.advance(made.whole(round(0.05 / made.dt)))
    yield made
    made.close()


def momentum(run: Simulation) -> np.ndarray:
    """Momentum (2,) N s of water, hull and grains half a step ago, with what of it is on its way.

    Grains are ahead of the water by half a step of their lift, and the hull has yet to take what they pushed.
    """
    p, hold = run.water.particles, run.parts.bodies.hold
    mass, *velocity = (values[0] for values in p.read(p.mass, *p.velocity))
    pending = hold.gathered.to_numpy()[0] - 0.5 * (hold.every - 1) * run.dt * hold.former.to_numpy()[0]
    of_water = run.scene.thickness * np.array([mass @ along for along in velocity])
    lift = [field.to_numpy()[0, : len(masses(run))].sum() for field in run.grains.mover.water.lift]
    ahead = 0.5 * run.exchange_interval * run.dt * np.array(lift)
    return of_water + together(run)["momentum"] + pending[:2] - ahead


@pytest.mark.slow
def test_what_water_and_grains_and_hull_gain_together_is_their_weight_less_what_the_tank_bears(run):
    """To 1e-12 of Σ|F|Δt, as she rolls, water runs in, and grains sink to her floor."""
    start = run.state()
    run.parts.bodies.velocity[2].from_numpy(np.full((1, 1), RATE))
    first, began, given, pushed, dragged, pressed = momentum(run), run.time, np.zeros(2), 0.0, 0.0, 0.0
    mass = run.scene.thickness * run.water.particles.read(run.water.particles.mass)[0][0].sum()
    weight, step = GRAVITY * (mass + together(run)["mass"]), run.exchange_interval * run.dt
    begun = run.observe()["room_water"][0, 0]
    for _ in range(600):
        run.advance(run.exchange_interval)
        of_water, of_grains = (
            np.stack([field.to_numpy()[0, :3] for field in load.instant[:2]], axis=-1)
            for load in (run.water.load, run.grains.load)
        )
        given += step * of_water[0]  # on the tank of water
        pushed += step * (np.abs(of_water).sum() + np.abs(of_grains).sum())
        dragged += sum(np.abs(field.to_numpy()).sum() for field in run.grains.mover.water.impulse)
        pressed += step * np.abs(of_grains).sum()
    fell = np.array([0.0, weight * (run.time - began)])
    off, entered = momentum(run) - first + given + fell, run.observe()["room_water"][0, 0] - begun
    turned = abs(run.parts.bodies.place[2].to_numpy()[0, 0])
    run.restore(start)
    assert np.abs(off).max() < 1e-12 * pushed
    assert dragged > 1e-6 * pushed and pressed > 0.0 and entered > 0.0 and turned > 0.05  # else nothing was tried


@pytest.mark.slow
def test_a_run_goes_on_from_its_state_bit_for_bit(run):
    kept, found = run.state(), []
    for _ in range(2):
        run.restore(kept)
        run.advance(run.whole(round(0.05 / run.dt)))
        found.append(run.state())
    for name, values in found[0].items():
        np.testing.assert_array_equal(values, found[1][name], err_msg=name)


def fallen(scene_and_places: tuple, lasts: float = 0.25) -> tuple[np.ndarray, np.ndarray]:
    """How far (n, 2) m grains have gone in a tank, or in a hull, and their last speeds downwards (n,) m/s there."""
    scene, places = scene_and_places
    run = run_of(scene, places)
    run.advance(run.whole(round(lasts / run.dt)))
    found = run.snapshot()
    run.close()
    return (found["position"] - places)[0], -found["velocity"][0, :, 1]


@pytest.mark.slow
def test_grains_sink_in_a_hull_as_in_a_tank_at_rest():
    """In a hull that is held, and in one that floats."""
    (tank, fast), (held, of_held), (_, of_afloat) = (
        fallen(scene) for scene in (in_tank(), in_hull(release=NEVER, opens=NEVER), in_hull(opens=NEVER))
    )
    assert tank[:, 1].max() < -5.0 * SIZE
    np.testing.assert_allclose(held, tank, atol=0.01 * np.abs(tank).max())
    np.testing.assert_allclose(of_held, fast, rtol=0.01)
    np.testing.assert_allclose(of_afloat, fast, rtol=0.02)


@pytest.mark.slow
def test_a_scene_that_is_elsewhere_does_the_same():
    """To what rounding makes of it in 0.1 s, with the hole closed: about an open one a lattice has ties.

    Places that are off by 4e-16 m at 1.7 m make the pressure off by ρ c0² 5e-14 = 5e-9 Pa, and the water, 8 mm apart,
    by 3e-12 m after 0.1 s; here it may be a thousand times as much.
    """
    here, there = (fallen(in_hull(shift=shift, opens=NEVER), 0.1)[0] for shift in ((0.0, 0.0), (1.7, -0.4)))
    np.testing.assert_allclose(there, here, atol=3e-9)


@pytest.mark.slow
def test_water_on_the_other_side_of_a_thin_wall_does_not_act():
    """The wall is a spacing thick, and the kernel reaches four: grains beside it stay dry, and its water is clear."""
    height, off = np.array([0.02, 0.05, 0.08]), 0.5 * (WIDE - SIZE) - 1e-5
    places = np.stack([np.array([-off, off, -off]), height], axis=-1)[None]
    scene, places = in_hull(release=NEVER, opens=NEVER, deep=0.0, places=places)
    run = run_of(scene, places)
    run.advance(run.exchange_interval)
    near = np.abs(run.snapshot()["water_position"][0, :, 0]) < 0.5 * WIDE + WALL + SPACING
    lift = [np.abs(field.to_numpy()).max() for field in run.grains.mover.water.lift]
    porosity = run.snapshot()["water_porosity"]
    run.close()
    assert near.any() and lift == [0.0, 0.0] and porosity.min() == 1.0


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"fixed": np.array([[0.0, 0.1, 0.002]])}, "take out the fixed grains"),
        ({"inside": 1e-3}, "have a room's corners"),
    ],
)
def test_what_cannot_get_wet_in_a_hull_is_refused(changes, says):
    scene, places = in_hull()
    if "fixed" in changes:
        scene = scene.holding(replace(scene.grains, fixed=changes["fixed"]))
    else:
        [tank] = scene.more_tanks
        scene = replace(scene, more_tanks=(replace(tank, outline=tank.outline * (1.0 - changes["inside"])),))
    with pytest.raises(Unavailable, match=says):
        Simulation(scene, places, 1)


def test_steps_of_the_water_suit_the_hull():
    """Half a collision of the grains at most, as for dry ones."""
    scene, _ = in_hull()
    assert longest_pace(scene, scene.time_step()) == PACE
