"""A release: the wheel has what the lab looks for, and the files that make, try and pack it name what there is."""

import re
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
import yaml

from lab.base import data
from tests.test_house import modules

ROOT = Path(__file__).parents[1]
POSTERS = sorted((ROOT / data.GALLERY).glob("*-*.webp"))
WORKFLOWS = sorted((ROOT / ".github" / "workflows").glob("*.yml"))
MOST_BYTES = 8_000_000  # of the wheel
IN_WHEEL = "cargolab", "lab", "solvers", "presets", "cargo_shift_lab"


def made(folder: Path, uv: str = "") -> subprocess.CompletedProcess:
    """What `make .venv/bin/pip` says and does where python3 is of a version that Taichi has no wheels for."""
    tools = {"python3": "exit 1", "rm": f'exec {shutil.which("rm")} "$@"', **({"uv": uv} if uv else {})}
    for name, text in tools.items():
        path = folder / name
        path.write_text(f"#!/bin/sh\n{text}\n", encoding="utf-8")
        path.chmod(0o755)
    make = shutil.which("make") or pytest.skip("no make")
    command = [make, "--no-print-directory", "-f", ROOT / "Makefile", ".venv/bin/pip"]
    env = {"PATH": str(folder)}
    return subprocess.run(command, cwd=folder, env=env, capture_output=True, text=True, check=False)


def test_make_without_a_python_for_taichi_says_the_remedy(tmp_path):
    ran = made(tmp_path)
    assert ran.returncode and "install uv" in ran.stdout and "PYTHON=" in ran.stdout
    assert len(ran.stdout.splitlines()) == 1


def test_make_has_uv_get_a_python(tmp_path):
    ran = made(tmp_path, 'echo "$@" > asked')
    assert not ran.returncode and not ran.stdout
    assert (tmp_path / "asked").read_text() == "venv --quiet --seed --python 3.13 .venv\n"


def test_a_uv_that_gets_none_leaves_nothing_behind_and_the_remedy(tmp_path):
    ran = made(tmp_path, "/bin/mkdir .venv; exit 2")
    assert ran.returncode and "uv could not" in ran.stdout and "PYTHON=" in ran.stdout
    assert not (tmp_path / ".venv").exists()


@pytest.mark.parametrize("path", WORKFLOWS, ids=[path.stem for path in WORKFLOWS])
def test_a_workflow_may_only_read_and_runs_what_make_has(path):
    told = yaml.safe_load(path.read_text(encoding="utf-8"))
    assert told["permissions"] == {"contents": "read"} and "secrets." not in path.read_text(encoding="utf-8")
    steps = [step for job in told["jobs"].values() for step in job["steps"]]
    targets = re.findall(r"^([\w-]+):", (ROOT / "Makefile").read_text(encoding="utf-8"), re.MULTILINE)
    runs = [step["run"].split() for step in steps if "run" in step]
    assert runs and all(words[0] == "make" and words[1] in targets for words in runs)
    assert all(re.fullmatch(r"actions/[\w-]+@v\d+", step["uses"]) for step in steps if "uses" in step)


def test_workflows_try_all_pythons_that_are_supported():
    asked = {path.stem: path.read_text(encoding="utf-8") for path in WORKFLOWS}
    assert set(asked) == {"docs", "tests", "wheel"}
    assert all('python: ["3.11", "3.12", "3.13"]' in asked[name] for name in ("tests", "wheel"))


def test_the_image_takes_what_the_wheel_is_made_of():
    text = (ROOT / "Containerfile").read_text(encoding="utf-8")
    taken = {word for line in re.findall(r"^COPY (?!--)(.+) \S+$", text, re.MULTILINE) for word in line.split()}
    assert all((ROOT / word).exists() for word in taken)
    assert taken >= {"pyproject.toml", "setup.py", "README.md", "LICENSE", *IN_WHEEL[:4], str(data.GALLERY)}
    assert re.search(r"^USER [1-9]\d*$", text, re.MULTILINE)


@pytest.mark.slow
def test_a_wheel_has_all_modules_all_presets_and_all_posters(tmp_path):
    source, out = tmp_path / "source", tmp_path / "dist"
    kept = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    for name in filter(None, kept.split("\0")):
        if (ROOT / name).exists():
            (source / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, source / name)
    build = sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps", "--wheel-dir", out, source
    subprocess.run(build, check=True, capture_output=True)
    (wheel,) = out.glob("*.whl")
    assert wheel.stat().st_size < MOST_BYTES
    held = set(zipfile.ZipFile(wheel).namelist())
    paths = {path.relative_to(ROOT).as_posix() for name, path in modules().items() if name.split(".")[0] in IN_WHEEL}
    presets = {path.relative_to(ROOT).as_posix() for path in (ROOT / "presets").rglob("*.toml")}
    assert (paths | presets | {f"presets/posters/{path.name}" for path in POSTERS}) - held == set()
    assert {re.split(r"[/-]", name)[0] for name in held} == set(IN_WHEEL)
