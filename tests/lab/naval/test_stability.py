"""`cargolab stability`: a ship judged without a simulation, its tables, figure, and what it cannot judge."""

import csv
import re

import numpy as np
import pytest
from click.testing import CliRunner

from lab.assembly.scene import vessels
from lab.cli.naval import stability
from lab.naval import sheet, tables
from lab.naval.condition import condition
from lab.preset.find import load
from tests.oracles.presets import error_of

SHIP = "ship/handysize-grain"


@pytest.fixture(scope="module")
def handysize():
    """The Handysize's condition."""
    preset = load(SHIP).resolved
    return condition(preset, vessels(preset)[0])


def of(name: str, **overrides):
    preset = load(name, overrides).resolved
    return condition(preset, vessels(preset)[0])


def verdicts(found) -> dict[str, str]:
    return {row.criterion.rule + row.criterion.what[-9:]: row.criterion.verdict for row in sheet.rows(found)}


def test_condition_by_hand(handysize):
    """The box 27 × 14 m at 9.7 m: KB T/2, BM B²/12T, λ0 = 557 × 25 × 1.12 / (1.3 × 35 086)."""
    assert handysize.displacement == pytest.approx(1.025 * 27.0 * 9.7 * 130.7, rel=1e-9)
    assert handysize.metacentric_height == pytest.approx(4.85 + 27.0**2 / (12.0 * 9.7) - 9.11, rel=1e-9)
    assert handysize.assumed_arm == pytest.approx(0.342, abs=5e-4)
    assert np.degrees(handysize.deck_edge_angle) == pytest.approx(np.degrees(np.arctan(4.3 / 13.5)), rel=1e-6)
    assert handysize.cargo.stowage == pytest.approx(1.3, rel=0.03)  # so the preset's grains stow as it says


def test_too_little_metacentric_height_fails():
    """0.45 m more KG: 16 deg of heel from the assumed shift, and no area left."""
    assert "fail" not in verdicts(of(SHIP)).values()
    found = sheet.rows(of(SHIP, **{"ship.gravity_height": "9.61 m", "ship.roll_period": "16 s"}))
    failed = {row.criterion.rule for row in found if not row.criterion.passed}
    assert failed == {"Grain Code A 7.1.2", "IS Code A 2.2.3"}  # 1.5 m: 11.4 deg, 0.053 m rad


def test_free_surfaces_lower_the_metacentric_height(handysize):
    slack = of(SHIP, **{"stability.free_surface": "3508.6 t m"})
    assert handysize.metacentric_height - slack.metacentric_height == pytest.approx(0.1, rel=1e-4)
    heel = np.radians(20.0)
    assert float(handysize.levers.at(heel) - slack.levers.at(heel)) == pytest.approx(0.1 * np.sin(heel), rel=1e-4)


def test_model_is_judged_at_full_scale():
    """Froude: angles stay, lengths go with the scale, areas in m rad too."""
    model, full = of("ship/barge-roll"), of("ship/barge-roll", **{"ship.scale": 50})
    one, other = ({row.criterion.rule: row.criterion for row in sheet.rows(found)} for found in (model, full))
    assert other["Grain Code A 7.1.1"].attained == pytest.approx(one["Grain Code A 7.1.1"].attained, rel=1e-9)
    assert other["Grain Code A 7.1.2"].attained == pytest.approx(50 * one["Grain Code A 7.1.2"].attained, rel=1e-9)
    assert full.displacement == pytest.approx(50**3 * model.displacement, rel=1e-9)


def test_arm_of_moved_cargo_is_that_of_the_moved_centre(handysize):
    """GZ of a ship whose G has moved is GZ less the arm, at all heels."""
    arm, heel = sheet.shifted(0.2, 0.05), handysize.levers.heel
    low = handysize.fluid_height
    moved = handysize.form.righting_levers(handysize.displacement, handysize.water, heel, (-0.2, low + 0.05))
    assert handysize.levers.less(arm).lever == pytest.approx(moved, abs=1e-9)


