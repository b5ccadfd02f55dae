"""A small complete run: the results of one call."""

import json

import numpy as np
import pytest

import lab
from lab.assembly.scene import build
from lab.base.costs import PARTS
from lab.base.errors import LabError
from lab.preset.find import load
from lab.recording import open_recording
from lab.report.explain import explain
from lab.runs.run import prepare
from lab.runs.runner import run_preset
from lab.sweeps.dry_run import available_measures
from solvers.machine.errors import BadState

SMALL = {  # kernels of `test_resume.py`
    "tank": {"width": "24 mm", "height": "24 mm"},
    "grains": {"count": 16},
    "motion": {"tilt": {"rate": "60 deg/s", "angle": "15 deg", "hold": "0.05 s"}},
    "run": {"repeats": 2, "threads": 1},
}


@pytest.fixture(scope="module")
def result(tmp_path_factory):
    return lab.run("tilting/quick", tmp_path_factory.mktemp("run") / "small", quiet=True, **SMALL)


def test_a_run_leaves_recording_plots_video_and_summary(result):
    data = json.loads((result.folder / "summary.json").read_text())
    assert data["preset"] == "tilting/quick"
    assert {"wall_s", "grain_steps", "grain_steps_per_s", "dt_s"} <= data["cost"].keys()
    assert all((result.folder / name).exists() for name in data["files"].values())
    assert (result.folder / "video.mp4").stat().st_size > 1000
    assert "critical angle" in (result.folder / "summary.md").read_text()
    assert data["measures"]["final_shift_y"]["value"] == pytest.approx(result.measures["final_shift_y"].value)


def test_the_summary_says_what_the_time_went_into(result):
    """Compiling happens within settling and running, but is told on its own; the recording times the run by itself."""
    data = json.loads((result.folder / "summary.json").read_text())
    seconds = data["cost"]["seconds"]
    parts = [seconds[part] for part in PARTS]
    assert all(part >= 0.0 for part in parts) and seconds["rest"] >= 0.0
    assert sum(parts) + seconds["rest"] == pytest.approx(seconds["whole"], abs=0.01)
    assert seconds["compile"] > 0.0 and data["cost"]["wall_s"] <= seconds["run"] + seconds["compile"]
    assert f"import {seconds['import']:.1f} s, compile" in (result.folder / "summary.md").read_text()


def test_samples_and_frames_have_their_times(result):
    series, frames = result.recording.series, result.recording.frames
    assert np.allclose(np.diff(series["time"]), 0.01, rtol=1e-9)
    assert np.allclose(np.diff(frames["time"][:]), 0.04, rtol=1e-9)
    assert np.degrees(series["pose"][-1, :, 2]) == pytest.approx(15.0, rel=1e-6)
    weight = result.recording.radius**3
    centre = (frames["position"][-1] * weight[:, :, None]).sum(axis=1) / weight.sum(axis=1)[:, None]
    assert np.allclose(centre, series["centre_of_mass"][4 * (len(frames["time"]) - 1)], atol=1e-6)


def test_the_walls_carry_the_grains(result):
    recording = result.recording
    volume = (4 / 3 * np.pi * recording.radius**3).sum(axis=1)
    weight = 9.81 * recording.preset.material.density * volume
    assert np.allclose(-recording.series["wall_force"][1, :, 1], weight, rtol=0.02)
    assert not recording.series["spilled"].any()
    assert recording.frames["part"].shape == (len(recording.frames["time"]), 2, 0, 2)


def test_the_counted_steps_are_the_computed_ones(result):
    recording = result.recording
    taken = recording.series["time"][-1] / recording.step
    assert recording.grain_steps == pytest.approx(taken * recording.radius.size, rel=1e-9)


