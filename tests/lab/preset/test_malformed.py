"""Malformed input ends in one sentence and exit code 2, never in a traceback; accepted presets can be built."""

import json
import os
import shutil
import tomllib
import warnings
from collections.abc import Iterator
from contextlib import nullcontext
from functools import cache
from pathlib import Path
from types import SimpleNamespace

import h5py
import numpy as np
import pytest
from click.testing import CliRunner
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import presets
from lab.assembly.grains import grain_count
from lab.assembly.scene import build
from lab.assembly.water import most_drops
from lab.base import toml
from lab.base.errors import LabError
from lab.cli import main
from lab.preset.fields import walk
from lab.preset.find import load, names
from lab.preset.formats import OldFormat
from lab.preset.schema import Preset
from lab.preset.units import NUMBER
from lab.recording import Recorder
from lab.runs.checkpoint import Checkpoint, read_checkpoint
from lab.runs.run import prepare
from lab.sweeps import grid
from lab.sweeps import sweep as sweeps
from tests.oracles.presets import MATERIAL
from tests.oracles.synthetic import frame, sample

RICH = """
title = "Everything at once"
[tank]
outline = [["-50 mm", "0 mm"], ["50 mm", "0 mm"], ["60 mm", "80 mm"], ["-60 mm", "80 mm"]]
lid = false
roughness = "4 mm"
[grains]
distribution = "table"
table = [["4 mm", 0.3], ["6 mm", 0.7]]
spread = "5 %"
depth = "30 mm"
surface = "disturbed"
[material]
density = "1319 kg/m^3"
young = "3.2 GPa"
poisson = 0.28
friction = 0.25
restitution = 0.6
[wall]
friction = 0.4
[contact]
rolling = "none"
[motion]
soft_start = "0.5 s"
[motion.history]
file = "record.csv"
angle_unit = "deg"
centre = ["0 mm", "40 mm"]
[motion.sway]
amplitude = "5 mm"
frequency = "1.1 Hz"
phase = "90 deg"
[parts.gate]
points = [["0 mm", "50 mm"], ["0 mm", "75 mm"]]
move = ["0 mm", "60 mm"]
start = "0.2 s"
speed = "0.5 m/s"
acceleration = "9.81 m/s^2"
[run]
duration = "1 s"
repeats = 2
step = "auto"
[record]
series_rate = "200 Hz"
[video]
width = 640
height = 360
"""

LISTED = f"""
title = "Three grains"
[tank]
width = "40 mm"
height = "40 mm"
[grains]
bed = "grains.csv"
{MATERIAL}
[run]
duration = "1 s"
settle = false
"""

WET = """
format = 3
title = "Water in a tank"
[tank]
outline = [["-60 mm", "0 mm"], ["60 mm", "0 mm"], ["80 mm", "20 mm"], ["80 mm", "90 mm"], ["-60 mm", "90 mm"]]
lid = false
[water]
depth = "40 mm"
spacing = "5 mm"
scheme = "as_F"
delta = 0.05
[gauges.P1]
place = ["-60 mm", "30 mm"]
length = "4 mm"
response = "1 ms"
[gauges.L1]
kind = "level"
y = "10 mm"
[motion.sway]
amplitude = "3 mm"
frequency = "1.5 Hz"
[run]
duration = "2 s"
"""

TABLES = {
    "record.csv": "time,roll,heave\n" + "".join(f"{0.1 * k:.1f},{k * (20 - k) % 7},0.00{k % 5}\n" for k in range(20)),
    "grains.csv": "y,z,radius,vy,vz,omega\n0,0.005,0.003,0,0,0\n0.01,0.02,0.003,0.1,0,5\n-0.01,0.03,0.002,0,-0.1,0\n",
    "roll-damper.csv": "time,x\n" + "".join(f"{4 * k},{k * k * (30 - 2 * k)}\n" for k in range(11)),
    "roll-damper-empty.csv": "time,x\n" + "".join(f"{4 * k},{k * k * (30 - 2 * k)}\n" for k in range(11)),
    "drop.csv": "time,heave\n" + "".join(f"{0.1 * k:.1f},{-k * k * (10 - k) ** 2}e-3\n" for k in range(11)),
    "standing-wave.csv": "time,sway\n" + "".join(f"{0.1 * k:.1f},{k * k * (30 - 2 * k)}e-3\n" for k in range(11)),
    "moving-square.csv": "time,sway\n" + "".join(f"{k},{k * k * (30 - 2 * k)}e-3\n" for k in range(11)),
    "wave-flume.csv": "time,sway\n" + "".join(f"{2 * k},{k * k * (30 - 2 * k)}e-5\n" for k in range(11)),
    "flap-flume.csv": "time,roll\n" + "".join(f"{2 * k},{k * k * (30 - 2 * k)}e-5\n" for k in range(11)),
    "ciemito-flume.csv": "time,sway\n" + "".join(f"{4 * k},{k * k * (30 - 2 * k)}e-5\n" for k in range(11)),
    "impact.csv": "time,roll\n" + "".join(f"{0.1 * k:.1f},{k * k * (30 - 2 * k)}e-3\n" for k in range(11)),
    "stack-fall.csv": "y,z,radius\n-0.006,0.0007,0.0007\n0,0.0007,0.0007\n0.003,0.003,0.0007\n",
}

