"""Posters of presets are found in the source, in an installed lab, and in a gallery of one's own."""

import runpy
from pathlib import Path

import pytest
from PIL import Image

from lab.base import data
from lab.preset.find import QUICK, names

ROOT = Path(__file__).parents[3]
POSTERS = sorted((ROOT / data.GALLERY).glob("*-*.webp"))


def plain(name: str) -> str:
    return name.replace("/", "-")


@pytest.fixture
def copied(tmp_path, monkeypatch):
    """The data of a wheel as its build copies them: the folder of the packages."""
    setuptools = pytest.importorskip("setuptools")
    monkeypatch.setattr(setuptools, "setup", lambda **_: None)
    monkeypatch.chdir(ROOT)
    building = runpy.run_path(str(ROOT / "setup.py"))["WithPosters"]
    monkeypatch.setattr(building.__base__, "run", lambda _: None)  # all but the posters
    monkeypatch.setattr(building.__base__, "get_source_files", lambda _: [])
    command = building(setuptools.Distribution())
    command.build_lib = str(tmp_path / "packages")
    command.run()
    assert {ROOT / name for name in command.get_source_files()} == set(POSTERS)
    return tmp_path / "packages"


def test_every_poster_is_of_a_preset_and_is_found_from_any_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    shown = {plain(name): name for name in names() if not name.endswith(QUICK)}
    assert len(POSTERS) > 100 and [path.stem for path in POSTERS if path.stem not in shown] == []
    assert [path for path in POSTERS if data.poster(shown[path.stem]) != path] == []


def test_an_installed_lab_has_the_same_posters(copied, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(data, "PRESETS", copied / "presets")
    found = [path for path in map(data.poster, names()) if path]
    assert {path.name for path in found} == {path.name for path in POSTERS}
    with Image.open(found[0]) as image:
        assert image.size == (400, 225)


def test_a_gallery_of_ones_own_comes_first(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    own = data.GALLERY / "tilting-lowwall.webp"
    own.parent.mkdir(parents=True)
    own.touch()
    assert data.poster("tilting/lowwall") == own
    assert data.poster("tilting/nonsense") is None
