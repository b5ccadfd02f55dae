"""A recording of format 2, made by the last version that wrote it: it opens, measures and is painted."""

import shutil
from pathlib import Path

import numpy as np
import pytest

from lab.base.errors import LabError
from lab.measures import measure_all
from lab.paint.video import render_recording
from lab.recording import Recorder, open_recording
from lab.report.plots import write_plots

KEPT = Path(__file__).parents[2] / "data" / "recording-format-2.h5"


@pytest.fixture
def path(tmp_path) -> Path:
    return Path(shutil.copy(KEPT, tmp_path / "recording.h5"))


def test_a_recording_of_format_2_opens_with_its_quantities(path):
    with open_recording(path) as found:
        assert found.complete and found.name == "tilting/quick" and found.worlds == 2
        assert found.radius.shape == (2, 18) and "title = " in found.given
        assert found.series["wall_force"].shape == (33, 2, 3) and found.frames["position"].shape == (9, 2, 18, 2)
        np.testing.assert_allclose(found.frames["time"][:], np.arange(9) / 8)
        mass = found.series["centre_of_mass"]
        # The centre of mass is that of the grains, heavier ones more: a check that numbers are what their names say.
        weight = found.radius**3
        centre = (weight[..., None] * found.frames["position"][0]).sum(axis=1) / weight.sum(axis=1)[:, None]
        np.testing.assert_allclose(mass[0], centre, rtol=1e-5)
        assert found.quantities["wall_force"].units == ("N", "N", "N m") and found.quantities["spin"].per == "grain"
        assert found.labelled()["pose"].sel(freedom="roll").max() == pytest.approx(np.radians(40.0))


def test_a_recording_of_format_2_is_measured_and_drawn(path, tmp_path):
    with open_recording(path) as found:
        measures = measure_all(found)
        assert measures["final_shift"].value < -1.0
        assert set(write_plots(found, measures, tmp_path)) >= {"shift", "energy"}
    pictures = render_recording(path, tmp_path / "pictures", png=True, width=320, height=180)
    assert len(list(pictures.glob("*.png"))) >= 9


def test_a_recording_of_format_2_cannot_be_continued(path):
    with pytest.raises(LabError, match="begun by another version: start the run again"):
        Recorder(path.parent, samples=33, frames=9)
