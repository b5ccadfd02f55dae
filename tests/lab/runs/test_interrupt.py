"""Signals that ask a process to end: the recording is closed and summed up, and the exit code says which it was."""

import json
import os
import signal
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path

import pytest

from lab.base.errors import LabError
from lab.recording import open_recording
from lab.view.worker import begin

pytestmark = pytest.mark.skipif(os.name != "posix", reason="signals as POSIX has them")

ROOT = Path(__file__).parents[3]
TANK = """
format = 3
title = "An empty tank"
tank = { width = "0.3 m", height = "0.2 m", lid = false }
motion.sway = { amplitude = "10 mm", frequency = "1 Hz" }
run = { duration = "9000 s", repeats = 1, threads = 1 }
record.checkpoint_every = "50 ms"
"""
COMMAND = """
import sys
from types import SimpleNamespace
from lab.cli import main

sys.modules["lab.report.plots"] = SimpleNamespace(write_plots=lambda *_: {})  # figures take seconds
main(sys.argv[1:], prog_name="cargolab")
"""
STUBBORN = """
import time
from lab.base.interrupt import handling_signals

with handling_signals():
    try:
        print("ready", flush=True)
        time.sleep(60)
    except KeyboardInterrupt:
        print("asked", flush=True)
        time.sleep(60)
"""

WORKERS = """
import sys
from pathlib import Path
from lab.base.errors import LabError
from lab.base.interrupt import exit_code, handling_signals
from lab.base.progress import Progress
from lab.studies.reproduce.runs import Batch
from lab.studies.reproduce.workers import carry_out_all

batches = {Path(sys.argv[1]) / name: Batch(sys.argv[2]) for name in ("a", "b")}
try:
    with handling_signals():
        list(carry_out_all(batches, Progress(quiet=True)))
except KeyboardInterrupt:
    sys.exit(exit_code())
except LabError as error:
    sys.exit(str(error))
"""


