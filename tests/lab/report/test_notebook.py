"""What a notebook shows: numbers as the lab writes them, presets, runs and films, with every text escaped."""

import re
from base64 import b64decode
from html.parser import HTMLParser

import pytest

import cargolab
from lab.measures.value import Measures, Value, over_worlds
from lab.recording import open_recording
from lab.report import notebook
from lab.report.numbers import number
from lab.runs.runner import Result
from tests.oracles.synthetic import preset, recorder, sample

HOSTILE = "<script>alert('1')</script>"
EMPTY = {"progress", "source", "img", "br"}


class Tags(HTMLParser):
    """The tags of a page, which must close as they open."""

    def __init__(self, page):
        super().__init__()
        self.seen, self.open = set(), []
        self.feed(page)
        assert self.open == []

    def handle_starttag(self, tag, attrs):
        self.seen.add(tag)
        self.open += [] if tag in EMPTY else [tag]

    def handle_endtag(self, tag):
        assert tag in EMPTY or self.open.pop() == tag


def tags(page):
    return Tags(page).seen


def test_a_value_says_itself_as_everywhere():
    value = over_worlds([24.0, 26.0], "deg", note=HOSTILE)
    assert str(value) == number(value) == "25.0 ± 1.4 deg (2 beds)"
    assert repr(value) == "<Value 25.0 ± 1.4 deg (2 beds)>"
    page = value._repr_html_()
    assert "25.0 ± 1.4 deg (2 beds)" in page and tags(page) == {"div", "strong", "p"} and "&lt;script" in page
    assert str(Value(None, "deg")) == "none"


def test_measures_are_a_table():
    measures = Measures(critical_angle=over_worlds([24.0, 26.0], "deg"), clogged=Value(0.0, "1", note=HOSTILE))
    assert repr(measures).splitlines() == ["critical angle  25.0 ± 1.4 deg (2 beds)", "clogged         0"]
    page = measures._repr_html_()
    assert page.count("<tr>") == 3 and "script" not in tags(page)
    assert repr(Measures()) == "no measures"


def test_a_preset_shows_the_keys_that_it_sets_with_units_and_sentences():
    page = cargolab.Preset("tilting/quick", material__friction=0.4)._repr_html_()
    rows = re.findall(r"<tr>(.*?)</tr>", page)
    width = next(row for row in rows if ">width<" in row)
    assert "96 mm" in width and ">m<" in width and "Width of a rectangular tank" in width
    assert any(">friction<" in row and ">0.4<" in row for row in rows)
    assert "after Spandonidis (2016)" in page and "Reports: Nothing for this tank" in page
    assert {"details", "table", "pre"} <= tags(page)


def test_a_preset_of_anybodys_runs_no_script():
    one = cargolab.Preset(
        {"based_on": "tilting/quick", "title": HOSTILE, "source": HOSTILE, "reports": f"</div>{HOSTILE}"}
    )
    assert "script" not in tags(one._repr_html_()) and "<script" not in one._repr_html_()


@pytest.fixture
def result(tmp_path):
    """A run of no grains to speak of, with a film and two figures beside it."""
    with recorder(tmp_path, 2, resolved=preset() | {"title": HOSTILE}) as run:
        run.sample(sample(0.0, 2))
    (tmp_path / "video.mp4").write_bytes(b"film")
    for name in ("shift", "critical_angle"):
        (tmp_path / f"{name}.png").write_bytes(b"\x89PNG")
    return Result(tmp_path, Measures(shift=over_worlds([1.0, 2.0], "mm")), "the summary")


def test_a_result_shows_title_numbers_and_film(result):
    page = result._repr_html_()
    assert {"video", "table"} <= tags(page) and "script" not in tags(page)
    assert "1.50 ± 0.71 mm (2 beds)" in page and "tilting/acetate" in page
    assert str(result) == "the summary"
    assert repr(result).splitlines() == [f"<Result in {result.folder}>", "shift  1.50 ± 0.71 mm (2 beds)"]


def test_the_film_plays_from_the_page_or_where_it_is_long_from_its_file(result, monkeypatch):
    held = re.search(r'src="data:video/mp4;base64,([^"]+)"', result.video._repr_html_())
    assert b64decode(held[1]) == b"film"
    monkeypatch.setattr(notebook, "MOST_INLINE", 3)
    assert f'src="{result.folder.as_posix()}/video.mp4"' in result.video._repr_html_()
    (result.folder / "video.mp4").unlink()
    with pytest.raises(cargolab.Error, match=r"has no video: `cargolab render .*` paints it"):
        result.video  # noqa: B018
    assert "video" not in tags(result._repr_html_())


def test_a_figure_is_shown_by_its_name_and_an_unknown_one_names_those_that_there_are(result):
    assert result.plot("shift")._repr_png_() == b"\x89PNG"
    assert result.plot("critical angle").path == result.folder / "critical_angle.png"
    with pytest.raises(cargolab.Error, match=r"no figure 'shfit'; did you mean shift\?"):
        result.plot("shfit")
    with pytest.raises(cargolab.Error, match=r"no figure '\.\./x'; it has critical_angle, shift\."):
        result.plot("../x")


def test_a_page_of_a_recording_is_whole(result):
    with open_recording(result.folder) as recording:
        assert {"details", "table"} <= tags(recording._repr_html_())
