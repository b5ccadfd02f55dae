"""Runs of water: from the preset to the report, continued after an interruption, and swept, bit for bit."""

import json
from dataclasses import replace
from shutil import copytree

import numpy as np
import pytest

from lab.assembly.scene import build
from lab.base.errors import LabError, Unusable
from lab.paint.film import Film, choose_beds, choose_look
from lab.paint.footage import open_footage
from lab.preset.find import load
from lab.recording import open_recording
from lab.report.explain import explain
from lab.runs.batch import Batch
from lab.runs.runner import resume_run, run_preset
from lab.sweeps.dry_run import available_measures
from lab.sweeps.sweep import run_sweep
from solvers.fluid.start.rest import STARTS

pytestmark = pytest.mark.usefixtures("no_plots")

CUP = """
format = 3
title = "A cup of water"
tank = { width = "60 mm", height = "60 mm" }
water = { depth = "24 mm", spacing = "6 mm", sound_speed = "12 m/s" }
gauges.P1 = { place = ["-30 mm", "12 mm"] }
gauges.L1 = { kind = "level", y = "25 mm" }
gauges.F1 = { kind = "force", place = ["0 mm", "0 mm"] }  # as `tests/solvers/fluid/test_step.py` has some: one kernel
motion.sway = { amplitude = "3 mm", frequency = "3 Hz" }
run = { duration = "0.8 s", threads = 1, schedule = "per-world" }
record.checkpoint_every = "0 s"
"""


@pytest.fixture(scope="module")
def cup(tmp_path_factory):
    path = tmp_path_factory.mktemp("cup") / "cup.toml"
    path.write_text(CUP)
    return path


@pytest.fixture(scope="module")
def swayed(cup):
    """The folder of a run; in the folder `cut` beside it is what would be there, had the run been killed."""
    folder, pause, paused = cup.parent / "run", Batch._pause, []

    def noted(batch, interrupt):
        pause(batch, interrupt)
        paused.append(batch)
        if len(paused) == 30:
            copytree(folder, folder.with_name("cut"))

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Batch, "_pause", noted)
        run_preset(cup, out=folder, video=False, quiet=True)
    return folder


def same(first, second) -> None:
    """All rows of two recordings have the same bits."""
    with open_recording(first) as one, open_recording(second) as other:
        assert one.status == other.status == "complete"
        for name in one.series:
            assert one.series[name].tobytes() == other.series[name].tobytes(), name
        for name in one.frames:
            assert one.frames[name][:].tobytes() == other.frames[name][:].tobytes(), name


def test_a_run_records_the_water_and_its_gauges(swayed):
    with open_recording(swayed) as recording:
        series, scene = recording.series, build(recording.preset)[0]
        assert recording.volume.shape == (1, 40) and recording.volume.sum() == pytest.approx(0.06 * 0.024)
        assert scene.particles == 40 and recording.grain_steps == 40 * round(0.8 / recording.step)
        assert series["gauge_pressure"].shape == (81, 1, 1) and series["level_depth"].shape == (81, 1, 1)
        assert series["level_depth"][0, 0, 0] == pytest.approx(0.024, rel=5e-3)
        assert recording.frames["water_position"].shape == (21, 1, 40, 2)
        weight = 1000.0 * 9.81 * 0.06 * 0.024  # of a slab one metre thick
        assert -series["wall_force"][1:, 0, 1].mean() == pytest.approx(weight, rel=0.05)
        assert np.ptp(series["water_centre"][:, 0, 0]) > 1e-3


