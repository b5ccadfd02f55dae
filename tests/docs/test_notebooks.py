"""The notebooks: small, their outputs kept and free of a machine's traces, their code on names that stay; each runs."""

import ast
import importlib.util
import json
import os
import re
import sys
from pathlib import Path

import pytest

import cargolab
from tests.docs.test_cookbook import NOT_OURS, OF_LAWS, imported, names_of_the_lab

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "docs" / "notebooks"
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))
NAMES = {"angle_of_repose", "hopper", "sloshing_resonance", "barge_with_cargo", "own_grain", "own_law"}
MOST_BYTES = 1_500_000  # of the folder
TOOLS = "nbclient", "nbformat", "ipykernel"
MISSING = [name for name in TOOLS if importlib.util.find_spec(name) is None]
MACHINE = re.compile(r"/(?:tmp|home|root|work|Users|var|mnt|usr)/|\b20\d\d-\d\d-\d\d\b")
LINK = re.compile(r"\]\(([^):\s#]+)")


def cells(path: Path, kind: str) -> list[dict]:
    """The cells of a kind, "code" or "markdown", of a notebook."""
    return [cell for cell in json.loads(path.read_text(encoding="utf-8"))["cells"] if cell["cell_type"] == kind]


def source(path: Path) -> str:
    """All code of a notebook."""
    return "\n".join("".join(cell["source"]) for cell in cells(path, "code"))


def said(output: dict) -> str:
    """The text of an output."""
    data = output.get("data", {})
    shown = {kind: "".join(text) for kind, text in data.items() if not kind.startswith("image/")}
    return "".join([*output.get("text", []), *shown.values()])


def test_there_are_six_and_they_are_small():
    assert {path.stem for path in NOTEBOOKS} == NAMES
    assert sum(path.stat().st_size for path in NOTEBOOKS) < MOST_BYTES
    page = (FOLDER / "index.md").read_text(encoding="utf-8")
    assert [name for name in NAMES if f"\n{name}\n" not in page or f"]({name}.ipynb)" not in page] == []


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_uses_what_stays(path):
    tree = ast.parse(source(path))
    ours = {name for name in imported(tree) if name.split(".")[0] in NOT_OURS}
    used = names_of_the_lab(tree)
    assert ours == OF_LAWS.get(path.stem, set()) and used and used <= set(cargolab.__all__)


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_is_kept_as_it_ran(path):
    """Every cell ran, in order and once; a picture and a number with its error are there, and no trace of a machine."""
    code = cells(path, "code")
    assert [cell["execution_count"] for cell in code] == list(range(1, len(code) + 1))
    outputs = [output for cell in code for output in cell["outputs"]]
    texts = [said(output) for output in outputs]
    assert {output["output_type"] for output in outputs} <= {"stream", "display_data", "execute_result"}
    assert [output for output in outputs if output.get("name") == "stderr"] == []
    assert [text for text in texts if MACHINE.search(text) or "progress of a run" in text] == []
    assert any("image/png" in output.get("data", {}) for output in outputs)
    assert any("±" in text or "too low" in text for text in texts)


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_teaches(path):
    """It asks a question, has a formula, says what it is not, ends with an exercise; its links lead on."""
    text = "\n".join("".join(cell["source"]) for cell in cells(path, "markdown"))
    assert text.startswith("# ") and "?" in text.splitlines()[0]
    assert "$$" in text and "## What this is not" in text and "**You learn**" in text
    assert text.rpartition("\n## ")[2].startswith("Exercise\n")
    assert [link for link in LINK.findall(text) if not (FOLDER / link).exists()] == []


@pytest.mark.slow
@pytest.mark.skipif(bool(MISSING), reason=f"{', '.join(MISSING)} not installed: pip install -e '.[notebooks]'")
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs_in_a_kernel_and_shows_as_much_as_is_kept(path, monkeypatch):
    """Numbers may differ in their last digits from processor to processor, so kinds of outputs are compared."""
    monkeypatch.syspath_prepend(str(FOLDER))
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([str(ROOT), *filter(None, sys.path)]))
    from execute import executed

    kept = [[sorted(output.get("data", {})) for output in cell["outputs"]] for cell in cells(path, "code")]
    again = [cell for cell in executed(path).cells if cell.cell_type == "code"]
    assert [[sorted(output.get("data", {})) for output in cell.outputs] for cell in again] == kept
