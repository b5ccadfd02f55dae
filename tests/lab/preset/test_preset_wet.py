"""Grains in water, as presets give them: what cannot be is refused in one sentence with key and remedy."""

import numpy as np
import pytest

from lab.assembly.scene import build
from lab.base.errors import LabError
from lab.preset.find import load

WET = "wet/sway"


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        (
            {"water.spacing": "6 mm"},
            "water.spacing: 6 mm is under two grains' diameters; the water is a mean over many grains: take at least "
            "8 mm.",
        ),
        (
            {"water.spacing": "auto"},
            "water.spacing: 2.25 mm is under two grains' diameters; the water is a mean over many grains: take at "
            "least 8 mm.",
        ),
        ({"tank.roughness": "4 mm"}, "tank.roughness: grains in water are not computed over a rough lining yet; "),
        (
            {"tank.thickness": "3 mm"},
            "tank.thickness: 3 mm is less than the grains' mean diameter; in water the slab is a layer of whole "
            "grains: take at least 4 mm.",
        ),
        (
            {"grains.true_size": "5 mm"},
            "grains.true_size: 5 mm is more than the grains' own diameter, 4 mm; a computed grain stands for smaller "
            "ones: take less, or leave it out.",
        ),
        (
            {"water.depth": False, "water.radius": "20 mm", "water.centre": ["0 mm", "80 mm"]},
            "water.radius: water between grains starts level and at rest; give water.depth.",
        ),
        (
            {"contact.cohesion": "bridge", "material.bridge_volume": "0.01 mm^3"},
            "contact.cohesion: grains in water are not computed with bridges yet; ",
        ),
        ({"water.shifting": "delta-plus"}, "water.shifting: grains in water are not computed with shifted particles "),
        (
            {"parts.gate.points": [["0 mm", "0 mm"], ["0 mm", "160 mm"]]},
            "parts.gate: grains in water are not computed round what holds water back; set parts.gate.sieve = true for "
            "a plate that holds grains alone, or leave it out.",
        ),
        ({"air.density": "1.2 kg/m^3"}, "air: grains in water are not computed with air yet; "),
    ],
)
def test_errors_name_key_and_remedy(changes, sentence):
    """Each in one sentence."""
    with pytest.raises(LabError) as error:
        load(WET, changes)
    assert str(error.value).startswith(sentence)
    assert str(error.value).count(". ") == 0


@pytest.mark.parametrize(("name", "key"), [("tilting/quick", "grains.true_size"), ("sloshing/quick", "water.drag")])
def test_keys_of_wet_cargo_need_both(name, key):
    """A bed without water has no true size, and water without grains no drag."""
    with pytest.raises(LabError, match=rf"^{key}: goes with "):
        load(name, {key: "1 mm" if key.endswith("size") else "ergun"})


def test_a_sieve_goes_with_grains_in_water():
    """A plate in water alone holds the water, or it is none."""
    gate = {"parts.gate.points": [["0 mm", "0 mm"], ["0 mm", "160 mm"]], "parts.gate.sieve": True}
    with pytest.raises(LabError, match=r"^parts\.gate\.sieve: goes with grains in the water of their tank; "):
        load("sloshing/quick", gate)
    scene, _ = build(load(WET, gate).resolved)
    assert scene.parts[0].sieve


def test_a_ship_in_her_own_weight_alone_is_refused():
    """The water of the preset is not yet that which the bed leaves, so that her mass is not known."""
    with pytest.raises(LabError, match=r"^ship\.bare: grains in water are not computed in a ship whose centre "):
        load("ship/slurry", {"ship.bare": True, "ship.roll_period": False, "ship.gyradius": "130 mm"})


def test_water_that_enters_a_hold_of_grains_waits_at_first():
    """The hold has room for as many particles as would fill it without grains, and none is in it at the start."""
    scene, _ = build(load("ship/coal-hatch").resolved)
    assert scene.mixture and not scene.fluid.present.any()
    assert scene.fluid.count == scene.fluid.waiting[0]


def test_the_water_between_the_grains_is_as_much_as_they_leave():
    """The scene has about as many particles as fill the tank up to the level less the grains, to a tenth."""
    preset = load(WET).resolved
    scene, position = build(preset)
    spheres = np.pi / 6.0 * 0.004**3 * position.shape[1] / 0.004
    assert scene.mixture.level == pytest.approx(0.09)
    assert scene.fluid.count * scene.fluid.water.spacing**2 == pytest.approx(0.3 * 0.09 - spheres, rel=0.1)