ODD_TEXTS = ["", " ", "\u202e", "🚢" * 30, "x" * 5000, "é\u0301", "a\nb", "\ufeff", "nan", "inf", "../..", "~", "\x7f"]
ODD_NUMBERS = [0, -1, 1, 2**31, 2**63, -(2**63), 10**40, 1e-300, 1e300, -0.0, float("nan"), float("inf"), -float("inf")]
ODD_QUANTITIES = [
    f"{number} {unit}"
    for number in ("0", "-3", "1e-300", "1e300", "1e999", "nan", "3", "1e-9", "1e6")
    for unit in ("m", "mm", "s", "deg", "deg/s", "Hz", "Pa", "kg/m^3", "m/s", "%", "N s/m", "furlong", "")
]
ODD = (
    st.sampled_from(ODD_TEXTS)
    | st.sampled_from(ODD_NUMBERS)
    | st.sampled_from(ODD_QUANTITIES)
    | st.booleans()
    | st.text(st.characters(exclude_categories=["Cs"]), max_size=20)
    | st.integers(-(2**63), 2**63)
    | st.floats()
)
ODD_TREES = st.recursive(
    ODD,
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.sampled_from(["x", "file", "é"]), inner, max_size=2),
)

MOST_GRAINS, MOST_DROPS = 600, 100_000  # of a mangled preset that is built
KEYS = sorted(key for key, _ in walk(Preset))

often = pytest.mark.parametrize("times", [1, pytest.param(50, marks=pytest.mark.slow)])


ONE = "ship/anti-roll-tank"
SHIPS = [name for name in names() if name.startswith("ship/") and name != ONE]  # their tables take a second each


def examples(number: int) -> settings:
    """The same examples at every run."""
    return settings(
        max_examples=number, derandomize=True, database=None, deadline=None, suppress_health_check=list(HealthCheck)
    )


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    """A folder with the tables that the presets name."""
    made = tmp_path_factory.mktemp("presets")
    for name, text in TABLES.items():
        (made / name).write_text(text)
    for surface in Path(presets.__file__).parent.rglob("*.stl"):
        shutil.copy(surface, made)
    return made


SMALL_BED = {"grains.count": 30, "run.repeats": 1}
OF_TESTS = {"rich": RICH, "listed": LISTED, "wet": WET}
# Presets that are in order: all that ship, which `test_presets.py` asks for, and four that say what these do not
SOUND = [*[*OF_TESTS, "small"] * 12, *(name for name in names() if name not in SHIPS)]


@cache
def text_of(name: str) -> str:
    """The text of one of the SOUND presets."""
    if name in OF_TESTS:
        return OF_TESTS[name]
    return (load("tilting/quick", SMALL_BED) if name == "small" else load(name)).given_text


def call(*arguments: str):
    return CliRunner().invoke(main, [str(argument) for argument in arguments], prog_name="cargolab")


def refused(done) -> str:
    """The message of a command, which must have ended with one sentence and exit code 2.

    A preset that does not say its format may be told before that its [water] is read as the sea.
    """
    assert isinstance(done.exception, SystemExit), repr(done.exception)
    said = "".join(line for line in done.stderr.splitlines(True) if " is read as the sea here, " not in line)
    assert done.exit_code == 2 and said.startswith("cargolab: ") and said.count("\n") == 1, said
    assert_sentence(said.strip())
    return said


