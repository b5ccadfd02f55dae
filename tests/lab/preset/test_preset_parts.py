"""Parts in a preset: tables with names of one's own, inherited, changed and dropped like any other keys."""

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from lab.base.errors import LabError
from lab.preset.find import load
from lab.preset.recorded import from_table, to_table
from solvers.tank.parts import Part
from tests.oracles.presets import MATERIAL, error_of

PRESET = f"""
title = "a tank with parts"
[tank]
width = "100 mm"
height = "100 mm"
[grains]
diameter = "3 mm"
depth = "30 mm"
{MATERIAL}
[parts.gate]
points = [["10 mm", "0 mm"], ["10 mm", "80 mm"]]
move = ["0 mm", "9 cm"]
start = "0.5 s"
speed = "1 m/s"
acceleration = "20 m/s^2"
[parts.funnel-1]
points = [["-40 mm", "150 mm"], ["-5 mm", "110 mm"], ["-5 mm", "100 mm"]]
[run]
duration = "1 s"
"""
GATE = Part(((0.01, 0.0), (0.01, 0.08)), (0.0, 0.09), 0.5, 1.0, 20.0)


@pytest.fixture
def preset(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(PRESET)
    return path


def fault(preset, key, value) -> str:
    return error_of(load, preset, {key: value})


def test_parts_are_in_order_and_in_si(preset):
    parts = load(preset).resolved.parts
    assert list(parts) == ["gate", "funnel-1"]
    assert parts["gate"].parameters() == pytest.approx(GATE.parameters(), rel=1e-14)
    assert parts["gate"].points == ((0.01, 0.0), (0.01, 0.08))
    assert parts["funnel-1"].way == 0.0 and len(parts["funnel-1"].points) == 3


def test_resolved_goes_to_json_and_back(preset):
    resolved = load(preset).resolved
    again = from_table(to_table(resolved))
    assert again == resolved and list(again.parts) == ["gate", "funnel-1"]
    assert isinstance(again.parts["gate"], Part)


def test_given_text_is_the_same_preset(preset, tmp_path):
    loaded = load(preset, {"parts.gate": False, "parts.step": {"points": [["0 mm", "0 mm"], ["0 mm", "5 mm"]]}})
    (tmp_path / "again.toml").write_text(loaded.given_text)
    again = load(tmp_path / "again.toml").resolved
    assert again == loaded.resolved and list(again.parts) == ["funnel-1", "step"]


def test_parts_are_inherited_changed_and_removed(preset, tmp_path):
    heir = tmp_path / "heir.toml"
    heir.write_text('based_on = "mine.toml"\n[parts]\nfunnel-1 = false\n[parts.gate]\nspeed = "2 m/s"\n')
    parts = load(heir, {"parts.gate.start": "0.1 s"}).resolved.parts
    assert list(parts) == ["gate"]
    assert (parts["gate"].speed, parts["gate"].start, parts["gate"].move) == (2.0, 0.1, pytest.approx((0.0, 0.09)))


def test_a_preset_without_parts_has_none():
    assert load("tilting/quick").resolved.parts == {}


@pytest.mark.parametrize(
    ("key", "value", "sentence"),
    [
        ("parts", 3, "parts: tables with names of your own are needed (got 3)."),
        ("parts.gate", 3, "parts.gate: a table of keys is needed (got 3)."),
        ("parts.gate", True, "parts.gate: a table of keys is needed (got true)."),
        ("parts.gate.spee", "1 m/s", "parts.gate.spee: unknown key; did you mean 'speed'?"),
        ("gate.speed", "1 m/s", "gate: unknown key;"),
        ("acceleration", "1 m/s", "acceleration: unknown key; did you mean 'parts.NAME.acceleration'?"),
        ("parts.gate.speed", "1 mm", 'parts.gate.speed: "1 mm" is a length, but m/s (a speed) is needed'),
        ("parts.gate.start", "-1 s", "parts.gate.start: must be at least 0 (got -1 s)."),
        ("parts.gate.speed", "0 m/s", "parts.gate.speed: missing for a part that moves; a speed is needed"),
        ("parts.funnel-1.move", ["1 mm", "0 mm"], "parts.funnel-1.speed: missing for a part that moves"),
        ("parts.gate.acceleration", "0 m/s^2", "parts.gate.acceleration: missing for a part that moves"),
        ("parts.gate.move", ["1 mm"], "parts.gate.move: a list of 2 is needed"),
        ("parts.gate.move", ["1.5e308 m", "1.5e308 m"], "parts.gate.move[0]:"),
        ("parts.gate.move", ["nan m", "0 m"], 'parts.gate.move[0]: "nan m" is not a finite number'),
        ("parts.gate.points", [["1 mm", "1 mm"]], "parts.gate.points: from 2 to 200 points are needed (got 1)."),
        ("parts.gate.points", [["1 mm", "1 mm"]] * 2, "parts.gate.points[1]: the same point as the one before"),
        ("parts.gate.points", [["0 mm", "0 mm"], ["0 mm", "201 mm"]], "parts.gate.points[1]: 0 m, 201 mm is farther"),
        ("parts.gate.points", [[0, 0], [0, 1]], "parts.gate.points[0][0]: 0 has no unit"),
        ("parts.step", {}, "parts.step.points: missing; a list is needed."),
        ("parts", {"a b": {}}, 'parts: "a b" is no name; up to 40 letters'),
        ("parts", {"": {}}, 'parts: "" is no name;'),
        ("parts", {"x" * 41: {}}, 'parts: "xxx'),
        ("parts", {3: {}}, 'parts: "3" is no name;'),
        ("parts", {f"p{k}": {"points": [["0 mm", "0 mm"], ["0 mm", "1 mm"]]} for k in range(60)}, "parts: at most 50"),
    ],
)
def test_errors_name_the_part_and_its_key(preset, key, value, sentence):
    assert fault(preset, key, value).startswith(sentence)


LENGTHS = st.sampled_from(["0 mm", "1 mm", "-30 mm", "90 mm", "150 mm", "1e-320 m", "1e308 m"])
TABLES = st.fixed_dictionaries(
    {"points": st.lists(st.lists(LENGTHS, min_size=2, max_size=2), min_size=2, max_size=4)},
    optional={
        "move": st.lists(LENGTHS, min_size=2, max_size=2),
        "start": st.sampled_from(["0 s", "1 s", "1e308 s"]),
        "speed": st.sampled_from(["1 m/s", "1e-320 m/s", "1e308 m/s"]),
        "acceleration": st.sampled_from(["10 m/s^2", "1e-320 m/s^2", "1e308 m/s^2"]),
    },
)


@settings(max_examples=80, deadline=None, suppress_health_check=list(HealthCheck))
@given(st.dictionaries(st.text(max_size=3) | st.just("gate"), TABLES | st.booleans() | st.text(), max_size=2))
def test_any_parts_give_a_preset_or_one_sentence(preset, parts):
    try:
        resolved = load(preset, {"parts": parts}).resolved
    except LabError as error:
        assert "\n" not in str(error) and len(str(error)) < 400
    else:
        numbers = [x for part in resolved.parts.values() for x in (*part.parameters(), part.fastest(), part.duration())]
        assert all(abs(x) < float("inf") for x in numbers)
