"""What the commands list, and what they print as JSON for other programs."""

import json

import pytest
from click.testing import CliRunner

from lab.cli import main
from lab.preset.find import listed, names
from tests.lab.studies.test_suite import stub, suite


def call(*words: str):
    return CliRunner().invoke(main, words)


def test_a_group_and_a_word_choose_presets():
    ships = call("list", "ship").stdout.splitlines()
    assert len(ships) > 5 and all(line.startswith("ship/") for line in ships)
    found = call("list", "--search", "ANTI-ROLL").stdout
    assert "ship/anti-roll-tank" in found and "tilting" not in found
    both = call("list", "sloshing", "--search", "spheric").stdout.splitlines()
    assert all(line.startswith("sloshing/") for line in both)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("shp",), "the groups are bulk, flooding, funnel, "),
        (("ship", "--search", "porridge"), 'no preset has "porridge"'),
    ],
)
def test_nothing_found_is_said_in_a_sentence(words, said):
    done = call("list", *words)
    assert done.exit_code == 2 and done.stderr.count("\n") == 1 and said in done.stderr and not done.stdout


def test_the_list_as_json_has_every_preset_with_its_source():
    found = json.loads(call("list", "--json").stdout)
    assert {one["name"]: one["title"] for one in found} == names() and found == listed()
    assert any(one["quick"] and one["name"].endswith("-quick") for one in found)
    assert next(one for one in found if one["name"] == "tilting/acetate")["source"]


def test_what_explains_and_judges_a_preset_as_json():
    told = json.loads(call("explain", "ship/barge-empty", "--json").stdout)
    assert told["name"] == "ship/barge-empty" and {"Scene", "Ship", "Step", "Cost"} <= set(told["sections"])
    assert told["preset"]["ship"] and told["sections"]["Scene"]["tank"] in call("explain", "ship/barge-empty").stdout


def test_the_sheet_of_criteria_as_json(tmp_path):
    sheet = json.loads(call("stability", "ship/handysize-grain", "--json", "--out", str(tmp_path)).stdout)
    assert {"criteria", "hydrostatics", "righting-levers", "hold", "folder"} <= set(sheet)
    limits = [row["limit"] if "limit" in row else row["required"] for row in sheet["criteria"]]
    assert limits and {row["verdict"] for row in sheet["criteria"]} <= {"pass", "fail"}
    assert all(isinstance(row["T m"], float) for row in sheet["hydrostatics"])


def test_cases_that_were_verified_as_json(tmp_path, monkeypatch):
    monkeypatch.setattr("lab.studies.verify.SUITE", suite((stub("good", 1.05), stub("off", 1.2))))
    done = call("verify", "--json", "--out", str(tmp_path))
    found = json.loads(done.stdout)
    assert done.exit_code == 1 and not found["passed"] and "failed: off" in done.stderr
    assert {name: case["passed"] for name, case in found["cases"].items()} == {"good": True, "off": False}
    assert found["cases"]["off"]["lines"][0]["reference"] == 1.0
    named = json.loads(call("verify", "good", "--json", "--out", str(tmp_path)).stdout)
    assert named["passed"] and list(named["cases"]) == ["good"]
