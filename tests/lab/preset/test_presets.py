"""Presets: all of the lab's presets resolve; inheritance and overrides; every error is one sentence with its key."""

import tomllib
from dataclasses import dataclass, replace
from functools import cache
from importlib.resources import files
from shutil import copy
from typing import Annotated

import numpy as np
import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from lab.assembly.scene import build
from lab.base import toml
from lab.base.errors import LabError
from lab.preset import reader
from lab.preset.fields import walk
from lab.preset.find import QUICK, load, names
from lab.preset.merge import merged, nested
from lab.preset.outline import area, simple_polygon
from lab.preset.recorded import resolved_from, to_table
from lab.preset.schema import Preset, resolve
from solvers.machine.marks import Interval, Unit
from solvers.motion import MOTIONS, Tilt
from tests.oracles.presets import MATERIAL, error_of

NAMES = names()
# Quick variants say little that those have not that they are variants of.
OF_THEIR_OWN = [pytest.param(name, marks=pytest.mark.slow) if name.endswith(QUICK) else name for name in NAMES]
as_shipped = cache(load)  # a preset of the lab without changes, read once
MINIMAL = f"""
title = "a tank"
[tank]
width = "100 mm"
height = "100 mm"
[grains]
diameter = "3 mm"
depth = "30 mm"
{MATERIAL}
[run]
duration = "1 s"
"""


def minimal(**overrides) -> Preset:
    """The minimal preset with dotted keys (double underscores for dots) over it."""
    dotted = {key.replace("__", "."): value for key, value in overrides.items()}
    return resolve(merged(tomllib.loads(MINIMAL), nested(dotted)))


def fault(**overrides) -> str:
    return error_of(lambda: minimal(**overrides))


def write(folder, name: str, text: str) -> str:
    path = folder / name
    path.write_text(text)
    return str(path)


@pytest.mark.parametrize("name", NAMES)
def test_every_preset_of_the_lab_resolves_and_has_a_title_and_source(name):
    preset = as_shipped(name)
    assert preset.name == name
    said = preset.resolved
    assert said.title.strip() and said.source.strip() and said.reports.strip()
    moving = [motion.fastest(said.motion.soft_start) for motion in said.motion.parts.values()]
    moving += [part.fastest() for part in said.parts.values()]
    of_itself = said.ship or said.axle or said.bodies or said.openings or (said.bulk and said.bulk.region)
    assert (any(moving) or of_itself or said.water.region or said.water.flow) and said.duration > 0


def on_its_own(preset: Preset) -> Preset:
    """The preset as its given text has it, which holds all that it was based on."""
    return replace(preset, based_on="")


@pytest.mark.parametrize("name", OF_THEIR_OWN)
def test_given_text_is_the_same_preset(name, tmp_path):
    changes = {"grains.spread": "5 %", "material.dissipative_time": "1e-6 s"}
    preset = load(name, {"run.seed": 5, **(changes if as_shipped(name).resolved.grains else {})})
    folder = (files("presets") / name).parent
    for table in (*folder.glob("*.csv"), *folder.glob("*.stl")):  # paths in the text are as written
        copy(table, tmp_path)
    again = load(write(tmp_path, "again.toml", preset.given_text))
    assert again.name == "again"
    assert again.resolved == on_its_own(preset.resolved)


