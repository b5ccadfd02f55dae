"""Pages are made from results that are kept beside them, with what made them."""

import json

import pytest
from jinja2 import UndefinedError

from lab.report.page import Page, render


def test_a_page_is_made_from_results_that_say_what_made_them(tmp_path):
    """Rendered again from the file alone it is the same page."""
    page = Page(tmp_path, "trial", "A trial")
    page.section("One")
    page.say("A  sentence\n in lines.")
    page.table(["a", "b"], [[1.23456, "x"], [float("nan"), 2]])
    text = page.write().read_text()
    data = json.loads((tmp_path / "trial.json").read_text())
    assert data["made"]["command"] == "cargolab bench trial"
    assert all(data["made"][name] for name in ("version", "date", "processor", "packages"))
    assert render(tmp_path / "again.md", "page.md.j2", **data).read_text() == text
    assert data["made"]["processor"] in text and "## One\n\nA sentence in lines.\n\n| a | b |" in text
    assert "| 1.23 | x |\n| none | 2 |" in text


def test_a_page_with_a_number_missing_is_none(tmp_path):
    with pytest.raises(UndefinedError):
        render(tmp_path / "page.md", "page.md.j2", title="A trial")
