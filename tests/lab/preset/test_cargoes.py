"""The cargo library: every number has a unit and a source, all agree, and presets are filled."""

import tomllib
from math import radians, tan

import pytest

import cargolab
from lab.base.errors import LabError
from lab.preset.cargo.cargoes import FOLDER, cargo_named, cargo_of, library, own_cargo
from lab.preset.cargo.numbers import QUANTITIES
from lab.preset.find import load
from lab.report.cargo.sources import described
from solvers.bulk.given import Bulk

ASKED = {
    *("soybeans", "wheat", "maize", "barley", "rice", "coal", "iron-ore-fines", "iron-ore-pellets", "bauxite"),
    *("nickel-ore", "sulphide-concentrates", "sugar", "urea"),
}
BOX, HOLD = "imsbc/tilting-box-quick", "bulk/box-quick"
MINE = """
title = "Linseed"
[density]
range = ["1100 kg/m^3", "1200 kg/m^3"]
source = "our laboratory, sample 7"
[repose]
value = "25 deg"
source = "our laboratory, tilting box"
[stowage]
value = "1.5 m^3/t"
source = "the charterer"
"""


def raw() -> dict:
    return tomllib.loads((FOLDER / "cargoes.toml").read_text(encoding="utf-8"))


def test_the_cargoes_of_the_naval_desk_are_there_under_their_other_names_too():
    assert library().keys() >= ASKED
    assert cargo_named("Copper concentrate").name == "sulphide-concentrates" and cargo_named("corn").name == "maize"
    names = [name for cargo in library().values() for name in (cargo.name, *cargo.also)]
    assert len(names) == len(set(names))


def test_every_number_is_written_with_a_unit_and_has_a_source_that_is_used():
    sources = tomllib.loads((FOLDER / "sources.toml").read_text(encoding="utf-8"))["sources"]
    used = set()
    for table in raw().values():
        used |= {table.get("code_source"), *(source for _, source in table.get("notes", ()))}
        for name in table.keys() & QUANTITIES.keys():
            for row in table[name]:
                used.add(row["source"])
                texts = [*row.get("range", ()), *([row["value"]] if "value" in row else [])]
                assert texts and all(text.endswith(QUANTITIES[name].unit) for text in texts), (name, row)
    assert used - {None} == sources.keys()


def test_ranges_are_ordered_and_stowage_factor_times_bulk_density_is_one_within_them():
    both = 0
    for cargo in library().values():
        assert all(one.low <= one.value <= one.high for known in cargo.numbers.values() for one in known)
        for stowage in cargo.numbers.get("stowage", ()):
            for bulk in cargo.numbers.get("bulk_density", ()):
                assert stowage.low * bulk.low <= 1.0 <= stowage.high * bulk.high, (cargo.name, bulk)
                both += 1
    assert both >= 8


def test_a_preset_with_a_cargo_has_its_numbers_and_keeps_its_own_size_and_stiffness():
    plain, made = load(BOX).resolved, load(BOX, {"grains.cargo": "soybeans"}).resolved
    soy = library()["soybeans"]
    assert made.material.density == pytest.approx(soy.number("density").value) and made.material.restitution == 0.6
    assert made.grains.stands_for == pytest.approx(soy.number("diameter").value)
    assert made.grains.diameter == plain.grains.diameter and made.material.young == plain.material.young
    assert made.material.density != plain.material.density


def test_own_keys_win_beside_the_cargo_above_it_and_not_below_it(tmp_path):
    beside = load(BOX, {"grains.cargo": "soybeans", "material.density": "1300 kg/m^3"}).resolved
    assert beside.material.density == 1300.0
    heir = tmp_path / "heir.toml"
    heir.write_text(f'based_on = "{BOX.removesuffix("-quick")}"\ngrains.cargo = "wheat"\nmaterial.friction = 0.7\n')
    assert load(heir).resolved.material.density == 1220.0
    assert load(heir).resolved.material.friction == 0.7
    assert load(heir, {"material.density": "900 kg/m^3"}).resolved.material.density == 900.0
    assert load(heir, {"grains.cargo": False}).resolved.material.density == 1400.0


def test_the_text_of_a_filled_preset_says_its_numbers_and_reads_as_the_same(tmp_path):
    loaded = load(BOX, {"grains.cargo": "wheat"})
    again = tmp_path / "again.toml"
    again.write_text(loaded.given_text)
    assert "1220 kg/m^3" in loaded.given_text
    assert load(again).resolved.material == loaded.resolved.material


def test_the_size_of_the_grains_is_filled_where_none_is_given(tmp_path):
    preset = load(BOX).given_text.replace('diameter = "9.5 mm"\n', "")
    (tmp_path / "box.toml").write_text(preset)
    with pytest.raises(LabError, match=r"grains\.diameter: missing"):
        load(tmp_path / "box.toml")
    made = load(tmp_path / "box.toml", {"grains.cargo": "maize"}).resolved
    assert made.grains.diameter == pytest.approx(7.1e-3) and made.grains.stands_for is None


def test_spheres_and_discs_have_their_own_friction():
    spheres = load("space/tilting-box-quick", {"grains.cargo": "soybeans"}).resolved
    soy = library()["soybeans"]
    assert spheres.material.friction == soy.number("friction", "space").value == 0.45
    assert spheres.material.rolling_friction == soy.number("rolling_friction", "space").value == 0.05


