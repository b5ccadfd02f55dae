"""Kernels are kept when a command ends, serve scenes of other sizes, and `explain` knows it."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).parents[3]
SMALL = ["grains.depth=10 mm", "motion.tilt.angle=1 deg", "motion.tilt.rate=20 deg/s", "run.repeats=1", "run.threads=1"]


def command(home: Path, what: str, *more: str, changed: tuple[str, ...] = ()) -> str:
    """The output of a command on a small bed, with caches of its own."""
    sets = [word for change in (*SMALL, *changed) for word in ("--set", change)]
    done = subprocess.run(
        [sys.executable, "-m", "cargolab", what, "tilting/quick", *sets, *more],
        cwd=REPOSITORY,
        env=os.environ | {"XDG_CACHE_HOME": str(home / "cache"), "PYTHONPATH": str(REPOSITORY)},
        capture_output=True,
        text=True,
        check=True,
    )
    return done.stdout


@pytest.mark.skipif(os.name != "posix", reason="caches as POSIX has them")
def test_a_run_of_another_size_compiles_nothing(tmp_path):
    def kernels() -> set[str]:
        return {path.name for path in (tmp_path / "cache" / "taichi" / "ticache").glob("*.tic")}

    numbers_alone = "--no-video", "--no-plots", "--quiet", "--out"
    assert "to be compiled" in command(tmp_path, "explain")
    command(tmp_path, "run", *numbers_alone, str(tmp_path / "first"))
    first = kernels()
    assert first
    other = "tank.width=80 mm", "grains.depth=12 mm", "grains.diameter=3.2 mm", "material.friction=0.3"
    command(tmp_path, "run", *numbers_alone, str(tmp_path / "second"), changed=other)
    assert kernels() == first
    assert "kept from an earlier run" in command(tmp_path, "explain", changed=("tank.width=84 mm",))
