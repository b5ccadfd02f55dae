"""What is said of a run that goes on, where there is no terminal, and in a notebook."""

import sys
import time
from time import sleep
from types import ModuleType, SimpleNamespace

import pytest

from lab.base import progress
from lab.base.progress import COMPILES, EVERY, Progress


def test_a_log_gets_a_line_every_half_minute(monkeypatch, capsys):
    """Of two minutes of a stage, told of every ten seconds: four lines with its share, and none if quiet."""
    now = [1000.0]
    monkeypatch.setattr(progress.time, "monotonic", lambda: now[0])
    for quiet in (True, False):
        with Progress(quiet) as told:
            told.start("settling", 5.0)
            for step in range(1, 13):
                now[0] += 10.0
                told.reach(5.0 * step / 12)
            told.finish()
    lines = capsys.readouterr().err.splitlines()
    assert [line for line in lines if line.startswith("settling")] == [
        "settling …",
        "settling: 25 % after 30 s",
        "settling: 50 % after 60 s",
        "settling: 75 % after 2 min",
        "settling: 100 % after 2 min",
    ]
    assert EVERY == 30.0


def test_a_stage_that_tells_nothing_is_excused(monkeypatch, capsys):
    """By the kernels that it waits for; one that has begun to tell is not."""
    monkeypatch.setattr(progress, "SOON", 0.05)
    for waits in (True, False):
        with Progress(False) as told:
            told.start("settling", 5.0)
            if not waits:
                told.reach(1.0)
            sleep(0.3)
    assert capsys.readouterr().err.splitlines() == ["settling …", f"settling: {COMPILES}", "settling …"]


class Shown:
    """What a notebook shows: its outputs, each as it was written last."""

    def __init__(self):
        self.pages = []

    def display(self, page, display_id):
        assert display_id is True
        self.pages.append([page._repr_html_()])
        return SimpleNamespace(update=lambda again, own=self.pages[-1]: own.append(again._repr_html_()))


@pytest.fixture
def shown(monkeypatch):
    """A stand-in for IPython in the kernel of a notebook."""
    shown = Shown()
    python = ModuleType("IPython")
    python.get_ipython = lambda: SimpleNamespace(kernel=object())
    python.display = ModuleType("IPython.display")
    python.display.display = shown.display
    monkeypatch.setitem(sys.modules, "IPython", python)
    monkeypatch.setitem(sys.modules, "IPython.display", python.display)
    return shown


def test_a_notebook_has_one_output_with_a_bar_a_stage(shown, monkeypatch, capsys):
    now = [1000.0]
    monkeypatch.setattr(time, "monotonic", lambda: now[0])
    with Progress(False) as told:
        told.say("tilting/<b>quick</b>")
        for stage in ("settling", "running"):
            told.start(stage, 5.0)
            for step in range(1, 101):
                now[0] += 0.05
                told.reach(5.0 * step / 100)
            told.finish()
        told.warn("the bed still moves")
    (output,) = shown.pages
    assert 10 < len(output) < 80  # a few a second and not one a step
    assert output[-1].count("<progress") == 1 and 'value="1.000"' in output[-1] and "running" in output[-1]
    assert "settling" in output[10] and "running" not in output[10]
    assert "&lt;b&gt;quick" in output[-1] and "note: the bed still moves" in output[-1]
    assert capsys.readouterr() == ("", "")


def test_a_notebook_shows_nothing_if_quiet_and_python_without_a_kernel_has_lines(shown, capsys):
    with Progress(True) as told:
        told.start("settling", 5.0)
        told.warn("the bed still moves")
    assert shown.pages == [] and told.warnings == ["the bed still moves"]
    sys.modules["IPython"].get_ipython = lambda: SimpleNamespace()  # IPython in a terminal
    with Progress(False) as told:
        told.start("settling", 5.0)
    assert shown.pages == [] and "settling …" in capsys.readouterr().err
