"""Resolved presets stored in files: values beyond the limits are refused before they take memory."""

import json

import h5py
import pytest

from lab.preset.find import load
from lab.preset.recorded import resolved_from, to_table
from lab.runs.checkpoint import Checkpoint
from lab.sweeps import grid
from tests.lab.preset.test_malformed import LISTED, RICH, SMALL, TABLES, call, copied, refused
from tests.lab.recording.test_trust_recordings import little_memory, sound  # noqa: F401 (fixtures)


def put(table: dict, dotted: str, value: object) -> None:
    *outer, last = dotted.split(".")
    for key in outer:
        table = table[key]
    table[last] = value


def record(times: int, rolls: int) -> dict:
    """A recorded motion of so many times and angles."""
    return {"name": "", "columns": {"time": [0.001 * k for k in range(times)], "roll": [0.0] * rolls}}


MANY = [[k * 1e-7, (k * k % 7) * 1e-7] for k in range(2_000)]
EXCESS = {
    "repeats": {"run.repeats": 10**12},
    "seed": {"run.seed": 10**40},
    "threads": {"run.threads": 10**9},
    "count": {"grains.count": 10**12},
    "tiny": {"grains.diameter": 1e-12, "grains.count": None, "grains.depth": 0.01},
    "huge-tank": {"tank.outline": [[-1e9, 0.0], [1e9, 0.0], [1e9, 1e9], [-1e9, 1e9]]},
    "corners": {"tank.outline": MANY},
    "lining": {"tank.roughness": 1e-12},
    "spread": {"grains.spread": 100.0},
    "nan": {"material.density": float("nan")},
    "infinite": {"run.duration": float("inf")},
    "rate": {"record.series_rate": 1e300},
    "nodes": {"contact.nodes": 10**9},
    "table": {"grains.table": [[0.003, 1e-3]] * 2_000},
    "draws": {"shapes": {"x": {"share": 1.0, "diameter": 0.003, "descriptors": [0.1], "phases": None, "draws": 10**9}}},
    "descriptors": {"shapes": {"x": {"share": 1.0, "diameter": 0.003, "descriptors": [0.0] * 10**5, "phases": None}}},
    "parts": {"parts": {f"p{k}": {"points": [[0.0, 0.01], [0.001, 0.01]]} for k in range(10_000)}},
    "part-names": {"parts": {"<b>": {"points": [[0.0, 0.01], [0.001, 0.01]]}}},
    "history": {"motion.history": {"file": record(100_001, 100_001)}},
    "history-short": {"motion.history": {"file": record(100, 50)}},
    "history-column": {"motion.history": {"file": {"name": "", "columns": {"time": [0.0], "x": [0.0]}}}},
    "pixels": {"video.width": 10**6, "video.height": 10**6},
    "odd-pixels": {"video.width": 641},
    "region": {"grains.region": MANY},
    "grains-listed": {"grains.bed": {"name": "", "columns": dict.fromkeys(("y", "z", "radius"), [0.01] * 100_001)}},
    "gauges": {"gauges": {f"P{k}": {"place": [0.0, 0.0]} for k in range(10_000)}},
    "grains-outside": {"grains.bed": {"name": "", "columns": {"y": [9.0], "z": [9.0], "radius": [0.003]}}},
}


@pytest.mark.parametrize("name", EXCESS)
def test_a_recording_whose_preset_is_beyond_the_limits_is_refused(sound, tmp_path, name, little_memory):  # noqa: F811
    folder = copied(sound, tmp_path / "run")
    (folder / "checkpoint.npz").unlink()
    with h5py.File(folder / "recording.h5", "r+") as file:
        table = json.loads(file["preset/resolved"].asstr()[0])
        for key, value in EXCESS[name].items():
            put(table, key, value)
        del file["preset/resolved"]
        file["preset/resolved"] = json.dumps(table)
    said = refused(call("resume", folder, "--quiet"))
    assert "has no preset that this version can run" in said


@pytest.mark.parametrize("name", EXCESS)
def test_a_sweep_whose_presets_are_beyond_the_limits_is_refused(tmp_path, name, little_memory):  # noqa: F811
    grid.define_sweep("tilting/quick", {"run.seed": "1, 2"}, SMALL).write(tmp_path)
    content = json.loads((tmp_path / "sweep.json").read_text())
    for key, value in EXCESS[name].items():
        put(content["points"][1]["resolved"], key, value)
    (tmp_path / "sweep.json").write_text(json.dumps(content))
    assert "sweep.json is damaged" in refused(call("resume", tmp_path))


SWEEPS = {
    "product": {"axes": {f"k{n}": list(range(100)) for n in range(20)}},
    "long-axis": {"axes": {"run.seed": list(range(10**6))}},
    "no-axes": {"axes": {}},
    "text-axes": {"axes": {"run.seed": "12"}},
    "table-name": {"preset": {"a": 1}},
    "no-points": {"points": []},
}


@pytest.mark.parametrize("name", [*SWEEPS, "deep"])
def test_a_manipulated_sweep_is_refused(tmp_path, name, little_memory):  # noqa: F811
    grid.define_sweep("tilting/quick", {"run.seed": "1, 2"}, SMALL).write(tmp_path)
    content = json.loads((tmp_path / "sweep.json").read_text()) | SWEEPS.get(name, {})
    text = "[" * 10**5 if name == "deep" else json.dumps(content)
    (tmp_path / "sweep.json").write_text(text)
    assert "sweep.json is damaged" in refused(call("resume", tmp_path))


def test_a_sweep_whose_checkpoint_is_of_other_runs_is_refused(tmp_path):
    grid.define_sweep("tilting/quick", {"run.seed": "1, 2"}, SMALL).write(tmp_path)
    Checkpoint({}, ("points/777",), (0, 0)).write(tmp_path)
    assert "its checkpoint is of other runs" in refused(call("resume", tmp_path, "--quiet"))


def test_presets_with_tables_of_all_kinds_are_within_the_limits(tmp_path):
    """Those of the lab are read so in `test_presets.py`."""
    for name, text in TABLES.items():
        (tmp_path / name).write_text(text)
    for name, text in (("rich.toml", RICH), ("listed.toml", LISTED)):
        (tmp_path / name).write_text(text)
        preset = load(tmp_path / name).resolved
        assert resolved_from(to_table(preset)) == preset
