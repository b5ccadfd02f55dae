"""Commands of whole hulls: offsets of Lewis sections, and the comparison of coefficients."""

import csv
import sys

import pytest
from click.testing import CliRunner

from lab.assembly.lines.offsets import read_offsets
from lab.cli.naval import hydrodynamics, lewis
from lab.naval.lewis import write_lewis
from solvers.ship.water import Water
from tests.oracles.presets import error_of

S175 = {"length": 175.0, "breadth": 25.4, "draught": 9.5, "depth": 15.4, "block": 0.569, "kb": 5.207, "plane": None}


def test_lewis_writes_a_hull_that_the_lab_reads(tmp_path):
    file = tmp_path / "s175.csv"
    options = [f"--{name}={value}" for name, value in S175.items() if value is not None]
    done = CliRunner().invoke(lewis, [str(file), *options])
    assert done.exit_code == 0 and "Cb 0.569" in done.output and "KB 5.207" in done.output
    found = read_offsets(file).hydrostatics(9.5, Water(1025.0))
    assert (found.volume, found.kb) == pytest.approx((0.569 * 175.0 * 25.4 * 9.5, 5.207), rel=2e-3)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"plane": 0.7}, "give either KB or the waterplane coefficient"),
        ({"depth": 9.0}, "--depth: must be more than the draught"),
        ({"breadth": -1.0}, "--breadth: must be above 0"),
        ({"block": 0.999}, "must be below that of the midship section"),
    ],
)
def test_what_no_lewis_hull_has_is_told(changes, words, tmp_path):
    assert words in error_of(write_lewis, tmp_path / "none.csv", S175 | {"midship": None} | changes)


def test_the_comparison_works_without_capytaine(tmp_path, monkeypatch):
    """It says what it leaves out. Strips of a prism are its section, in the page's numbers, too."""
    monkeypatch.setitem(sys.modules, "capytaine", None)
    odd = "ship.draught=109 mm"  # a hull that no other test has kept
    done = CliRunner().invoke(hydrodynamics, ["ship/barge-two-tanks", "--set", odd, "--out", str(tmp_path)])
    assert done.exit_code == 0 and "hull in space: left out. ship.hydrodynamics: needs Capytaine" in done.output
    rows = {kind: list(csv.reader((tmp_path / f"hydrodynamics-{kind}.csv").open())) for kind in ("section", "strips")}
    numbers = {kind: [[float(cell) for cell in row] for row in one[1:]] for kind, one in rows.items()}
    assert rows["section"][0] == rows["strips"][0]
    assert numbers["strips"][8] == pytest.approx(numbers["section"][8], rel=1e-4, abs=1e-4)
    assert "| strips of the hull |" in (tmp_path / "hydrodynamics.md").read_text()
    assert {path.name for path in tmp_path.glob("*.png")} == {"coefficients.png", "response.png"}
