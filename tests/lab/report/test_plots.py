"""Figures: which are drawn of what, and that hard cases are drawn too."""

import json
import warnings
from types import SimpleNamespace

import matplotlib
import numpy as np
import pytest
from PIL import Image

from lab import measures
from lab.base.errors import LabError
from lab.measures import energies, measure_all
from lab.measures.drawing import mark
from lab.measures.value import over_worlds
from lab.recording import open_recording
from lab.report.plots import STYLE, figures, write_plots
from lab.report.summary import write_summary
from tests.oracles.synthetic import DEPTH, DIAMETER, WIDTH, box, frame, preset, recorder, sample

TILT = preset(tilt={"rate": 0.07, "angle": 0.7})
SWAY = preset(sway={"amplitude": 0.04, "frequency": 1.0})
SLOW = pytest.mark.slow
FEW = [(TILT, 2), *(pytest.param(*few, marks=SLOW) for few in ((TILT, 9), (SWAY, 2), (SWAY, 9)))]


def bed(count=600):
    """Places (count, 2) of a filled tank."""
    y = np.linspace(-WIDTH / 2 + DIAMETER / 2, WIDTH / 2 - DIAMETER / 2, 60)
    return np.stack(np.meshgrid(y, DIAMETER * (0.5 + np.arange(count // 60))), -1).reshape(-1, 2)


def run(folder, resolved, samples=241, worlds=2, parts=None, lost=None, **scene):
    """A recording of a tilt to 40 deg and back, or of a sway at 1 Hz, of a bed that answers.

    lost: a world whose last grain leaves half-way.
    """
    time, places, parts = np.linspace(0, 16, samples), bed(), parts or {}
    count = len(places)
    scene = {"radius": np.full((worlds, count), DIAMETER / 2), "outline": box(), **scene}
    with recorder(folder, resolved=resolved, parts=parts, **scene) as writer:
        for k, now in enumerate(time):
            wave = np.sin(2 * np.pi * now)
            tilt = np.radians(40 - 5 * abs(now - 8)) if "tilt" in resolved["motion"] else 0.0
            pose = np.tile([0.04 * wave * ("sway" in resolved["motion"]), 0.0, tilt], (worlds, 1))
            shift = -0.01 * min(1.0, now / 6) if tilt else 0.003 * wave
            centre = np.tile([shift, DEPTH / 2], (worlds, 1))
            spilled, position = np.zeros(worlds), np.tile(places, (worlds, 1, 1))
            if scene.get("open_edges"):
                spilled += np.floor(count * min(0.5, 0.1 * max(0.0, now - 4)))
            if lost is not None and now > 8:
                centre[lost], spilled[lost], position[lost] = np.nan, count, np.nan
            force = np.array([[-0.1 * wave, -1.0, 0.01 * wave]] * worlds)
            said = {"spilled": spilled, "wall_force": force, "contacts": 2.0 * (count - spilled)}
            said |= {"kinetic": np.full(worlds, 1e-6), "pose": pose, "centre_of_mass": centre}
            writer.sample(sample(now, worlds, **said))
            if k % 8 == 0:
                position[..., 1] += 0.002 * wave * position[..., 0] / WIDTH
                moved = np.zeros((worlds, len(parts), 2))
                writer.frame(frame(now, worlds, count, pose=pose, position=position, part=moved))
    return folder


def drawn(folder):
    """Names of the figures of a recording, that have been drawn without a warning and show something."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with open_recording(folder) as recording:
            files = write_plots(recording, measure_all(recording), folder)
    for path in files.values():
        with Image.open(path) as picture:
            assert picture.width > 350
            assert len(np.unique(np.asarray(picture.convert("RGBA")).view(np.uint32))) > 50  # colours
    return list(files)


@pytest.mark.parametrize(
    ("resolved", "scene", "figures"),
    [
        pytest.param(TILT, {}, ["shift", "slope", "hysteresis", "force", "contacts", "energy"], marks=SLOW),
        (TILT, {"open_edges": (2,)}, ["spilled", "shift", "slope", "hysteresis", "force", "contacts", "energy"]),
        pytest.param(SWAY, {}, ["shift", "spectrum", "wave", "force", "contacts", "energy"], marks=SLOW),
        (preset(), {"parts": {"gate": np.zeros((2, 2))}}, ["altitude", "shift", "force", "contacts", "energy"]),
    ],
)
def test_each_experiment_has_the_relevant_figures(tmp_path, resolved, scene, figures):
    assert drawn(run(tmp_path, resolved, **scene)) == figures


@pytest.mark.slow
@pytest.mark.parametrize("resolved", [TILT, SWAY])
def test_a_world_that_loses_every_grain_is_left_out_of_figures(tmp_path, resolved):
    assert "shift" in drawn(run(tmp_path, resolved, open_edges=(2,), lost=1))


def test_a_single_bed_that_loses_every_grain_is_drawn(tmp_path):
    assert "spilled" in drawn(run(tmp_path, SWAY, worlds=1, open_edges=(2,), lost=0))


@pytest.mark.parametrize(("resolved", "samples"), FEW)
def test_a_run_stopped_after_a_few_samples_is_drawn(tmp_path, resolved, samples):
    assert "shift" in drawn(run(tmp_path, resolved, samples=samples, worlds=1))


def words(figure):
    """All that a figure says in its title and its legends."""
    legends = [text.get_text() for legend in figure.legends for text in legend.get_texts()]
    return " ".join([figure.get_suptitle(), *legends])


@pytest.mark.parametrize(("worlds", "bars"), [(1, False), (2, True)])
def test_plus_minus_appears_only_for_several_beds_with_their_number(tmp_path, worlds, bars):
    with open_recording(run(tmp_path, TILT, worlds=worlds)) as recording:
        drawn = dict(figures(recording, measure_all(recording)))
        said = [words(drawn[name]) for name in ("shift", "slope", "contacts")]
    assert all(("±" in text) is bars for text in said)
    assert ("mean ± std of 2 beds" in said[0]) is bars
    assert "band: uncertainty of the fit" in said[1]


def test_axes_in_powers_of_ten_have_readable_numbers(tmp_path):
    """With STYLE a number in a power of ten is set as one, not printed as its source."""
    with open_recording(run(tmp_path, SWAY, worlds=1)) as recording, matplotlib.rc_context(STYLE):
        figure = dict(figures(recording, {}))["energy"]
        figure.savefig(tmp_path / "energy.png")
        labels = figure.axes[0].get_yticklabels()
    assert labels and all(label.get_parse_math() for label in labels)


def draw_drift(sheet, recording, values):
    """The made-up measure below, as a mark on an axis."""
    ((axes,),) = sheet.panels()
    mark(sheet, axes, values["drift"], "drift", "black")
    axes.set_xlabel("drift (mm)")


def test_a_new_measure_brings_its_number_its_error_and_its_figure(tmp_path, monkeypatch):
    """A file with `applies`, `measure` and `FIGURES`, and a line in MEASURES: the report shows it all."""
    drift = over_worlds([3.0, 5.0], "mm", uncertainties=[0.1, 0.1], kind="fit")
    made_up = SimpleNamespace(
        applies=lambda recording: recording.worlds == 2,
        measure=lambda recording: {"drift": drift},
        FIGURES={"drift-figure": draw_drift},
    )
    monkeypatch.setattr(measures, "MEASURES", (measures.MEASURES[0], made_up))
    with open_recording(run(tmp_path, TILT, worlds=2)) as recording:
        values = measure_all(recording)
        drawn = dict(figures(recording, values))["drift-figure"]
        page = write_summary(recording, values, write_plots(recording, values, tmp_path), tmp_path)["summary"]
    assert "drift 4.0 ± 1.4 mm (2 beds)" in words(drawn)
    assert (tmp_path / "drift-figure.png").exists()
    assert "![drift-figure](drift-figure.png)" in page.read_text()
    assert "| drift | 4 | 1.414 | 2 | fit 0.1 mm | mm |  |" in page.read_text()
    assert json.loads((tmp_path / "summary.json").read_text())["measures"]["drift"]["std"] == pytest.approx(2**0.5)
    with open_recording(run(tmp_path / "alone", TILT, worlds=1)) as recording:
        assert "drift-figure" not in write_plots(recording, measure_all(recording), tmp_path / "alone")


def test_a_long_title_takes_more_lines_and_stays_on_the_page(tmp_path, monkeypatch):
    monkeypatch.setattr(energies, "FIGURES", {})
    long = "A tank of many grains that are shaken for a long time, " * 4
    writer = recorder(tmp_path, resolved={**SWAY, "title": long})
    for now in (0.0, 1.0, 2.0):
        writer.sample(sample(now))
    writer.close()
    assert drawn(tmp_path) == ["shift"]
    with Image.open(tmp_path / "shift.png") as picture:
        dark = np.asarray(picture.convert("L")) < 200
    title = dark[: picture.height // 7]
    assert np.diff(title.any(axis=1).astype(int)).tolist().count(1) >= 3  # lines
    assert not title[:, -4:].any()


def test_a_run_without_samples_or_with_one_has_no_figures(tmp_path):
    recorder(tmp_path / "none").close()
    writer = recorder(tmp_path / "one")
    writer.sample(sample(0.0))
    writer.close()
    assert drawn(tmp_path / "none") == drawn(tmp_path / "one") == []


def test_a_lost_folder_is_named(tmp_path):
    with open_recording(run(tmp_path, SWAY, samples=20)) as recording, pytest.raises(LabError, match="nowhere"):
        write_plots(recording, {}, tmp_path / "nowhere")
