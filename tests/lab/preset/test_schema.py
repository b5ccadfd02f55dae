"""What follows from the schema's fields: the JSON Schema that editors read, the reference, and formats of presets."""

import json
import tomllib
from pathlib import Path

import pytest
from click.testing import CliRunner
from jsonschema import Draft7Validator

from lab.base.errors import LabError
from lab.cli import main
from lab.preset import formats
from lab.preset.editor import json_schema, text_of_schema
from lab.preset.fields import NAME, Taken, walk
from lab.preset.find import QUICK, load, names
from lab.preset.recorded import from_table, to_table
from lab.preset.reference import range_of, reference, value_of
from lab.preset.schema import Preset
from solvers.machine.marks import Interval
from tests.lab.preset.test_malformed import LISTED, RICH, WET
from tests.oracles.presets import error_of

PRESETS = Path(__file__).parents[3] / "presets"
VALIDATOR = Draft7Validator(json_schema())
WRONG = {
    "a key that is none": "[tank]\nwidht = '3 mm'",
    "a word that is none": "[contact]\nnormal = 'herz'",
    "a number without its unit": "[tank]\nwidth = 3",
    "a unit without a number": "[tank]\nwidth = 'mm'",
    "a number out of range": "[run]\nrepeats = 0",
    "a text for a number": "[video]\nwidth = 'wide'",
    "a point of three": "[motion.tilt]\ncentre = ['0 m', '0 m', '0 m']",
    "a name that is none": "[parts.'a b']\nstart = '1 s'",
    "a quick variant of another experiment": "quick.tank.width = '3 mm'",
    "a kernel that is none": "[water]\nkernel = 'cubic'",
    "a gauge of another kind": "[gauges.P1]\nkind = 'sound'",
}


def complaints(text: str) -> list[str]:
    return [error.message for error in VALIDATOR.iter_errors(tomllib.loads(text))]


@pytest.mark.parametrize("path", sorted(PRESETS.glob("*/*.toml")), ids=lambda path: path.stem)
def test_a_shipped_preset_names_the_schema_and_fits_it(path):
    text = path.read_text(encoding="utf-8")
    first, second = text.split("\n")[:2]
    named = path.parent / first.removeprefix("#:schema ")
    assert named.resolve() == PRESETS / "schema.json" and second == "format = 3"
    assert complaints(text) == []


def test_the_schema_beside_the_presets_is_the_present_one():
    assert (PRESETS / "schema.json").read_text(encoding="utf-8") == text_of_schema()  # cargolab schema --out
    Draft7Validator.check_schema(json_schema())


@pytest.mark.parametrize("text", [RICH, LISTED, WET])
def test_other_sound_presets_fit_the_schema(text):
    assert complaints(text) == []


@pytest.mark.parametrize("name", [name for name in names() if name.endswith(QUICK)][:3])
def test_a_preset_as_it_is_recorded_fits_the_schema(name):
    assert complaints(load(name).given_text) == []


@pytest.mark.parametrize("name", WRONG)
def test_an_editor_complains_of_what_the_lab_refuses(name):
    assert complaints('title = "x"\nbased_on = "tilting/quick"\n') == []
    assert complaints(f'title = "x"\nbased_on = "tilting/quick"\n{WRONG[name]}')


def test_a_preset_on_its_own_needs_its_sections_and_an_heir_does_not():
    assert complaints('title = "x"') and not complaints('based_on = "tilting/quick"')


def test_the_command_shows_schema_and_reference(tmp_path):
    run = CliRunner().invoke
    assert json.loads(run(main, ["schema"]).output) == json_schema()
    assert run(main, ["schema", "--reference"]).output == reference()
    done = run(main, ["schema", "--out", str(tmp_path / "keys.json")])
    assert "#:schema ./keys.json" in done.output
    assert json.loads((tmp_path / "keys.json").read_text()) == json_schema()


def test_the_reference_has_every_key_with_its_sentence_in_its_section():
    sections = {}
    for part in reference().split("\n## ")[1:]:
        heading, _, body = part.partition("\n")
        sections[heading.strip("[]")] = body
    for key, taken in walk(Preset):
        section, _, name = key.rpartition(".")
        if not taken.below:
            rows = [
                line for line in sections[section or "The preset itself"].split("\n") if line.startswith(f"| `{name}` ")
            ]
            assert len(rows) == 1 and taken.doc.replace("|", "\\|") in rows[0], key
        elif taken.named:
            assert f"{key}.{NAME}" in sections


def test_values_and_ranges_in_words():
    assert range_of(Taken(float, symbol="m", interval=Interval(gt=0, le=0.05))) == "above 0 to 50 mm"
    assert value_of(Taken(float, ("auto",), "s")) == 'a time, e.g. "0.5 s" or "auto"'
    assert value_of(Taken(tuple[float, ...], symbol="rad")) == 'a list, each an angle, e.g. "20 deg"'


# ---- formats

BARGE = 'title = "x"\nbased_on = "ship/barge-roll"\n'


def written(folder: Path, text: str, name: str = "mine.toml") -> str:
    (folder / name).write_text(text)
    return str(folder / name)


def full(folder: Path, sea: str, head: str = "") -> str:
    """A preset of a barge on its own, with that table of the sea."""
    lines = load("ship/barge-roll", {"waves.frequency": "5 rad/s"}).given_text.split("\n")
    kept = "\n".join(line for line in lines if not line.startswith("format"))
    return written(folder, f"{head}{kept}\n{sea}\n")