def hear_all() -> None:
    """Signals as they are at first: who runs the tests by nohup, or in the background, has some of them ignored."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_DFL)


@pytest.fixture
def tank(tmp_path) -> Path:
    """A preset that goes on for long and compiles fast."""
    path = tmp_path / "tank.toml"
    path.write_text(TANK)
    return path


def endless_run(folder: Path, *preset: object, **options) -> subprocess.Popen:
    """A run of the command line that goes on until it is ended, with some rows recorded."""
    line = [sys.executable, "-c", COMMAND, "run", *preset, "--no-video", "--out", folder]
    usual = {"stderr": subprocess.PIPE, "preexec_fn": hear_all}
    run = subprocess.Popen(line, cwd=ROOT, text=True, **(usual | options))
    wait_for_rows(folder, 1, run)
    return run


def wait_for_rows(folder: Path, count: int, run: subprocess.Popen) -> int:
    while run.poll() is None:
        try:
            with open_recording(folder) as recording:
                if (rows := len(recording.series["time"])) >= count:
                    return rows
        except LabError:  # not there yet
            pass
        time.sleep(0.1)
    raise AssertionError(run.stderr and run.stderr.read())


def ignore_hangups() -> None:
    signal.signal(signal.SIGHUP, signal.SIG_IGN)


def assert_summed_up(folder: Path) -> None:
    with open_recording(folder) as recording:
        assert recording.status == "stopped: interrupted by the user"
        assert len(recording.series["time"]) > 0
    assert json.loads((folder / "summary.json").read_text())["status"] == "stopped: interrupted by the user"
    assert (folder / "checkpoint.npz").exists()


def test_sigterm_ends_a_run_as_ctrl_c_does_and_nohup_lets_it_continue(tank, tmp_path):
    run = endless_run(tmp_path / "run", tank, preexec_fn=ignore_hangups)
    run.send_signal(signal.SIGHUP)
    rows = wait_for_rows(tmp_path / "run", 1, run)
    wait_for_rows(tmp_path / "run", rows + 1, run)
    run.send_signal(signal.SIGTERM)
    _, said = run.communicate(timeout=60)
    assert run.returncode == 143, said
    assert said.splitlines()[-1].endswith(f"continue with: cargolab resume {tmp_path / 'run'}")
    assert_summed_up(tmp_path / "run")


def test_a_run_whose_terminal_is_closed_ends_cleanly(tank, tmp_path):
    import pty

    master, terminal = pty.openpty()
    run = endless_run(tmp_path / "run", tank, stdin=terminal, stdout=terminal, stderr=terminal)
    os.close(terminal)
    os.close(master)
    run.send_signal(signal.SIGHUP)  # as the system does for who has this terminal for their own
    assert run.wait(60) == 129
    assert_summed_up(tmp_path / "run")


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_second_signal_ends_at_once(number):
    line = [sys.executable, "-c", STUBBORN]
    process = subprocess.Popen(line, cwd=ROOT, stdout=subprocess.PIPE, text=True, preexec_fn=hear_all)
    assert process.stdout.readline() == "ready\n"
    process.send_signal(number)
    assert process.stdout.readline() == "asked\n"
    process.send_signal(number)
    assert process.wait(10) == -number


@pytest.fixture
def workers(tank, tmp_path):
    """A process that has two workers carry out a batch each."""
    if len(os.sched_getaffinity(0)) < 2:
        pytest.skip("needs two cores")
    line = [sys.executable, "-c", WORKERS, tmp_path, tank]
    process = subprocess.Popen(line, cwd=ROOT, stderr=subprocess.PIPE, text=True, preexec_fn=hear_all)
    for name in ("a", "b"):
        wait_for_rows(tmp_path / name, 1, process)
    return process


@pytest.mark.slow  # of one process it is above
@pytest.mark.parametrize("at_once", [False, True])
def test_sigterm_to_a_process_with_workers_ends_them_all_cleanly(workers, tmp_path, at_once):
    """Sent to the process alone, or to all of them, as a batch system does."""
    for one in [*(workers_of(workers) if at_once else []), workers.pid]:
        os.kill(one, signal.SIGTERM)
    _, said = workers.communicate(timeout=60)
    assert workers.returncode == 143 and said == ""
    for name in ("a", "b"):
        assert_summed_up(tmp_path / name)


@pytest.mark.slow  # a killed painter is reported in `tests/lab/paint/test_many.py`
def test_a_killed_worker_is_reported_in_one_sentence(workers, tmp_path):
    os.kill(workers_of(workers)[0], signal.SIGKILL)
    _, said = workers.communicate(timeout=60)
    assert workers.returncode == 1
    assert said.startswith("a process that ran a batch was ended from outside") and said.count("\n") == 1


def test_sigterm_to_a_live_experiment_closes_its_recording(tank, tmp_path):
    experiment, pipe = begin(str(tank), {}, tmp_path / "live")
    word = ""
    while word != "ready":
        assert pipe.poll(60)
        word = pipe.recv()[0]
    pipe.send(("go", True))
    for _ in range(3):
        pipe.recv()
    os.kill(experiment.pid, signal.SIGHUP)  # its terminal is closed: the window hears of it
    os.kill(experiment.pid, signal.SIGTERM)
    while experiment.is_alive():  # what it still has to say must not hold it up
        with suppress(EOFError, ConnectionResetError):
            pipe.poll(0.02) and pipe.recv()
    assert experiment.exitcode == 0
    with open_recording(tmp_path / "live") as recording:
        assert recording.status == "stopped: interrupted by the user"
        assert len(recording.series["time"]) > 0


def workers_of(process: subprocess.Popen) -> list[int]:
    """The processes that carry out batches (Linux)."""
    children = Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
    return [int(one) for one in children if b"spawn_main" in Path(f"/proc/{one}/cmdline").read_bytes()]
