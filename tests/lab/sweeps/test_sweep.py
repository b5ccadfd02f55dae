"""Sweeps: their values, points that run in a batch as they do alone, and interrupted sweeps."""

import csv
import json
import shutil
import signal
import subprocess
import sys
import time
from itertools import product
from pathlib import Path

import h5py
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import lab
from lab.base.errors import LabError
from lab.base.lock import only_one
from lab.base.progress import Progress
from lab.recording import open_recording
from lab.runs.checkpoint import Checkpoint
from lab.runs.runner import run_preset
from lab.sweeps import report as sweep_report
from lab.sweeps.axes import plain, values
from lab.sweeps.grid import define_sweep, read_sweep
from lab.sweeps.report import numeric, write_report
from lab.sweeps.resume import resume_any
from lab.sweeps.sweep import _plan, run_sweep
from solvers.machine.state import Axis, without_worlds

ROOT = Path(__file__).parents[3]
SMALL = {
    "tank": {"width": "24 mm", "height": "24 mm"},
    "grains": {"count": 16},
    "contact": {"tangential": "none"},  # compiles faster
    "motion": {"tilt": False, "sway": {"amplitude": "4 mm"}},
    "run": {"repeats": 1, "threads": 1, "duration": "0.3 s"},
}
AXES = {"motion.sway.frequency": "1, 3, 600 Hz"}  # the last throws the grains about, and the watch stops it


@pytest.fixture(scope="module", autouse=True)
def films():
    """What was to be filmed: films and plots of runs take long, and are tested elsewhere."""
    filmed = []

    def film(beds, captions, out, **_):
        filmed.append(dict(zip(captions, beds, strict=True)))
        out.touch()
        return out

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("lab.report.plots.write_plots", lambda *_: {})
        patch.setattr(sweep_report, "render_grid", film)
        yield filmed


@pytest.fixture(scope="module")
def swept(films, tmp_path_factory):
    return run_sweep("tilting/quick", AXES, SMALL, tmp_path_factory.mktemp("sweep") / "s", quiet=True)


def data_sets(folder):
    found = {}
    with h5py.File(folder / "recording.h5", "r") as file:
        file.visititems(lambda name, item: found.update({name: item[()]}) if isinstance(item, h5py.Dataset) else None)
        return found, file.attrs["status"].decode()


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("0.2:0.5:4 Hz", ["0.2 Hz", "0.3 Hz", "0.4 Hz", "0.5 Hz"]),
        ("0.2 Hz : 0.5 Hz : 4", ["0.2 Hz", "0.3 Hz", "0.4 Hz", "0.5 Hz"]),
        ("1:100:3:log mm", ["1 mm", "10 mm", "100 mm"]),
        ("-10:10:3 deg", ["-10 deg", "0 deg", "10 deg"]),
        ("10 %:30 %:3", ["10 %", "20 %", "30 %"]),
        ("1:4:4", [1, 2, 3, 4]),
        ("0.1:0.3:3", [0.1, 0.2, 0.3]),
        ("5:4:2", [5, 4]),
        ("2, 3,4 mm", ["2 mm", "3 mm", "4 mm"]),
        ("2 mm, 3 cm", ["2 mm", "3 cm"]),
        ("undisturbed, disturbed", ["undisturbed", "disturbed"]),
        ("true, false", [True, False]),
        ('["0 mm", "0 mm"], ["0 mm", "5 mm"]', [["0 mm", "0 mm"], ["0 mm", "5 mm"]]),
        ('["0 mm", "5 mm"]', [["0 mm", "5 mm"]]),
        ("4 mm", ["4 mm"]),
        ("'one, two'", ["one, two"]),
        ("rest: 3", ["rest: 3"]),
    ],
)
def test_values_are_parsed(text, expected):
    read = values("key", text)
    assert read == expected and list(map(type, read)) == list(map(type, expected))


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("1 mm:3 s:3", "needs one unit"),
        ("1:2:1", "has 2 to 10000 values"),
        ("1:2:99999", "has 2 to 10000 values"),
        ("2:2:4", "two different numbers"),
        ("0:2:3:log", "cannot reach or cross zero"),
        ("-1:2:3:log mm", "cannot reach or cross zero"),
    ],
)
def test_an_impossible_range_is_refused_with_its_key(text, complaint):
    with pytest.raises(LabError, match=rf"grains\.diameter: .*{complaint}"):
        values("grains.diameter", text)


