"""`make same`: equal bits pass, and a sum that is regrouped does not."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from tests.same.__main__ import HERE, difference


def kept(path: Path, **arrays: np.ndarray) -> Path:
    """A file of arrays as a scene leaves it."""
    np.savez(path, **arrays)
    return path


def test_equal_bytes_are_the_same_and_one_bit_is_not(tmp_path):
    place = np.linspace(0.0, 1.0, 12).reshape(4, 3)
    moved = place.copy()
    moved[2, 1] = np.nextafter(moved[2, 1], 1.0)
    base, same = kept(tmp_path / "base.npz", y=place), kept(tmp_path / "same.npz", y=place.copy())
    assert difference(base, same) == ""
    assert difference(base, kept(tmp_path / "moved.npz", y=moved)).startswith("y from row 2 of 4")
    assert difference(kept(tmp_path / "a.npz", y=np.array([0.0])), kept(tmp_path / "b.npz", y=np.array([-0.0])))


def test_what_one_side_lacks_is_not_the_same(tmp_path):
    base = kept(tmp_path / "base.npz", y=np.zeros(3))
    assert "one of the two" in difference(base, kept(tmp_path / "more.npz", y=np.zeros(3), z=np.zeros(3)))
    assert "another shape" in difference(base, kept(tmp_path / "long.npz", y=np.zeros(4)))
    assert "not run by one" in difference(base, tmp_path / "missing.npz")


@pytest.mark.slow
@pytest.mark.skipif(not (HERE / ".git").exists(), reason="needs the repository's history")
@pytest.mark.parametrize(("regroup", "code"), [(False, 0), (True, 1)])
def test_a_regrouped_sum_is_seen(tmp_path, regroup, code):
    """b_y + (φ̈ z + φ̇ (φ̇ y + 2 ż)) is (φ̈ z + φ̇² y) + 2 φ̇ ż but for rounding."""
    copy = tmp_path / "copy"
    subprocess.run(["git", "clone", "--quiet", str(HERE), str(copy)], check=True)
    before = "rise * z + rate * (rate * y + 2.0 * g.now[1][w, i])"
    after = "(rise * z + rate * rate * y) + 2.0 * rate * g.now[1][w, i]"
    file = next(path for path in copy.glob("solvers/**/*.py") if before in path.read_text(encoding="utf-8"))
    text = file.read_text(encoding="utf-8")
    if regroup:
        file.write_text(text.replace(before, after), encoding="utf-8")
    command = [sys.executable, "-m", "tests.same", "HEAD", "haff-werner", "--build", "strict"]
    assert subprocess.run(command, cwd=copy).returncode == code