def test_a_world_settles_alone_as_with_other_worlds():
    """Repeat 0 starts from the same grains and the same step whatever the number of repeats."""
    (alone, start), (among, starts) = (
        build(load("tilting/quick", SMALL | {"run": {"repeats": n, "step": "auto"}}).resolved) for n in (1, 3)
    )
    assert np.array_equal(start[0], starts[0]) and np.array_equal(alone.grains.radius[0], among.grains.radius[0])
    assert alone.step == among.step and alone.grains.interfaces == among.grains.interfaces
    assert not np.array_equal(among.grains.radius[0], among.grains.radius[1])


@pytest.mark.parametrize(
    ("run", "company", "threads"),
    [
        ({"repeats": 4, "threads": 1}, 0, 1),
        ({"repeats": 1, "threads": 3}, 0, 1),  # a small bed is one thread's
        ({"repeats": 2, "threads": 3}, 0, 2),
        ({"repeats": 2, "threads": 3}, 9, 3),
        ({"repeats": 1, "threads": 2, "schedule": "per-band"}, 0, 2),
        ({"repeats": 2, "threads": 0}, 0, 2),
    ],
)
def test_a_run_reports_its_number_of_threads(run, company, threads, tmp_path, monkeypatch):
    monkeypatch.setattr("lab.runs.run.available_cores", lambda: 2)
    ready = prepare(load("tilting/quick", SMALL | {"run": run | {"arch": "cpu"}}), tmp_path)
    assert ready.device(company)["threads"] == threads


def test_a_run_has_the_measures_of_its_dry_run(result):
    """Those of other motions are in `tests/lab/sweeps/test_dry_run.py`, those of water in `test_water_runs.py`."""
    expected = available_measures(load("tilting/quick", SMALL))
    assert {name: m.unit for name, m in expected.items()} == {name: m.unit for name, m in result.measures.items()}


def test_the_recording_names_the_device(result):
    assert result.recording.machine["threads"] == 1
    assert ", on 1 of " in (result.folder / "summary.md").read_text()


def test_a_step_above_the_limit_needs_force_and_one_far_above_is_refused():
    with pytest.raises(LabError, match=r"run\.step: .*past the limit.*force_step"):
        build(load("tilting/quick", SMALL | {"run": {"step": "29 us"}}).resolved)
    forced = SMALL | {"run": {"step": "29 us", "force_step": True}}
    assert build(load("tilting/quick", forced).resolved)[0].step == pytest.approx(2.9e-5, rel=0.01)
    with pytest.raises(LabError, match=r"run\.step: 1 ms is [\d.]+ times the limit.* at most 3\.75 times"):
        build(load("tilting/quick", SMALL | {"run": {"step": "1 ms", "force_step": True}}).resolved)


def test_a_step_up_to_that_of_its_level_needs_no_force():
    """At draft steps are longer than at standard; one as long as draft's own is taken as it is, a longer one is not."""
    draft = SMALL | {"run": {"accuracy": "draft"}}
    own = build(load("tilting/quick", draft).resolved)[0].longest_step(1.6)
    given = {"run": {"accuracy": "draft", "step": f"{0.99 * own} s"}}
    assert 0.95 * own < build(load("tilting/quick", SMALL | given).resolved)[0].step < own
    given["run"]["step"] = f"{1.1 * own} s"
    with pytest.raises(LabError, match=r"past the limit.*1\.6 times that at this accuracy"):
        build(load("tilting/quick", SMALL | given).resolved)


@pytest.mark.slow
def test_the_summary_reports_a_forced_step(tmp_path):
    forced = SMALL | {"run": {"repeats": 1, "step": "20 us", "force_step": True, "duration": "0.02 s"}}
    folder = run_preset("tilting/quick", forced, tmp_path / "forced", video=False, quiet=True).folder
    assert "The step is forced past the derived one" in (folder / "summary.md").read_text()


