"""What is said of a run that goes on, where there is no terminal."""

from time import sleep

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