@pytest.mark.usefixtures("roughly_packed")
@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, marks=pytest.mark.slow) if "s175" in name else name  # her potential flow takes long
        for name in NAMES
        if name.endswith(QUICK)
    ],
)
def test_a_quick_variant_states_its_differences_and_differs_only_in_cost(name, monkeypatch):
    # Both take long, and no step follows from them
    monkeypatch.setattr("lab.assembly.grains.start_positions", lambda size, *_: np.zeros((len(size), 2)))
    monkeypatch.setattr("lab.assembly.water._cut_off", lambda _, __, drops, ___: drops)
    whole, quick = as_shipped(name.removesuffix(QUICK)).resolved, as_shipped(name).resolved
    assert quick.quick.strip() and not whole.quick
    assert "stiffness" not in quick.quick  # a warning says it, with what the run was made with (`test_summary.py`)
    contact = replace(quick.contact, stiffness_scale=whole.contact.stiffness_scale)
    motion = quick.motion
    if motion.tilt:
        motion = replace(motion, tilt=replace(motion.tilt, rate=whole.motion.tilt.rate))
    alike = {"quick": "", "run": whole.run, "record": whole.record, "contact": contact, "motion": motion}
    if quick.grains:
        of_size = {name: getattr(whole.grains, name) for name in ("diameter", "table", "count")}
        alike["grains"] = replace(quick.grains, **of_size)
        sized = {name: replace(kind, diameter=whole.kinds[name].diameter) for name, kind in quick.kinds.items()}
        alike["kinds"] = sized
    if quick.bulk:
        alike["bulk"] = replace(quick.bulk, spacing=whole.bulk.spacing, stiffness=whole.bulk.stiffness)
    if quick.water:
        alike["water"] = replace(quick.water, spacing=whole.water.spacing)
    assert replace(quick, **alike) == whole
    assert cost(quick) < cost(whole)


def cost(preset: Preset) -> float:
    """Steps of the run in all its repeats."""
    one = replace(preset, run=replace(preset.run, repeats=1))
    return preset.run.repeats * preset.duration / build(one)[0].step


@pytest.mark.parametrize("name", OF_THEIR_OWN)
def test_resolved_goes_to_json_and_back(name):
    """And a recording may have it: it is within the limits of what a file from an unknown source may say."""
    resolved = as_shipped(name).resolved
    assert resolved_from(to_table(resolved)) == resolved


def test_names_are_sorted_with_titles():
    assert list(names()) == sorted(names())
    assert names()["tilting/quick"].startswith("Quick tilt")


def test_units_become_si():
    given = {"grains.diameter": "3 mm", "motion.tilt.rate": "4 deg/s", "tank.width": "96 mm", "tank.height": "12 cm"}
    quick = load("tilting/quick", given).resolved
    assert quick.grains.diameter == pytest.approx(0.003)
    assert quick.motion.tilt.rate == pytest.approx(0.0698131700797732)
    assert quick.tank.width == pytest.approx(0.096) and quick.tank.height == pytest.approx(0.12)


def test_base_preset_and_override_in_that_order():
    assert load("tilting/acetate").resolved.run.repeats == 1
    assert load("tilting/quick").resolved.run.repeats == 4
    assert load("tilting/quick", {"run.repeats": 7}).resolved.run.repeats == 7
    assert load("tilting/quick").resolved.material == load("tilting/acetate").resolved.material


def test_nested_overrides_are_dotted_ones():
    dotted = load("tilting/quick", {"grains.diameter": "4 mm", "run.seed": 3})
    nested = load("tilting/quick", {"grains": {"diameter": "4 mm"}, "run": {"seed": 3}})
    assert dotted.resolved == nested.resolved


def test_overrides_may_be_numbers_and_arrays_of_numpy(tmp_path):
    given = {"run.repeats": np.int64(3), "grains.spread": np.float64(0.1), "run.settle": np.bool_(True)}
    preset = load("tilting/quick", given)
    assert preset.resolved.run.repeats == 3 and preset.resolved.grains.spread == 0.1
    assert load(write(tmp_path, "again.toml", preset.given_text)).resolved == on_its_own(preset.resolved)


def test_alternatives_replace_inherited_keys():
    counted = load("tilting/quick", {"grains.count": 100}).resolved.grains
    assert (counted.count, counted.depth) == (100, None)
    damped = load("tilting/quick", {"material.dissipative_time": "1e-6 s"}).resolved.material
    assert (damped.restitution, damped.dissipative_time) == (None, pytest.approx(1e-6))
    corners = [["0 mm", "0 mm"], ["90 mm", "0 mm"], ["0 mm", "90 mm"]]
    outlined = load("tilting/quick", {"tank.outline": corners}).resolved.tank
    assert len(outlined.outline) == 3


