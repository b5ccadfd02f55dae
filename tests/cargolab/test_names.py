"""`import cargolab`: its names stay, importing it loads nothing, and a user's own file that hides the lab is named."""

import inspect
import os
import subprocess
import sys
from ast import literal_eval
from pathlib import Path

import pytest

import cargolab

ROOT = Path(__file__).parents[2]
# Frozen, too: what these have
METHODS = {
    "Preset": {"name", "title", "text", "values", "quantity", "change", "changed", "schema", "keys", "cost", "explain",
               "run", "sweep", "save"},
    "Simulation": {"resume", "folder", "preset", "time", "duration", "ended", "now", "run", "every", "stop", "set",
                   "bed", "save", "restore", "report", "close"},
}  # fmt: skip
# Frozen: a name or a parameter here is in users' scripts. Adding is fine; taking away breaks them.
NAMES = {
    "colour": ("function", "label", "name"),
    "law": ("kind", "name"),
    "measure": ("function", "unit", "of", "when", "name"),
    "motion": ("function", "moves", "unit", "parameters", "name"),
    "plugin": ("path",),
    "quantity": ("function", "unit", "label", "name"),
    "Preset": ("of", "overrides"),
    "Simulation": ("preset", "out", "repeats", "quiet", "overrides"),
    "calibrate": ("preset", "target", "vary", "out", "repeats", "quiet", "cluster", "overrides"),
    "cargoes": ("name",),
    "explain": ("preset", "overrides"),
    "export": ("path", "to", "out", "every", "world", "frame", "sound", "progress"),
    "fields": ("of", "frame", "world", "spacing", "width"),
    "water_at": ("of", "points", "frame", "world"),
    "flood": ("case", "out", "video", "overrides"),
    "hull": tuple(["file", "density", "fair", "lbp", "ap", "stations", "scale", "up", "origin", "mirror", "close"]),
    "open": ("path", "sound"),
    "presets": ("word",),
    "render": ("path", "out", "png", "world", "progress", "look"),
    "resume": ("folder", "video", "plots", "quiet"),
    "run": ("preset", "out", "repeats", "video", "plots", "quiet", "overrides"),
    "sweep": ("preset", "axes", "out", "repeats", "video", "plots", "quiet", "cluster", "overrides"),
    "view": ("preset", "out", "size", "overrides"),
}


def python(*words: str, folder: Path, path: tuple[Path, ...] = (ROOT,)) -> subprocess.CompletedProcess:
    """What Python says, started in a folder with these folders on its path behind it."""
    env = os.environ | {"PYTHONPATH": os.pathsep.join(map(str, path))}
    return subprocess.run([sys.executable, *words], cwd=folder, env=env, capture_output=True, text=True, check=False)


def test_the_public_names_and_their_parameters_stay():
    assert sorted([*NAMES, "Error", "__version__"]) == cargolab.__all__ == dir(cargolab)
    assert {name: tuple(inspect.signature(getattr(cargolab, name)).parameters) for name in NAMES} == NAMES
    assert all(getattr(cargolab, name).__doc__ for name in NAMES)
    assert all(names <= set(dir(getattr(cargolab, kind))) for kind, names in METHODS.items())
    assert issubclass(cargolab.Error, Exception)
    with pytest.raises(AttributeError, match=r"cargolab has no runn; it has .*\brun\b"):
        cargolab.runn  # noqa: B018
    assert (Path(cargolab.__file__).parent / "py.typed").exists()


def test_importing_loads_nothing_of_the_lab(tmp_path):
    told = python("-c", "import sys, cargolab; print([m for m in sys.modules if m.split('.')[0] in "
                  "('lab', 'solvers', 'numpy', 'taichi', 'pydantic')])", folder=tmp_path)  # fmt: skip
    assert literal_eval(told.stdout) == []


def test_presets_by_name_with_their_titles():
    assert cargolab.presets("tilting/")["tilting/quick"].startswith("Quick tilt")
    assert all(name.startswith("ship/") for name in cargolab.presets("ship/"))
    assert len(cargolab.presets()) > len(cargolab.presets("ship/")) > 5


@pytest.mark.parametrize("name", ["lab.py", "lab/", "solvers.py", "solvers/", "lab/__init__.py"])
def test_a_file_of_the_users_that_hides_the_lab_is_named_in_one_sentence(tmp_path, name):
    mine = tmp_path / name
    mine.parent.mkdir(exist_ok=True)
    mine.mkdir() if name.endswith("/") else mine.write_text("x = 1\n")
    hiding = tmp_path / Path(name).parts[0]
    if name.endswith("/"):  # a folder without code hides only what is not on Python's path, as an editable installation
        (tmp_path / "elsewhere").mkdir()
        (tmp_path / "elsewhere" / "cargolab").symlink_to(ROOT / "cargolab")
        path = (tmp_path / "elsewhere",)
    else:
        path = (ROOT,)
    package = hiding.stem
    said = f"{hiding} hides the lab's own package {package}: rename it"
    told = python("-c", "import cargolab\ncargolab.run('tilting/quick')", folder=tmp_path, path=path)
    last = told.stderr.strip().splitlines()[-1]
    assert told.returncode == 1 and last.startswith(f"ImportError: {said}")
    command = python("-m", "cargolab", "list", folder=tmp_path, path=path)
    assert command.returncode == 2 and command.stderr.startswith(f"cargolab: {said}")
    assert command.stderr.count("\n") == 1 and command.stdout == ""


def test_a_users_own_presets_hide_nothing(tmp_path):
    (tmp_path / "presets").mkdir()
    (tmp_path / "presets" / "mine.toml").write_text("title = 'mine'\n")
    (tmp_path / "presets.py").write_text("x = 1\n")
    told = python("-m", "cargolab", "list", folder=tmp_path)
    assert told.returncode == 0 and "tilting/quick" in told.stdout
