"""Hydrostatics of a hull of one's own: closed forms of a box with trim, wetted surface, round draughts, commands."""

import json

import numpy as np
import pytest
from click.testing import CliRunner
from scipy.integrate import dblquad

import cargolab
from lab.base.errors import LabError
from lab.cli import main
from lab.naval.tables import LEAST_DRAUGHTS, round_draughts
from solvers.ship.naval.wetted import wetted_girth

LENGTH, BREADTH, DEPTH, RHO = 130.0, 27.0, 14.0, 1.025
BOX = "station,z,half_breadth\n" + "".join(f"{x},{z},13.5\n" for x in (0, 65, 130) for z in (0, 14))


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    path = tmp_path_factory.mktemp("box") / "box.csv"
    path.write_text(BOX)
    return path


@pytest.fixture(scope="module")
def box(file):
    return cargolab.hull(file)


@pytest.mark.parametrize("trim", [0.0, 0.796, -2.0])
def test_a_box_with_trim_has_its_closed_forms(box, trim):
    """Upright with the keel turned: a trapezoid along her. KB = T/2 + t²/(24 T), LCB = L/2 − t L/(12 T)."""
    draught = 8.617
    found = box.at(draught, trim=trim)
    assert found.displacement == pytest.approx(RHO * LENGTH * BREADTH * draught, rel=1e-12)
    assert found.kb == pytest.approx(draught / 2.0 + trim**2 / (24.0 * draught), rel=1e-9)
    assert found.lcb == pytest.approx(LENGTH / 2.0 - trim * LENGTH / (12.0 * draught), rel=1e-9)
    assert found.bml == pytest.approx(LENGTH**2 / (12.0 * draught), rel=1e-9)
    assert found.kml == pytest.approx(found.kb + found.bml, rel=1e-12)
    assert found.mct == pytest.approx(RHO * BREADTH * LENGTH**2 / 1200.0, rel=1e-9)
    ends = BREADTH * 2.0 * draught  # those of the fore and the aft end, whose mean is that amidships
    assert found.wetted == pytest.approx(LENGTH * (BREADTH + 2.0 * draught) + ends, rel=1e-9)
    assert found.draught == pytest.approx(draught, rel=1e-12)
    again = box.at(displacement=found.displacement, trim=trim)
    assert again.draught == pytest.approx(draught, rel=1e-9)


def test_the_wetted_surface_of_wigleys_hull_is_that_of_its_girths(tmp_path):
    """y = (B/2)(1 − (2x/L)²)(1 − (z/T)²): ∫∫ 2 √(1 + y_z²) dz dx, by quadrature of the surface itself.

    Straight lines between 41 waterlines are shorter than the parabola by its turn in a step, 1e-4; Simpson's rule with
    41 stations is as near.
    """
    long, broad, deep = 100.0, 10.0, 6.25
    lines = ["station,z,half_breadth"]
    for x in np.linspace(-long / 2.0, long / 2.0, 41):
        for z in np.linspace(-deep, 0.0, 41):
            half = 0.5 * broad * (1.0 - (2.0 * x / long) ** 2) * (1.0 - (z / deep) ** 2)
            lines.append(f"{x + long / 2.0:.9g},{z + deep:.9g},{half:.9g}")
    path = tmp_path / "wigley.csv"
    path.write_text("\n".join(lines) + "\n")

    def slope(z, x):
        return 2.0 * np.hypot(1.0, broad * (1.0 - (2.0 * x / long) ** 2) * z / deep**2)

    asked = dblquad(slope, -long / 2.0, long / 2.0, -deep, 0.0)[0]
    assert cargolab.hull(path).at(deep).wetted == pytest.approx(asked, rel=5e-4)


def test_the_girth_of_a_ring_is_its_arc_under_water():
    turn = np.linspace(0.0, 2.0 * np.pi, 4000, endpoint=False)
    ring = np.column_stack([np.cos(turn), np.sin(turn)])
    for level in (-1.5, -0.5, 0.0, 0.5, 1.5):
        asked = 2.0 * (np.pi - np.arccos(np.clip(level, -1.0, 1.0)))
        assert wetted_girth(ring, level) == pytest.approx(asked, abs=1e-5)


@pytest.mark.parametrize("deepest", [0.17, 1.0, 9.49, 13.3, 25.0])
def test_draughts_are_round(deepest):
    found = round_draughts(deepest)
    assert LEAST_DRAUGHTS <= len(found) <= 2.5 * LEAST_DRAUGHTS + 1
    leading = {f"{found[0]:e}"[:3].rstrip(".0")}
    assert leading <= {"1", "2", "5"} and found == pytest.approx(found[0] * np.arange(1, len(found) + 1))
    assert found[-1] <= deepest < found[-1] + found[0]
    assert round_draughts(deepest, 0.05) == pytest.approx(0.05 * np.arange(1, int(deepest / 0.05 + 1e-9) + 1))


def test_what_a_hull_cannot_have_is_refused_in_a_sentence(box):
    for how, said in (
        ({}, "give a draught"),
        ({"draught": 5.0, "displacement": 9.0}, "one of them"),
        ({"draught": 14.5}, "the draught of 14.5 m"),
        ({"draught": 13.9, "trim": 1.0}, "13.4 to 14.4 m of her under water"),
        ({"displacement": 1e6}, "up to her deck she displaces 50368 t"),
        ({"displacement": -1.0}, "is not hers"),
    ):
        with pytest.raises(LabError, match=said):
            box.at(**how)
    with pytest.raises(LabError, match=r"--step: 20 m gives 0 draughts up to 13\.3 m"):
        box.table(step=20.0)


def test_the_command_gives_the_same_rows_as_python(box, file, tmp_path):
    def rows(*words):
        done = CliRunner().invoke(main, ["hull", str(file), "--json", "--out", str(tmp_path), *words])
        assert done.exit_code == 0, done.output
        return json.loads(done.stdout)["hydrostatics"]

    table = box.table(step=0.5)
    found = rows("--step", "0.5")
    assert [row["T m"] for row in found] == pytest.approx(table["draught"].tolist())
    assert [row["KML m"] for row in found] == pytest.approx(table["kml"].tolist(), abs=0.006)
    assert [row["wetted m2"] for row in found] == pytest.approx(table["wetted"].tolist(), abs=0.06)
    asked = rows("--draught", "8.617", "--displacement", "31000", "--trim", "0.796")
    assert [row["displacement t"] for row in asked] == pytest.approx([31001.8, 31000.0], abs=0.06)
    refused = CliRunner().invoke(main, ["hull", str(file), "--draught", "5", "--step", "1", "--out", str(tmp_path)])
    assert refused.exit_code == 2 and "--step: is of a table at round draughts" in refused.output
