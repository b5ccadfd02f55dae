"""Pages are made by templates, and show all that a study has to show."""

import re

import pytest
from jinja2 import UndefinedError
from matplotlib.figure import Figure
from PIL import Image

from lab.report.page import Page, render
from lab.studies.engine import write_sections


def test_a_page_shows_the_blocks_of_its_studies(tmp_path):
    page = Page(tmp_path, "trial")
    page.section("One")
    page.say("A  sentence\n in lines.")
    page.table(["a", "b"], [[1.23456, "x"], [None, 2]])
    page.figure("drawn", Figure(), "What it shows")
    results = {"one": {"said": "Made by hand.", "blocks": page.blocks}}
    text = write_sections(tmp_path / "trial.md", "A trial", results, "About\n it.").read_text()
    assert text.startswith("# A trial\n\nMade by hand.\n\nAbout it.\n\n## One\n\nA sentence in lines.\n\n| a | b |")
    assert "| 1.23 | x |\n| none | 2 |" in text
    assert "![What it shows](trial-drawn.png)" in text
    with Image.open(tmp_path / "trial-drawn.png") as drawn:
        assert min(drawn.size) > 200


def test_one_figure_stands_on_a_page_and_the_others_are_named(tmp_path):
    page = Page(tmp_path, "trial")
    for name in ("first", "second", "third"):
        page.figure(name, Figure(), f"The {name}")
    results = {"one": {"said": "Made by hand.", "blocks": page.blocks}}
    for wanted, shown in (("second", "second"), ("none", "first")):
        text = write_sections(tmp_path / "trial.md", "A trial", results, "", f"trial-{wanted}.png").read_text()
        assert re.findall(r"]\((.+?)\)", text) == [f"trial-{shown}.png"]
        assert "`cargolab bench trial STUDY` writes the others" in text
        assert sorted(re.findall(r"`(trial-\w+\.png)`", text)) == sorted(
            f"trial-{one}.png" for one in {"first", "second", "third"} - {shown}
        )


def test_what_was_made_at_different_times_says_so_itself(tmp_path):
    blocks = {name: [{"section": name}, {"text": "It is so."}] for name in ("ann", "bob")}
    results = {name: {"said": f"Made by {name}.", "blocks": found} for name, found in blocks.items()}
    text = write_sections(tmp_path / "trial.md", "A trial", results).read_text()
    assert "# A trial\n\n## ann\n\nMade by ann.\n\nIt is so.\n\n## bob\n\nMade by bob." in text
    results |= {"eve": {"said": "Made by bob.", "blocks": [{"section": "eve"}]}}  # what most have is said once
    text = write_sections(tmp_path / "trial.md", "A trial", results).read_text()
    top = "# A trial\n\nMade by bob, unless a section says otherwise.\n\n"
    assert text.startswith(top + "## ann\n\nMade by ann.\n\nIt is so.\n\n## bob\n\nIt is so.")


def test_of_a_program_that_did_not_run_a_page_says_so_and_not_what_it_wrote(tmp_path):
    page = Page(tmp_path, "trial")
    page.say("That could not be run here: LAMMPS stopped: [mpiexec@vm] match_arg (/src/args.c:166): unrecognized")
    page.say("That could not be run here: there is one core only.")
    results = {"one": {"said": "Made by hand.", "blocks": page.blocks}}
    text = write_sections(tmp_path / "trial.md", "A trial", results).read_text()
    assert "Not measured: LAMMPS did not run here." in text and "mpiexec" not in text
    assert "That could not be run here: there is one core only." in text


def test_a_page_with_a_number_missing_is_none(tmp_path):
    with pytest.raises(UndefinedError):
        render(tmp_path / "page.md", "page.md.j2", title="A trial")
