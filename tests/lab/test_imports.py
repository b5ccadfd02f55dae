"""What is loaded before a user sees something; it takes seconds, and most of it is needed later or never."""

import subprocess
import sys
from ast import literal_eval
from pathlib import Path

import pytest

from tests.oracles.synthetic import recorder

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


LATE = ("taichi", "pint", "pydantic", "lab.preset.schema", "xarray", "matplotlib")
REFUSED = {
    "unknown key": ["run", "tilting/quick", "--set", "grains.diamter=3 mm"],
    "unit": ["explain", "tilting/quick", "--set", "grains.diameter=3 kg"],
    "point of a sweep": ["sweep", "tilting/quick", "--set", "run.sed=1,2"],
    "file of a preset": ["stability", "absent.toml"],
    "folder of a run": ["resume", "absent"],
    "recording": ["render", "absent.h5"],
    "offsets": ["hull", "absent.csv"],
}
CURRENT = "from lab.preset.kept import read\nread.is_current = lambda: True  # also while the code is being changed\n"


@pytest.mark.parametrize("what", REFUSED)
def test_what_is_refused_loads_neither_taichi_nor_the_schema(what):
    assert loaded_by(CURRENT + CALLED.format(words=REFUSED[what]), LATE) == []


def test_python_refuses_and_opens_recordings_without_taichi_and_the_schema(tmp_path):
    recorder(tmp_path).close("complete")
    refused = "import cargolab\ntry: cargolab.run('tilting/quick', grains__diamter='3 mm')\nexcept Exception: pass\n"
    opened = f"with cargolab.open({str(tmp_path)!r}) as run: run.series['time'], run.frames['position']\n"
    assert loaded_by(CURRENT + refused + opened, LATE) == []


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


def test_taichi_says_nothing_where_a_notebook_has_put_its_own_output():
    """A kernel's sys.stdout is not the one that Python began with, which Taichi tells in a message of its own."""
    heard = "import io, sys; sys.stdout = said = io.StringIO(); import solvers, taichi"
    code = f"{heard}; sys.__stdout__.write(said.getvalue())"
    root = Path(__file__).parents[2]
    done = subprocess.run([sys.executable, "-c", code], cwd=root, capture_output=True, text=True, check=True)
    assert done.stdout + done.stderr == ""