def assert_sentence(said: str) -> None:
    assert said[-1] in ".?" and len(said) < 800 and said.isprintable(), said


def is_small(preset: Preset) -> bool:
    """Whether a mangled preset is built: a kilometre of water takes minutes to pack."""
    return preset.run.repeats < 50 and grain_count(preset) < MOST_GRAINS and most_drops(preset) < MOST_DROPS


def tried(path: Path, overrides: dict | None = None) -> bool:
    """Whether a preset loads and can be built; if not, it was refused in one sentence."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")  # arithmetic that fails is said on the screen, too
            warnings.simplefilter("ignore", OldFormat)  # a sentence, where a mangled preset does not say its format
            preset = load(path, overrides).resolved
            if is_small(preset):
                build(preset)
    except LabError as error:
        assert_sentence(str(error))
        return False
    return True


# ---- presets, mangled


@st.composite
def mangled(draw) -> dict:
    """A sound preset with one or two of its keys dropped, renamed, swapped, or given another value."""
    table = tomllib.loads(text_of(draw(st.sampled_from(SOUND))))
    for _ in range(draw(st.integers(1, 2))):
        draw(st.sampled_from([drop, rename, swap, replace, quantity, scale, scale, scale, bury, flatten, double]))(
            draw, table
        )
    return table


def places(table: dict | list) -> Iterator[tuple]:
    """Every place of a table and of the tables and lists in it: what holds it, and its key or index."""
    for key, value in list(table.items() if isinstance(table, dict) else enumerate(table)):
        yield table, key
        if isinstance(value, dict | list):
            yield from places(value)


def place(draw, table: dict):
    return draw(st.sampled_from(list(places(table)) or [({"": 0}, "")]))


def drop(draw, table):
    holder, key = place(draw, table)
    del holder[key]


def rename(draw, table):
    holder, key = place(draw, table)
    if isinstance(holder, dict):
        others = [key + "s", key[:-1], key.upper(), "é", "", "a.b", "x" * 3000, "based_on", "quick"]
        holder[draw(st.sampled_from(others))] = holder.pop(key)


def swap(draw, table):
    (holder, key), (other, at) = place(draw, table), place(draw, table)
    first, second = json.dumps(holder[key]), json.dumps(other[at])  # copies: no table may come to hold itself
    holder[key] = json.loads(second)
    other[at] = json.loads(first)


def replace(draw, table):
    holder, key = place(draw, table)
    holder[key] = draw(ODD_TREES)


def quantity(draw, table):
    holder, key = place(draw, table)
    holder[key] = draw(st.sampled_from(ODD_QUANTITIES))


def scale(draw, table):
    """Another number with the same unit."""
    quantities = [(holder, key) for holder, key in places(table) if NUMBER.match(str(holder[key]))]
    holder, key = draw(st.sampled_from(quantities or [({"": 0}, "")]))
    number = draw(st.sampled_from(["0", "-1", "1e300", "1e-300", "1e14", "1e-14", "1e6", "1e-6", "3", "1e30", "1e-30"]))
    value = holder[key]
    holder[key] = number + value[NUMBER.match(value).end() :] if isinstance(value, str) else float(number)


def bury(draw, table):
    holder, key = place(draw, table)
    holder[key] = draw(st.sampled_from([{"x": holder[key]}, [holder[key]], [holder[key]] * 3, {}, []]))


def flatten(draw, table):
    holder, key = place(draw, table)
    if isinstance(holder[key], dict):
        table |= holder.pop(key)


def double(draw, table):
    """Insert one of the lab's keys where it may not belong."""
    parts = draw(st.sampled_from(KEYS)).replace("NAME", "gate").split(".")
    for part in parts[:-1]:
        inner = table.get(part)
        table[part] = inner if isinstance(inner, dict) else {}
        table = table[part]
    table[parts[-1]] = draw(ODD)


def write(folder: Path, table: dict) -> Path:
    path = folder / "mangled.toml"
    path.write_bytes(toml.dumps(table).encode())
    return path


def test_the_presets_to_be_mangled_are_valid(folder):
    load(write(folder, tomllib.loads(text_of("small"))))
    for text in OF_TESTS.values():
        assert tried(write(folder, tomllib.loads(text)))


@often
def test_a_mangled_preset_is_refused_in_one_sentence_or_can_be_built(folder, times):
    passed = []

    @examples(30 * times)
    @given(mangled())
    def check(table):
        passed.append(tried(write(folder, table)))

    check()
    assert (0.05 if times > 1 else 0.0) <= np.mean(passed) < 0.5  # of few it is chance how many can be built


