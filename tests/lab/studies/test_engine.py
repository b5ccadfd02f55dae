"""What the verbs share: names are beginnings, and a result is kept with what made it."""

import json

import numpy as np
import pytest

from lab.base.errors import LabError
from lab.report.kept import Made, plain
from lab.studies.engine import Kept, choose


def test_names_are_beginnings_and_without_names_the_usual_ones_are_taken():
    known = ("fall-far", "fall-near", "roll")
    assert choose(["roll", "fall"], known, "case") == [*known]
    assert choose(["fall-n"], known, "case", {"roll"}) == ["fall-near"]
    assert choose([], known, "case", {"roll"}) == ["roll"]
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


@pytest.mark.parametrize("text", ["[1, 2", "[1, 2]", '{"one": 2}'])
def test_a_file_that_holds_no_results_is_one_sentence(text, tmp_path):
    (tmp_path / "kept.json").write_text(text)
    with pytest.raises(LabError, match="holds no results"):
        Kept(tmp_path / "kept.json", "", None)


def test_what_is_not_known_of_a_result_is_left_out_of_its_words():
    assert Made("0.1.0").words == "version 0.1.0"
    assert Made("0.2.0", "2026-11-23", "AMD EPYC").words == "version 0.2.0, 2026-11-23, AMD EPYC"
    assert plain({"a": (1.0, np.inf, np.int64(3))}) == {"a": [1.0, None, 3]}
