"""Runs of water with air over it: what is recorded of both, the pictures, and going on with the same bits."""

import numpy as np
import pytest

from lab.paint.film import Film, choose_beds, choose_look
from lab.paint.footage import open_footage
from lab.preset.find import load
from lab.recording import open_recording
from lab.report.explain import explain
from lab.runs.batch import Batch
from lab.runs.runner import resume_run, run_preset
from solvers.machine.runtime import initialise

pytestmark = pytest.mark.usefixtures("no_plots")

CUP = """
format = 3
title = "A closed cup of water and air"
tank = { width = "60 mm", height = "60 mm" }
water = { depth = "24 mm", spacing = "6 mm", sound_speed = "12 m/s" }
air = {}
gauges.P1 = { place = ["-30 mm", "12 mm"] }
gauges.A1 = { place = ["0 mm", "60 mm"] }
motion.sway = { amplitude = "3 mm", frequency = "3 Hz" }
run = { duration = "0.4 s", threads = 1, schedule = "per-world" }
record.checkpoint_every = "0 s"
"""


@pytest.fixture(scope="module")
def cup(tmp_path_factory):
    path = tmp_path_factory.mktemp("airy") / "cup.toml"
    path.write_text(CUP)
    run_preset(path, out=path.parent / "run", video=False, quiet=True)
    return path


@pytest.mark.slow
@pytest.mark.parametrize("pauses", [10, 30])
def test_an_interrupted_run_goes_on_over_the_moment_at_which_its_air_becomes_stiff(cup, monkeypatch, pauses):
    """From a checkpoint before it, and from one after it; the summary tells the long steps."""
    late = cup.parent / "late.toml"
    late.write_text(CUP.replace("air = {}", 'air = { sound_speed = "96 m/s", stiff_from = "0.2 s" }'))
    if not (late.parent / "run-late").exists():
        run_preset(late, out=late.parent / "run-late", video=False, quiet=True)
    goes_on(late, late.parent / "run-late", late.parent / f"again-{pauses}", monkeypatch, pauses)
    text = (late.parent / f"again-{pauses}" / "summary.md").read_text()
    assert "longer steps while the air is soft" in text and "8 steps in one" in text


@pytest.mark.slow
def test_an_interrupted_run_goes_on_with_the_same_bits(cup, monkeypatch):
    goes_on(cup, cup.parent / "run", cup.parent / "again", monkeypatch, 20)


def goes_on(path, whole, folder, monkeypatch, pauses: int) -> None:
    """Interrupt a run after so many calls and resume it: it ends with the bits of the `whole` one."""
    pause, paused = Batch._pause, []

    def interrupted(batch, interrupt):
        paused.append(pause(batch, interrupt))
        if len(paused) == pauses:
            raise KeyboardInterrupt

    with monkeypatch.context() as patch, pytest.raises(KeyboardInterrupt):
        patch.setattr(Batch, "_pause", interrupted)
        run_preset(path, out=folder, video=False, quiet=True)
    with open_recording(folder) as stopped:
        assert stopped.status != "complete"
    resume_run(folder, video=False, quiet=True)
    with open_recording(whole) as one, open_recording(folder) as other:
        assert one.status == other.status == "complete"
        for name in ("air_position", "air_pressure", "water_position"):
            assert one.frames[name][:].tobytes() == other.frames[name][:].tobytes(), name


@pytest.mark.slow
def test_both_phases_are_recorded_apart(cup):
    with open_recording(cup.parent / "run") as recording:
        series, frames = recording.series, recording.frames
        assert recording.volume.shape == (1, 40) and recording.air_volume.shape == (1, 60)
        assert frames["water_position"].shape[1:] == (1, 40, 2) and frames["air_position"].shape[1:] == (1, 60, 2)
        assert series["air_volume"][0, 0] == pytest.approx(0.06 * 0.036, rel=0.01)
        assert (series["air_centre"][:, 0, 1] > series["water_centre"][:, 0, 1]).all()
        assert np.ptp(series["water_centre"][:, 0, 0]) > 1e-3
        assert recording.labelled(frames=slice(0, 1))["air_velocity"].dims == ("time", "world", "air_particle", "axis")
        assert "Pa" in recording.quantities["air_mean_pressure"].unit


@pytest.mark.slow
def test_the_summary_says_how_soft_the_air_is(cup):
    text = (cup.parent / "run" / "summary.md").read_text()
    assert "60 particles of air" in text and "times softer than real air" in text
    page = explain(load(cup)).partition("Preset in full")[0]
    assert "60 of these particles, 1.2 kg/m^3" in page and "times softer than real air" in page


@pytest.mark.slow
def test_pictures_show_the_air_where_water_is_not(cup):
    """By its pressure in colours, while water looks like water; where water alone is asked for, air is left out."""
    initialise(fields=False)
    with open_footage(cup.parent / "run") as footage:
        beds = choose_beds(footage)
        airy, plain, pressed = (
            Film(beds, choose_look(footage, width=640, height=360, colour=colour)).picture(3).astype(int)
            for colour in ("air", "water", "pressure")
        )
    blue = np.abs(plain - [44, 106, 168]).sum(axis=2) < 150
    changed = np.abs(airy - plain).sum(axis=2) > 30
    assert blue.sum() > 1000 and changed.sum() > 1000
    assert (blue & changed).sum() < 0.1 * blue.sum()
    assert (np.abs(pressed - plain).sum(axis=2) > 30).sum() > changed.sum()