@given(st.text())
def test_any_text_is_a_value_or_gives_one_sentence(text):
    try:
        assert len(values("key", text)) >= 1
    except LabError as error:
        assert "\n" not in str(error)
    plain(text)


@given(st.floats(1e-6, 1e6), st.floats(1e-6, 1e6), st.integers(2, 50), st.booleans())
def test_a_range_runs_from_end_to_end(first, last, count, log):
    if first == last:
        return
    read = values("key", f"{first!r}:{last!r}:{count}{':log' * log}")
    assert len(read) == count
    np.testing.assert_allclose([read[0], read[-1]], [first, last], rtol=1e-11)
    steps = np.diff(np.log(read) if log else read)
    assert np.ptp(steps) <= 1e-9 * max(1.0, abs(first), abs(last), np.abs(np.log(read)).max())


def test_the_grid_has_every_combination_and_the_last_key_changes_fastest():
    sweep = define_sweep("tilting/quick", {"run.seed": "1:3:3", "material.friction": [0.1, 0.2], "run.repeats": "2"})
    asked = [(point.resolved.run.seed, point.resolved.material.friction) for point in sweep.points]
    assert asked == [(1, 0.1), (1, 0.2), (2, 0.1), (2, 0.2), (3, 0.1), (3, 0.2)]
    assert all(point.resolved.run.repeats == 2 for point in sweep.points)
    assert sweep.settings[1] == {"run.seed": 1, "material.friction": 0.2}


def test_points_share_batches_as_far_as_scenes_and_machine_allow(monkeypatch):
    monkeypatch.setattr("lab.sweeps.sweep.available_cores", lambda: 2)
    monkeypatch.setattr("lab.runs.run.available_cores", lambda: 2)

    def plan(axes, **settings):
        return list(_plan(define_sweep("tilting/quick", axes, {"run.repeats": 2, "run.arch": "cpu", **settings})))

    assert plan({"run.seed": "1:10:10"}) == [list(range(8)), [8, 9]]  # eight worlds a core
    assert plan({"run.seed": "1:3:3"}, **{"run.repeats": 40}) == [[0], [1], [2]]
    assert plan({"grains.count": "20, 30", "run.seed": "1:3:3"}) == [[0, 1, 2], [3, 4, 5]]
    assert plan({"run.seed": "1, 2", "grains.count": "20, 30"}) == [[0, 2], [1, 3]]
    assert plan({"run.duration": "1 s, 2 s"}) == [[0], [1]]
    assert plan({"material.friction": "0.1:0.3:3"}) == [[0, 1, 2]]
    assert plan({"run.seed": "1, 2"}, **{"run.schedule": "per-band"}) == [[0], [1]]


@pytest.mark.parametrize(
    ("axes", "complaint"),
    [
        ({}, "needs a key with several values"),
        ({"run.seed": "3"}, "needs a key with several values"),
        ({"run.sed": "1:3:3"}, r"point run\.sed = 1: run\.sed: unknown key"),
        ({"material.friction": "0.1:0.3:3 mm"}, r"point material\.friction = 0\.1 mm: material\.friction"),
        ({"run.seed": "1:1000:1000", "grains.spread": "0:0.1:1000"}, "1000000 points, more than"),
    ],
)
def test_impossible_sweeps_are_refused_before_any_run(axes, complaint, tmp_path):
    with pytest.raises(LabError, match=complaint):
        run_sweep("tilting/quick", axes, None, tmp_path / "s", quiet=True)
    assert not (tmp_path / "s").exists()


def test_a_point_in_a_batch_has_the_bits_of_the_run_alone(swept, tmp_path):
    """Point 1 shares its batch with a point that is stopped."""
    alone = SMALL | {"motion": {"tilt": False, "sway": {"amplitude": "4 mm", "frequency": "3 Hz"}}}
    run_preset("tilting/quick", alone, tmp_path / "alone", video=False, quiet=True)
    mine, status = data_sets(swept.points[1])
    reference, _ = data_sets(tmp_path / "alone")
    assert status == "complete" and mine.keys() == reference.keys()
    for name in reference:
        if name != "preset/given":  # its keys may stand in another order
            assert np.array_equal(mine[name], reference[name]), name