@often
def test_mangled_overrides_are_refused_in_one_sentence_or_can_be_built(folder, times):
    (folder / "rich.toml").write_text(RICH)

    @examples(30 * times)
    @given(st.dictionaries(st.sampled_from(KEYS) | st.text(max_size=9), ODD_TREES, min_size=1, max_size=3))
    def check(overrides):
        tried(folder / "rich.toml", overrides)

    check()


@often
def test_damaged_bytes_of_a_preset_are_refused_in_one_sentence_or_can_be_built(folder, times):
    @examples(30 * times)
    @given(st.sampled_from(SOUND), st.data())
    def check(name, data):
        (folder / "bytes.toml").write_bytes(damaged(data.draw, text_of(name).encode()))
        tried(folder / "bytes.toml")

    check()


def damaged(draw, content: bytes) -> bytes:
    """The content with noise in it, a piece cut out, cut short, or nothing but noise."""
    begin, end = sorted((draw(st.integers(0, len(content))), draw(st.integers(0, len(content)))))
    noise = draw(st.binary(max_size=40) | st.text(max_size=20).map(lambda text: text.encode("utf-8", "replace")))
    tail = [content[end:], content[begin:], b""]
    return draw(st.sampled_from([content[:begin], b""])) + noise + draw(st.sampled_from(tail))


@often
@pytest.mark.parametrize(("name", "text"), [("grains.csv", LISTED), ("record.csv", RICH)])
def test_damaged_tables_are_refused_in_one_sentence_or_can_be_built(folder, name, text, times, tmp_path):
    (tmp_path / "preset.toml").write_text(text)

    @examples(50 * times)
    @given(mangled_table(TABLES[name]) | st.data())
    def check(content):
        if not isinstance(content, bytes):
            content = damaged(content.draw, TABLES[name].encode())
        (tmp_path / name).write_bytes(content)
        tried(tmp_path / "preset.toml")

    check()


@st.composite
def mangled_table(draw, text: str) -> bytes:
    """A CSV file with some invalid cells."""
    rows = [line.split(",") for line in text.splitlines()]
    for _ in range(draw(st.integers(1, 4))):
        row = draw(st.sampled_from(rows))
        change = draw(st.sampled_from(["cell", "cell", "longer", "shorter", "again", "without"]))
        if change == "cell" and row:
            numbers = ["0", "-1", "1e300", "-1e300", "1e-300", "nan", "inf", "1e999", "", "0.5", "1,5", '"', "1e6"]
            row[draw(st.integers(0, len(row) - 1))] = draw(st.sampled_from(numbers) | st.text(max_size=5))
        elif change == "longer":
            row.append("1")
        elif change == "shorter":
            del row[-1:]
        elif change == "again":
            rows.insert(draw(st.integers(0, len(rows))), list(row))
        elif len(rows) > 1:
            rows.remove(row)
    return "\n".join(",".join(row) for row in rows).encode("utf-8", "replace")


# ---- the command


@pytest.fixture
def idle(monkeypatch, tmp_path):
    """The commands prepare what they are asked for and go no further."""

    def run_preset(name, overrides, out, **_):
        preset = load(name, overrides)
        if is_small(preset.resolved):
            prepare(preset, tmp_path)
        return done

    def plan(sweep, *_):
        grains = [point.resolved.run.repeats * grain_count(point.resolved) for point in sweep.points]
        if max(grains) < MOST_GRAINS:
            list(sweeps._plan(sweep))
        assert len(sweep.settings) == len(sweep.points)
        return done

    done = SimpleNamespace(summary_text="", folder=tmp_path)
    monkeypatch.setattr("lab.runs.runner.run_preset", run_preset)
    monkeypatch.setattr("lab.paint.beside.second_process", nullcontext)
    monkeypatch.setattr("lab.sweeps.sweep.complete", plan)
    monkeypatch.setattr("lab.runs.runner._complete", lambda *_: done)


@often
def test_the_command_refuses_mangled_presets(idle, folder, times):
    @examples(50 * times)
    @given(mangled())
    def check(table):
        ends_well(call("run", write(folder, table), "--no-video"))

    check()


def ends_well(done) -> None:
    if done.exit_code != 0:
        refused(done)


