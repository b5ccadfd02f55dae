"""The player: its data are the recorded places to half a step, its script reads them, and a page stays small."""

import json
import os
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from lab.export.exporting import export_recording
from lab.export.html import page as made
from lab.export.html.codec import packed, quantised, turned, unpacked
from lab.export.html.scene import sharp_edges
from lab.export.things import Shape
from lab.recording import open_recording
from tests.oracles.exported import TIMES, in_space, ship

SCRIPTS = Path(made.__file__).parent
NODE = shutil.which("node")
BROWSER = os.environ.get("CARGOLAB_BROWSER") or next(
    filter(None, map(shutil.which, ("chromium-headless-shell", "chromium", "google-chrome"))), None
)


@pytest.fixture(scope="module")
def barge(tmp_path_factory) -> Path:
    return ship(tmp_path_factory.mktemp("barge"), title="</script><b>a barge</b>", lost=True)


@pytest.fixture(scope="module")
def text(barge, tmp_path_factory) -> str:
    return export_recording(barge, "html", tmp_path_factory.mktemp("page") / "player.html").read_text()


def scene_of(text: str) -> dict:
    return json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', text, re.DOTALL)[1])


def test_embedded_places_are_the_recorded_ones_to_half_a_step(barge, text):
    scene = scene_of(text)
    stream = scene["clouds"][0]["place"]
    with open_recording(barge) as recording:
        recorded = recording.frames["position"][:][:, 0]
    found, there = unpacked(stream), np.isfinite(recorded)
    assert (np.isfinite(found) == there).all() and not there.all()
    off = np.abs(np.where(there, found - recorded, 0.0)).max(axis=(0, 1))
    assert (off <= 0.5 * np.array(stream["step"]) * 1.001 + 1e-9).all() and max(stream["step"]) < 1e-6
    assert scene["time"] == TIMES.tolist() and np.allclose(scene["pose"][2][3:6], [np.cos(0.6), -np.sin(0.6), 0.0])


@pytest.mark.parametrize("shape", [(5, 7), (4, 3, 2), (1, 6, 3)])
def test_what_is_packed_comes_back(shape):
    values = (
        np.random.default_rng(1).normal(size=shape) * np.array([1.0, 30.0, 0.1])[: shape[-1] if len(shape) > 2 else 1]
    )
    stream = quantised(values)
    assert np.abs(unpacked(stream) - values).max() <= 0.501 * max(stream["step"])
    assert (np.abs(unpacked(stream) - values) <= 0.501 * np.array(stream["step"])).all()
    assert np.isnan(unpacked(quantised(np.full((2, 3), np.nan)))).all()


def test_angles_come_back_up_to_whole_turns():
    angles = np.linspace(-9.0, 9.0, 60).reshape(12, 5)
    off = unpacked(turned(angles)) - angles
    assert np.abs(off - 2.0 * np.pi * np.round(off / (2.0 * np.pi))).max() < 6e-5


def test_a_page_needs_nothing_from_elsewhere_and_shows_titles_as_text(text):
    assert not re.search(r"""(src|href)\s*=|https?://|@import|url\(""", text.replace("default-src", ""))
    assert text.count("</script>") == 2 and "&lt;/script&gt;&lt;b&gt;a barge" in text


def test_a_page_that_would_be_too_large_has_fewer_pictures_and_says_so(barge, tmp_path, monkeypatch):
    monkeypatch.setattr(made, "MOST_BYTES", 1000)
    text = export_recording(barge, "html", tmp_path / "player.html").read_text()
    assert scene_of(text)["time"] == [0.0, 1.0]
    assert "This page holds 2 of the 3 recorded pictures" in text


def test_edges_are_sharp_where_faces_meet_at_an_angle():
    points = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (2, 0, 0), (2, 1, 0), (0, 0, 1), (1, 0, 1.0)])
    cells = [[0, 1, 2, 3], [1, 4, 5, 2], [0, 1, 7, 6]]  # two in one plane, one upright
    shape = Shape(points, tuple(map(np.array, cells)), True, np.zeros(3, dtype=int), ("tank",))
    sharp = {frozenset(edge[:2]): edge[4] for edge in sharp_edges(shape)}
    assert sharp[frozenset((1, 2))] == 0 and sharp[frozenset((0, 1))] == 1 and sharp[frozenset((3, 0))] == 1


@pytest.mark.skipif(NODE is None, reason="node is not installed, which runs the page's script")
def test_the_script_reads_what_is_embedded(text, tmp_path):
    cloud = scene_of(text)["clouds"][0]
    tables = {
        "place": cloud["place"],
        "angle": cloud["angle"],
        "coarse": packed(np.array([[1, 2], [255, 0]], dtype="u1")),
    }
    tables["coarse"] |= {"low": [0.0], "step": [1.0]}
    (tmp_path / "given.json").write_text(json.dumps(tables))
    (tmp_path / "run.js").write_text(
        "".join((SCRIPTS / name).read_text() for name in ("codec.js", "view.js"))
        + """
        (async () => {
          const given = JSON.parse(require("fs").readFileSync(process.argv[2])), found = {};
          for (const [name, stream] of Object.entries(given)) {
            const one = await decode(stream);
            found[name] = Array.from({ length: one.frames }, (_, k) => [...valuesAt(one, k, 0, new Array(one.row))]);
          }
          found.between = placeInTime([0, 0.4, 1.0], 0.7);
          console.log(JSON.stringify(found));
        })();"""
    )
    told = subprocess.run([NODE, "run.js", "given.json"], cwd=tmp_path, capture_output=True, text=True, check=True)
    found = json.loads(told.stdout)
    for name in ("place", "angle"):
        read = np.array(found[name], dtype=float).reshape(cloud[name]["shape"])
        np.testing.assert_allclose(read, unpacked(cloud[name]), atol=1e-12)
    assert found["coarse"] == [[1, 2], [None, 0]] and found["between"] == [1, pytest.approx(0.5)]


@pytest.mark.skipif(BROWSER is None, reason="no headless Chromium: CARGOLAB_BROWSER names one")
@pytest.mark.parametrize("record", [ship, in_space])
def test_a_browser_shows_the_scene(tmp_path, record):
    page = export_recording(record(tmp_path / "run"), "html")
    shot = tmp_path / "shot.png"
    asked = ["--no-sandbox", "--hide-scrollbars", "--window-size=800,1000", "--virtual-time-budget=5000"]
    said = subprocess.run(
        [BROWSER, *asked, "--enable-logging=stderr", f"--screenshot={shot}", f"file://{page}#time=0.4"],
        capture_output=True,
        text=True,
        timeout=120,
        check=True,
    )
    assert "CONSOLE" not in said.stderr  # no error of the script
    with Image.open(shot) as picture:
        pixels = np.asarray(picture.convert("RGB")).reshape(-1, 3).astype(int)
    brown = (np.abs(pixels - [201, 143, 60]).max(axis=1) < 30).sum()  # of grains
    assert brown > 20
    if record is ship:
        assert (np.abs(pixels - [181, 207, 228]).max(axis=1) < 12).sum() > 5000  # the sea