def test_the_report_names_what_was_computed_and_measured(swayed, cup):
    summary, page = json.loads((swayed / "summary.json").read_text()), (swayed / "summary.md").read_text()
    expected = {"gauge_largest_P1", "gauge_impulse_P1", "run_up_L1", "highest_water", "sloshing_frequency"}
    expected |= {"gauge_mean_P1", "crest_L1", "trough_scatter_L1", "force_peak_F1", "force_impulse_F1", "gauge_std_F1"}
    assert expected | {"water_residual", "water_density_deviation"} <= summary["measures"].keys()
    floor = summary["measures"]["gauge_mean_F1"]
    assert floor["value"] == pytest.approx(1000.0 * 9.81 * 0.06 * 0.024, rel=0.05) and floor["unit"] == "N"
    assert summary["measures"].keys() == available_measures(load(cup)).keys()
    water = summary["water"]
    assert water["particles"] == 40 and water["spacing_m"] == pytest.approx(0.006) and water["sound_speed_m_s"] == 12.0
    assert water["steps"] == round(0.8 / summary["cost"]["dt_s"]) and len(water["limits"]) >= 3
    assert min(limit["step"] for limit in water["limits"]) >= summary["cost"]["dt_s"]
    peak = summary["measures"]["gauge_largest_P1"]["value"]
    assert water["peaks"]["P1"]["pressure_Pa"] == pytest.approx(peak) and peak > 100.0
    page = page.partition("## The preset")[0]
    assert "40 particles of water, 6 mm apart, 24 mm deep" in page and "settled" not in page


def test_explain_says_what_the_water_is_and_what_sets_the_step(cup):
    page = explain(load(cup)).partition("Preset in full")[0]
    for part in ("40 particles in each tank", "12 m/s", "P1 of pressure, L1 of level", "wendland-c2", "crosses the sm"):
        assert part in page
    assert "grain" not in page and "settl" not in page


def test_a_recording_of_other_water_is_not_continued(swayed, tmp_path, monkeypatch):
    """Such as after a change of how the particles are laid."""
    copytree(swayed.with_name("cut"), tmp_path / "run")
    usual = STARTS["packed"]
    monkeypatch.setitem(STARTS, "packed", lambda *of: usual(*of[:2], replace(of[2], spacing=0.8 * of[2].spacing)))
    with pytest.raises(Unusable, match="does not belong to the preset in it"):
        resume_run(tmp_path / "run", video=False, quiet=True)


@pytest.mark.slow  # runs of grains do in `test_resume.py`, states of water in `fluid/test_sound_switch.py`
def test_a_run_that_was_killed_goes_on_with_the_same_bits(swayed):
    cut = swayed.with_name("cut")
    with open_recording(cut) as recording:
        assert 0 < len(recording.series["time"]) < 81
    resume_run(cut, video=False, quiet=True)
    same(swayed, cut)


@pytest.mark.slow  # that of grains is in `tests/lab/sweeps`
def test_a_point_of_a_sweep_has_the_bits_of_the_run_alone(cup, swayed, tmp_path, monkeypatch):
    monkeypatch.setattr("lab.sweeps.report.render_grid", lambda *_, **__: None)
    done = run_sweep(cup, {"motion.sway.amplitude": "3, 1 mm"}, None, tmp_path / "s", video=False, quiet=True)
    alone, other = sorted(done.folder.glob("**/recording.h5"), key=lambda path: -amplitude(path))
    same(alone.parent, swayed)
    with open_recording(alone) as large, open_recording(other) as small:
        rises = [np.ptp(recording.series["level_depth"]) for recording in (large, small)]
    assert rises[0] > 1.5 * rises[1] > 0.0


def amplitude(path) -> float:
    with open_recording(path) as recording:
        return recording.preset.motion.sway.amplitude


def test_water_is_painted(swayed):
    with open_footage(swayed) as footage:
        film = Film(choose_beds(footage), choose_look(footage, width=480, height=270))
        first, last = film.picture(0), film.picture(len(film.time) - 1)
    assert (first != last).any()


def test_more_water_than_fits_the_memory_is_refused_before_it_is_made(cup, monkeypatch):
    monkeypatch.setattr("lab.assembly.room.machine_memory", lambda: 10**6)
    with pytest.raises(LabError) as error:
        build(load(cup, {"water.spacing": "0.5 mm"}).resolved)
    assert str(error.value).startswith("water.spacing: 5929 particles of water take some 17.8 MB of memory, at 3 kB a ")