def test_tables_agree_with_each_other(handysize):
    """KN less KG sin φ is GZ; volumes of the hold are integrals of its section; TPC of a box is ρ L B / 100."""
    header, lines = tables.hydrostatics(handysize.form, handysize.water, [9.7])
    values = dict(zip(header, map(float, lines[0]), strict=True))
    assert values["TPC t/cm"] == pytest.approx(1.025 * 130.7 * 27.0 / 100.0, abs=5e-4)
    assert values["displacement t"] == pytest.approx(handysize.displacement, abs=0.05)
    header, lines = tables.cross_curves(handysize.form, handysize.water, [9.7])
    for name, text in zip(header[1:], lines[0][1:], strict=True):
        heel = np.radians(float(name.split()[1]))
        gz = float(text) - handysize.fluid_height * np.sin(heel)
        assert gz == pytest.approx(float(handysize.levers.at(heel)), abs=1e-3)
    rows = [tuple(map(float, line)) for line in tables.hold(handysize.hold)[1]]
    assert rows[-1][1] == pytest.approx(handysize.hold.volume, rel=1e-4)
    assert rows[-1][3:] == pytest.approx((0.0, 0.0), abs=1.0)  # a full hold has nothing to shift


def test_command_writes_tables_and_figure(tmp_path):
    answer = CliRunner().invoke(stability, [SHIP, "--out", str(tmp_path)])
    assert answer.exit_code == 0, answer.output
    assert "starboard down" in answer.output and "Grain Code A 7.1.2" in answer.output
    with (tmp_path / "criteria.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert {row["verdict"] for row in rows} == {"pass"} and len(rows) == 11
    names = {path.name for path in tmp_path.iterdir()}
    assert names == {
        f"{name}.csv" for name in ("criteria", "righting-levers", "hydrostatics", "cross-curves", "hold")
    } | {"righting-levers.png", "stability.html"}


def test_page_for_the_file_has_what_the_sheet_has(tmp_path):
    """The page that `stability` promises: each criterion with its verdict, figure, tables, inputs, and no link."""
    answer = CliRunner().invoke(stability, [SHIP, "--set", "ship.gravity_height=9.61 m", "--out", str(tmp_path)])
    assert answer.exit_code == 0, answer.output
    page = (tmp_path / "stability.html").read_text(encoding="utf-8")
    with (tmp_path / "criteria.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        assert row["rule"] in page and f'<td class="n">{row["attained"]}</td>' in page
    assert page.count('<span class="fail">fail</span>') == sum(row["verdict"] == "fail" for row in rows) > 0
    for name in ("hydrostatics", "cross-curves", "hold"):
        last = (tmp_path / f"{name}.csv").read_text(encoding="utf-8").splitlines()[-1]
        assert "".join(f"<td>{cell}</td>" for cell in last.split(",")) in page
    assert "data:image/png;base64," in page and "starboard down" in page and "9.61 m" in page
    assert not re.search(r"(href|src)=.(?!data:)", page)


@pytest.mark.parametrize(
    ("name", "overrides", "words"),
    [
        (SHIP, {"tank.length": "200 m"}, "tank.length"),
        (SHIP, {"ship.length": False}, "ship.length"),
        (SHIP, {"stability.wind_lever": False}, "stability.wind_lever"),
        ("tilting/quick", {"stability.keel_area": "1 m^2"}, "stability"),
        ("tilting/quick", {"tank.length": "1 m"}, "tank.length"),
    ],
)
def test_contradictions_are_one_sentence(name, overrides, words):
    assert error_of(load, name, overrides).startswith(words)


def test_what_was_not_judged_is_said():
    said = " ".join(sheet.unjudged(of("ship/barge-roll")))
    assert "wind_area" in said and "ship.scale" in said