SETTINGS = st.tuples(st.sampled_from(KEYS) | st.text(max_size=9), ODD | st.text(max_size=12)).map(
    lambda pair: f"{pair[0]}={pair[1]}"
)


@often
def test_the_command_refuses_mangled_settings(idle, folder, times):
    (folder / "rich.toml").write_text(RICH)

    @examples(35 * times)
    @given(st.lists(SETTINGS | st.text(max_size=20), min_size=1, max_size=3))
    def check(texts):
        ends_well(call("run", folder / "rich.toml", *[word for text in texts for word in ("--set", text)]))

    check()


ENDS = st.sampled_from(["0", "-1", "1", "3", "1e300", "1e-300", "1e999", "nan", "inf", "", "x", "0.5", "1e", "--1"])
COUNTS = st.sampled_from(["0", "1", "2", "5", "-3", "2.5", "10001", "99999999999999999999", "", "x"])
UNITS = st.sampled_from(["", " mm", "mm", " Hz", " furlong", " %", " deg", "::", ":log", ":log mm", ": log Hz", ","])
RANGES = st.tuples(ENDS, UNITS, ENDS, UNITS, COUNTS, UNITS).map(lambda t: f"{t[0]}{t[1]}:{t[2]}{t[3]}:{t[4]}{t[5]}")
LISTS = st.lists(ENDS | st.sampled_from(ODD_QUANTITIES), max_size=4).map(", ".join)


@often
def test_the_command_refuses_mangled_ranges(idle, folder, times, tmp_path):
    (folder / "rich.toml").write_text(RICH)
    axis = st.tuples(st.sampled_from(KEYS), RANGES | LISTS | st.text(max_size=12)).map("=".join)

    @examples(35 * times)
    @given(st.lists(axis, min_size=1, max_size=2))
    def check(texts):
        words = [word for text in texts for word in ("--set", text)]
        ends_well(call("sweep", folder / "rich.toml", *words, "--out", tmp_path / "sweep"))

    check()


# ---- files of the lab, damaged

SMALL = {
    "tank": {"width": "24 mm", "height": "24 mm"},
    "grains": {"count": 3},
    "run": {"repeats": 1},
    "video": {"width": 320, "height": 180},
}


@pytest.fixture(scope="module")
def recorded(tmp_path_factory) -> Path:
    """The folder of a run that was cut short, with its checkpoint."""
    folder = tmp_path_factory.mktemp("recorded") / "run"
    prepare(load("tilting/quick", SMALL), folder).make_recording()
    rows = 4
    with Recorder(folder) as run:
        for k in range(rows):
            run.sample(sample(0.01 * k))
            run.frame(frame(0.01 * k, count=3, position=np.full((1, 3, 2), 0.004)))
        run.close("stopped: interrupted by the user")
    Checkpoint({"numbers": np.arange(5), "origin": np.array(0.0)}, (".",), (rows, rows), ("Beware.",)).write(folder)
    return folder


@pytest.fixture
def unpainted(monkeypatch):
    """One picture is painted of every video, and none is encoded."""

    def paint(out, film, *_):
        film.picture(0)
        return out

    monkeypatch.setattr("lab.paint.video._write", paint)


def copied(recorded: Path, folder: Path) -> Path:
    folder.mkdir(exist_ok=True)
    for path in recorded.iterdir():
        (folder / path.name).write_bytes(path.read_bytes())
    return folder


@often
def test_damaged_recordings_are_refused(idle, unpainted, recorded, tmp_path, times):
    contents = (recorded / "recording.h5").read_bytes()

    @examples(20 * times)
    @given(st.data())
    def check(data):
        folder = copied(recorded, tmp_path / "run")
        (folder / "recording.h5").write_bytes(damaged(data.draw, contents))
        ends_well(call("render", folder))
        ends_well(call("resume", folder, "--quiet"))

    check()


def members(path: Path) -> list[str]:
    with h5py.File(path, "r") as file:
        found = list(file.attrs)
        file.visit(found.append)
    return sorted(found)


ARRAYS = [np.zeros(0), np.zeros((0, 0)), np.zeros(3), np.zeros((2, 2, 2)), np.full((4, 1, 2), np.nan), np.array(7)]
VALUES = st.sampled_from(["", "{}", "[]", "null", "nan", "é", 0, -1, 1e300, float("nan"), *ARRAYS])


