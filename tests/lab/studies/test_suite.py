"""A suite of cases: what fails or breaks is said and stops nothing else, and what is kept is not run again."""

import json
from dataclasses import replace

import numpy as np
import pytest

from lab.base.errors import LabError
from lab.studies.case import Case, Found, Line, Table
from lab.studies.suite import Suite


def suite(cases) -> Suite:
    return Suite("bench trial", "A trial", cases, "What it is about.", {"Section": "What the section is about."})


def told(folder) -> dict[str, dict]:
    """What the file holds of each case."""
    return json.loads((folder / "trial.json").read_text(encoding="utf-8"))


def stub(name: str, value: float, quick: bool = True) -> Case:
    """A case of one line, 1 ± 0.1."""
    line = Line("a quantity", value, 1.0, "by hand", 0.1, "no reason")
    return Case(name, "Section", f"Title of {name}", lambda fast: Found([line]), quick)


def broken(fast: bool) -> Found:
    raise ArithmeticError("what went wrong")


def test_what_fails_or_breaks_is_reported_and_stops_nothing(tmp_path, capsys):
    empty = Case("empty", "Section", "Nothing shown", lambda fast: Found([]))
    cases = (
        stub("off", 1.2),
        Case("breaks", "Section", "Breaks", broken),
        stub("nan", np.nan),
        empty,
        stub("good", 1.05),
    )
    assert not suite(cases).run((), tmp_path, fast=False)
    assert "failed: off, breaks, nan, empty" in capsys.readouterr().out
    page, found = (tmp_path / "trial.md").read_text(encoding="utf-8"), told(tmp_path)
    assert page.count("FAIL |") == 2
    assert "**Failed: off, breaks, nan, empty.**" in page
    assert "ArithmeticError: what went wrong" in page
    assert {name: (one["passed"], one["fault"]) for name, one in found.items()} == {
        "off": (False, ""),
        "breaks": (False, "ArithmeticError: what went wrong"),
        "nan": (False, ""),
        "empty": (False, ""),
        "good": (True, ""),
    }
    assert [[line["passed"] for line in found[name]["lines"]] for name in ("off", "nan", "good")] == [
        [False], [False], [True]
    ]  # fmt: skip
    assert suite(cases).run(("good",), tmp_path, fast=False), "only the named one counts"


def test_what_is_kept_is_not_run_again_unless_named_or_broken(tmp_path, capsys):
    cases = (stub("off", 1.2), Case("breaks", "Section", "Breaks", broken), stub("good", 1.05))
    suite(cases).run((), tmp_path, fast=False)
    page = (tmp_path / "trial.md").read_text(encoding="utf-8")
    run = []
    again = [replace(case, check=lambda fast, name=case.name: run.append(name) or Found([])) for case in cases]
    assert not suite(again).run((), tmp_path, fast=False, page_only=True)
    assert (tmp_path / "trial.md").read_text(encoding="utf-8") == page and not run
    assert not suite(again).run((), tmp_path, fast=False)
    assert run == ["breaks"]
    said = capsys.readouterr().out
    assert "off: FAIL, kept from an earlier run\n" in said and "good: pass, kept from an earlier run\n" in said
    suite(again).run(("good",), tmp_path, fast=False)
    assert run == ["breaks", "good"]


def test_names_are_prefixes_and_unknown_ones_are_answered_with_all():
    asked = suite((stub("fall-far", 1.0), stub("fall-near", 1.0), stub("roll", 1.0, quick=False)))
    assert [case.name for case in asked.select(("fall",), fast=False)] == ["fall-far", "fall-near"]
    assert [case.name for case in asked.select((), fast=True)] == ["fall-far", "fall-near"]
    with pytest.raises(LabError, match="no case spin; there are fall-far, fall-near, roll"):
        asked.select(("roll", "spin"), fast=False)
    with pytest.raises(LabError, match="no fast case roll; there are fall-far, fall-near"):
        asked.select(("roll",), fast=True)


def test_a_page_tells_all_that_was_found_the_failed_first(tmp_path):
    """Also errors where none is allowed, which no share of the tolerance can tell."""
    good = Found(
        [Line.off("none lost", "by hand", 0.0, 0.0, "exact")], notes=["A  note."], tables=[Table(["a"], [["b"]])]
    )
    bad = Found([Line.off("lost", "by hand", 2.0, 0.0, "exact", "m")])
    cases = [
        Case(name, "Section", f"The {name}", lambda fast, it=it: it) for name, it in (("good", good), ("bad", bad))
    ]
    assert not suite(cases).run((), tmp_path, fast=True)
    page = (tmp_path / "trial.md").read_text(encoding="utf-8")
    assert "1 of 2 lines in 2 cases are within their tolerances. **Failed: bad.** What it is about.\n" in page
    assert "## Section\n\nWhat the section is about.\n\n**The bad** (`bad`)" in page
    assert "| lost | 2 m | 0 m | by hand | 2 m | 0 m | exact | FAIL |" in page
    assert "A note.\n\n| a |\n| --- |\n| b |" in page and page.index("The bad") < page.index("The good")
    assert (tmp_path / "trial-errors.png").stat().st_size > 1000
