"""`cargolab doctor` says what is missing and what follows; `cargolab cache` deletes what it is told, nothing else."""

import json
import shutil
from collections import namedtuple

import pytest
from click.testing import CliRunner

from lab.cli import main
from lab.doctor import machine
from lab.doctor.cache import clear, size_of, stores
from lab.doctor.machine import GOOD, MISSING, SLOWER, examine


def verdicts() -> dict[str, str]:
    return {one.what: one.verdict for one in examine()}


def test_every_finding_that_is_not_good_says_what_follows(monkeypatch):
    for one in examine():
        assert one.found and (one.verdict == GOOD or one.follows), one
    told = CliRunner().invoke(main, ["doctor"])
    assert told.exit_code == 0 and len(told.output.splitlines()) == len(examine())
    known = {one["what"]: one for one in json.loads(CliRunner().invoke(main, ["doctor", "--json"]).output)}
    assert known["lab"]["found"].startswith("0.") and set(known["cores"]) == {"what", "found", "verdict", "follows"}


def test_what_is_missing_is_seen(monkeypatch):
    def none() -> str:
        raise RuntimeError("no ffmpeg exe could be found")

    usage = namedtuple("usage", "total used free")
    monkeypatch.setattr("lab.paint.encoder.ffmpeg", none)
    monkeypatch.setattr("solvers.machine.runtime.available_cores", lambda: 1)
    monkeypatch.setattr("solvers.machine.wide.registers", lambda: 0)
    monkeypatch.setattr(machine, "machine_memory", lambda: 2**30)
    monkeypatch.setattr(shutil, "disk_usage", lambda _: usage(1, 1, 2**20))
    monkeypatch.setattr("lab.view.windows.has_display", lambda: False)
    found = verdicts()
    assert [found[name] for name in ("cores", "vectors", "memory", "disk")] == [SLOWER] * 4
    assert found["ffmpeg"] == found["display"] == MISSING
    monkeypatch.setattr(machine, "works", lambda: False)
    assert CliRunner().invoke(main, ["doctor"]).exit_code == 1


@pytest.fixture
def kept(tmp_path, monkeypatch):
    """A cache with something in each store."""
    monkeypatch.setenv("CARGOLAB_CACHE", str(tmp_path / "lab"))
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "user"))
    for store in stores():
        store.folder.mkdir(parents=True)
        (store.folder / "one").write_bytes(bytes(1000))
    (tmp_path / "lab" / "mine.txt").write_text("not of a store")
    return tmp_path


def test_stores_are_shown_and_deleted_by_name(kept):
    shown = CliRunner().invoke(main, ["cache"]).output
    assert all(store.name in shown for store in stores())
    assert clear(["beds"]) == 1000
    assert {store.name: size_of(store.folder) for store in stores()}["beds"] == 0
    assert all(size_of(store.folder) == 1000 for store in stores() if store.name != "beds")
    assert CliRunner().invoke(main, ["cache", "--clear"]).exit_code == 0
    assert all(size_of(store.folder) == 0 for store in stores()) and (kept / "lab" / "mine.txt").exists()


def test_an_unknown_store_deletes_nothing(kept):
    told = CliRunner().invoke(main, ["cache", "--clear", "beds", "bedds"])
    assert told.exit_code != 0 and all(size_of(store.folder) == 1000 for store in stores())
    assert "bedds" in str(told.exception) or "bedds" in told.output
    assert CliRunner().invoke(main, ["cache", "beds"]).exit_code != 0
