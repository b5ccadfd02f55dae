"""Whatever a preset says, it is read, or refused in one sentence that names a key. `FUZZ=20000` tries so many."""

import os
import re
import tomllib
import warnings
from pathlib import Path

import pytest
from hypothesis import given

from lab.base.errors import LabError
from lab.preset.fields import NAME, walk
from lab.preset.recorded import checked, from_table, to_table
from lab.preset.schema import Preset, resolve
from lab.preset.units import quoted
from tests.lab.preset.test_malformed import LISTED, RICH, TABLES, WET, assert_sentence, examples
from tests.oracles.made_presets import presets

SHIP = {
    **{name: table for name, table in tomllib.loads(RICH).items() if name not in ("motion", "parts", "tank")},
    "tank": {"width": "100 mm", "height": "80 mm"},
    "ship": {
        **{"breadth": "400 mm", "height": "300 mm", "draught": "110 mm", "gravity_height": "110 mm"},
        "gyradius": "130 mm",
        "hold": ["0 mm", "100 mm"],
    },
    "waves": {"amplitude": "10 mm", "frequency": "5 rad/s"},
}
FEW, MANY = 150, int(os.environ.get("FUZZ", 20_000))
BASES = [*map(tomllib.loads, (RICH, LISTED, WET)), SHIP]
TOP = {key.partition(".")[0] for key, _ in walk(Preset)}


@pytest.fixture
def folder(tmp_path, monkeypatch) -> Path:
    """The working directory, with the tables that presets name."""
    for name, text in TABLES.items():
        (tmp_path / name).write_text(text)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize("number", [FEW, pytest.param(MANY, marks=pytest.mark.slow)])
def test_a_preset_of_any_kind_is_read_or_refused_in_a_sentence_that_names_a_key(folder, number):
    said = []

    @examples(number)
    @given(presets(BASES))
    def check(table):
        said.append(tried(table))

    check()
    assert len(said) >= 0.9 * number
    assert 0.05 < said.count("") / len(said) < 0.7
    assert len(set(said)) > 0.2 * FEW  # many keys are at fault, not always the same


def tried(table: dict) -> str:
    """What was said against a preset; empty if it was read, and then it comes back from a file as it was."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            preset = resolve(table)
    except LabError as error:
        assert_sentence(str(error))
        assert names_a_key(str(error), table), error
        return str(error).partition(":")[0]
    assert checked(from_table(to_table(preset))) == preset
    return ""


def names_a_key(sentence: str, table: dict) -> bool:
    """Whether a sentence begins with a key of a preset, or with one that this table has."""
    return sentence.startswith((*TOP, *(quoted(str(own))[1:-1] for own in table)))


def test_every_key_has_a_sentence():
    for key, taken in walk(Preset):
        assert re.fullmatch(r"[A-Z].*\.", taken.doc), key
        assert NAME not in taken.doc