def test_water_without_a_format_is_the_sea_and_is_said_to_be(tmp_path):
    with pytest.warns(formats.OldFormat, match=r"mine.toml: \[water\] is read as the sea here, .* format = 3"):
        old = load(full(tmp_path, '[water]\ndensity = "1025 kg/m^3"')).resolved
    new = load(full(tmp_path, '[sea]\ndensity = "1025 kg/m^3"', "format = 3\n")).resolved
    assert old == new and old.sea.density == 1025.0


def test_the_command_says_so_in_a_sentence(tmp_path):
    done = CliRunner().invoke(main, ["explain", full(tmp_path, "[water]\ndepth = 3")], prog_name="cargolab")
    first, second = done.stderr.strip().split("\n")
    assert first.startswith("cargolab: ") and "read as the sea" in first
    assert second.startswith("cargolab: sea.depth: 3 has no unit")


@pytest.mark.parametrize("head", ["format = 3\n", ""])
def test_water_of_the_present_format_is_not_the_sea(head, tmp_path):
    preset = load(
        written(tmp_path, f"{head}{BARGE}"), {"water.depth": "30 mm", "grains": False, "material": False}
    ).resolved
    assert preset.water.depth == 0.03
    assert preset.sea.depth is None


def test_presets_of_two_formats_are_not_based_on_each_other(tmp_path):
    with pytest.raises(LabError, match=r"mine\.toml: based_on: one of these presets has \[water\] and no format"):
        load(written(tmp_path, f'{BARGE}[water]\ndepth = "1 m"'))


def test_a_preset_without_format_and_water_reads_the_same(tmp_path):
    assert load(written(tmp_path, BARGE)).resolved == load(written(tmp_path, f"format = 3\n{BARGE}")).resolved


@pytest.mark.parametrize("said", ["4", "2", "true", "3.0", '"3"', "[3]", "{}"])
def test_a_format_that_is_not_known_is_refused(said, tmp_path):
    with pytest.raises(LabError, match=r"mine.toml: format: this version reads presets of format 3 \(got"):
        load(written(tmp_path, f"format = {said}\n{BARGE}"))


@pytest.mark.parametrize("in_file", [True, False])
def test_the_staggered_coupling_is_read_under_its_earlier_name(in_file, tmp_path):
    with pytest.warns(formats.OldFormat, match=r'mine.toml: ship.coupling: "as_K" is called "staggered" now'):
        said = '[ship]\ncoupling = "as_K"\n' if in_file else ""
        read = load(written(tmp_path, BARGE + said), {} if in_file else {"ship.coupling": "as_K"}).resolved
    assert read == load(written(tmp_path, BARGE), {"ship.coupling": "staggered"}).resolved
    kept = to_table(read)
    kept["ship"]["coupling"] = "as_K"
    assert from_table(kept) == read


@pytest.mark.parametrize("in_file", [True, False])
def test_a_key_that_is_gone_is_left_out_and_said_to_be(in_file, tmp_path):
    with pytest.warns(formats.OldFormat, match=r"record.xdmf: is not read any more: ParaView opens .* leave it out"):
        said = "[record]\nxdmf = true\n" if in_file else ""
        read = load(written(tmp_path, BARGE + said), {} if in_file else {"record.xdmf": True}).resolved
    assert read == load(written(tmp_path, BARGE)).resolved
    kept = to_table(read)
    kept["record"]["xdmf"] = True
    assert from_table(kept) == read


OLD = {
    "tank": {"outline": [[0.0, 0.0], [0.1, 0.0], [0.1, 0.1]], "open_edges": [1], "roughness": None},
    "water": {"density": 1025.0, "depth": None},
    "ship": {"sheet": 0.004, "draught": 0.1},
    "grains": {"diameter": 0.004, "table": [[0.004, 1.0]], "shares": "mass", "bed": None, "listed": []},
    "shapes": {
        "a": {"share": 0.5, "diameter": 0.004, "descriptors": [0.1], "phases": None, "draws": 3},
        "b": {"share": 0.5, "diameter": 0.004, "descriptors": [], "phases": [], "draws": 1},
    },
    "kinds": {"light": {"share": 0.3, "material": {"density": 700.0}, "against": None}},
    "motion": {"soft_start": 0.0, "history": {"time": [0.0, 1.0], "sway": None, "roll": [0.0, 0.1], "centre": [0, 0]}},
}


def test_a_recorded_preset_of_an_earlier_version_has_the_present_keys():
    found = formats.recorded(OLD)
    assert found["tank"] == {**{k: OLD["tank"][k] for k in ("outline", "roughness")}, "lid": False, "thickness": 0.004}
    assert found["sea"] == OLD["water"] and "water" not in found and found["ship"] == {"draught": 0.1}
    assert (found["grains"]["table"], found["grains"]["shares"]) == (None, "number")
    assert found["shapes"] == {"a": OLD["shapes"]["a"], "b": {"disc": True, "share": 0.5, "diameter": 0.004}}
    assert found["kinds"] == {"light": {"share": 0.3, "density": 700.0, "against": None}}
    assert found["motion"]["history"]["file"]["columns"] == {"time": [0.0, 1.0], "roll": [0.0, 0.1]}
    assert OLD["ship"]["sheet"] == 0.004  # the table that was given stays as it was


def test_water_without_a_format_is_asked_for_it(tmp_path):
    """[water] of a preset that says no format is the sea of format 2, which has no particles."""
    (tmp_path / "mine.toml").write_text('title = "a"\n[water]\ndepth = "100 mm"\nspacing = "5 mm"\n')
    assert "mine.toml: water.spacing: write format = 3 at the top of the file" in error_of(load, tmp_path / "mine.toml")
