"""Outlines from pictures: area, form and place of a drawn grain are found again, on light and on dark ground."""

import numpy as np
import pytest
from click.testing import CliRunner
from PIL import Image, ImageDraw

import cargolab
from lab.assembly.traced import otsu, trace
from lab.base.errors import LabError
from lab.cli import main

A, B, TURN = 90.0, 40.0, np.radians(30.0)


def drawn(path, ground=250, grain=60, noise=12.0, shift=(0, 0), hole=False):
    """A picture of an ellipse with noise."""
    angle = np.linspace(0.0, 2.0 * np.pi, 400)
    y, z = A * np.cos(angle), B * np.sin(angle)
    turned = np.cos(TURN) * y - np.sin(TURN) * z, np.sin(TURN) * y + np.cos(TURN) * z
    image = Image.new("L", (320, 240), ground)
    brush = ImageDraw.Draw(image)
    brush.polygon([(160 + shift[0] + p, 120 + shift[1] - q) for p, q in zip(*turned, strict=True)], fill=grain)
    if hole:
        brush.ellipse((150, 110, 170, 130), fill=ground)
    brush.ellipse((10, 10, 20, 20), fill=grain)  # a crumb
    shades = np.asarray(image, dtype=float) + np.random.default_rng(1).normal(0.0, noise, (240, 320))
    Image.fromarray(np.clip(shades, 0, 255).astype(np.uint8)).save(path)
    return path


@pytest.mark.parametrize(("ground", "grain"), [(250, 60), (20, 180)])
@pytest.mark.parametrize("hole", [False, True])
def test_an_ellipse_is_found_again(tmp_path, ground, grain, hole):
    """Asked: area to 2 %, axes to 2 %, the turn to 1 degree; a pixel is 1 to 2.5 % of the axes."""
    found = trace(drawn(tmp_path / "grain.png", ground, grain, hole=hole), points=200)
    assert len(found.points) == 200 and found.area == pytest.approx(np.pi * A * B, rel=0.02)
    assert np.abs(found.points.mean(axis=0)).max() < 1.0
    spread = np.linalg.eigh(np.cov(found.points.T))
    assert np.ptp(found.points @ spread.eigenvectors[:, 1]) == pytest.approx(2.0 * A, rel=0.02)
    assert np.ptp(found.points @ spread.eigenvectors[:, 0]) == pytest.approx(2.0 * B, rel=0.02)
    across, up = spread.eigenvectors[:, 1]
    assert np.arctan2(up, across) % np.pi == pytest.approx(TURN, abs=np.radians(1.0))


def test_its_file_is_a_contour_of_a_preset(tmp_path):
    told = CliRunner().invoke(
        main, ["outline", str(drawn(tmp_path / "grain.png")), "--width", "6 mm", "--out", str(tmp_path / "grain.csv")]
    )
    assert told.exit_code == 0 and "grain.csv" in told.output, told.output
    table = np.loadtxt(tmp_path / "grain.csv", delimiter=",", skiprows=2)
    assert np.ptp(table[:, 0]) == pytest.approx(0.006, rel=1e-6)
    preset = cargolab.Preset("shapes/box", shapes={"grain": False, "mine": {"contour": str(tmp_path / "grain.csv")}})
    descriptors, _ = preset.values.shapes["mine"].described
    assert descriptors[1] == pytest.approx(0.4, abs=0.15)  # an elongation of 2.25


def test_what_shows_no_whole_grain_is_refused(tmp_path):
    Image.new("L", (200, 200), 128).save(tmp_path / "plain.png")
    (tmp_path / "text.png").write_text("no picture")
    for name, said in (
        ("plain.png", "nothing that stands out"),
        ("text.png", "no picture"),
        ("gone.png", "No such file"),
    ):
        with pytest.raises(LabError, match=said):
            trace(tmp_path / name)
    with pytest.raises(LabError, match="cut off by the edge"):
        trace(drawn(tmp_path / "cut.png", shift=(90, 0)))
    with pytest.raises(LabError, match="from 8 to"):
        trace(drawn(tmp_path / "grain.png"), points=3)


def test_otsus_shade_parts_two_normal_distributions_in_the_middle():
    random = np.random.default_rng(3)
    shades = np.concatenate([random.normal(0.3, 0.05, 5000), random.normal(0.7, 0.05, 5000)])
    assert otsu(np.clip(shades, 0.0, 1.0)) == pytest.approx(0.5, abs=0.02)
