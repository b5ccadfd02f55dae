"""`make same BASE=REVISION`: whether this tree still gives the base's numbers, bit for bit, on this machine.

Each scene is run by the base and by this tree side by side, in the normal build and with fast-math off, and everything
that was recorded is compared as bytes. Nothing is stored: processors round differently.
"""

import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from tests.same.scenes import SCENES

HERE = Path(__file__).resolve().parents[2]


def unpack(revision: str, folder: Path) -> Path:
    """The tree of a revision, in a folder of its own."""
    archive = subprocess.run(["git", "-C", str(HERE), "archive", revision], capture_output=True)
    if archive.returncode:
        sys.exit(f"same: {archive.stderr.decode().strip()}; give a revision, e.g. make same BASE=HEAD~1")
    folder.mkdir()
    subprocess.run(["tar", "-x", "-C", str(folder)], input=archive.stdout, check=True)
    return folder


def start(tree: Path, folder: Path, options: list[str]) -> subprocess.Popen:
    """A process that runs scenes by the lab of a tree, with a cache of beds of its own."""
    folder.mkdir(parents=True)
    own = {"TREE": str(tree), "PYTHONPATH": str(tree), "CARGOLAB_CACHE": str(folder / "cache")}
    command = [sys.executable, str(Path(__file__).with_name("play.py")), str(folder), *options]
    return subprocess.Popen(command, env={**os.environ, **own}, stdout=subprocess.DEVNULL)


def difference(base: Path, here: Path) -> str:
    """What differs between two files of arrays, the earliest first; empty where all bytes are equal."""
    if not base.exists() or not here.exists():
        return "was not run by " + ("both" if not base.exists() and not here.exists() else "one of the two")
    old, new = np.load(base), np.load(here)
    unlike = []  # (row, what)
    for name in set(old) | set(new):
        if name not in old or name not in new:
            unlike.append((-1, f"{name} is in one of the two"))
        elif old[name].shape != new[name].shape or old[name].dtype != new[name].dtype:
            unlike.append((-1, f"{name} has another shape or kind"))
        elif old[name].tobytes() != new[name].tobytes():
            unlike.append(apart(name, old[name], new[name]))
    more = f"; and {len(unlike) - 3} more" if len(unlike) > 3 else ""
    return "; ".join(what for _, what in sorted(unlike)[:3]) + more


def apart(name: str, old: np.ndarray, new: np.ndarray) -> tuple[int, str]:
    """The first row in which two arrays differ, and by how much they do at most, in words."""
    row = [a.tobytes() != b.tobytes() for a, b in zip(old, new, strict=True)].index(True)
    most = np.nanmax(np.abs(old.astype(float) - new.astype(float)))
    return row, f"{name} from row {row} of {len(old)}, by up to {most:.2g}"


def compare(base: Path, out: Path, build: str, wanted: list[str]) -> int:
    """Run the scenes in one build by both trees side by side, and say of each what differs; returns how many do."""
    options = [*(["--strict"] if build == "strict" else []), *wanted]
    runs = [start(tree, out / build / side, options) for tree, side in ((base, "base"), (HERE, "here"))]
    for run in runs:
        run.wait()
    failed = 0
    for name in wanted or SCENES:
        found = difference(*(out / build / side / f"{name}.npz" for side in ("base", "here")))
        failed += bool(found)
        print(f"{build:7s} {name:15s} {found or 'same bits'}", flush=True)
    return failed


def main() -> None:
    """Compare the two trees; exits with 1 if anything differs."""
    parser = argparse.ArgumentParser(prog="make same", description=__doc__)
    parser.add_argument("base", help="a revision of this repository")
    parser.add_argument("scenes", nargs="*", metavar="SCENE", help=f"some of {', '.join(SCENES)}; default: all")
    parser.add_argument("--build", choices=["normal", "strict"], action="append", help="default: both")
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="same-") as home:
        base = unpack(asked.base, Path(home) / "base")
        builds = asked.build or ["normal", "strict"]
        failed = sum(compare(base, Path(home) / "out", build, asked.scenes) for build in builds)
    print(f"{failed} of {len(builds) * len(asked.scenes or SCENES)} scenes differ from {asked.base}")
    sys.exit(bool(failed))


if __name__ == "__main__":
    main()
