"""Grains in water, as presets give them: what cannot be is refused in one sentence with key and remedy."""

import re
from dataclasses import asdict

import numpy as np
import pytest

from lab.assembly.scene import build
from lab.base.errors import LabError
from lab.preset.find import load
from lab.preset.sections.wet.states import state
from solvers.mixture.start import Laying

WET = "wet/sway"
NEW = {"water.moisture": False}  # of a preset that has one


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
            "water.radius: water between grains starts level and at rest; give water.depth, moisture or saturation.",
        ),
        (
            {"contact.cohesion": "bridge", "material.bridge_volume": "0.01 mm^3"},
            "contact.cohesion: this water fills 238 % of the pores, so that no grain has bridges; leave this out",
        ),
        (
            {"water.depth": False, "water.moisture": "5 %"},
            "water.moisture: 5 % fills the bed up to 9.959 mm, less than two kernel radii, 64 mm; "
            "take at least 28.1 %, or a smaller water.spacing.",
        ),
        (
            {"water.depth": False, "water.saturation": "20 %"},
            "water.saturation: 20 % fills the bed up to 11.33 mm, less than two kernel radii, 64 mm; take "
            "at least 130.4 %",
        ),
        (
            {"water.depth": False, "water.moisture": "80 %"},
            "water.moisture: with 80 % the water would stand 356.3 mm high in a tank of 160 mm; take less, or ",
        ),
        (
            {"water.moisture": "30 %"},
            "water.moisture: give exactly one of depth, moisture and saturation (got depth and moisture).",
        ),
        (
            {"water.depth": False, "water.moisture": "30 %", "water.saturation": "90 %"},
            "water.moisture: give exactly one of depth, moisture and saturation (got moisture and saturation).",
        ),
        ({"water.moisture": "100 %"}, "water.moisture: must be less than 1"),
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


def test_the_colour_of_pores_needs_both():
    """Water alone has no porosity, and a wet bed has."""
    with pytest.raises(LabError, match=r"^video\.colour: porosity is of water between grains; add \[grains\] and "):
        load("sloshing/quick", {"video.colour": "porosity"})
    assert load(WET, {"video.colour": "porosity"}).resolved.video.colour == "porosity"


def test_a_share_of_water_needs_grains():
    """Water alone has a depth."""
    for key in ("moisture", "saturation"):
        with pytest.raises(LabError, match=rf"^water.{key}: goes with grains in the water's tank; add "):
            load("sloshing/quick", {"water.depth": False, f"water.{key}": "30 %"})


def test_the_share_that_an_error_asks_for_fits():
    """As it is told, and a tenth of a per cent less does not."""
    changes = {"water.depth": False, "water.spacing": "8 mm"}
    with pytest.raises(LabError) as error:
        load(WET, changes | {"water.moisture": "5 %"})
    least = float(re.search(r"at least ([\d.]+) %", str(error.value))[1])
    assert 25.0 < least < 35.0
    assert load(WET, changes | {"water.moisture": f"{least} %"}).resolved.wet


@pytest.mark.parametrize("share", [{"water.moisture": "30 %"}, {"water.saturation": "90 %"}, {"water.saturation": 2.0}])
def test_the_three_ways_to_say_how_wet_a_bed_is_agree(share):
    """The moisture, saturation and depth of a state are each the same state."""
    wet = state(load("wet/sand", NEW | share).resolved)
    for key in ("moisture", "saturation"):
        again = state(load("wet/sand", NEW | {f"water.{key}": getattr(wet, key)}).resolved)
        assert asdict(again) == pytest.approx(asdict(wet), rel=1e-6)
    deep = state(load("wet/sand", NEW | {"water.depth": f"{wet.level} m"}).resolved)
    assert asdict(deep) == pytest.approx(asdict(wet), rel=1e-6)


def test_the_sand_of_the_source_is_full_at_a_quarter():
    """Grains of 2650 kg/m³ at 1386 kg/m³ in bulk are full at 25.6 % of the whole mass (own, by hand)."""
    wet = state(load("wet/sand").resolved)
    assert wet.dry == pytest.approx(1386.0, rel=5e-3)
    assert wet.free == pytest.approx(51e-3, abs=1e-3) and wet.bed == pytest.approx(115e-3, abs=1e-3)
    full = state(load("wet/sand", {"water.moisture": "25.6 %"}).resolved)
    assert full.saturation == pytest.approx(1.0, abs=0.01)
    drained = state(load("wet/sand", {"water.moisture": "25 %"}).resolved)
    assert drained.free == 0.0 and 2e-3 < drained.bed - drained.level < 6e-3


def test_a_moisture_is_exact_in_each_bed():
    """Of grains that scatter in size, and of two kinds, m_w = M/(1 − M) m_g in every world, to rounding."""
    changes = {
        "water.depth": False,
        "water.moisture": "30 %",
        "water.spacing": "9 mm",
        "grains.spread": 0.1,
        "kinds.heavy.share": 0.3,
        "kinds.heavy.density": "5000 kg/m^3",
        "run.repeats": 2,
    }
    scene, _ = build(load(WET, changes).resolved)
    volume, thickness = 4.0 / 3.0 * np.pi * scene.grains.radius**3, scene.tanks[0].thickness
    grains = (volume * scene.grains.density).sum(axis=1)
    water = scene.fluid.particles["volume"].sum(axis=1) * scene.fluid.water.density * thickness
    assert grains[0] != pytest.approx(grains[1], rel=1e-4)
    assert water == pytest.approx(0.3 / 0.7 * grains, rel=1e-12)


def test_a_saturation_is_of_the_pores_of_the_settled_bed():
    """Of a lattice of known depth, half its pores are laid, and in its lower half; a loose bed takes more than a dense.

    Laid water is as deep as the pores it fills, to a row of particles.
    """
    scene, _ = build(load("wet/sand", NEW | {"water.saturation": "70 %"}).resolved)
    size, columns = 4e-3, 75
    for apart in (1.0, 1.1):
        lines = -(-scene.grains.count // columns)
        z = (0.5 + apart * np.arange(lines)) * size
        place = np.stack(np.meshgrid((np.arange(columns) - 37.0) * size, z, indexing="ij"), axis=-1).reshape(-1, 2)
        place = place[np.argsort(place[:, 1], kind="stable")][: scene.grains.count][None]
        drops = Laying(scene).particles(place)[0]
        deep = 2.0 * place[0, :, 1].mean()
        pores = 0.3 * deep - scene.grains.count * np.pi / 6.0 * size**3 / 4.39e-3
        assert (drops["volume"] * (1.0 + drops["deviation"])).sum() == pytest.approx(0.7 * pores, rel=1e-6)
        assert drops["position"][:, 1].max() == pytest.approx(0.7 * deep, abs=8e-3)


def test_the_water_between_the_grains_is_as_much_as_they_leave():
    """The scene has about as many particles as fill the tank up to the level less the grains, to a tenth."""
    preset = load(WET).resolved
    scene, position = build(preset)
    spheres = np.pi / 6.0 * 0.004**3 * position.shape[1] / 0.004
    assert scene.mixture.level == pytest.approx(0.09)
    assert scene.fluid.count * scene.fluid.water.spacing**2 == pytest.approx(0.3 * 0.09 - spheres, rel=0.1)
