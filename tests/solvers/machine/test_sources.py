"""Loading Taichi: where that fails, one sentence says what is missing."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]


def without_taichi(folder: Path, error: str) -> dict[str, str]:
    """The environment of a process that finds a Taichi in this folder which fails to load with an error."""
    (folder / "taichi").mkdir()
    (folder / "taichi" / "__init__.py").write_text(f"raise ImportError({error!r})\n", encoding="utf-8")
    return os.environ | {"PYTHONPATH": f"{folder}{os.pathsep}{ROOT}"}


@pytest.mark.parametrize(
    ("error", "remedy"),
    [
        ("libX11.so.6: cannot open shared object file: No such file or directory", "sudo apt install libx11-6."),
        ("No module named 'taichi._lib.core'", "install cargo-shift-lab anew."),
    ],
)
def test_a_machine_on_which_taichi_cannot_be_loaded_is_told_the_remedy(error, remedy, tmp_path):
    env = without_taichi(tmp_path, error)
    calls = ["-m", "cargolab", "doctor"], ["-c", "import cargolab; cargolab.run('tilting/quick')"]
    for call in calls:
        command = sys.executable, *call
        ran = subprocess.run(command, cwd=tmp_path, env=env, capture_output=True, text=True, check=False)
        said = ran.stderr.splitlines()[-1].split(": ", 1)[1]
        assert ran.returncode and said.startswith(f"Taichi cannot be loaded ({error}): ") and said.endswith(remedy)
    assert "NotLoaded" in ran.stderr


def test_a_recording_is_not_called_damaged_where_taichi_cannot_be_loaded(tmp_path):
    env = without_taichi(tmp_path, "libX11.so.6")
    recording = ROOT / "tests" / "data" / "recording-format-2.h5"
    command = sys.executable, "-m", "cargolab", "poster", recording, "--out", tmp_path / "poster.png"
    ran = subprocess.run(command, cwd=tmp_path, env=env, capture_output=True, text=True, check=False)
    assert ran.returncode == 2 and ran.stderr.startswith("cargolab: Taichi cannot be loaded (libX11.so.6): ")
