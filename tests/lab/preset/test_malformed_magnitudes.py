"""Numbers of any magnitude, of every key that takes one: refused in a sentence, or what they say can be built."""

import tomllib
from collections.abc import Iterator
from typing import Annotated, Any, get_args, get_origin

import numpy as np
import pytest

from lab.assembly import room, ship, ship_tables
from lab.assembly.scene import build
from lab.base import memory
from lab.base.errors import LabError
from lab.preset.fields import Taken, taken_from, walk
from lab.preset.find import load
from lab.preset.schema import Preset
from lab.report.explain import explain
from tests.lab.preset.test_malformed import RICH, TABLES, WET, assert_sentence, tried, write

EXPONENTS = 30  # numbers come from 1e-30 to 1e30
FEW, MANY = 2, 12  # of them for each key
KINDS = """[kinds.NAME]
share = 0.3
young = "1e9 Pa"
[kinds.NAME.against]
friction = 0.3
"""
SHAPES = """[shapes.NAME]
share = 0.5
descriptors = [0.1, 0.05]
[shapes.b]
share = 0.5
disc = true
"""


def numeric(kind: type) -> Iterator[tuple[str, Taken]]:
    """Every key below a dataclass that takes numbers, and what it takes."""
    for key, taken in walk(kind):
        if taken.kind in (int, float) or get_origin(taken.kind) is tuple:
            yield key, taken


NUMERIC = dict(numeric(Preset))


@pytest.fixture(scope="module")
def bases(tmp_path_factory) -> dict[str, dict]:
    """Presets in order, by the first part of the keys that they are to have."""
    folder = tmp_path_factory.mktemp("bases")
    for name, text in TABLES.items():
        (folder / name).write_text(text)
    rich = tomllib.loads(RICH)
    barge = tomllib.loads(load("ship/barge-3dof-quick", {"grains.diameter": "12 mm"}).given_text)
    outlines = rich | {"grains": {"diameter": "6 mm", "count": 20}} | tomllib.loads(SHAPES)
    found = dict.fromkeys(("ship", "sea", "waves"), barge)
    found |= dict.fromkeys(("water", "gauges"), tomllib.loads(WET))
    found |= {"kinds": rich | tomllib.loads(KINDS), "shapes": outlines}
    return {"": rich, "folder": folder} | found


@pytest.fixture(autouse=True)
def coarse_tables(monkeypatch):
    """Hulls' tables of few frequencies and panels, which take a tenth of a second."""
    monkeypatch.setattr(ship, "FREQUENCIES", 12)
    monkeypatch.setattr(ship_tables, "PANELS", 24)


def magnitudes(taken: Any, random: np.random.Generator, count: int) -> Iterator[object]:
    """Extreme values as a person may write them, with the key's unit; a list has one of them in it."""
    exponents = random.uniform(-EXPONENTS, EXPONENTS, count)
    signs = random.choice([1.0, 1.0, 1.0, -1.0], count)
    for number in (*(signs * 10.0**exponents).tolist(), float("inf"), float("nan")):
        yield filled(taken.kind, taken, number, random)


def filled(kind: Any, taken: Any, number: float, random: np.random.Generator) -> object:
    if get_origin(kind) is Annotated:
        inner = taken_from(kind)
        return filled(inner.kind, inner, number, random)
    if get_origin(kind) is tuple:
        parts = get_args(kind)
        parts = parts[:1] * 4 if parts[-1] is Ellipsis else parts
        extreme = int(random.integers(len(parts)))
        tame = random.permutation(np.linspace(0.01, 0.05, len(parts)))
        return [filled(part, taken, number if k == extreme else float(tame[k]), random) for k, part in enumerate(parts)]
    if kind is int:
        return int(number) if abs(number) < 1e31 else number
    return f"{number:.3g} {taken.symbol}" if taken.symbol != "1" else number


def put(table: dict, key: str, value: object) -> dict:
    """The table with a value under a dotted key, that of the first of the tables that people name."""
    part, _, rest = key.partition(".")
    if part == "NAME":
        part = next(iter(table), "a")
    inner = table.get(part)
    return table | {part: put(inner if isinstance(inner, dict) else {}, rest, value) if rest else value}