def test_false_removes_an_inherited_motion():
    assert list(load("shaking/sway").resolved.motion.parts) == ["sway"]


def test_own_file_is_based_on_another_own_file(tmp_path):
    (tmp_path / "deep").mkdir()
    write(tmp_path, "base.toml", MINIMAL)
    path = write(tmp_path, "deep/heir.toml", 'based_on = "../base.toml"\ntitle = "heir"')
    heir = load(path).resolved
    assert heir.title == "heir" and heir.grains.depth == pytest.approx(0.03)


def test_title_source_and_reports_are_not_inherited(tmp_path):
    """Title, source and reports are of one experiment; a file that is based on it names it, and has its own or none."""
    heir = load(write(tmp_path, "mine.toml", 'based_on = "tilting/acetate"\n[tank]\nwidth = "90 mm"'))
    said, base = heir.resolved, load("tilting/acetate").resolved
    assert (said.title, said.source, said.reports) == ("mine, based on tilting/acetate", "", "")
    assert said.based_on == "tilting/acetate" and not base.based_on
    assert said.material == base.material and base.source and base.reports
    assert ' with "tilting/acetate", on which it is based, and all overrides merged in.' in heir.given_text
    assert "based_on" not in tomllib.loads(heir.given_text)
    grandchild = load(write(tmp_path, "own.toml", 'based_on = "mine.toml"\nsource = "a report"')).resolved
    assert (grandchild.based_on, grandchild.source, grandchild.reports) == ("mine.toml", "a report", "")
    quick, whole = load("tilting/acetate-quick").resolved, load("tilting/acetate").resolved
    assert (quick.source, quick.reports, quick.title) == (whole.source, whole.reports, whole.title)


def test_own_file_may_carry_a_byte_order_mark(tmp_path):
    path = tmp_path / "windows.toml"
    path.write_bytes(b"\xef\xbb\xbf" + MINIMAL.replace("\n", "\r\n").encode())
    assert load(path).resolved.title == "a tank"


def test_duration_is_derived_from_the_tilt_unless_given(monkeypatch):
    monkeypatch.setattr(Tilt, "duration", lambda self: 7.5)
    assert load("tilting/quick").resolved.duration == 7.5
    assert load("tilting/quick", {"run.duration": "3 s"}).resolved.duration == 3.0


def test_the_wall_has_the_grains_material_except_for_its_own_keys():
    assert minimal().wall_material == minimal().material
    wall = minimal(wall__friction=0.5).wall_material
    assert wall == replace(minimal().material, friction=0.5)
    wall = minimal(wall__dissipative_time="1e-6 s").wall_material
    assert (wall.restitution, wall.dissipative_time) == (None, pytest.approx(1e-6))
    wall = minimal(material__dissipative_time="1e-6 s", wall__restitution=0.9).wall_material
    assert (wall.restitution, wall.dissipative_time) == (0.9, None)


def test_outline_is_turned_counter_clockwise():
    clockwise = [["0 mm", "0 mm"], ["0 mm", "90 mm"], ["90 mm", "90 mm"], ["90 mm", "0 mm"]]
    base = tomllib.loads(MINIMAL)
    tank = resolve({**base, "tank": {"outline": clockwise}}).tank
    assert area(tank.corners) == pytest.approx(0.0081)
    closed = resolve({**base, "tank": {"outline": [*clockwise, clockwise[0]]}}).tank
    assert closed.corners == tank.corners


@pytest.mark.parametrize(
    ("corners", "words"),
    [
        ([(0, 0), (1, 1), (1, 0), (0, 1)], "crosses"),
        ([(0, 0), (1, 0), (2, 0)], "crosses or touches"),
        ([(0, 0), (2, 0), (2, 2), (1, 0), (0, 2)], "touches"),
        ([(0, 0), (1, 0), (1, 0), (0, 1)], "same point"),
        ([(0, 0), (1, 0)], "3 to"),
        ([(0, 0)] * 500, "3 to"),
        ([], "3 to"),
    ],
)
def test_invalid_outlines_are_refused(corners, words):
    with pytest.raises(LabError, match=words):
        simple_polygon(corners)


