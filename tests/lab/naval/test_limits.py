"""`cargolab hull --limiting-kg --strength`: what it writes and says, and bad input in one sentence."""

import csv
from pathlib import Path

import pytest
from click.testing import CliRunner

from lab.cli.naval import hull

BOX = "station,z,half_breadth\n0,0,8\n0,10,8\n50,0,8\n50,10,8\n100,0,8\n100,10,8\n"
WEIGHTS = "name,mass,lcg,tcg,vcg,fsm,aft,forward\nlight,4000,50,0,4,,0,100\ncargo,2500,50,0,5,250,25,75\n"


@pytest.fixture
def asked(tmp_path) -> list[str]:
    (tmp_path / "box.csv").write_text(BOX)
    (tmp_path / "weights.csv").write_text(WEIGHTS)
    return [str(tmp_path / "box.csv"), "--weights", str(tmp_path / "weights.csv"), "--out", str(tmp_path / "out")]


def test_limits_and_strength_of_a_box(asked, tmp_path):
    """Her own KM less 0.30 m or 0.15 m; cargo of W over the middle half sags her by W L/16."""
    done = CliRunner().invoke(hull, [*asked, "--limiting-kg", "--strength", "--displacement", "6500"])
    assert done.exit_code == 0, done.output
    (row,) = _rows(tmp_path / "out/limiting-kg.csv")
    gm = row["IS Code A 2.2.4: GM, corrected for free surfaces m"]
    assert float(gm) == pytest.approx(float(row["KM m"]) - 0.15, abs=2e-3)
    assert "KG fluid 4.423 m" in done.output and "to spare" in done.output
    middle = next(row for row in _rows(tmp_path / "out/strength.csv") if float(row["x m"]) == 50.0)
    assert float(middle["moment kN m"]) == pytest.approx(-2500.0 * 9.81 * 100.0 / 16.0, rel=1e-4)
    assert all((tmp_path / "out" / name).exists() for name in ("limiting-kg.png", "strength.png"))


def _rows(path: Path) -> list[dict[str, str]]:
    return list(csv.DictReader(path.open()))


def test_strength_needs_weights(asked):
    done = CliRunner().invoke(hull, [asked[0], "--strength", *asked[3:]])
    assert done.exit_code != 0 and "--weights" in str(done.exception)


@pytest.mark.parametrize(("ends", "said"), [("60,80", "middle third"), ("0,", "needs a number for forward")])
def test_ends_that_do_not_fit_are_told(asked, tmp_path, ends, said):
    (tmp_path / "weights.csv").write_text(WEIGHTS.replace("25,75", ends))
    done = CliRunner().invoke(hull, [*asked, "--strength", "--draught", "4"])
    assert done.exit_code != 0 and said in str(done.exception) and "weights.csv" in str(done.exception)
