"""What strangers have written shows on pages and screens as it stands: no markup, no HTML, no terminal's commands."""

import csv
import json
import re
from itertools import product
from pathlib import Path

import h5py
import pytest
from click.testing import CliRunner
from markdown_it import MarkdownIt

from lab.base.errors import LabError
from lab.base.progress import Progress
from lab.cli import main
from lab.recording import open_recording
from lab.recording.layout import fixed_text
from lab.report.file import write_report as write_file
from lab.report.page import Page
from lab.report.plots import write_plots
from lab.studies import gallery
from lab.studies.engine import write_sections
from lab.studies.gallery import make_gallery
from lab.sweeps.report import write_report
from tests.lab.preset.test_malformed import call, refused
from tests.lab.report.test_summary import summed_up, tilt_run
from tests.oracles.synthetic import preset, recorder, sample

NASTY = [
    "<script>alert(1)</script>",
    '"onerror="alert(1)" <img src=x onerror=alert(1)>',
    "[a link](javascript:alert(1)) ![a picture](http://elsewhere/x.png)",
    "one line\n\n<script>alert(1)</script>\n\n# another heading",
    "| a | cell | more |\n|---|---|---|",
    "```\n<script>alert(1)</script>\n```",
    "`code` <b>bold</b> &lt;script&gt; &#60;script&#62;",
    "\\<script>alert(1)</script> \\[x](javascript:alert(1))",
    "\x1b[31mred\x1b]0;title\x07 \x9b31m \u202emirrored \r\b",
    "[red]markup[/red] [/nothing] [link=http://elsewhere]x[/link]",
    "$\\frac{$",
    "---\n***\n===\n- item\n> quoted\n1. one\n    indented",
]

TO_DRAW = NASTY[3], NASTY[8], NASTY[10]  # what a figure may take for more than text: lines, control codes, formulas


def tokens(page: str) -> list:
    """All tokens of a Markdown page in which HTML counts, as GitHub and most viewers take it."""
    parsed = MarkdownIt("commonmark", {"html": True}).enable("table").parse(page)
    return [token for block in parsed for token in [block, *(block.children or [])]]


def assert_tame(page: str) -> None:
    """A page without HTML, whose links and pictures lie beside it."""
    for token in tokens(page):
        assert token.type not in ("html_block", "html_inline"), token.content
        for name in ("href", "src"):
            assert not re.match(r"\s*\w+:", str(token.attrs.get(name, ""))), token.attrs
    assert_printable(page)


def assert_printable(text: str) -> None:
    assert all(c.isprintable() or c == "\n" for c in text), repr(text)


def sections(page: str) -> list[str]:
    """Its headings."""
    found = tokens(page)
    return [found[k + 1].content for k, token in enumerate(found) if token.type == "heading_open"]


def nasty_run(folder: Path, text: str) -> Path:
    said = {"title": text, "source": text, "reports": text, "quick": text}
    tilt = {"tilt": {"rate": 0.07, "angle": 0.7, "hold": 0.0}}
    return tilt_run(
        folder,
        worlds=1,
        resolved=preset(**tilt) | said,
        given=f"title = '''{text}'''",
        preset=text,
        machine={"processor": text, "system": text, "cores": text},
        status=f"stopped: {text}",
    )


@pytest.fixture(scope="module")
def usual(tmp_path_factory) -> list[str]:
    """The headings of a summary of plain texts."""
    return sections(summed_up(nasty_run(tmp_path_factory.mktemp("plain"), "plain"), warnings=["x"])[0])


@pytest.mark.parametrize("text", NASTY)
def test_a_summary_shows_texts_of_a_recording_escaped(text, tmp_path, usual):
    page, data, said = summed_up(nasty_run(tmp_path, text), warnings=[text])
    assert_tame(page)
    assert_printable(said)
    assert len(sections(page)) == len(usual) and sections(page)[1:] == usual[1:]
    assert sum(token.type == "fence" for token in tokens(page)) == 1
    assert data["warnings"][0] == text


@pytest.mark.parametrize(
    "text", [pytest.param(text, marks=() if text in TO_DRAW else pytest.mark.slow) for text in NASTY]
)
def test_any_title_is_drawn(text, tmp_path):
    with recorder(tmp_path, resolved=preset() | {"title": text}) as writer:
        for now in (0.0, 1.0, 2.0):
            writer.sample(sample(now))
    with open_recording(tmp_path) as recording:
        assert recording.preset.title == text
        assert write_plots(recording, {}, tmp_path)