@pytest.mark.parametrize(
    ("overrides", "sentence"),
    [
        ({"grains.diamter": "3 mm"}, "grains.diamter: unknown key; did you mean 'diameter'?"),
        ({"diameter": "3 mm"}, "diameter: unknown key; did you mean 'grains.diameter' or 'bulk.diameter'?"),
        ({"motion.rol.amplitude": 1}, "motion.rol: unknown key; did you mean 'roll'?"),
        ({"wall.density": 1}, "wall.density: unknown key; did you mean 'material.density'?"),
        ({"repeats": 12}, "repeats: unknown key; did you mean 'run.repeats'?"),
        ({"fricton": 0.3}, "fricton: unknown key; did you mean 'material.friction'?"),
        ({"spacing": "5 mm"}, "spacing: unknown key; did you mean 'water.spacing' or 'bulk.spacing'?"),
        ({"grain.diameter": "5 mm"}, "grain: unknown key; did you mean 'grains'?"),
        (
            {"motion.tilt.rate": "3 mm"},
            'motion.tilt.rate: "3 mm" is a length, but deg/s (an angular rate) is needed, '
            'e.g. "3 deg/s".',
        ),
        ({"grains.diameter": "-3 mm"}, "grains.diameter: must be greater than 0 (got -3 mm)."),
        ({"grains.spread": 0.7}, "grains.spread: must be at most 0.5 (got 0.7)."),
        ({"motion.roll": {}}, "motion.roll.amplitude: missing; an angle is needed, "),
        ({"grains": 3}, "grains: a table of keys is needed (got 3)."),
        ({"motion.tilt": True}, "motion.tilt: a table of keys is needed (got true)."),
        ({"run.repeats": 2.0}, "run.repeats: a whole number is needed (got 2.0)."),
        ({"run.repeats": True}, "run.repeats: a whole number is needed (got true)."),
        ({"title": 3}, "title: a text in quotes is needed (got 3)."),
        ({"title": "a\0b"}, "title: the text has characters that cannot be shown"),
        ({"title": "\udcff"}, "title: the text has characters that cannot be shown"),
        ({"run.step": "aut"}, 'run.step: "aut" cannot be read; a time is needed, e.g. "0.5 s" (or'),
        ({"contact.normal": "herz-viscoelastic"}, 'contact.normal: "herz-viscoelastic" is unknown'),
        ({"video.colour": "sped"}, "video.colour: \"sped\" is unknown; did you mean 'speed'?"),
        ({"video.width": 1281}, "video.width: must be even"),
        ({"motion.roll.centre": "0 mm", "motion.roll.frequency": "1 Hz",
          "motion.roll.amplitude": "3 deg"}, "motion.roll.centre: a list of 2 is needed"),
        ({"tank.outline": [["1 mm", "2 s"]]}, 'tank.outline[0][1]: "2 s" is a time'),
        ({"grains.count": 3, "grains.depth": "9 mm"}, "grains.depth: give exactly one of depth and"),
        ({"grains.depth": "200 mm"}, "grains.depth: 200 mm must be less than the tank's height"),
        ({"grains.depth": "1 mm"}, "grains.depth: 1 mm is less than one grain"),
        ({"grains.diameter": "95 mm", "grains.spread": 0.1}, "grains.diameter: grains of up to 104"),
        ({"grains.count": 1500}, "grains.count: 1500 grains do not fit"),
        ({"material.restitution": 1, "material.dissipative_time": "1 s"}, "material.restitution: g"),
        ({"wall.restitution": 1, "wall.dissipative_time": "1 s"}, "wall.restitution: give rest"),
        ({"tank.outline": [], "tank.width": "1 m"}, "tank.outline: give either"),
        ({"grains..depth": 3}, '"grains..depth" is not a key'),
        ({"based_on": "tilting/quick"}, "based_on: cannot be overridden"),
        ({"contact.cohesion": "humid"}, "material.humidity: missing; contact.cohesion"),
        ({"contact.cohesion": "bridge"}, "material.bridge_volume: missing; contact.cohesion"),
        ({"material.humidity": "100 %"}, "material.humidity: must be less than 1"),
    ],
)  # fmt: skip
def test_errors_name_the_key(overrides, sentence):
    assert fault(**overrides).startswith(sentence)


