"""Where a run's time goes: each second is counted once, in the part that it was spent on."""

from types import SimpleNamespace

import pytest

from lab.base import costs
from lab.base.costs import PARTS, Costs, importing, in_words


@pytest.fixture
def clock(monkeypatch):
    """A clock that stands, and the compiler's account of the time that it took."""
    now = SimpleNamespace(time=100.0, compiled=0.0)
    monkeypatch.setattr(costs.time, "perf_counter", lambda: now.time)
    monkeypatch.setattr(costs.compiling, "seconds", lambda: now.compiled)
    monkeypatch.setattr(costs, "_importing", 0.0)
    return now


def spend(clock, seconds, compiling=0.0):
    clock.time += seconds
    clock.compiled += compiling


def test_the_seven_parts_and_the_rest_are_the_whole(clock):
    with importing():
        spend(clock, 2.0)
    spend(clock, 50.0)  # of the process before this run
    with importing():
        spend(clock, 1.0)
    told = Costs()
    spend(clock, 0.5)  # of no part
    for part, seconds, compiled in (
        ("settle", 10.0, 4.0),
        ("run", 20.0, 1.0),
        ("measures", 1.5, 0.0),
        ("plots", 3.0, 0.0),
        ("video", 5.0, 0.0),
    ):
        with told.of(part):
            spend(clock, seconds, compiled)
    found = told.told()
    assert {part: found[part] for part in PARTS} == {
        "import": 3.0,
        "compile": 5.0,
        "settle": 6.0,
        "run": 19.0,
        "measures": 1.5,
        "plots": 3.0,
        "video": 5.0,
    }
    assert (found["rest"], found["whole"]) == (0.5, 43.0)
    assert in_words(found).startswith("43.0 s in all: import 3.0 s, compile 5.0 s, settle 6.0 s, run 19.0 s")


def test_imports_are_counted_for_the_first_run_only(clock):
    with importing():
        spend(clock, 2.0)
    assert (Costs().seconds["import"], Costs().seconds["import"]) == (2.0, 0.0)


def test_a_part_that_fails_is_counted(clock):
    told = Costs()
    with pytest.raises(KeyboardInterrupt), told.of("run"):
        spend(clock, 7.0)
        raise KeyboardInterrupt
    assert told.seconds["run"] == 7.0