@often
def test_recordings_with_other_contents_are_refused(idle, unpainted, recorded, tmp_path, times):
    @examples(20 * times)
    @given(st.sampled_from(members(recorded / "recording.h5")), st.none() | VALUES)
    def check(name, value):
        folder = copied(recorded, tmp_path / "run")
        with h5py.File(folder / "recording.h5", "r+") as file:
            holder = file.attrs if name in file.attrs else file
            del holder[name]
            if value is not None:
                holder[name] = value
        ends_well(call("render", folder))
        ends_well(call("resume", folder, "--quiet"))

    check()


@often
def test_damaged_checkpoints_are_refused(recorded, tmp_path, times):
    content = (recorded / "checkpoint.npz").read_bytes()

    @examples(35 * times)
    @given(st.data())
    def check(data):
        (tmp_path / "checkpoint.npz").write_bytes(damaged(data.draw, content))
        try:
            read_checkpoint(tmp_path)
        except LabError as error:
            assert_sentence(str(error))

    check()


@pytest.mark.parametrize("about", ["", "[]", "null", "{}", "7", '{"format": "cargo-shift-lab checkpoint 1"}',
    '{"format": "cargo-shift-lab checkpoint 1", "runs": 3, "rows": [1], "warnings": null}'])  # fmt: skip
def test_a_checkpoint_without_its_format_is_refused(idle, recorded, tmp_path, about):
    folder = copied(recorded, tmp_path / "run")
    np.savez(folder / "checkpoint.npz", about=np.array(about))
    assert "checkpoint.npz" in refused(call("resume", folder))


def test_a_sweep_over_numbers_of_numpy_is_read_again(tmp_path):
    asked = grid.define_sweep(
        "tilting/quick", {"run.seed": np.arange(1, 3), "grains.spread": [np.float64(0.1), 0.2]}, SMALL
    )
    asked.write(tmp_path)
    assert not grid.read_sweep(tmp_path).differs_from(asked)


@often
def test_damaged_sweeps_are_refused(idle, tmp_path, times):
    sweep = grid.define_sweep("tilting/quick", {"run.seed": "1, 2"}, SMALL)
    sweep.write(tmp_path)
    content = (tmp_path / "sweep.json").read_bytes()

    @examples(35 * times)
    @given(st.data())
    def check(data):
        if data.draw(st.booleans()):
            changed = damaged(data.draw, content)
        else:
            table = json.loads(content)
            data.draw(st.sampled_from([drop, rename, swap, replace, bury]))(data.draw, table)
            changed = json.dumps(table).encode()
        (tmp_path / "sweep.json").write_bytes(changed)
        ends_well(call("resume", tmp_path))
        ends_well(call("sweep", "tilting/quick", "--set", "run.seed=1,2", "--out", tmp_path))

    check()


# ---- hard ones, by hand


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (RICH.encode() + b"#" * 1_000_000, "too large for a preset"),
        (b"#" * 999_000, "title: missing"),
        (b"a = [" + b"1, " * 300_000 + b"]", "a: unknown key"),
        (b"x" * 900_000 + b" = 1", "x…: unknown key"),
        (b"title = 'a'\ntitle = 'b'", "not valid TOML: Cannot overwrite a value"),
        (b"[run]\n[run]", "not valid TOML: Cannot declare"),
        (b"\xff\xfet\x00i\x00t\x00l\x00e\x00", "not UTF-8 text"),
        (RICH.replace("[run]", "[x]").encode(), "x: unknown key"),
        (RICH.replace('file = "record.csv"', "file = 3").encode(), "motion.history.file: a text in quotes is needed"),
        (b"run = 3\n" + RICH.encode(), "not valid TOML: Cannot overwrite a value"),
        (b"based_on = 'tilting/quick'\ngrains = 3", "grains: a table of keys is needed (got 3)"),
        (b"based_on = 'tilting/quick'\n[run.repeats]\nx = 1", "run.repeats: a whole number is needed"),
        (b"based_on = 'tilting/quick'\n[quick]\nrun.repeats = 1", "quick.differs: missing"),
        (
            b"based_on = 'tilting/quick'\n[quick]\ndiffers = 'much'\ngrains.depth = '1 mm'",
            "quick.grains.depth: may not",
        ),
        (b"based_on = 'tilting/quick'\nquick = 3", "quick: a table of keys is needed"),
        (b"based_on = 'cyclic.toml'", "the preset ends up based on itself"),
        (b"based_on = 'heir.toml'", "the preset ends up based on itself"),
    ],
)
def test_invalid_presets_are_refused(tmp_path, content, words):
    (tmp_path / "cyclic.toml").write_bytes(content)
    (tmp_path / "heir.toml").write_text("based_on = 'cyclic.toml'")
    (tmp_path / "record.csv").write_text(TABLES["record.csv"])
    assert words in refused(call("run", tmp_path / "cyclic.toml"))


