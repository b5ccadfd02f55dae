"""What a shell completes: presets, keys, their words, measures; and that a Tab does not wait for the solvers."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from lab.cli.completion import measures
from tests.lab.test_imports import CURRENT, LATE, loaded_by

ROOT = Path(__file__).parents[2]


def completed(*words: str) -> list[str]:
    """What Bash is offered for the last of these words."""
    env = os.environ | {"_CARGOLAB_COMPLETE": "bash_complete", "COMP_CWORD": str(len(words))}
    env["COMP_WORDS"] = " ".join(["cargolab", *words])
    done = subprocess.run([sys.executable, "-m", "cargolab"], cwd=ROOT, env=env, capture_output=True, text=True)
    return [line.partition(",")[2] for line in done.stdout.splitlines()]


@pytest.mark.parametrize(
    ("words", "offered"),
    [
        (("run", "tilting/qu"), {"tilting/quick"}),
        (("run", "tilting/quick", "--set", "contact.tang"), {"contact.tangential="}),
        (("run", "tilting/quick", "--set", "run.accuracy=dr"), {"run.accuracy=draft"}),
        (("run", "tilting/quick", "--set", "run.settle="), {"run.settle=true", "run.settle=false"}),
        (("calibrate", "tilting/quick", "--target", "critical_a"), {"critical_angle="}),
    ],
)
def test_a_shell_completes(words, offered):
    assert set(completed(*words)) == offered


def test_the_measures_that_are_completed_are_those_of_the_lab():
    found = measures()
    assert {"critical_angle", "contact_number", "largest_roll", "capsized_at", "flow_rate"} <= set(found)
    assert len(found) > 80


def test_a_tab_loads_neither_taichi_nor_the_schema():
    asked = "from lab.cli.completion import *\nSetting().shell_complete(None, None, 'run.')\nmeasures()\n"
    assert loaded_by(CURRENT + asked, LATE) == []
