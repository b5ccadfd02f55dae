"""The package's metadata: one version everywhere, a licence compatible with its libraries, the citation."""

import re
import tomllib
from importlib import metadata
from pathlib import Path

import pytest
import yaml
from click.testing import CliRunner

import lab
from lab.cli import main
from lab.recording.writer import versions

ROOT = Path(lab.__file__).parents[1]
MANUAL = [page for page in sorted((ROOT / "docs").rglob("*.md")) if "_build" not in page.parts]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *MANUAL]
LINK = re.compile(r"\]\(([^)#\s]+)[^)]*\)")
MADE = re.compile(r"^# (\S+\.py)$", re.MULTILINE)  # files that a recipe tells its reader to write
NAMED = re.compile(r"(?<![\w/])(?:lab|solvers|tests|docs|presets|\.ci)/[\w./-]*")


def test_one_version_everywhere():
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    assert citation["version"] == lab.__version__
    assert CliRunner().invoke(main, ["--version"]).output == f"cargolab {lab.__version__}\n"
    assert versions()["cargo-shift-lab"] == lab.__version__
    assert f"## {lab.__version__}" in (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")


def test_the_citation_has_what_the_format_requires():
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    assert {"cff-version", "message", "title", "authors"} <= set(citation)
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert citation["license"] == project["license"] == "MIT"


def test_classifiers_are_the_pythons_that_are_supported():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    named = [text.rsplit(" ", 1)[1] for text in project["classifiers"] if "Python :: 3." in text]
    assert named == ["3.11", "3.12", "3.13"] and project["requires-python"] == ">=3.11,<3.14"


@pytest.mark.parametrize("package", ["taichi", "numpy", "scipy", "h5py", "pydantic", "pint", "click", "rich", "pillow"])
def test_no_library_that_is_needed_forbids_the_licence(package):
    """Libraries that a run imports are under permissive licences; a copyleft one would bind who passes the lab on."""
    told = metadata.metadata(package)
    texts = [told.get("License-Expression") or "", (told.get("License") or "")[:200], *told.get_all("Classifier", [])]
    assert not any("GPL" in text and "LGPL" not in text for text in texts)


def test_every_path_that_a_page_names_is_there():
    found = []
    for page in PAGES:
        text = page.read_text(encoding="utf-8")
        found += [page.parent / link for link in LINK.findall(text) if "://" not in link]
        made = set(MADE.findall(text))
        found += [ROOT / name.rstrip(".") for name in NAMED.findall(text) if name not in made]
    assert len(found) > 20
    assert [str(path) for path in found if not path.exists()] == []