@pytest.mark.parametrize("text", [NASTY[10], pytest.param(NASTY[3], marks=pytest.mark.slow)])
def test_labels_and_units_of_a_file_are_drawn_as_they_stand(text, tmp_path):
    """Those of a quantity are attributes of its data set. A scale of powers of ten keeps its formulas."""
    with recorder(tmp_path) as writer:
        for now in (0.0, 1.0, 2.0):
            writer.sample(sample(now))
    with h5py.File(tmp_path / "recording.h5", "r+") as file:
        for name in ("contacts", "kinetic", "wall_force"):
            file[f"series/{name}"].attrs["long_name"] = fixed_text(text + " $")
            file[f"series/{name}"].attrs["plot"] = True
    with open_recording(tmp_path) as recording:
        assert text + " $" in {quantity.label for quantity in recording.quantities.values()}
        assert write_plots(recording, {}, tmp_path)
    assert write_file(tmp_path)


def test_a_recording_that_does_not_say_what_made_it_has_a_report(tmp_path):
    with recorder(tmp_path) as writer:
        writer.sample(sample(0.0))
    with h5py.File(tmp_path / "recording.h5", "r+") as file:
        file.attrs["versions"] = fixed_text("{}")
    (page,) = write_file(tmp_path)
    assert "Cargo Shift Lab, version unknown." in page.read_text()
    with h5py.File(tmp_path / "recording.h5", "r+") as file:
        file.attrs["versions"] = fixed_text('{"cargo-shift-lab": {"a": 1}}')
    with pytest.raises(LabError, match="attribute versions is not what the lab writes there"):
        open_recording(tmp_path)


def test_a_label_of_a_million_letters_is_refused(tmp_path):
    recorder(tmp_path).close()
    with h5py.File(tmp_path / "recording.h5", "r+") as file:
        file["series/kinetic"].attrs["long_name"] = fixed_text("x" * 1000)
    with pytest.raises(LabError, match="longer label than the lab writes"):
        open_recording(tmp_path)


@pytest.mark.parametrize("text", [NASTY[8], pytest.param(NASTY[3] * 2000, marks=pytest.mark.slow)])
def test_a_title_commands_no_terminal_and_no_browser_and_fits_a_picture(text, tmp_path):
    """A preset's reader refuses such characters, but a recording's preset may come from anywhere."""
    folder = nasty_run(tmp_path / "run", text)
    for words in (("report", folder), ("poster", folder, "--width", 320, "--height", 180), ("run", "--replay", folder)):
        done = CliRunner().invoke(main, [*map(str, words)], prog_name="cargolab")
        assert isinstance(done.exception, SystemExit | None) and done.exit_code in (0, 2), done.exception
        assert_printable(done.output)
    assert_printable((folder / "report.html").read_text())
    assert (folder / "poster.png").exists()


@pytest.mark.parametrize("command", ["explain", "stability"])
def test_what_commands_print_has_no_control_codes(command, monkeypatch):
    monkeypatch.setattr("lab.report.explain.explain", lambda _: NASTY[8])
    monkeypatch.setattr("lab.report.stability.judge", lambda *_: (NASTY[8], Path("x"), {}))
    done = CliRunner().invoke(main, [command, "ship/handysize-grain"], prog_name="cargolab")
    assert done.exit_code == 0 and "red" in done.output
    assert_printable(done.output)


# ---- sweeps


def foreign(folder: Path, **changes: object) -> None:
    """A run's summary.json with one measure as others may write it."""
    measure = {"value": 1.0, "unit": "deg", "std": None, "uncertainty": None, "worlds": [1.0], "note": ""}
    content = {"status": "complete", "warnings": [], "notes": [], "cost": {}, "measures": {"repose": measure}}
    folder.mkdir(parents=True)
    (folder / "summary.json").write_text(json.dumps(content | changes))


def reported(folder: Path, name="preset", axes=None) -> tuple[list, str, str]:
    """The report of a sweep of one point: its rows, its page and the short text."""
    axes = axes or {"run.seed": [1, 2]}
    settings = [dict(zip(axes, chosen, strict=True)) for chosen in product(*axes.values())]
    folders = [folder / "points" / f"{k:03}" for k in range(len(settings))]
    rows, text = write_report(name, axes, settings, folder, folders, Progress(True), video=False)
    return rows, (folder / "summary.md").read_text(), text


@pytest.mark.parametrize("text", NASTY)
def test_the_page_of_a_sweep_shows_texts_of_its_points_escaped(text, tmp_path):
    foreign(tmp_path / "points" / "000", status=text, warnings=[text])
    foreign(tmp_path / "points" / "001")
    _, page, said = reported(tmp_path, name=text, axes={"run.seed": [text, "2"]})
    assert_tame(page)
    assert_printable(said)
    rows = [token for token in tokens(page) if token.type in ("tr_open", "td_open", "th_open")]
    assert [token.type for token in rows].count("tr_open") == 3 and len(rows) == 3 + 3 * 4
    assert sections(page)[1:] == ["Points", "Files"]


@pytest.mark.parametrize("key", ["../../outside", "/tmp/outside", "a/b", "x\0", "x" * 500, "..", "<b>"])
def test_no_measure_of_a_point_can_name_another_file(key, tmp_path):
    folder = tmp_path / "deep" / "er" / "sweep"
    measure = {"value": 1.0, "unit": "deg", "std": None, "uncertainty": None, "worlds": [1.0], "note": ""}
    for number in ("000", "001"):
        foreign(folder / "points" / number, measures={key: measure})
    with pytest.raises(LabError, match=r"000/summary\.json is damaged"):
        reported(folder)
    assert {path.name for path in tmp_path.rglob("*") if path.is_file()} == {"summary.json"}


