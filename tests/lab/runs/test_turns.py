"""Two threads, and a forked child: one sentence each, instead of a failed assertion of Taichi's or a hang."""

import os
import sys
import threading

import pytest

import lab
from lab.base.errors import LabError
from lab.base.turn import in_turn
from solvers.machine import runtime
from solvers.machine.errors import Unavailable


@pytest.mark.parametrize(
    "act",
    [
        lambda folder: lab.run("tilting/quick", folder / "run", video=False, quiet=True),
        lambda folder: lab.sweep("tilting/quick", {"run.seed": "1:2:2"}, folder / "sweep", video=False, quiet=True),
    ],
)
def test_a_second_thread_is_told_in_a_sentence(act, tmp_path):
    begun, end = threading.Event(), threading.Event()

    @in_turn
    def busy():
        begun.set()
        end.wait(60.0)

    other = threading.Thread(target=busy)
    other.start()
    begun.wait(60.0)
    try:
        with pytest.raises(LabError, match="at work in another thread of this process"):
            act(tmp_path)
    finally:
        end.set()
        other.join()
    assert list(tmp_path.iterdir()) == []
    assert in_turn(in_turn(lambda: 7))() == 7  # the first has ended, and a thread may go on within its own turn


@pytest.mark.skipif(sys.platform != "linux", reason="other systems start processes anew")
def test_a_forked_child_is_told_in_a_sentence(tmp_path):
    runtime.initialise(1)
    reading, writing = os.pipe()
    child = os.fork()
    if not child:
        try:
            lab.run("tilting/quick", tmp_path / "run", video=False, quiet=True)
        except Unavailable as error:
            os.write(writing, str(error).encode())
        finally:
            os._exit(0)
    os.close(writing)
    assert os.waitpid(child, 0)[1] == 0
    assert "forked from one in which the lab has computed" in os.read(reading, 1000).decode()
    os.close(reading)
    assert list(tmp_path.iterdir()) == []