@pytest.mark.parametrize(
    ("key", "words"),
    [
        ("title", "title: missing; a text"),
        ("tank", "tank.width: missing; give width and height, or an outline"),
        ("grains", "material: goes with grains, and there are none; add a table \\[grains\\], or set material = false"),
        ("material", "material.density: missing; a density is needed"),
        ("run", "run.duration: missing, and no motion has an end"),
    ],
)
def test_missing_keys_are_named(key, words):
    table = tomllib.loads(MINIMAL)
    del table[key]
    with pytest.raises(LabError, match=words):
        resolve(table)


def test_a_missing_alternative_is_an_error():
    table = tomllib.loads(MINIMAL)
    del table["grains"]["depth"]
    with pytest.raises(LabError, match=r"grains\.depth: give exactly one .*neither"):
        resolve(table)
    table = tomllib.loads(MINIMAL)
    del table["material"]["restitution"]
    with pytest.raises(LabError, match=r"material\.restitution: missing"):
        resolve(table)


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("tiltng/quick", "did you mean tilting/quick?"),
        ("quick", "did you mean tilting/quick?"),
        ("tilting", '"tilting" is a group of presets; `cargolab list` shows those in it.'),
        ("tilting/quick-quick", "tilting/quick: has no quick variant; run tilting/quick itself."),
        ("tilting/none-quick", 'there is no preset "tilting/none-quick"'),
        ("zzz", "`cargolab list`"),
        ("", "`cargolab list`"),
        ("absent.toml", "absent.toml: cannot be read: No such file"),
        ("nul\0.toml", "is not a file name"),
        ("x" * 5000 + ".toml", "cannot be read"),
    ],
)
def test_presets_that_cannot_be_found_are_reported(name, words):
    with pytest.raises(LabError) as caught:
        load(name)
    assert words in str(caught.value) and "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"a 1", "mine.toml: not valid TOML: .*line 1"),
        (b"a = 1\nb = '\xff'", r"mine.toml: not UTF-8 text \(line 2\)"),
        (b"a = " + b"1" * 5000, "mine.toml: not valid TOML: too long a number"),
        (b"a = " + b"[" * 5000, "mine.toml: not valid TOML: .*too deep a list"),
        (b"#" * 1_000_001, "mine.toml: too large"),
        (b"based_on = 3", "mine.toml: based_on: the name"),
        (b"based_on = 'tilting/quik'", "mine.toml: based_on: .*did you mean tilting/quick"),
        (b"based_on = 'mine.toml'", "mine.toml: based_on: .*itself"),
        (b"based_on = '../files/mine.toml'", "mine.toml: based_on: .*itself"),
        (b"a." * 2000 + b"a = 1", "^a: unknown key"),
    ],
)
def test_files_that_cannot_be_used_are_reported(content, words, tmp_path):
    (tmp_path / "files").mkdir()
    path = tmp_path / "files" / "mine.toml"
    path.write_bytes(content)
    with pytest.raises(LabError, match=words):
        load(path)


def test_a_folder_is_refused_as_a_preset(tmp_path):
    (tmp_path / "folder.toml").mkdir()
    with pytest.raises(LabError, match=r"folder\.toml: is not a file"):
        load(tmp_path / "folder.toml")


