"""`cargolab.Preset`: checked whenever it changes, the same whatever it is made from, unchanged by what is refused."""

import tomllib

import numpy as np
import pint
import pytest

import cargolab

UNITS = pint.UnitRegistry()


@pytest.fixture
def preset():
    return cargolab.Preset("tilting/quick")


def test_a_name_a_table_a_text_and_a_file_make_the_same(preset, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    mine = preset.changed({"grains.diameter": "4 mm"})
    path = mine.save("mine.toml")
    of_table = cargolab.Preset({"based_on": "tilting/quick", "grains": {"diameter": 4 * UNITS.mm}})
    of_text = cargolab.Preset('based_on = "tilting/quick"\n[grains]\ndiameter = "4 mm"\n')
    base = cargolab.Preset({"based_on": "mine.toml"})  # a path of the working directory, whatever the file's place is
    for other in (cargolab.Preset(path), of_table, of_text, base, cargolab.Preset(mine)):
        assert other["grains.diameter"] == 0.004
        assert other.values.motion == mine.values.motion and other.values.material == mine.values.material
    assert preset["grains.diameter"] == 0.003  # a change makes another preset


@pytest.mark.parametrize(
    ("key", "given", "value"),
    [
        ("grains.diameter", 4 * UNITS.mm, 0.004),
        ("grains.diameter", 0.4 * UNITS.cm, 0.004),
        ("motion.tilt.rate", 2 * UNITS.deg / UNITS.s, np.radians(2.0)),
        ("motion.tilt.rate", 0.5 * UNITS.rpm, np.pi / 60),
        ("material.density", 1.5 * UNITS.g / UNITS.cm**3, 1500.0),
        ("material.young", 30 * UNITS.MPa, 30e6),
        ("material.friction", UNITS.Quantity(0.3), 0.3),
        ("material.friction", np.float32(0.25), 0.25),
        ("material.friction", 40 * UNITS.percent, 0.4),
    ],
)
def test_quantities_of_any_registry_and_numbers_of_numpy_are_values(preset, key, given, value):
    preset[key] = given
    assert preset[key] == pytest.approx(value, rel=1e-12)
    assert preset.quantity(key).magnitude == preset[key]


def test_a_list_of_quantities_is_one_of_texts(preset):
    preset["motion.tilt.centre"] = UNITS.Quantity([1.0, 20.0], "mm")
    assert preset["motion.tilt.centre"] == (0.001, 0.02)


@pytest.mark.parametrize(
    ("key", "value", "said"),
    [
        ("grains.diametre", "3 mm", r"grains\.diametre: unknown key; did you mean 'diameter'"),
        ("grains.diameter", 3, r"grains\.diameter: 3 has no unit"),
        ("grains.diameter", 3 * UNITS.s, r"grains\.diameter: .* is a time, but mm"),
        ("grains.diameter", "-3 mm", r"grains\.diameter: must be greater than 0"),
        ("material.friction", 3 * UNITS.candela, r"candela"),
        ("quick", {}, r"quick: cannot be overridden"),
    ],
)
def test_what_is_refused_changes_nothing(preset, key, value, said):
    before = preset.text
    with pytest.raises(cargolab.Error, match=said):
        preset[key] = value
    assert preset.text == before
    preset["material.friction"] = 0.31  # and it goes on as if nothing had been
    with pytest.raises(cargolab.Error, match=r"grains\.x: unknown key"):
        preset["grains.x"]


@pytest.mark.parametrize("given", ["title = 'x'\n[grains", {"grains": 3}, {}, "no/such", "a = 1"])
def test_what_is_no_preset_is_refused_in_one_sentence(given):
    with pytest.raises(cargolab.Error) as refused:
        cargolab.Preset(given)
    assert len(str(refused.value).splitlines()) == 1
    assert refused.value._render_traceback_() == [f"{type(refused.value).__name__}: {refused.value}"]


def test_it_says_what_its_keys_take_and_which_it_sets(preset):
    told = preset.schema("grains.diameter")
    assert (told["unit"], told["usual"], told["range"]) == ("m", "mm", "above 0")
    assert "grains.diameter" in set(preset.keys()) and "grains.count" not in set(preset.keys())
    assert preset.schema()["properties"]["title"]["type"] == "string"
    assert tomllib.loads(preset.text)["title"] == preset.title


def test_its_cost_grows_with_its_beds_and_its_duration(small):
    one = small.cost()
    more = small.changed(run__repeats=6, motion__tilt__hold="1.5 s").cost()
    assert one.particles == 32 and more.particles == 96
    assert more.memory == pytest.approx(3.0 * one.memory, rel=0.01)
    assert more.steps - one.steps == pytest.approx(1.0 / one.step, rel=0.01)
    assert more.total > one.total > 0.0
    few, many = (small.changed(run__repeats=n, run__threads=1).cost().seconds["of steps"] for n in (2, 8))
    assert many > 2.0 * few  # on one core; to observe all beds costs the same
