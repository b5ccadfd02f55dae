"""Bulk in several holds of a ship: what a preset may say of them, and what follows from it."""

import numpy as np
import pytest

from lab.assembly.scene import build, vessels
from lab.base.errors import LabError
from lab.naval import tables
from lab.naval.condition import condition, mass_of
from lab.paint.water.basins import basins_of
from lab.preset.find import load
from lab.preset.sections.bulk.beds import beds_of, over_first, slices
from solvers.bulk.given import Bulk

TWO, ONE = "ship/handysize-grain-bulk-two-holds-quick", "ship/handysize-grain-bulk-quick"


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"tanks.starboard.depth": False}, r"tanks\.starboard\.depth: missing; say how deep the bulk is in it"),
        ({"tanks.starboard.lid": False}, r"tanks\.starboard\.lid: bulk needs a closed tank"),
        ({"tanks.starboard.depth": "13 m"}, r"tanks\.starboard\.depth: 13 m is not less than the tank's height"),
        ({"tanks.starboard.depth": "1.5 m"}, r"bulk\.spacing: the bed in tanks\.starboard is 1\.5 m deep"),
        ({"tanks.starboard.friction": 0.2}, r"tanks\.starboard\.friction: unknown key"),
        ({"tanks.starboard.place": ["2 m", "1.6 m"]}, r"tanks\.starboard\.place: the tank stands out of the hull"),
        ({"bulk.spacing": "20 mm"}, r"bulk\.spacing: all tanks would have .* cells"),
        ({"bulk": False}, r"tanks\.starboard\.depth: goes with water or bulk"),
    ],
)
def test_what_cannot_be_is_refused_with_key_and_remedy(changes, said):
    with pytest.raises(LabError, match=said):
        load(TWO, changes)


def test_two_halves_are_the_whole_cut_in_two():
    """Mass, centre and inertia of the cargo that the ship starts with are those of the hold without the bulkhead."""
    found = []
    for name in (TWO, ONE):
        preset = load(name).resolved
        scene, _ = build(preset)
        bulk = scene.of(Bulk)
        assert sum(bulk.fill) == bulk.count and len(bulk.fill) == len(scene.tanks)
        place, mass = bulk.points["position"][0], bulk.points["mass"][0]
        found.append([mass.sum(), *(mass @ place / mass.sum()), mass @ (place**2).sum(axis=1), mass_of(preset)])
        assert mass_of(preset) == pytest.approx(mass.sum() * 25.0 / 130.7)
    assert found[0] == pytest.approx(found[1], rel=3e-3, abs=1e-6)


def test_a_longer_hold_counts_for_more():
    """Of the mass that a metre of her carries; the slabs are as they were."""
    preset = load(TWO, {"tanks.starboard.length": "50 m"}).resolved
    assert over_first(beds_of(preset)) == pytest.approx(1.5)
    assert mass_of(preset) == pytest.approx(1.5 * mass_of(load(TWO).resolved))


def test_each_tank_has_its_points():
    """A picture and a measure find them by their volumes."""
    preset = load(TWO, {"tanks.starboard.depth": "4 m"}).resolved
    scene, _ = build(preset)
    bulk = scene.of(Bulk)
    first, volume = bulk.fill[0], bulk.points["mass"] / 770.0
    assert bulk.fill[1] < 0.8 * first
    own = slices(beds_of(preset), volume[0])
    assert own == (slice(0, first), slice(first, bulk.count))
    assert bulk.points["position"][0, own[0], 0].max() < 0.0 < bulk.points["position"][0, own[1], 0].min()
    assert [basin.drops for basin in basins_of(preset, scene.outline, (), volume)] == list(own)


def test_the_grain_code_counts_each_hold_by_itself():
    """Both shift to one side, in one hold outwards. Halves of a box have a quarter of its moment, L b³/12 tan 25°."""
    preset = load(TWO).resolved
    found = condition(preset, vessels(preset)[0])
    port, starboard = found.stowed
    ways = [port.hold.volumetric_moment(port.volume, np.radians(surface)) for surface in (25.0, -25.0)]
    assert found.assumed_moment == pytest.approx(sum(ways), rel=1e-6)
    assert port.volume == pytest.approx(starboard.volume) and found.cargo.volume == pytest.approx(2.0 * port.volume)
    box = {
        "tank.outline": [["-10 m", "0 m"], ["0 m", "0 m"], ["0 m", "12.4 m"], ["-10 m", "12.4 m"]],
        "tanks.starboard.outline": [["0 m", "0 m"], ["10 m", "0 m"], ["10 m", "12.4 m"], ["0 m", "12.4 m"]],
    }
    preset = load(TWO, box).resolved
    moment = condition(preset, vessels(preset)[0]).assumed_moment
    assert moment == pytest.approx(0.25 * 20.0**3 / 12.0 * np.tan(np.radians(25.0)) * 25.0)


def test_tables_and_explanations_name_each_hold():
    preset = load(TWO).resolved
    written = tables.all_of(condition(preset, vessels(preset)[0]), [])
    assert {"hold", "hold-starboard"} <= set(written)
    assert len(written["hold"][1]) == len(written["hold-starboard"][1])