def test_presets_based_on_each_other_are_refused(tmp_path):
    write(tmp_path, "a.toml", 'based_on = "b.toml"')
    write(tmp_path, "b.toml", 'based_on = "a.toml"')
    with pytest.raises(LabError, match="based on itself"):
        load(tmp_path / "a.toml")


def test_a_new_motion_is_a_new_table():
    @dataclass(frozen=True)
    class Surge:
        """A motion of the future."""

        amplitude: Annotated[float, Unit("m"), Interval(gt=0)]
        gust: Annotated[tuple[float, float] | None, Unit("m/s")] = None

    assert reader.read(Surge, {"amplitude": "3 mm", "gust": ["1 m/s", "2 km/hour"]}) == Surge(
        pytest.approx(0.003), (1.0, pytest.approx(2 / 3.6))
    )
    with pytest.raises(LabError, match="amplitude: must be greater than 0"):
        reader.read(Surge, {"amplitude": "0 mm"})


def test_every_registered_motion_can_be_named():
    known = {key for key, _ in walk(Preset)}
    assert {f"motion.{name}.{field}" for name in MOTIONS for field in ("centre",)} - known == {
        "motion.sway.centre",
        "motion.heave.centre",
    }
    assert {f"motion.{name}" for name in MOTIONS} <= known


KEYS = sorted(key for key, _ in walk(Preset))
VALUES = (
    st.none()
    | st.booleans()
    | st.integers()
    | st.floats(allow_subnormal=False, )
    | st.text()
    | st.from_regex(r"-?[0-9]{1,2}(\.[0-9])?(e-?[0-9]{1,3})? (mm|m|s|deg|deg/s|Hz|Pa|kg/m\^3|%)", fullmatch=True)
    | st.sampled_from(["auto", "speed", "earth", "mindlin", "false"])
)  # fmt: skip
TREES = st.recursive(VALUES, lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(), inner, max_size=3))
quickly = settings(
    max_examples=60, derandomize=True, database=None, suppress_health_check=[HealthCheck.too_slow], deadline=None
)


@quickly
@given(st.dictionaries(st.sampled_from(KEYS), VALUES, max_size=3))
@example({"motion.tilt": {"rate": "1e-300 deg/s", "angle": "1e-300 deg"}})
@example({"grains.diameter": "1e-200 mm", "grains.count": 1_000_000})
@example({"tank.width": "1e300 m", "tank.height": "1e300 m"})
def test_any_value_gives_a_preset_or_one_sentence(overrides):
    try:
        load("tilting/quick", overrides)
    except LabError as error:
        assert "\n" not in str(error) and str(error)[-1] in ".?"


@quickly
@given(st.dictionaries(st.sampled_from(KEYS) | st.text(), TREES, max_size=3))
def test_any_tree_gives_a_preset_or_one_sentence(overrides):
    try:
        load("tilting/quick", overrides)
    except LabError as error:
        assert "\n" not in str(error) and len(str(error)) < 400


@quickly
@given(st.binary(max_size=60), st.integers(0, len(MINIMAL)))
def test_any_bytes_give_a_preset_or_one_sentence(tmp_path_factory, noise, place):
    path = tmp_path_factory.getbasetemp() / "noise.toml"
    text = MINIMAL.encode()
    path.write_bytes(text[:place] + noise + text[place:])
    try:
        load(path)
    except LabError as error:
        assert "\n" not in str(error)


TOML = st.recursive(
    st.booleans() | st.integers(-(2**63), 2**63 - 1) | st.floats(allow_subnormal=False, allow_nan=False)
    | st.text(st.characters(exclude_categories=["Cs"])),
    lambda inner: st.lists(inner, max_size=3)
    | st.dictionaries(st.text(st.characters(exclude_categories=["Cs"])), inner, max_size=3),
)  # fmt: skip


@quickly
@given(st.dictionaries(st.text(st.characters(exclude_categories=["Cs"])), TOML, max_size=4))
def test_toml_text_reads_back(table):
    assert tomllib.loads(toml.dumps(table)) == table
