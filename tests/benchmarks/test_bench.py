"""A bench: its studies are kept, done again where named, and told on one page; and the command without them."""

import numpy as np
import pytest
from click.testing import CliRunner
from matplotlib.figure import Figure

from benchmarks.bench import Bench
from lab.base.errors import LabError
from lab.cli import main


def trial(done: list[str]) -> Bench:
    """A bench of two studies that note that they were done."""

    def study(name):
        def add(page, work, fast):
            done.append(name)
            page.section(name)
            page.table(["number"], [[np.float64(1.23456)], [float("nan")]])
            page.figure(name, Figure(), f"Drawn by {name}")

        return add

    return Bench("trial", "A trial", {"one": study("one"), "two": study("two")}, "What it is about.")


def test_studies_are_kept_and_done_again_where_they_are_named(tmp_path, capsys):
    done = []
    bench = trial(done)
    page = bench.run((), tmp_path, fast=True)
    first = page.read_text()
    assert done == ["one", "two"] and "## one" in first and "## two" in first and "What it is about." in first
    assert bench.run((), tmp_path, fast=True).read_text() == first
    assert done == ["one", "two"]
    assert "one: kept from an earlier run" in capsys.readouterr().out
    bench.run(["two"], tmp_path, fast=True)
    assert done == ["one", "two", "two"] and page.read_text() == first, "the other study stays on the page"
    bench.run((), tmp_path, fast=False)
    assert done[3:] == ["one", "two"], "a full study is not a hasty one"


def test_a_page_is_made_again_from_what_is_kept_alone(tmp_path):
    """Also by other code, and where nothing is kept of a study, without it."""
    done = []
    page = trial(done).run(["one"], tmp_path, fast=True)
    text = page.read_text()
    page.unlink()
    trial(done).run((), tmp_path, fast=True, page_only=True)
    assert page.read_text() == text and done == ["one"]


def test_a_study_that_breaks_off_leaves_those_before_it(tmp_path):
    def broken(page, work, fast):
        raise LabError("it broke off.")

    done = []
    studies = dict(trial(done).studies) | {"two": broken}
    with pytest.raises(LabError):
        Bench("trial", "A trial", studies).run((), tmp_path, fast=True)
    assert "## one" in (tmp_path / "trial.md").read_text()
    trial(done).run((), tmp_path, fast=True)
    assert done == ["one", "two"]


def test_a_lab_without_benchmarks_says_where_they_are(tmp_path, monkeypatch):
    monkeypatch.setattr("lab.cli.benches.BENCHMARKS", tmp_path / "benchmarks")
    done = CliRunner().invoke(main, ["bench", "speed", "--out", str(tmp_path)])
    assert done.exit_code == 2 and len(done.stderr.strip().splitlines()) == 1
    assert "clone" in done.stderr and "cargolab bench speed" in done.stderr