@pytest.mark.parametrize("mark", [b"", b"\xef\xbb\xbf"])
@pytest.mark.parametrize("end", [b"\n", b"\r\n"])
def test_a_preset_may_have_a_byte_order_mark_and_any_line_ends(folder, mark, end):
    (folder / "ends.toml").write_bytes(mark + RICH.replace("\n", end.decode()).encode())
    assert tried(folder / "ends.toml")


def test_a_folder_a_pipe_and_an_unreadable_file_are_refused_as_presets(tmp_path, monkeypatch):
    (tmp_path / "folder.toml").mkdir()
    assert "folder.toml: is not a file." in refused(call("run", tmp_path / "folder.toml"))
    if hasattr(os, "mkfifo"):  # nobody ever writes into it
        os.mkfifo(tmp_path / "pipe.toml")
        assert "pipe.toml: is not a file." in refused(call("run", tmp_path / "pipe.toml"))
    (tmp_path / "secret.toml").write_text(RICH)
    monkeypatch.setattr(Path, "open", denied)
    assert "secret.toml: cannot be read: Permission denied." in refused(call("run", tmp_path / "secret.toml"))


def denied(path, *_, **__):
    raise PermissionError(13, "Permission denied", str(path))


@pytest.mark.parametrize(
    ("setting", "words"),
    [
        ("parts.gate.sped=1 m/s", "parts.gate.sped: unknown key; did you mean 'speed'?"),
        ("parts.door.speed=1 m/s", "parts.door.points: missing"),
        ("parts.door=3", "parts.door: a table of keys is needed"),
        ("motion.swing.amplitude=1 m", "motion.swing: unknown key"),
        ("motion.roll.amplitude=1 deg", "motion.roll.frequency: missing"),
        ("motion.tilt=true", "motion.tilt: a table of keys is needed"),
        ("motion=3", "motion: a table of keys is needed"),
        ("run.repeats=0", "run.repeats: must be at least 1 (got 0)"),
        ("run.repeats=-1", "run.repeats: must be at least 1 (got -1)"),
        ("run.repeats=1e1", "run.repeats: a whole number is needed (got 10.0)"),
        ("run=", "run: a table of keys is needed"),
        ("quick=much", "quick: cannot be overridden"),
        ("based_on=tilting/quick", "based_on: cannot be overridden"),
        ("motion.history.file=no.csv", "no.csv: cannot be read: No such file or directory"),
        ("grains.bed=no.csv", "no.csv: cannot be read: No such file or directory"),
        ("motion.history.file=.", "is not a file"),
        ("tank.outline=[]", "tank.outline: from 3 to"),
        ("grains.table=[]", "grains.table: at least one class"),
        ("run.duration=nan s", "not a finite number"),
        ("x" * 5000 + "=1", "unknown key"),
        ("x" * 5000, "write it like --set"),
        ("\a\n\x1b[31m", "write it like --set"),
        (".".join("a" * 3000) + "=1", "a: unknown key"),
    ],
)
def test_invalid_settings_are_refused(folder, setting, words):
    (folder / "rich.toml").write_text(RICH)
    assert words in refused(call("run", folder / "rich.toml", "--set", setting))


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("tilting/quick-quick", "tilting/quick: has no quick variant; run tilting/quick itself."),
        ("-quick", "there is no preset"),
        ("tilting", '"tilting" is a group of presets'),
        ("tilting/\x1b[31m", "there is no preset"),
        ("x" * 5000, "there is no preset"),
        ("x" * 5000 + ".toml", "x.toml: cannot be read: File name too long"),
        ("\x1b[31m.toml", "?[31m.toml: cannot be read: No such file"),
        ("nul\0.toml", "nul?.toml: is not a file name"),
    ],
)
def test_unknown_preset_names_are_refused(name, words):
    assert words in refused(call("run", "--", name))
