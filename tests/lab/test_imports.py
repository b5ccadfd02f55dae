"""What is loaded before a user sees something; it takes seconds, and most of it is needed later or never."""

import subprocess
import sys
from ast import literal_eval
from pathlib import Path

import pytest

SLOW = ("scipy", "matplotlib", "PIL", "imageio_ffmpeg", "xarray", "jinja2", "pint")
CALLED = """
from lab.cli import main
try: main({words})
except SystemExit: pass
"""
# A run that ends with its first message
BEGUN = """
from lab.base.progress import Progress
def say(progress, sentence): raise SystemExit(loaded())
Progress.say = say
from lab.cli import main
main(["run", "tilting/quick", "--no-video", "--out", {out!r}])
"""


def loaded_by(code: str, modules: tuple[str, ...] = SLOW) -> list[str]:
    """Which of some modules a process has loaded once it has run this code."""
    code = (
        f"import sys\ndef loaded(): return str([m for m in {modules} if m in sys.modules])\n{code}\nsys.exit(loaded())"
    )
    root = Path(__file__).parents[2]
    done = subprocess.run([sys.executable, "-c", code], cwd=root, capture_output=True, text=True, check=False)
    return literal_eval(done.stderr.splitlines()[-1])


def test_help_and_list_need_no_slow_imports():
    for words in (["list"], ["run", "--help"]):
        assert loaded_by(CALLED.format(words=words), (*SLOW, "taichi", "numpy")) == []


def test_a_run_begins_without_imports_that_only_its_figures_need():
    assert loaded_by("from lab.runs.runner import run_preset") == []


@pytest.fixture(scope="module")
def explained() -> str:
    """What explains a preset, after it was explained once."""
    code = CALLED.format(words=["explain", "tilting/quick"])
    loaded_by(code)
    return code


@pytest.mark.usefixtures("explained")
def test_the_first_message_of_a_run_waits_for_no_slow_imports_once_its_collisions_are_known(tmp_path):
    assert loaded_by(BEGUN.format(out=str(tmp_path / "quick"))) == []


def test_a_preset_is_explained_without_slow_imports_once_its_collisions_are_known(explained):
    assert loaded_by(explained) == []


def test_taichi_is_loaded_without_a_search_through_all_modules_for_each_of_its_functions():
    """It asks for its 94 functions, Python's `inspect` up to three times for each."""
    counted = """
import inspect
search, calls = inspect.getmodule, []
inspect.getmodule = lambda *given: (calls.append(1), search(*given))[1]
import solvers.machine.runtime
sys.exit(str([len(calls)]))
"""
    assert loaded_by(counted)[0] < 30
    assert loaded_by("import inspect, solvers.machine.runtime\nsys.exit(str([inspect.getframeinfo.__name__]))") == [
        "getframeinfo"
    ]
