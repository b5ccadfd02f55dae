"""Tanks of water in a ship: what may be said of them, and where their water is."""

import numpy as np
import pytest

from lab.assembly.scene import build
from lab.assembly.water import water_aboard
from lab.base.errors import LabError
from lab.paint.water.basins import basins_of
from lab.preset.find import load
from lab.studies.reproduce.ships.coupled import linear_response, peaks
from solvers.ship.potential.springs import BoxLiquid

TWO, BOTH = "ship/barge-two-levels", "ship/ballast-and-grain"
COARSE = {"water.spacing": "38 mm"}


@pytest.mark.parametrize(
    ("name", "changes", "words"),
    [
        (TWO, {"tanks.deep.place": ["0.3 m", "300 mm"]}, "tanks.deep.place: the tank stands out of the hull"),
        (TWO, {"tanks.deep.depth": "560 mm"}, "tanks.deep.depth: 560 mm is not less than the tank's height"),
        (TWO, {"tanks.deep.width": False}, "tanks.deep.width: missing"),
        (TWO, {"tank.length": "4 m"}, "tank.length: the hold is longer than the ship, 2.546 m"),
        (TWO, {"ship.length": False}, "ship.length: missing; the hold has a length"),
        (TWO, {"ship.damping": 0.1}, "ship.linear_damping: give either"),
        (TWO, {"ship.gyradius": False, "ship.roll_period": "1 s"}, "ship.roll_period: is that of ship and cargo"),
        (TWO, {"air.density": "1.2 kg/m^3"}, "air: air in a ship's tanks is not computed yet"),
        (BOTH, {"water.depth": "20 mm"}, "tanks: grains in water are not computed beside further tanks yet"),
        ("sloshing/quick", {"water.model": "linear"}, 'water.model: "linear" is for tanks in a ship'),
        ("sloshing/quick", {"tank.length": "1 m"}, "tank.length: is that of a hold in a ship"),
    ],
)
def test_errors_name_key_and_remedy(name, changes, words):
    """Each in one sentence."""
    with pytest.raises(LabError, match="^" + words.replace("(", r"\(")):
        load(name, changes)


def test_each_tank_has_its_water():
    """In its place and its numbers; by the particles' volumes a picture finds which are in which tank."""
    preset = load(TWO, COARSE).resolved
    scene, _ = build(preset)
    first, second = scene.fills
    drops = scene.fluid.particles[0]
    assert first + second == len(drops)
    assert drops["position"][:first, 1].max() < 0.19 < 0.37 < drops["position"][first:, 1].max() < 0.39
    assert drops["volume"][:first].sum() == pytest.approx(0.8 * 0.19)
    assert drops["volume"][first:].sum() == pytest.approx(0.8 * 0.39)
    outline, volume = scene.outline, scene.fluid.particles["volume"]
    basins = basins_of(preset, outline, (), volume)
    assert [basin.drops for basin in basins] == [slice(0, first), slice(first, len(drops))]
    assert basins[1].drawn[:, 1].min() > basins[0].drawn[:, 1].max()  # one above the other


def test_a_bare_ship_floats_with_her_water():
    """Her draught is with the water, weight and centre are hers and the water's together."""
    preset = load("ship/barge-two-tanks", COARSE).resolved
    (vessel,) = build(preset)[0].vessels
    water = water_aboard(preset)
    length = preset.ship.length
    assert length * water.mass == pytest.approx(1000.0 * 0.5 * 0.8 * 0.19)
    assert length * vessel.ship.body.mass == pytest.approx(275.0, abs=0.1)
    hull = vessel.hull(water)
    assert length * hull.mass == pytest.approx(199.0, abs=0.1)
    assert hull.centre[1] == pytest.approx(0.14)
    assert hull.gyradius == pytest.approx(0.3704)


def test_barges_weights_agree_with_each_other():
    """40 kg near her centre, off or on, leave her moment of inertia as it is; with and without she floats as deep."""
    masses, moments = [], []
    for name in ("ship/barge-two-tanks", TWO):
        preset = load(name, COARSE).resolved
        (vessel,) = build(preset)[0].vessels
        hull = vessel.hull(water_aboard(preset))
        masses.append(preset.ship.length * hull.mass)
        moments.append(masses[-1] * hull.gyradius**2)
    assert masses[0] - masses[1] == pytest.approx(40.0, abs=0.1)
    assert moments[0] == pytest.approx(moments[1], rel=5e-3)


def test_linear_theory_gives_the_barge_two_peaks():
    """Below and above the first frequency of the water alone in a tank that stands still."""
    found = peaks(*linear_response(load("ship/barge-two-tanks", COARSE).resolved))
    (low, _), (high, _) = found
    alone = BoxLiquid(0.8, 0.19, 1000.0, 9.81).frequencies[0]
    assert alone == pytest.approx(4.94, abs=0.01)
    assert low < alone < high
    assert (low, high) == pytest.approx((4.026, 5.984), rel=0.03)  # the source's
    assert np.ptp([low, high]) > 1.0


def test_linear_theory_gives_the_barge_of_two_levels_three_peaks():
    """With the height of the tanks' floor that the other filling's peaks set."""
    found = [at for at, _ in peaks(*linear_response(load(TWO, COARSE).resolved))]
    assert found == pytest.approx([4.0, 5.25, 7.0], rel=0.03)  # the source's
