"""The keys of presets as the file beside the code keeps them: the same as the schema's, with the same refusals."""

import shutil

import pytest

from lab.base.errors import LabError
from lab.preset.fields import walk
from lab.preset.find import load, screen
from lab.preset.kept import read as kept
from lab.preset.kept.content import MATTERS, parted
from lab.preset.kept.recorded import content
from lab.preset.kept.written import text_of_keys
from lab.preset.reader import check_keys, read
from lab.preset.recorded import to_table
from lab.preset.schema import Preset

WRONG = (
    {"tank": {"widht": "3 mm"}},
    {"tank": {"width": "3 kg"}},
    {"tank": {"width": 3}},
    {"tank": {"width": "-3 mm"}},
    {"tank": {"outline": [["1 m", "2 m"], ["1 m"]]}},
    {"contact": {"normal": "herz"}},
    {"run": {"repeats": 0}},
    {"run": {"repeats": 1.5}},
    {"run": {"settle": "no"}},
    {"grains": {"table": [["3 mm", -1.0]]}},
    {"grains": {"bed": "absent.csv"}},
    {"parts": {"a b": {"start": "1 s"}}},
    {"parts": {"gate": {"strat": "1 s"}}},
    {"gauges": {"P1": {"kind": "sound"}}},
    {"motion": {"tilt": {"rate": "3 Hz"}}},
    {"shapes": {"pea": {"descriptors": [3.0]}}},
    {"motoin": {}},
    {"ship": 3},
    {},
)


def test_the_file_beside_the_code_has_the_keys_of_the_schema():
    assert kept.FILE.read_text(encoding="utf-8") == text_of_keys()  # cargolab schema --out presets/schema.json
    assert kept.is_current.__wrapped__()  # the same command, also where a source changed and no key did
    assert text_of_keys(kept.preset()) == text_of_keys()
    assert [key for key, _ in walk(kept.preset())] == [key for key, _ in walk(Preset)]


def refusal(kind: type, table: dict) -> str:
    with pytest.raises(LabError) as error:
        check_keys(kind, table)
        read(kind, table)
    return str(error.value)


@pytest.mark.parametrize("table", WRONG, ids=str)
def test_what_is_wrong_with_a_key_is_said_in_the_same_words_without_the_schema(table):
    table = {"title": "x"} | table if table else table
    assert refusal(kept.preset(), table) == refusal(Preset, table)


def without_schema(monkeypatch) -> None:
    """As in a process that has not loaded it, with a file that no source is newer than."""
    monkeypatch.setattr(kept, "loaded", lambda: None)
    monkeypatch.setattr(kept, "is_current", lambda: True)


def test_a_preset_is_screened_by_the_file_alone_unless_the_code_is_newer(monkeypatch):
    without_schema(monkeypatch)
    screen("tilting/quick", {"grains.diameter": "4 mm"})
    with pytest.raises(LabError, match=r"grains\.diamter: unknown key; did you mean 'diameter'\?"):
        screen("tilting/quick", {"grains.diamter": "4 mm"})
    assert kept.keys() is kept.preset()
    monkeypatch.setattr(kept, "is_current", lambda: False)
    known = iter([None, Preset])  # before and after it is imported
    monkeypatch.setattr(kept, "loaded", lambda: next(known))
    assert kept.keys() is Preset


@pytest.mark.parametrize(
    "source",
    ["lab/preset/sections/tank.py", "solvers/grains/laws/__init__.py", "solvers/motion/axle.py",
     "solvers/grains/shapes/cargo.toml", "solvers/grains/materials.py"],
)  # fmt: skip
def test_a_source_that_is_another_is_noticed(monkeypatch, tmp_path, source):
    for package in ("lab/preset", "solvers"):
        leave_out = shutil.ignore_patterns("__pycache__")
        shutil.copytree(kept.ROOT / package, tmp_path / package, ignore=leave_out)
    monkeypatch.setattr(kept, "ROOT", tmp_path)
    assert kept.is_current.__wrapped__()
    with (tmp_path / source).open("a") as file:
        file.write("\n# another\n")
    assert not kept.is_current.__wrapped__()


@pytest.mark.parametrize(
    "name",
    [
        *("tilting/quick", "sloshing/quick", "ship/barge-roll", "validation/ciemito-flume"),
        *("wet/sand", "flooding/coal-barge", "flooding/grain-barge"),
    ],
)
def test_what_a_recording_is_laid_out_by_is_read_without_the_schema(name, monkeypatch):
    preset = load(name).resolved
    table = to_table(preset)
    without_schema(monkeypatch)
    found = content(table)
    assert found.matters == preset.matters and found.repeats == preset.run.repeats
    assert (found.ship, found.axle) == (bool(preset.ship), bool(preset.axle))
    assert (found.wet, found.soaks) == (preset.wet, preset.soaks)
    assert [list(one) for one in parted(found.gauges)] == [list(one) for one in parted(preset.gauges)]
    assert found.material == (preset.material is not None) and set(found.matters) <= set(MATTERS)


@pytest.mark.parametrize(
    ("key", "value", "said"),
    [
        ("run", None, "run: a table is needed"),
        ("title", 3, "title: another kind"),
        ("tank", {"width": "3 mm"}, r"tank\.width: another kind"),
        ("gauges", {"P1": {"kind": "sound"}}, r"gauges\.P1\.kind: another kind"),
        ("parts", {"gate": {"points": [[1.0, True]]}}, r"parts\.gate\.points\[0\]\[1\]: another kind"),
        ("parts", {"gate": {"points": [[1.0]]}}, r"parts\.gate\.points\[0\]: another kind of list"),
        ("material", {}, r"material\.\w+: is missing"),
    ],
)
def test_a_recorded_preset_of_wrong_types_is_refused_without_the_schema(key, value, said):
    table = to_table(load("tilting/quick").resolved)
    with pytest.raises(ValueError, match=said):
        content(table | {key: value})
    with pytest.raises(ValueError, match="a table is needed"):
        content([table])
