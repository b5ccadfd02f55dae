"""The recipes of docs/extending.md, put into a copy of the lab and run: what they add is used."""

import os
import re
import shutil
import subprocess
import sys
from math import cos, pi, sqrt
from pathlib import Path

import pytest

from solvers.grains.laws.linear_spring import spring_coefficient, spring_stiffness
from solvers.grains.materials import hertz_stiffness

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "extending.md").read_text(encoding="utf-8")
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
RADIUS, DENSITY, GRAVITY = 1.5e-3, 1300.0, 9.81
MASS = 4.0 / 3.0 * pi * RADIUS**3 * DENSITY


@pytest.fixture(scope="module")
def tree(tmp_path_factory):
    """A copy of the lab with all recipes in it."""
    folder = tmp_path_factory.mktemp("tree")
    for package in ("cargolab", "lab", "solvers", "presets"):
        shutil.copytree(ROOT / package, folder / package, ignore=shutil.ignore_patterns("__pycache__"))
    for kind, text in BLOCK.findall(PAGE):
        if kind == "diff":
            for change in re.split(r"^--- ", text, flags=re.MULTILINE)[1:]:
                put_in(folder, *change.split("\n", 1))
        else:
            path = folder / text.splitlines()[0].removeprefix("# ")
            assert not path.exists()
            path.parent.mkdir(exist_ok=True)
            path.write_text(text, encoding="utf-8")
    return folder


def put_in(folder, name, change):
    """Apply the pieces of a change: lines that are there, of which those with − go, and lines with + after these."""
    path = folder / name
    text = path.read_text(encoding="utf-8")
    for piece in change.split("@@\n")[1:]:
        lines = piece.splitlines()
        before = "".join(f"{line[1:]}\n" for line in lines if line[0] in " -")
        after = "".join(f"{line[1:]}\n" for line in lines if line[0] in " +")
        assert text.count(before) == 1, f"{name} has not once: {before}"
        text = text.replace(before, after)
    path.write_text(text, encoding="utf-8")


def numbers(tree, script):
    """What a script of the page prints, by name."""
    env = os.environ | {"PYTHONPATH": str(tree)}
    done = subprocess.run([sys.executable, script], cwd=tree, env=env, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return {name: float(value) for name, value in re.findall(r"^(.+?)(?: \(.*\))?: (.+)$", done.stdout, re.MULTILINE)}


def overlap_at_rest():
    """ξ/R (1) of a grain at rest on the floor under the recipe's law, m g/(k_l R)."""
    text = PAGE[PAGE.index("[tank]") : PAGE.index("```", PAGE.index("[tank]"))]
    asked = {"grains.count": 1, "material.restitution": 0.5, "contact.stiffness_scale": 0.001}
    assert all(str(value) in text for value in asked.values())
    young = 0.001 * 4e9 / (2.0 * (1.0 - 0.3**2))
    spring = spring_stiffness(spring_coefficient(1.0), hertz_stiffness(young, RADIUS), MASS)
    return MASS * GRAVITY / spring / RADIUS


@pytest.mark.slow
def test_a_law_a_motion_a_quantity_a_measure_and_a_preset(tree):
    found = numbers(tree, "run_mine.py")
    assert found["push"] == pytest.approx(0.2 * 0.1 * (0.2 - 0.05), rel=1e-9)
    assert found["overlap at rest"] == pytest.approx(overlap_at_rest(), rel=0.02)
    assert found["mass"] == pytest.approx(MASS, rel=1e-9)
    assert found["mass left"] == pytest.approx(1e3 * MASS, rel=1e-9)
    assert found["figures"] == 1


def test_a_matter(tree):
    """The ball swings about where the spring bears its weight."""
    found = numbers(tree, "run_bob.py")
    mass, stiffness, anchor = 0.01, 10.0, 0.015
    fallen = mass * GRAVITY / stiffness * (1.0 - cos(sqrt(stiffness / mass) * found["time"]))
    error = 1e-5 * mass * GRAVITY / stiffness  # of the leapfrog: 0.01²/24 of ω t times the way
    assert found["height"] == pytest.approx(anchor - fallen, abs=error)
