"""The cookbook: each script says what it answers, uses what stays, is on its page, and runs."""

import ast
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

import cargolab

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "docs" / "cookbook"
SCRIPTS = sorted(FOLDER.glob("*.py"))
MOST_LINES = 40
OF_LAWS = {"own_law": {"solvers.grains.laws.hertz"}}  # a law is written against the solver
NOT_OURS = {"lab", "solvers", "benchmarks"}
SAYS = {  # a few words of what each prints
    "angle_of_repose": "mean ± standard deviation of the beds: ",
    "flooding": "duct of 0.8 m: largest heel ",
    "friction_from_tilt": "bulk.friction: 0.4",
    "own_grain": "lens: slides at ",
    "own_law": "restitution: 0.59",
    "own_measure": "run-up on the lower wall: ",
    "pressure_at_a_point": "at rest: 6.17 mbar",
    "righting_lever": "30 deg: GZ  0.851 m",
    "shifting_cargo": "open in a browser: ",
    "sloshing_response": "first frequency by linear theory: 1.131 Hz",
    "stop_and_go_back": "with a friction of 0.5 from ",
    "stress_under_a_bed": "across/upright",
}
QUICK = {"righting_lever"}  # it compiles nothing and takes seconds


def imported(tree: ast.Module) -> Iterator[str]:
    """The modules that a script imports."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield node.module


def names_of_the_lab(tree: ast.Module) -> set[str]:
    """What a script takes from cargolab."""
    nodes = [node for node in ast.walk(tree) if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name)]
    return {node.attr for node in nodes if node.value.id == "cargolab"}


def test_there_are_twelve_and_each_is_on_the_page():
    page = (FOLDER / "index.md").read_text(encoding="utf-8")
    assert len(SCRIPTS) == 12 and {path.stem for path in SCRIPTS} == set(SAYS)
    assert [path.stem for path in SCRIPTS if f"```{{literalinclude}} {path.name}\n" not in page] == []
    assert [name for name, said in SAYS.items() if said not in page] == []


@pytest.mark.parametrize("path", SCRIPTS, ids=lambda path: path.stem)
def test_a_script_is_short_says_what_it_answers_and_uses_what_stays(path):
    text = path.read_text(encoding="utf-8")
    tree = ast.parse(text)
    told = ast.get_docstring(tree)
    assert len(text.splitlines()) <= MOST_LINES
    assert "?" in told.splitlines()[0] and "prints" in told and "Takes" in told
    ours = {name for name in imported(tree) if name.split(".")[0] in NOT_OURS}
    assert ours == OF_LAWS.get(path.stem, set())
    used = names_of_the_lab(tree)
    assert used and used <= set(cargolab.__all__)


@pytest.mark.parametrize(
    "path",
    [pytest.param(path, marks=() if path.stem in QUICK else pytest.mark.slow) for path in SCRIPTS],
    ids=lambda path: path.stem,
)
def test_a_script_runs_from_anywhere_and_prints_what_its_page_shows(path, tmp_path):
    env = os.environ | {"PYTHONPATH": str(ROOT), "TMPDIR": str(tmp_path)}
    done = subprocess.run([sys.executable, path], cwd=tmp_path, env=env, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert SAYS[path.stem] in done.stdout
    page = (FOLDER / "index.md").read_text(encoding="utf-8")
    assert path.stem not in QUICK or f"```text\n{done.stdout}```" in page  # formulas give the same anywhere
    assert not (tmp_path / "renders").exists()