def test_rolling_friction_brings_its_laws_where_none_are_given_and_is_said_to_do_nothing_without(tmp_path):
    soy = library()["soybeans"]
    plain = tmp_path / "plain.toml"
    plain.write_text('based_on = "tilting/quick"\ngrains.cargo = "soybeans"\n')
    made = load(plain).resolved
    assert made.material.rolling_friction == soy.number("rolling_friction", "plane").value
    assert (made.contact.tangential, made.contact.rolling) == ("cundall-strack", "constant-torque")
    without = load(plain, {"contact.rolling": "none"}).resolved
    assert without.contact.rolling == "none"
    assert "does nothing" in dict(described(without))["contact.rolling"]


def test_bulk_takes_density_and_repose_in_place_of_another_friction():
    made = load(HOLD, {"bulk.cargo": "maize"}).resolved.bulk
    assert made.density == pytest.approx(0.5 * (709.5 + 746.0)) and made.slow_friction == pytest.approx(
        tan(radians(26))
    )
    assert made.diameter == pytest.approx(7.1e-3)
    own = load(HOLD, {"bulk.cargo": "maize", "bulk.friction": 0.4}).resolved.bulk
    assert own.slow_friction == 0.4 and own.density == made.density
    by_stowage = load(HOLD, {"bulk.cargo": "coal"}).resolved.bulk
    assert by_stowage.density == pytest.approx(1e3 / 1.3, rel=1e-4)


def test_explain_says_where_each_number_is_from_and_which_the_preset_replaces():
    rows = dict(described(load(BOX, {"grains.cargo": "wheat", "material.density": "1300 kg/m^3"}).resolved))
    assert rows["material.density"].startswith("1300 kg/m^3, the preset's own, not 1190 to 1250 kg/m^3")
    assert "Karimi" in rows["material.density"] and rows["grains.cargo"].startswith("Wheat, Grain Code")
    assert described(load(BOX).resolved) == []
    assert "Cargo" in cargolab.explain(BOX, grains__cargo="wheat")


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("soybeens", r'^grains\.cargo: there is no cargo "soybeens"; did you mean soybeans\?$'),
        ("iron ore fine", r"did you mean iron-ore-fines"),
        ("qqqq", r"`cargolab cargoes` lists them"),
        ("none.toml", r"^grains\.cargo: none\.toml cannot be read"),
    ],
)
def test_an_unknown_cargo_gets_one_sentence_with_near_names(name, said):
    with pytest.raises(LabError, match=said) as caught:
        load(BOX, {"grains.cargo": name})
    assert "\n" not in str(caught.value)


def test_a_cargo_of_ones_own_lies_beside_the_preset_that_names_it(tmp_path):
    (tmp_path / "linseed.toml").write_text(MINE)
    preset = tmp_path / "mine.toml"
    preset.write_text(f'based_on = "{HOLD.removesuffix("-quick")}"\nbulk.cargo = "linseed.toml"\n')
    made = load(preset).resolved
    assert made.bulk.density == pytest.approx(1e3 / 1.5, rel=1e-5)
    assert made.bulk.cargo == str(tmp_path / "linseed.toml")
    assert "our laboratory, tilting box" in dict(described(made))["bulk.repose"]
    (tmp_path / "linseed.toml").unlink()
    assert "cannot be looked up" in dict(described(made))["bulk.cargo"]
    assert list(cargolab.cargoes("wheat")) == ["wheat"]


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        (MINE.replace('source = "the charterer"', ""), "stowage: source: missing"),
        (MINE.replace("1.5 m^3/t", "1.5 m"), r"stowage\.value: .*a stowage factor"),
        (MINE.replace("1.5 m^3/t", "150 m^3/t"), "stowage factor must be from"),
        (MINE.replace('"1100 kg/m^3", "1200 kg/m^3"', '"1200 kg/m^3", "1100 kg/m^3"'), "the smaller number goes first"),
        (MINE.replace("[repose]", "[reposes]"), 'unknown key "reposes"; did you mean repose?'),
        (MINE + '[bulk_density]\nvalue = "900 kg/m^3"\nsource = "us"', "no stowage factor in its range"),
        (MINE + '[friction]\nvalue = "0.5"\nsource = "us"', 'axes = "plane" or "space" is needed'),
        (MINE.replace('title = "Linseed"', ""), "title: missing"),
        ('notes = "damp"\n' + MINE, r"notes: a list of \[text, source\]"),
        ("also = 3\n" + MINE, "also: a list of names"),
        ("title = ", "not valid TOML"),
    ],
)
def test_a_mistake_in_a_cargo_file_gets_one_sentence(tmp_path, wrong, said):
    (tmp_path / "mine.toml").write_text(wrong)
    with pytest.raises(LabError, match=said) as caught:
        own_cargo(tmp_path / "mine.toml")
    assert "mine.toml" in str(caught.value) and "\n" not in str(caught.value)


def test_a_bed_denser_than_its_grains_is_refused():
    with pytest.raises(LabError, match="denser than its grains"):
        cargo_of("x", {"title": "x", "density": _one("900 kg/m^3"), "bulk_density": _one("950 kg/m^3")}, "x.toml")


def _one(value: str) -> dict:
    return {"value": value, "source": "nobody"}


def test_the_scene_of_filled_bulk_has_the_cargos_numbers():
    from lab.assembly.scene import build

    bulk = build(load(HOLD, {"bulk.cargo": "maize"}).resolved)[0].of(Bulk)
    assert bulk.material.friction == pytest.approx(tan(radians(26.0)))
