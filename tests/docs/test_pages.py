"""The pages: built without a warning and without a network, and a README that says what the kept pages say."""

import importlib.util
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

from lab.cli import main
from lab.preset.find import load

ROOT = Path(__file__).parents[2]
TOOLS = "sphinx", "furo", "myst_nb", "latex2mathml"
MISSING = [name for name in TOOLS if importlib.util.find_spec(name) is None]
ELSEWHERE = re.compile(r"""<(?:script|link|img)[^>]*(?:src|href)="((?:https?:)?//[^"]+)""")
MOST_LINES, MOST_WORDS = 60, 700


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """The manual as HTML, made anew."""
    if MISSING:
        pytest.skip(f"{', '.join(MISSING)} not installed: pip install -e '.[docs]'")
    out = tmp_path_factory.mktemp("html")
    command = sys.executable, "-m", "sphinx", "-W", "--keep-going", "-q", "-b", "html", ROOT / "docs", out
    made = subprocess.run(command, capture_output=True, text=True, check=False)
    assert made.returncode == 0, made.stderr
    return out


def test_the_manual_builds_without_a_warning_and_needs_no_network(built):
    pages = {path: path.read_text(encoding="utf-8") for path in built.rglob("*.html")}
    assert len(pages) > 20
    assert [found for text in pages.values() for found in ELSEWHERE.findall(text)] == []
    assert [name for name, text in pages.items() if re.search(r"\{\{ \w+ ", text)] == []  # all was put in


def test_kept_results_are_shown_with_their_pictures(built):
    page = (built / "results" / "verify.html").read_text(encoding="utf-8")
    shown = re.findall(r'<img[^>]*src="([^"]+)"', page)
    assert shown and all((built / "results" / one).resolve().exists() for one in shown)
    assert "<math" in (built / "physics" / "contacts.html").read_text(encoding="utf-8")


def test_every_fence_with_a_formula_is_set(built):
    asked = {path: path.read_text(encoding="utf-8").count("```formula\n") for path in (ROOT / "docs").rglob("*.md")}
    assert sum(asked.values()) > 20
    for path, count in asked.items():
        page = built / path.relative_to(ROOT / "docs").with_suffix(".html")
        assert not count or page.read_text(encoding="utf-8").count('class="formula"') >= count, path


def test_the_first_preset_is_one_and_its_result_has_what_is_read(tmp_path):
    """Of getting started: the preset resolves, and the lines of Python name a measure that there is."""
    text = (ROOT / "docs" / "getting-started.md").read_text(encoding="utf-8")
    (tmp_path / "peas.toml").write_text(re.search(r"```toml\n(.*?)```", text, re.DOTALL)[1], encoding="utf-8")
    preset = load(tmp_path / "peas.toml").resolved
    assert preset.motion.sway.amplitude == 0.01 and preset.run.repeats == 2
    asked = re.findall(r'result\.measures\["(\w+)"\]', text)
    sources = "\n".join(path.read_text(encoding="utf-8") for path in (ROOT / "lab" / "measures").glob("*.py"))
    assert asked and all(f'"{name}"' in sources for name in asked)


@pytest.mark.parametrize("name", ["accuracy", "gpu", "outlines", "speed", "stability", "verify", "water"])
def test_a_kept_page_is_what_its_command_writes_from_the_kept_results(name, tmp_path):
    kept = ROOT / "renders" / "gallery" / "bench"
    shutil.copy(kept / f"{name}.json", tmp_path)
    command = ["verify"] if name == "verify" else ["bench", name]
    CliRunner().invoke(main, [*command, "--page", "--out", str(tmp_path)])
    assert (tmp_path / f"{name}.md").read_bytes() == (kept / f"{name}.md").read_bytes()


def test_every_picture_of_a_page_has_its_command_beside_it():
    for path in sorted((ROOT / "docs").rglob("*.md")):
        text = path.read_text(encoding="utf-8")
        for found in re.finditer(r"^!\[[^\]]*\]\([^)]+\)\n", text, re.MULTILINE):
            assert "`cargolab " in text[found.end() :].lstrip("\n").partition("\n\n")[0], path


def test_readme_is_short():
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    assert len(text.splitlines()) <= MOST_LINES and len(text.split()) <= MOST_WORDS


def test_a_number_in_bold_on_readme_is_on_the_page_that_its_row_links_to():
    """Results are made anew from time to time; README must not lag behind."""
    lines = (ROOT / "README.md").read_text(encoding="utf-8").splitlines()
    rows = [row for row in lines if row.startswith("| ") and "**" in row and "](renders/" in row]
    assert len(rows) >= 5
    for row in rows:
        linked = [ROOT / link for link in re.findall(r"\]\((renders/[^)]+\.md)\)", row)]
        text = "\n".join(page.read_text(encoding="utf-8") for page in linked)
        missing = [bold for bold in re.findall(r"\*\*(.+?)\*\*", row) if bold not in text]
        assert linked and missing == [], f"{missing} not in {linked}"