@pytest.mark.parametrize("count", [FEW, pytest.param(MANY, marks=pytest.mark.slow)])
@pytest.mark.parametrize("key", NUMERIC)
def test_any_magnitude_is_refused_in_one_sentence_or_can_be_built(bases, key, count):
    base, random = bases.get(key.partition(".")[0], bases[""]), np.random.default_rng([count, *key.encode()])
    for value in magnitudes(NUMERIC[key], random, count):
        tried(write(bases["folder"], put(base, key, value)))


def test_the_bases_are_valid(bases):
    for part in {*(key.partition(".")[0] for key in NUMERIC)} & bases.keys():
        assert tried(write(bases["folder"], bases[part])), part


@pytest.mark.parametrize(
    ("overrides", "said"),
    [
        ({"ship.breadth": "1e9 m"}, r"ship\.breadth: must be at most 1 km \(got 1e9 m\)"),
        ({"ship.breadth": "800 m"}, r"ship\.breadth: 800 m of breadth and 110 mm of draught are too far apart"),
        ({"ship.axis": '["1 km", "0 m"]'}, r"ship\.axis: a list of 2 is needed"),
        ({"ship.axis": ["1 km", "0 m"]}, r"ship\.axis: 1 km is more than 10 times the hull's size"),
        ({"ship.gyradius": "1 km", "ship.roll_period": False}, r"ship\.gyradius: 1 km is more than 10 times"),
        ({"sea.density": "1.025 kg/m^3"}, r"sea\.density: must be at least 500 kg/m\^3 \(got 1\.025 kg/m\^3\)"),
        ({"sea.density": "1e-12 kg/m^3"}, r"sea\.density: must be at least 500 kg/m\^3"),
        ({"sea.density": "1e6 kg/m^3"}, r"sea\.density: must be at most 2000 kg/m\^3"),
        ({"sea.depth": "1e9 m"}, r"sea\.depth: must be at most 20 km"),
    ],
)
def test_impossible_values_of_a_ship_name_their_key(overrides, said):
    with pytest.raises(LabError, match=said) as refused:
        build(load("ship/barge-roll-quick", overrides).resolved)
    assert_sentence(str(refused.value))


@pytest.fixture
def small_machine(monkeypatch):
    """A machine of 1 GB."""
    monkeypatch.setattr(room, "machine_memory", lambda: 1_000_000_000)


@pytest.mark.parametrize(
    ("overrides", "said"),
    [
        (
            {"run.repeats": 100_000},
            "run.repeats: 100000 beds of 990 grains take some 200 GB of memory, at 2 kB a grain, and half of this "
            "machine's is 500 MB: take at most 250 beds.",
        ),
        (
            {"run.repeats": 1, "grains.count": 900_000, "tank.width": "4 m", "tank.height": "4 m"},
            "grains.count: 900000 grains take some 1.8 GB of memory, at 2 kB a grain, and half of this machine's is "
            "500 MB: take fewer grains.",
        ),
    ],
)
@pytest.mark.parametrize("ask", [lambda loaded: build(loaded.resolved), explain])
def test_more_beds_than_fit_into_memory_are_refused_at_once(small_machine, ask, overrides, said):
    loaded = load("tilting/quick", {"grains.depth": False, "grains.count": 990, "tank.width": "300 mm"} | overrides)
    with pytest.raises(LabError) as refused:
        ask(loaded)
    assert str(refused.value) == said


def test_the_number_of_beds_that_fit_is_accepted(small_machine, monkeypatch):
    overrides = {"grains.depth": False, "grains.count": 90, "run.repeats": 2500, "run.arch": "cpu"}
    made = []
    monkeypatch.setattr("lab.report.cost.build", lambda preset: made.append(preset.run.repeats) or build(preset))
    text = explain(load("tilting/quick", overrides))
    assert made == [1]
    assert "2500, seeds 1 to 2500" in text and "90 in each" in text and "in the first" in text


def test_memory_is_that_of_the_machine_or_its_limit(tmp_path, monkeypatch):
    whole = memory.machine_memory()
    assert 2**28 < whole < 2**50
    monkeypatch.setattr(memory, "GROUP", tmp_path / "memory.max")
    for text, allowed in (("1000000\n", 1_000_000), ("max\n", float("inf"))):
        memory.GROUP.write_text(text)
        assert min(whole, allowed) <= memory.machine_memory() <= allowed
