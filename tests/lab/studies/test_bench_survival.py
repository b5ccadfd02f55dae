"""A quick share of what `cargolab bench survival` tries, and that it counts right."""

import os
import platform
import subprocess
import sys
from functools import partial
from pathlib import Path

import pytest
from click.testing import CliRunner

from lab.cli import main
from lab.studies.bench import survival
from lab.studies.bench.survival import kills
from lab.studies.bench.survival.child import Ended, begin, call
from lab.studies.bench.survival.straits import NO_LOCKS
from lab.studies.bench.survival.tally import Tally

RECORD = """
import sys
from tests.oracles.synthetic import recorder, sample
from lab.recording import Recorder, open_recording

with recorder(sys.argv[1]) as run:
    run.sample(sample(0.0))
with Recorder(sys.argv[1], samples=1) as run:
    run.sample(sample(1.0))
    run.flush()
with open_recording(sys.argv[1]) as recording:
    print(recording.status, len(recording.series["time"]))
"""

NO_FIGURES = """
import sys
from types import SimpleNamespace
sys.modules["lab.report.plots"] = SimpleNamespace(write_plots=lambda *_: {})
"""

filters = pytest.mark.skipif(
    sys.platform != "linux" or platform.machine() not in ("x86_64", "aarch64"), reason="needs Linux's filters of calls"
)


@filters
def test_recordings_work_where_files_cannot_be_locked(tmp_path):
    line = [sys.executable, "-c", NO_LOCKS + RECORD, tmp_path / "run"]
    paths = os.environ | {"PYTHONPATH": str(Path(__file__).parents[3])}
    done = subprocess.run(line, env=paths, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (0, "complete 2\n"), done.stderr


@pytest.mark.skipif(sys.platform == "win32", reason="kills as POSIX has them")
def test_runs_killed_at_random_times_give_the_same_results(tmp_path, monkeypatch):
    """Without figures, which take as long as the rest of such a run."""
    for act in (begin, call):
        monkeypatch.setattr(kills, act.__name__, partial(act, before=NO_FIGURES))
    monkeypatch.setattr(kills, "ANEW", (*kills.ANEW, "--set", "contact.tangential=none"))  # compiles faster
    tally = kills.run(tmp_path, 2)
    assert tally.tried >= 1 and tally.failed == [], list(tally.lines())


@pytest.mark.slow
def test_all_fast_cases_pass(tmp_path):
    assert survival.run_cases([], tmp_path, fast=True)


def test_failures_are_counted_and_reported(tmp_path, monkeypatch):
    def odd(_: Path, blows: int) -> Tally:
        tally = Tally("odd numbers")
        for number in range(blows):
            tally.count(number % 2 == 1, "odd", f"{number} is even")
        return tally

    monkeypatch.setattr(survival, "CASES", {"odd": odd})
    done = CliRunner().invoke(main, ["bench", "survival", "--kills", "3", "--out", str(tmp_path)])
    assert done.exit_code == 1
    assert done.stdout.splitlines() == ["odd: 3 tried: 2 FAILED, 1 odd", "odd: 0 is even", "odd: 2 is even"]
    assert "| odd | odd numbers | 3 | 2 FAILED, 1 odd |" in (tmp_path / "survival.md").read_text()
    monkeypatch.setattr(survival, "CASES", {"odd": None})
    assert not survival.run_cases((), tmp_path, blows=3), "what is kept is not tried again, and has failed all the same"
    assert "there is no case even" in CliRunner().invoke(main, ["bench", "survival", "even"]).stderr


@pytest.mark.parametrize(
    ("code", "said", "fine"),
    [
        (2, "settling …\ncargolab: no room there.\n", True),
        (1, "cargolab: world 0: grain 3 left.\n", True),
        (0, "cargolab: all is well.\n", False),
        (-11, "cargolab: about to break.\n", False),
        (2, "Traceback (most recent call last):\ncargolab: no.\n", False),
        (2, "", False),
    ],
)
def test_sentences_are_recognised(code, said, fine):
    assert Ended(code, said).in_a_sentence == fine
