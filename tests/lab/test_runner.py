"""A whole run, small: what a person gets from one call."""

import json

import numpy as np
import pytest

import lab
from lab.errors import LabError
from lab.explain import explain
from lab.presets import load
from lab.recording import open_recording
from lab.runner import run_preset
from lab.scene import build
from solvers.errors import BadState

SMALL = {
    "tank": {"width": "30 mm", "height": "30 mm"},
    "grains": {"count": 25},
    "motion": {"tilt": {"rate": "60 deg/s", "angle": "15 deg", "hold": "0.05 s"}},
    "run": {"repeats": 2},
    "record": {"xdmf": True},
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
    assert data["files"]["xdmf"] == "recording.xdmf"
    assert "critical angle" in (result.folder / "summary.md").read_text()
    assert data["measures"]["final_shift_y"]["value"] == pytest.approx(result.measures["final_shift_y"].value)


def test_samples_and_frames_stand_at_their_times(result):
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
    weight = 9.81 * recording.preset["material"]["density"] * volume
    assert np.allclose(-recording.series["wall_force"][1, :, 1], weight, rtol=0.02)
    assert not recording.series["spilled"].any()
    assert recording.frames["part"].shape == (len(recording.frames["time"]), 2, 0, 2)


def test_steps_counted_are_steps_taken(result):
    recording = result.recording
    taken = recording.series["time"][-1] / recording.step
    assert recording.grain_steps == pytest.approx(taken * recording.radius.size, rel=1e-9)


def test_a_world_settles_alone_as_it_does_in_company():
    """Repeat 0 starts from the same grains and the same step whatever the number of repeats."""
    (alone, start), (among, starts) = (
        build(load("tilting/quick", SMALL | {"run": {"repeats": n, "step": "auto"}}).resolved) for n in (1, 3)
    )
    assert np.array_equal(start[0], starts[0]) and np.array_equal(alone.radius[0], among.radius[0])
    assert alone.step == among.step and alone.interfaces == among.interfaces
    assert not np.array_equal(among.radius[0], among.radius[1])


def test_a_step_past_the_limit_is_refused_unless_forced_and_far_past_it_in_any_case():
    with pytest.raises(LabError, match=r"run\.step: .*past the limit.*force_step"):
        build(load("tilting/quick", SMALL | {"run": {"step": "20 us"}}).resolved)
    forced = SMALL | {"run": {"step": "20 us", "force_step": True}}
    assert build(load("tilting/quick", forced).resolved)[0].step == pytest.approx(2e-5)
    with pytest.raises(LabError, match=r"run\.step: 1 ms is 212 times the limit.* at most 5 times"):
        build(load("tilting/quick", SMALL | {"run": {"step": "1 ms", "force_step": True}}).resolved)


@pytest.mark.slow
def test_a_forced_step_is_said_in_the_summary(tmp_path):
    forced = SMALL | {"run": {"repeats": 1, "step": "20 us", "force_step": True, "duration": "0.02 s"}}
    folder = run_preset("tilting/quick", forced, tmp_path / "forced", video=False, quiet=True).folder
    assert "The step is forced past the derived one" in (folder / "summary.md").read_text()


def test_a_run_the_watch_stops_keeps_its_recording_and_says_why(tmp_path):
    soft = SMALL | {"run": {"repeats": 1}, "contact": {"stiffness_scale": 1e-9}}
    with pytest.raises(BadState, match=r"world 0: a grain moves at .* too fast for the step"):
        run_preset("tilting/quick", soft, tmp_path / "soft", video=False, quiet=True)
    with open_recording(tmp_path / "soft") as recording:
        assert recording.status.startswith("stopped: world 0")


def test_explain_names_step_limit_parts_and_cost():
    text = explain(load("tilting/quick", SMALL))
    for words in ("1/", "of the Hertz collision", "haff-werner", "Coriolis", "memory", "about"):
        assert words in text


def test_explain_says_how_wet_grains_pull():
    """2π γ R_eff over (4/3) π R³ ρ g of grains of 3 mm, and the Kelvin radius at 70 %."""
    text = explain(load("tilting/wet", SMALL))
    assert "humid: 339.3 µN, 1.9 times a mean grain's weight, across gaps of up to 1.472 nm" in text


@pytest.mark.slow
def test_a_bed_that_has_not_settled_is_said_in_the_summary(tmp_path):
    restless = SMALL | {"run": {"repeats": 1, "settle_limit": "0.01 s", "duration": "0.05 s"}}
    result = run_preset("tilting/quick", restless, tmp_path / "restless", video=False, quiet=True)
    assert "still moved after 0.01 s" in (result.folder / "summary.md").read_text()