@pytest.mark.slow  # a point of a sweep that is stopped is in `tests/lab/sweeps/test_sweep.py`
def test_a_run_stopped_by_the_watch_keeps_its_recording_and_the_reason(tmp_path):
    thrown = {"tilt": False, "sway": {"amplitude": "4 mm", "frequency": "600 Hz"}}
    changes = {"tank": {"width": "24 mm", "height": "24 mm"}, "grains": {"count": 16}, "motion": thrown}
    changes |= {"run": {"repeats": 1, "threads": 1, "duration": "0.3 s"}, "contact": {"tangential": "none"}}
    with pytest.raises(BadState, match=r"world 0: (a grain moves at .* too fast|grains overlap by .* too soft)"):
        run_preset("tilting/quick", changes, tmp_path / "thrown", video=False, quiet=True)
    with open_recording(tmp_path / "thrown") as recording:
        assert recording.status.startswith("stopped: world 0")


def test_explain_names_step_limit_parts_and_cost():
    text = explain(load("tilting/quick", SMALL))
    for words in ("1/", "of the Hertz collision", "haff-werner", "Coriolis", "memory", "about"):
        assert words in text


def test_explain_reports_the_force_of_liquid_bridges():
    """2π γ R_eff over (4/3) π R³ ρ g of grains of 3 mm, and the Kelvin radius at 70 %."""
    text = explain(load("tilting/wet", SMALL))
    assert "humid: 339.3 µN, 1.9 times a mean grain's weight, across gaps of up to 1.472 nm" in text


@pytest.mark.slow
def test_the_summary_reports_a_bed_that_has_not_settled(tmp_path):
    restless = SMALL | {"run": {"repeats": 1, "settle_limit": "0.01 s", "duration": "0.05 s"}}
    result = run_preset("tilting/quick", restless, tmp_path / "restless", video=False, quiet=True)
    assert "still moved after 0.01 s" in (result.folder / "summary.md").read_text()


SHIP = {"draught": "60 mm", "gravity_height": "35 mm", "breadth": "120 mm", "height": "100 mm", "gyradius": "40 mm"}


@pytest.mark.slow  # what is seen before the first step is in `tests/solvers/grains/test_unmoved.py`
@pytest.mark.parametrize("ship", [{}, SHIP], ids=["fixed", "afloat"])
def test_the_first_sample_is_the_state_of_grains_that_do_not_settle(tmp_path, ship):
    """Two grains of a file that move: one 2 µm deep in the floor, along which it slides, the other in flight."""
    (tmp_path / "bed.csv").write_text("y,z,radius,vy,vz,omega\n0,0.002998,0.003,0.05,0,5\n0.01,0.02,0.003,0,-0.1,0\n")
    given = {"grains": {"bed": str(tmp_path / "bed.csv"), "diameter": False, "depth": False, "count": False}}
    given |= {"run": {"settle": False, "repeats": 1, "duration": "0.02 s"}, "motion": {"tilt": False}}
    given |= {"tank": {"width": "40 mm", "height": "40 mm"}, "contact": {"tangential": "none"}} | (
        {"ship": ship} if ship else {}
    )
    preset = load("tilting/quick", given).resolved
    result = run_preset("tilting/quick", given, tmp_path / "run", video=False, plots=False, quiet=True)
    series = {name: values[0] for name, values in result.recording.series.items()}
    mass = 4 / 3 * np.pi * 0.003**3 * preset.material.density
    floor = build(preset)[0].grains.interfaces[1]
    force = 4 / 3 * floor.young_modulus * np.sqrt(0.003) * 2e-6**1.5  # Hertz (1882); the grain does not approach
    assert series["contacts"] == [1.0]
    assert series["overlap"] == pytest.approx([2e-6 / 0.003], rel=1e-6)
    assert series["elastic"] == pytest.approx([0.4 * force * 2e-6], rel=1e-6)
    assert series["wall_force"][0] == pytest.approx([0.0, -force, 0.0], rel=1e-6, abs=1e-9)
    assert series["centre_of_mass"][0] == pytest.approx([0.005, 0.011499])
    assert series["kinetic"] == pytest.approx([0.5 * mass * (0.05**2 + 0.1**2)])
    assert series["rotational"] == pytest.approx([0.2 * mass * 0.003**2 * 5.0**2])
