"""Runs of tanks that hold nothing: what is recorded, measured and painted, and what is refused."""

import json

import numpy as np
import pytest

from lab.base.errors import LabError
from lab.base.progress import Progress
from lab.measures import measure_all
from lab.paint.film import Film, choose_beds, choose_look
from lab.paint.footage import open_footage
from lab.preset.find import load
from lab.recording import open_recording
from lab.report.explain import explain
from lab.runs.batch import Batch
from lab.runs.runner import resume_run, run_preset
from lab.sweeps.dry_run import available_measures
from lab.view.live import Live, steerable
from solvers.ship.motion import sail, start

TANK = """
format = 3
title = "An empty tank"
tank = { width = "0.3 m", height = "0.2 m", lid = false }
motion.sway = { amplitude = "10 mm", frequency = "1 Hz" }
motion.tilt = { angle = "10 deg", rate = "20 deg/s" }
run = { duration = "0.4 s", repeats = 2, threads = 1 }
record.checkpoint_every = "0 s"
"""
BARGE = {"run.duration": "2 s", "record.series_rate": "50 Hz"}


@pytest.fixture(scope="module")
def preset(tmp_path_factory):
    path = tmp_path_factory.mktemp("empty") / "tank.toml"
    path.write_text(TANK)
    return path


@pytest.fixture(scope="module")
def moved(preset):
    folder = preset.parent / "run"
    run_preset(preset, out=folder, video=False, quiet=True)
    return folder


@pytest.fixture(scope="module")
def afloat(tmp_path_factory):
    folder = tmp_path_factory.mktemp("barge") / "run"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("lab.report.plots.write_plots", lambda *_: {})
        run_preset("ship/barge-empty", BARGE, folder, video=False, quiet=True)
    return folder


def test_an_empty_tank_records_how_it_moves_and_that_nothing_loads_it(moved):
    with open_recording(moved) as recording:
        time = recording.series["time"]
        assert recording.complete and recording.radius.shape == (2, 0)
        assert recording.step == pytest.approx(0.01)  # the interval between samples
        sway = 0.01 * np.sin(2.0 * np.pi * time)
        assert recording.series["pose"][:, 1, 0] == pytest.approx(sway, abs=1e-12)
        assert np.ptp(recording.series["pose"][..., 2]) > 0.05
        assert not recording.series["wall_force"].any()
        assert set(recording.series) == {"time", "pose", "pose_rate", "wall_force"}
        assert set(recording.frames) == {"time", "pose", "part", "part_turn"}
        assert recording.labelled().sizes["world"] == 2
        assert measure_all(recording) == {}


def test_an_interrupted_run_of_an_empty_tank_goes_on_with_the_same_bits(preset, moved, monkeypatch):
    folder, pause, paused = preset.parent / "again", Batch._pause, []

    def interrupted(batch, interrupt):
        paused.append(pause(batch, interrupt))
        if len(paused) == 17:
            raise KeyboardInterrupt

    with monkeypatch.context() as patch, pytest.raises(KeyboardInterrupt):
        patch.setattr(Batch, "_pause", interrupted)
        run_preset(preset, out=folder, video=False, quiet=True)
    resume_run(folder, video=False, quiet=True)
    with open_recording(moved) as whole, open_recording(folder) as resumed:
        for name in whole.series:
            assert whole.series[name].tobytes() == resumed.series[name].tobytes()


def test_an_empty_barge_moves_as_the_ship_that_is_computed_alone(afloat):
    with open_recording(afloat) as recording:
        loaded, time, pose = load("ship/barge-empty", BARGE), recording.series["time"], recording.series["pose"][:, 0]
    from lab.assembly.scene import vessels

    (vessel,) = vessels(loaded.resolved)
    alone = sail(vessel.ship, start(vessel.ship, vessel.heave(vessel.ship.body, 0.0)), 2e-3, time[-1])
    assert np.ptp(alone.roll) > 0.05
    roll = np.interp(time[1:], alone.time, alone.roll)
    assert pose[1:, 2] == pytest.approx(roll, abs=1e-5 * np.ptp(roll))


def test_the_report_on_an_empty_barge_says_nothing_of_grains(afloat):
    summary, page = json.loads((afloat / "summary.json").read_text()), (afloat / "summary.md").read_text()
    assert {"largest_roll", "deck_immersion_angle", "wave_power"} <= summary["measures"].keys()
    assert not {"granular_power", "frozen_largest_roll", "carried_weight"} & summary["measures"].keys()
    page = page.partition("## The preset")[0]
    assert "nothing in the tank" in page and "grain" not in page and "settled" not in page
    assert summary["measures"].keys() == available_measures(load("ship/barge-empty", BARGE)).keys()


def test_an_empty_tank_is_painted(moved, afloat):
    for folder in (moved, afloat):
        with open_footage(folder) as footage:
            look = choose_look(footage, width=480, height=270)
            film = Film(choose_beds(footage), look)
            first, last = film.picture(0), film.picture(len(film.time) - 1)
        assert (first != last).any()


def test_explain_says_what_sets_the_step(preset):
    afloat, moved = explain(load("ship/barge-empty")), explain(load(preset))
    assert "of the ship's shortest period" in afloat and "interval between samples" in moved
    for page in (afloat, moved):
        page = page.partition("Preset in full")[0]
        assert "grain" not in page and "skin" not in page and "Accuracy" not in page


def test_an_empty_tank_is_steered(preset, tmp_path):
    with Live(steerable(load(preset)), tmp_path / "live", Progress(quiet=True)) as live:
        live.set("tilt", 0.1)
        for _ in range(20):
            live.advance()
        frame = live.frame()
        live.close()
    assert frame.rows["pose"][0, 2] > 0.0 and frame.grains == {} and not len(frame.pressing.force)


@pytest.mark.parametrize(
    ("key", "value", "remedy"),
    [
        ("contact.rolling", "constant-torque", "set contact = false"),
        ("tank.roughness", "3 mm", "set tank.roughness = false"),
        ("run.accuracy", "draft", "leave this out"),
        ("shapes.a.cargo", "rice", "set shapes = false"),
        ("video.colour", "spin", "leave this out"),
    ],
)
def test_what_speaks_of_grains_is_refused_without_them(preset, key, value, remedy):
    with pytest.raises(LabError) as error:
        load(preset, {key: value})
    named = remedy.partition(" = ")[0].removeprefix("set ") if "false" in remedy else key
    matter = "grains or water" if key == "run.accuracy" else "grains"
    sentence = f"{named}: goes with {matter}, and there are none; add a table [grains], or {remedy}."
    assert str(error.value) == sentence


def test_false_takes_the_grains_out_of_a_base():
    kept = load("ship/barge-wet", {"grains": False, "material": False, "contact": False}).resolved
    assert kept.matters == () and kept.waves is not None