def test_a_point_stopped_by_the_watch_is_recorded_and_the_others_continue(swept):
    statuses = [row["status"] for row in swept.rows]
    assert statuses[:2] == ["complete"] * 2
    assert statuses[2].startswith("stopped: world 0: a grain moves at")
    assert "2 of 3 points are complete; stopped: 2." in (swept.folder / "summary.md").read_text()


def test_the_table_has_the_keys_in_their_units_and_each_measure_with_its_errors(swept):
    with (swept.folder / "results.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [row["motion.sway.frequency (Hz)"] for row in rows] == ["1.0", "3.0", "600.0"]
    summary = json.loads((swept.points[1] / "summary.json").read_text())
    name, measure = next((name, m) for name, m in summary["measures"].items() if m["value"] and m["unit"] != "1")
    assert float(rows[1][f"{name} ({measure['unit']})"]) == measure["value"]
    assert float(rows[1][f"{name} n"]) == 1


def test_a_sweep_leaves_figures_a_film_and_ordinary_runs(swept, films):
    names = ["frequency 1 Hz", "frequency 3 Hz", "frequency 600 Hz"]
    assert films == [dict(zip(names, swept.points, strict=True))]
    made = {path.name for path in swept.folder.iterdir()}
    assert {"results.csv", "summary.md", "sweep.json", "sweep.mp4"} < made and not made & {"checkpoint.npz"}
    assert any(name.endswith(".png") for name in made)
    with open_recording(swept.points[0]) as recording:
        assert recording.complete and recording.preset.motion.sway.frequency == 1.0


def test_finished_points_are_not_run_again_and_another_sweep_is_refused(swept, tmp_path, monkeypatch):
    shutil.copytree(swept.folder, tmp_path / "s")
    monkeypatch.setattr("lab.sweeps.sweep.run_batch", None)  # nothing is to be launched
    again = run_sweep("tilting/quick", AXES, SMALL, tmp_path / "s", video=False, quiet=True)
    assert again.rows == swept.rows
    assert resume_any(tmp_path / "s", video=False, quiet=True).rows == swept.rows
    with pytest.raises(LabError, match=r"than the requested one \(of other values of motion\.sway\.frequency"):
        run_sweep("tilting/quick", {"motion.sway.frequency": "1, 4, 600 Hz"}, SMALL, tmp_path / "s", quiet=True)
    with pytest.raises(LabError, match="holds a recording"):
        run_sweep("tilting/quick", AXES, SMALL, swept.points[0], quiet=True)


def test_points_of_another_sweep_are_not_taken_for_its_own(swept, tmp_path):
    """Where its folder has lost the file that says what was swept: by other values, keys or beds."""
    shutil.copytree(swept.folder, tmp_path / "s")
    (tmp_path / "s" / "sweep.json").unlink()
    for axes, others, differs in (
        ({"motion.sway.frequency": "2, 3, 600 Hz"}, {}, "000 .* another motion.sway.frequency: remove that folder"),
        ({"motion.sway.frequency": "1, 4, 600 Hz"}, {}, "001 .* another motion.sway.frequency"),
        (AXES, {"material.friction": 0.1}, "000 .* another material.friction"),
        (AXES, {"run.seed": 7}, "000 .* another run.seed"),
    ):
        with pytest.raises(LabError, match=differs):
            run_sweep("tilting/quick", axes, {**SMALL, **others}, tmp_path / "s", video=False, quiet=True)
        assert not (tmp_path / "s" / "sweep.json").exists()
    again = run_sweep("tilting/quick", AXES, SMALL, tmp_path / "s", video=False, quiet=True)
    assert again.rows == swept.rows


def test_a_summary_of_an_earlier_recording_in_its_place_is_not_taken(swept, tmp_path):
    """Killed between the end of a run and its summary, where another run had left its own."""
    shutil.copytree(swept.folder, tmp_path / "s")
    path = tmp_path / "s" / "points" / "000" / "summary.json"
    told = json.loads(path.read_text())
    path.write_text(json.dumps(told | {"created": "2026-01-01T00:00:00+00:00", "measures": {}}))
    run_sweep("tilting/quick", AXES, SMALL, tmp_path / "s", video=False, quiet=True)
    assert json.loads(path.read_text())["measures"] == told["measures"]


def test_a_sweep_refused_because_another_process_has_its_folder_leaves_that_ones_request(tmp_path):
    with only_one(tmp_path / "s"), pytest.raises(LabError, match="in use by another run"):
        run_sweep("tilting/quick", AXES, SMALL, tmp_path / "s", quiet=True)
    assert list((tmp_path / "s").iterdir()) == []


def test_points_run_by_different_versions_are_told_apart(swept, tmp_path):
    shutil.copytree(swept.folder, tmp_path / "s")
    path = tmp_path / "s" / "points" / "001" / "summary.json"
    path.write_text(json.dumps(json.loads(path.read_text()) | {"version": "0.1.0"}))
    run_sweep("tilting/quick", AXES, SMALL, tmp_path / "s", video=False, quiet=True)
    page = (tmp_path / "s" / "summary.md").read_text()
    assert f"run by different versions of the lab: 0.1.0, {lab.__version__}." in page
    assert "different versions" not in (swept.folder / "summary.md").read_text()


def test_an_interrupted_sweep_continues_with_the_remaining_points(swept, tmp_path, monkeypatch):
    folder = tmp_path / "s"
    shutil.copytree(swept.folder, folder)
    shutil.rmtree(folder / "points" / "002")  # never begun
    (folder / "points" / "000" / "summary.json").unlink()  # recorded, not yet summed up
    with h5py.File(folder / "points" / "001" / "recording.h5", "r+") as file:
        file.attrs["status"] = "stopped: interrupted by the user"
    Checkpoint({}, ("points/001",), (0, 0)).write(folder)
    launched = []

    def run_batch(runs, home, progress, kept):
        launched.append(([run.folder.name for run in runs], kept is not None))
        for run in runs:
            shutil.rmtree(run.folder)
            shutil.copytree(swept.folder / "points" / run.folder.name, run.folder)

    monkeypatch.setattr("lab.sweeps.sweep.run_batch", run_batch)
    assert resume_any(folder, video=False, quiet=True).rows == swept.rows
    assert launched == [(["001"], True), (["002"], False)]
    assert not (folder / "checkpoint.npz").exists()


@pytest.mark.parametrize("others", [{}, {"grains.diameter": 3}, {"grains.diameter": 9}, {"a.b": 2, "run.lid": 2}])
def test_every_grid_has_its_figure(tmp_path, others):
    """Curves, families of curves, a map; points that were not run leave gaps."""
    axes = {"motion.sway.frequency": ["1 Hz", "2 Hz", "4 Hz"]}
    axes |= {key: [f"{k + 1} mm" for k in range(count)] for key, count in others.items()}
    settings = [dict(zip(axes, chosen, strict=True)) for chosen in product(*axes.values())]
    folders = [tmp_path / "points" / str(k) for k in range(len(settings))]
    for k, folder in enumerate(folders[:-1]):
        folder.mkdir(parents=True)
        measure = {"value": float(k), "unit": "deg", "std": 0.5, "uncertainty": 0.1, "worlds": [k, k], "note": ""}
        measure["uncertainty_kind"] = "detector"
        data = {"status": "complete", "measures": {"critical_angle": measure}, "warnings": ["Beware."]}
        (folder / "summary.json").write_text(json.dumps(data))
    rows, text = write_report("x", axes, settings, tmp_path, folders, Progress(quiet=True), video=False)
    assert len(rows) == len(settings) and rows[-1]["status"] == "not run"
    assert rows[0]["critical_angle (deg)"] == 0.0 and rows[0]["critical_angle n"] == 2
    assert rows[0]["critical_angle detector uncertainty"] == 0.1
    assert (tmp_path / "critical_angle.png").stat().st_size > 5000
    assert f"{len(settings) - 1} of {len(settings)} points are complete" in text
    assert (tmp_path / "summary.md").read_text().count("Beware.") == 1
    (tmp_path / "critical_angle.png").unlink()
    write_report("x", axes, settings, tmp_path, folders, Progress(quiet=True), video=False, plots=False)
    assert not list(tmp_path.glob("*.png")) and "critical_angle.png" not in (tmp_path / "summary.md").read_text()


@pytest.mark.slow
def test_a_sweep_interrupted_and_killed_equals_the_uninterrupted_one(tmp_path):
    options = [("motion.sway.frequency", "1, 3 Hz"), ("material.friction", "0.1:0.3:2"), ("motion.tilt", "false")]
    options += [("tank.width", "24 mm"), ("tank.height", "24 mm"), ("grains.depth", "12 mm"), ("run.duration", "3 s")]
    options += [("motion.sway.amplitude", "4 mm"), ("record.checkpoint_every", "0 s")]
    words = [word for key, value in options for word in ("--set", f"{key}={value}")]

    def command(folder):
        line = [sys.executable, "-m", "lab", "sweep", "tilting/quick", "--no-video", "--out", folder, *words]
        return subprocess.Popen(line, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def samples():
        try:
            with open_recording(folder / "points" / "000") as recording:
                return len(recording.series["time"])
        except LabError:
            return 0

    whole, folder = tmp_path / "whole", tmp_path / "cut"
    assert command(whole).wait() == 0
    for blow, code in ((signal.SIGINT, 130), (signal.SIGKILL, -9), (signal.SIGINT, 130)):
        sweep, before = command(folder), samples()
        while sweep.poll() is None and samples() < before + 40:
            time.sleep(0.01)
        sweep.send_signal(blow)
        said = sweep.communicate()[1]
        assert sweep.returncode == code
        assert "Traceback" not in said and (code < 0 or f"continue with: cargolab resume {folder}" in said)
    resume_any(folder, video=False, quiet=True)
    assert (folder / "results.csv").read_text() == (whole / "results.csv").read_text()
    for number in range(4):
        mine, reference = (data_sets(where / "points" / f"{number:03}") for where in (folder, whole))
        assert mine[1] == reference[1] == "complete"
        assert all(np.array_equal(mine[0][name], reference[0][name]) for name in reference[0])


def test_a_damaged_request_is_refused(swept, tmp_path):
    (tmp_path / "sweep.json").write_text((swept.folder / "sweep.json").read_text()[:1000])
    with pytest.raises(LabError, match="is damaged"):
        resume_any(tmp_path, quiet=True)
    with pytest.raises(LabError, match="name the folder of a sweep"):
        read_sweep(tmp_path / "nowhere")


def test_a_state_without_some_worlds_keeps_the_others():
    """3 worlds of 2 units each; the second world leaves."""
    state = {"clock": np.array([7, 1, 0]), "origin": np.array(0.5), "y": np.arange(12).reshape(6, 2)}
    axes = {"clock": (Axis("number", 3),), "origin": (), "y": (Axis("unit", 6), Axis("place", 2))}
    left = {name: without_worlds(values, axes[name], 3, slice(1, 2)) for name, values in state.items()}
    np.testing.assert_array_equal(left["clock"], [7, 1, 0])
    assert left["origin"] == 0.5
    np.testing.assert_array_equal(left["y"], [[0, 1], [2, 3], [8, 9], [10, 11]])


def test_values_are_numbers_only_with_a_common_unit():
    numbers, unit = numeric(["1 mm", "2.5 mm"])
    assert list(numbers) == [1.0, 2.5] and unit == "mm"
    assert numeric([1, 2])[1] == ""
    assert numeric(["1 mm", "2 cm"]) is None and numeric([True, False]) is None and numeric(["a", "b"]) is None


def test_the_python_call_takes_tables_and_keys(monkeypatch):
    calls = []
    monkeypatch.setattr("lab.sweeps.sweep.run_sweep", lambda *a, **k: calls.append((a, k)))
    lab.sweep("shaking/sway", {"run.seed": "1:3:3"}, grains={"count": 9}, run__repeats=2, video=False)
    options = {"video": False, "plots": True, "quiet": False, "cluster": None}
    assert calls == [
        (("shaking/sway", {"run.seed": "1:3:3"}, {"grains": {"count": 9}, "run.repeats": 2}, None), options)
    ]
    monkeypatch.setattr("lab.runs.runner.run_preset", lambda *a, **k: calls.append((a, k)))
    lab.run("shaking/sway", "out", repeats=12, plots=False)
    options = {"video": True, "plots": False, "quiet": False}
    assert calls[1:] == [(("shaking/sway", {"run.repeats": 12}, "out"), options)]
    assert callable(lab.sweep) and callable(lab.resume)  # no module of the same name has taken their place
