"""Taichi runs without a writable home folder; a stale lock of a killed process is removed."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).parents[3]
SIMULATE = """
import numpy as np
from solvers.machine import kernel_cache, runtime
from solvers.machine.state import Axis, State

runtime.initialise(1)
arrays = State()
(field,) = arrays.reals((Axis("row", 3), Axis("column", 4)), "numbers")
arrays.finish()
field.fill(2.5)
print(field.to_numpy().sum())
print(kernel_cache.lacking())
"""


def simulate(**environment: str | None) -> list[str]:
    """The output of a process that uses Taichi; it must exit with code 0."""
    bare = {name: value for name, value in os.environ.items() if name not in ("HOME", "XDG_CACHE_HOME")}
    given = {name: value for name, value in environment.items() if value is not None}
    done = subprocess.run(
        [sys.executable, "-c", SIMULATE],
        cwd=REPOSITORY,
        env=bare | given,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0 and done.stderr == "", f"{done.returncode}: {done.stderr}"
    total, sentence = done.stdout.splitlines()
    assert float(total) == 30.0
    return sentence


@pytest.mark.skipif(os.name != "posix", reason="homes as POSIX has them")
@pytest.mark.parametrize("home", [None, "", "/proc/nobody", "file"])
def test_without_a_writable_home_it_runs_and_says_what_is_slower(tmp_path, home):
    if home == "file":
        home = str(tmp_path / "file")
        (tmp_path / "file").touch()
    (tmp_path / "temporary").mkdir()
    sentence = simulate(HOME=home, TMPDIR=str(tmp_path / "temporary"))
    assert "kernels are compiled anew in every run" in sentence and "XDG_CACHE_HOME" in sentence
    assert sentence.startswith(f"{home}/.cache/taichi/ticache cannot be written" if home else "HOME is not set")
    assert list((tmp_path / "temporary").iterdir()) == []


@pytest.mark.skipif(os.name != "posix", reason="homes as POSIX has them")
def test_with_a_home_kernels_are_kept_there(tmp_path):
    assert simulate(HOME=str(tmp_path)) == ""
    assert list(tmp_path.glob(".cache/taichi/ticache/*.tic"))


@pytest.mark.skipif(os.name != "posix", reason="homes as POSIX has them")
def test_a_stale_lock_of_a_killed_process_does_not_disable_the_kernel_cache(tmp_path):
    lock = tmp_path / "taichi" / "ticache" / "ticache.lock"
    lock.parent.mkdir(parents=True)
    lock.touch()
    os.utime(lock, (0.0, 0.0))
    assert simulate(XDG_CACHE_HOME=str(tmp_path)) == ""
    assert not lock.exists() and list(lock.parent.glob("*.tic"))