DAMAGED = [
    {"measures": []},
    {"measures": {"repose": {}}},
    {"measures": {"repose": 3}},
    {"measures": {"repose": {"value": "1", "unit": "", "std": None, "uncertainty": None, "worlds": [], "note": ""}}},
    {"measures": {"repose": {"value": 1, "unit": 3, "std": None, "uncertainty": None, "worlds": [], "note": ""}}},
    {"measures": {"repose": {"value": 1, "unit": "", "std": None, "uncertainty": None, "worlds": 3, "note": ""}}},
    {"status": 3},
    {"warnings": 3},
    {"warnings": [{}]},
]


@pytest.mark.parametrize("changes", DAMAGED)
def test_a_damaged_summary_of_a_point_is_named(changes, tmp_path):
    foreign(tmp_path / "points" / "000", **changes)
    with pytest.raises(LabError, match=r"000/summary\.json is damaged"):
        reported(tmp_path)


@pytest.mark.parametrize("formula", ["=1+1", "+cmd|' /C calc'!A0", "-2+3", "@SUM(A1)", "\t=1", "\r=1"])
def test_no_cell_of_a_table_is_a_formula(formula, tmp_path):
    for number in ("000", "001"):
        foreign(tmp_path / "points" / number, status=formula)
    reported(tmp_path, axes={"a": [formula, "x"], "b": ["-5 mm", "3 mm"], "c": [-1, 2]})
    with (tmp_path / "results.csv").open(newline="") as file:
        first = next(csv.DictReader(file))
    assert first["status"][0] == "'" and first["a"][0] == "'"
    assert (first["b (mm)"], first["c"]) == ("-5.0", "-1")


# ---- pages of benches, verification and reproduction


@pytest.mark.parametrize("text", NASTY)
def test_the_table_of_a_page_can_hold_any_text(text, tmp_path):
    page = Page(tmp_path, "page")
    page.table(["one", "two"], [[text, 1.0], ["x", 2.0]])
    written = write_sections(tmp_path / "page.md", "A page", {"one": {"said": "", "blocks": page.blocks}})
    kinds = [token.type for token in tokens(written.read_text())]
    assert not {"html_block", "html_inline"} & set(kinds)
    assert (kinds.count("th_open"), kinds.count("td_open")) == (2, 4)


# ---- the gallery


@pytest.mark.parametrize("text", NASTY)
def test_the_gallery_shows_titles_and_numbers_escaped(text, tmp_path, monkeypatch):
    monkeypatch.setattr(gallery, "names", lambda: {"tilting/quick": text, f"a/{text}": text})
    told = {"status": text, "numbers": {text: text}, "accuracy": text, "beds": 1, "version": text, "date": text}
    (tmp_path / "tilting-quick.json").write_text(json.dumps(told))
    monkeypatch.setattr(gallery, "_show", lambda *_: None)
    page = make_gallery(["tilting/quick"], tmp_path, quiet=True).read_text()
    assert page.count("<script>") == 1 and "<script>alert" not in page and "<b>bold" not in page
    assert not re.search(r"<[^>]*onerror", page) and not re.search(r"<img src=x", page)


UNREADABLE = ["", "[]", "{}", '{"status": 3, "numbers": {}}', '{"status": "", "numbers": {"a": 1}}', "[" * 10**5]


@pytest.mark.parametrize("content", UNREADABLE)
def test_numbers_of_the_gallery_that_cannot_be_read_are_named(content, tmp_path, monkeypatch):
    monkeypatch.setattr(gallery, "_show", lambda *_: None)
    (tmp_path / "tilting-quick.json").write_text(content)
    with pytest.raises(LabError, match=r"tilting-quick\.json is damaged: remove it"):
        make_gallery(["tilting/quick"], tmp_path, quiet=True)


# ---- the screen


@pytest.mark.parametrize("text", NASTY)
def test_progress_messages_contain_no_markup(text, capsys):
    with Progress(quiet=False) as progress:
        progress.say(text)
        progress.warn(text)
    said = capsys.readouterr().err
    assert_printable(said)
    if text == NASTY[9]:
        assert "[red]markup[/red] [/nothing]" in said
    assert progress.warnings == [text]


def test_messages_contain_no_terminal_control_codes(tmp_path):
    writer = recorder(tmp_path / "run")
    writer.sample(sample(0.0))
    writer.close("stopped: \x1b[31m\x9b\u202e")
    with open_recording(tmp_path / "run") as recording:
        assert recording.status.startswith("stopped: ")
    assert "?[31mrun?" in refused(call("render", tmp_path / "\x1b[31mrun\x07"))
