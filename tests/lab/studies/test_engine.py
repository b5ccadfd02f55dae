"""What the verbs share: names are beginnings, and a result is kept with what made it."""

import json

import numpy as np
import pytest

from lab.base.errors import LabError
from lab.report.kept import Made, plain, processor
from lab.studies.engine import Kept, choose


def test_names_are_beginnings_and_without_names_the_usual_ones_are_taken():
    known = ("fall-far", "fall-near", "roll")
    assert choose(["roll", "fall"], known, "case") == [*known]
    assert choose(["fall-n"], known, "case", {"roll"}) == ["fall-near"]
    assert choose([], known, "case", {"roll"}) == ["roll"]
    assert choose(["fall", "roll"], ["fall", *known, "roll-far"], "case") == ["fall", "roll"]
    with pytest.raises(LabError, match=r"^there is no case spin; there are fall-far, fall-near, roll\.$"):
        choose(["roll", "spin"], known, "case")


def test_a_result_is_kept_with_what_made_it_and_is_none_of_another_version_or_choice(tmp_path):
    path = tmp_path / "new" / "kept.json"
    first = Kept(path, "bench trial", {"fast": True})
    first.keep("one", {"value": np.float64(2.0), "none": float("nan")})
    assert first["one"]["none"] is None, "the page is the same before and after it was read again"
    kept = Kept(path, "bench trial", {"fast": True})
    assert "one" in kept and kept["one"]["value"] == 2.0 and kept["one"]["none"] is None
    made = kept["one"]["made"]
    assert made["command"] == "cargolab bench trial" and all(made[name] for name in ("version", "date", "processor"))
    assert "one" not in Kept(path, "bench trial", {"fast": False})
    data = json.loads(path.read_text())
    data["one"]["made"]["packages"]["numpy"] = "0"
    path.write_text(json.dumps(data))
    assert "one" not in Kept(path, "bench trial", {"fast": True})


@pytest.mark.parametrize(
    "other",
    [("code", "0"), ("made", "packages", "numpy", "0"), ("made", "processor", "another"), ("fault", "it broke off")],
)
def test_a_result_of_other_code_or_another_processor_is_made_again_and_shown_until_then(other, tmp_path):
    path = tmp_path / "kept.json"
    Kept(path, "bench trial", {"fast": True}).keep("one", {"value": 2.0, "fault": ""})
    data = json.loads(path.read_text())
    *keys, last, value = other
    place = data["one"]
    for key in keys:
        place = place[key]
    place[last] = value
    path.write_text(json.dumps(data))
    kept = Kept(path, "bench trial", {"fast": True})
    assert "one" not in kept
    assert kept.shown(["one", "two"])["one"]["value"] == 2.0


@pytest.mark.parametrize("text", ["[1, 2", "[1, 2]", '{"one": 2}'])
def test_a_file_that_holds_no_results_is_one_sentence(text, tmp_path):
    (tmp_path / "kept.json").write_text(text)
    with pytest.raises(LabError, match="holds no results"):
        Kept(tmp_path / "kept.json", "", None)


def test_numbers_that_json_lacks_are_none():
    assert plain({"a": (1.0, np.inf, np.int64(3))}) == {"a": [1.0, None, 3]}


@pytest.mark.parametrize(
    ("family", "model", "name"), [("25", "1", "Zen 3"), ("25", "17", "Zen 4"), ("26", "2", "Zen 5"), ("99", "1", None)]
)
def test_a_processor_is_told_with_its_generation(family, model, name, tmp_path):
    """AMD calls all its server processors EPYC; the first of several cores is read."""
    core = f"processor : 0\ncpu family : {family}\nmodel : {model}\nmodel name : AMD EPYC\nflags : fpu\n\n"
    (tmp_path / "cpuinfo").write_text(core + core.replace(family, "1"))
    assert processor(tmp_path / "cpuinfo") == ("AMD EPYC" if name is None else f"AMD EPYC, {name}")


@pytest.mark.parametrize(
    ("made", "said"),
    [
        (Made("0.2.0", "2026-11-23", "AMD EPYC, Zen 4"), "version 0.2.0, 2026-11-23, AMD EPYC, Zen 4"),
        (Made("0.2.0", "2026-11-23"), "version 0.2.0, 2026-11-23, processor not recorded"),
        (Made("0.1.0"), "version 0.1.0, date and processor not recorded"),
    ],
)
def test_what_made_a_result_says_what_was_not_kept_of_it(made, said):
    assert made.words == said and said.startswith(made.when) and "processor" not in made.when
