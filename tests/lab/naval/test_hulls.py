"""Hulls from offsets and surfaces: closed forms, published hulls, one against the other, and what is refused."""

import re
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from lab.assembly.lines.offsets import from_offsets, read_offsets
from lab.cli.naval import hull
from lab.naval.surfaces.read import read_surface
from lab.naval.weights import read_weights
from lab.report.hull import outline_at
from solvers.machine.errors import Unavailable
from solvers.ship.naval.form import prism
from solvers.ship.section import box
from solvers.ship.water import Water
from tests.oracles.presets import error_of
from tests.oracles.surfaces import stl, tube

SEA, FRESH = Water(1025.0), Water(1000.0)
LENGTH, BREADTH, DRAUGHT = 100.0, 10.0, 6.25  # m, of Wigley's hull
DATA = Path(__file__).parents[2] / "data"


def wigley(stations: int = 41, levels: int = 81) -> np.ndarray:
    """Offsets (n, 3) of Wigley's hull (1942), y = B/2 (1 − ξ²)(1 − ζ²), its sides upright above the water."""
    rows = []
    for xi in np.linspace(-1.0, 1.0, stations):
        z = DRAUGHT * np.linspace(0.0, 1.0, levels)
        y = 0.5 * BREADTH * (1.0 - xi**2) * (1.0 - (1.0 - z / DRAUGHT) ** 2)
        rows += [(0.5 * LENGTH * (1.0 + xi), *pair) for pair in zip(z, y, strict=True)]
        rows.append((0.5 * LENGTH * (1.0 + xi), 1.3 * DRAUGHT, y[-1]))
    return np.array(rows)


def of(rows: np.ndarray):
    return from_offsets(*np.array(rows, dtype=float).T)


def test_box_has_the_closed_forms():
    form, heel = prism(box(27.0, 14.0), 130.0), np.radians([5.0, 10.0, 15.0])
    found = form.hydrostatics(9.7, SEA)
    expected = {
        "volume": 27.0 * 9.7 * 130.0,
        "displacement": 1.025 * 27.0 * 9.7 * 130.0,
        "kb": 9.7 / 2.0,
        "bm": 27.0**2 / (12.0 * 9.7),
        "bml": 130.0**2 / (12.0 * 9.7),
        "lcb": 65.0,
        "lcf": 65.0,
        "tpc": 1.025 * 27.0 * 130.0 / 100.0,
        "mct": 1.025 * 27.0 * 130.0**2 / 1200.0,
        "block": 1.0,
        "plane": 1.0,
    }
    assert {name: getattr(found, name) for name in expected} == pytest.approx(expected, rel=1e-6)
    levers = form.righting_levers(found.displacement, SEA, heel, (0.0, found.km - 2.0))
    wall_sided = np.sin(heel) * (2.0 + 0.5 * found.bm * np.tan(heel) ** 2)  # Scribanti
    assert levers == pytest.approx(wall_sided, rel=1e-6)


def test_box_trims_by_its_longitudinal_metacentre():
    """A centre of gravity 1 m aft of amidships: tan(trim) = 1 m / (GM_L), KG at KB so that GM_L is BM_L, exactly."""
    form = prism(box(27.0, 14.0), 130.0)
    displacement = form.hydrostatics(7.0, SEA).displacement
    level = form.floating(displacement, SEA, lcg=64.0)
    assert (level[0] - level[-1]) / 130.0 == pytest.approx(1.0 * 12.0 * 7.0 / 130.0**2, rel=1e-6)
    assert level.mean() == pytest.approx(7.0, rel=1e-9)


def test_wigley_has_its_closed_forms():
    found = of(wigley()).hydrostatics(DRAUGHT, FRESH)
    volume = 4.0 / 9.0 * LENGTH * BREADTH * DRAUGHT
    expected = {
        "volume": volume,
        "kb": 0.625 * DRAUGHT,
        "bm": 4.0 / 105.0 * BREADTH**3 * LENGTH / volume,
        "bml": BREADTH * LENGTH**3 / 30.0 / volume,
        "lcb": LENGTH / 2.0,
        "lcf": LENGTH / 2.0,
        "block": 4.0 / 9.0,
        "midship": 2.0 / 3.0,
        "prismatic": 2.0 / 3.0,
        "plane": 2.0 / 3.0,
    }
    assert {name: getattr(found, name) for name in expected} == pytest.approx(expected, rel=2e-4)


def test_wigley_converges_with_its_waterlines():
    """Straight lines between waterlines: of second order."""
    exact = 4.0 / 9.0 * LENGTH * BREADTH * DRAUGHT
    off = [abs(of(wigley(41, n + 1)).hydrostatics(DRAUGHT, FRESH).volume - exact) for n in (10, 20)]
    assert off[0] / off[1] == pytest.approx(4.0, rel=0.02)


def test_series_60_has_its_published_coefficients():
    """Todd (1963), parent of block 0.70: L/B 7.0, B/T 2.5, Cb 0.70, Cm 0.986, Cp 0.710, Cw 0.785, LCB 0.5 % forward."""
    form = read_offsets(DATA / "series60-cb70.csv")
    length, draught = 30.48, 30.48 / 7.0 / 2.5
    found = form.hydrostatics(draught, FRESH)
    assert found.volume / (length * found.breadth * draught) == pytest.approx(0.70, rel=0.01)
    assert found.midship == pytest.approx(0.986, rel=0.01)
    assert found.waterplane / (length * found.breadth) == pytest.approx(0.785, rel=0.01)
    assert 100.0 * (found.lcb / length - 0.5) == pytest.approx(0.5, abs=0.15)


def test_wigley_as_a_surface(tmp_path):
    rings, given = [], wigley(61, 21)
    for x in np.unique(given[1:-1, 0])[1:-1]:
        z, y = given[given[:, 0] == x][1:, 1:].T
        keel = [[x, 0.0, 0.0]]
        starboard = np.column_stack([np.full_like(z, x), y, z])
        rings.append(np.concatenate([keel, starboard, (starboard * [1, -1, 1])[::-1]]))
    form, _ = read_surface(stl(tmp_path / "wigley.stl", tube(np.array(rings))), 59)
    same = of(given[(given[:, 0] > 0.0) & (given[:, 0] < LENGTH)])
    one, other = (hull.hydrostatics(DRAUGHT, FRESH) for hull in (form, same))
    assert (one.volume, one.km, one.bml) == pytest.approx((other.volume, other.km, other.bml), rel=1e-5)


def test_command_with_weights(tmp_path):
    """A box of 27 × 14 × 130 m as offsets carries what a hand calculation says."""
    rows = "".join(f"{x},{z},13.5\n" for x in (0, 65, 130) for z in (0, 14))
    (tmp_path / "box.csv").write_text("station,z,half_breadth\n" + rows)
    (tmp_path / "weights.csv").write_text(
        "name,mass,lcg,tcg,vcg,fsm\nlightship,10000,65,0,9,\ncargo,20000,65,0,8,\nfuel,1000,65,0,2,1550\n"
    )
    total, _ = read_weights(tmp_path / "weights.csv")
    assert (total.mass, total.vcg, total.fluid_vcg) == pytest.approx((31e3, 252e3 / 31e3, 252e3 / 31e3 + 0.05))
    given = [
        str(tmp_path / "box.csv"),
        "--weights",
        str(tmp_path / "weights.csv"),
        "--out",
        str(tmp_path / "out"),
        "--at",
        "0",
    ]
    answer = CliRunner().invoke(hull, given)
    assert answer.exit_code == 0, answer.output
    draught = 31e3 / (1.025 * 27.0 * 130.0)
    gm = draught / 2 + 27.0**2 / (12 * draught) - total.fluid_vcg
    assert (
        f"aft {draught:.3f}, forward {draught:.3f} m" in answer.output
        and f"GM fluid         {gm:.3f} m" in answer.output
    )
    assert {path.name for path in (tmp_path / "out").iterdir()} == {
        *(f"{name}.csv" for name in ("hydrostatics", "cross-curves", "criteria", "righting-levers", "weights")),
        "righting-levers.png",
    }
    assert '["13.5 m", "14 m"]' in answer.output
    assert (
        len(re.findall(r"^ +[0-9.]+ +[0-9.]+ +65\.000 .* 1\.0000$", answer.output, re.MULTILINE)) == 13
    )  # a row a draught


def test_weight_off_the_middle_lists_her_to_starboard(tmp_path):
    """tcg to starboard: starboard down, positive in naval output, by tan φ = tcg / GM while she is wall-sided."""
    (tmp_path / "box.csv").write_text(
        "station,z,half_breadth\n0,0,13.5\n0,14,13.5\n65,0,13.5\n65,14,13.5\n130,0,13.5\n130,14,13.5\n"
    )
    (tmp_path / "weights.csv").write_text("name,mass,lcg,tcg,vcg\nall,31000,65,0.1,9\n")
    answer = CliRunner().invoke(
        hull, [str(tmp_path / "box.csv"), "--weights", str(tmp_path / "weights.csv"), "--out", str(tmp_path / "out")]
    )
    draught = 31e3 / (1.025 * 27.0 * 130.0)
    gm = draught / 2 + 27.0**2 / (12 * draught) - 9.0
    heel = float(answer.output.split("  list ")[1].split(" deg to starboard")[0])
    assert heel == pytest.approx(np.degrees(0.1 / gm), abs=0.06)
    first = (tmp_path / "out" / "righting-levers.csv").read_text().splitlines()[:2]
    assert first == ["heel to starboard deg,GZ m", "0.0,-0.1000"]  # upright she is pulled to starboard


def test_offsets_that_bound_no_hull():
    good = [(0, 0, 1), (0, 2, 1), (5, 0, 1), (5, 2, 1), (9, 0, 1), (9, 2, 1)]
    assert "station 9 m crosses itself" in error_of(of, [*good[:4], (9, 2, 1), (9, 0, 1)])
    assert "half_breadth below 0" in error_of(of, [*good[:5], (9, 2, -1)])
    assert "three stations" in error_of(of, good[:2])
    assert "no station with an area" in error_of(of, [(x, z, 0) for x in (0, 5, 9) for z in (0, 2)])


def test_weights_that_are_none(tmp_path):
    path = tmp_path / "w.csv"
    path.write_text("name,mass,lcg,tcg,vcg\nship,many,1,1,1\n")
    assert "row 1 (ship) needs a number of at least 0 for mass (got many)" in error_of(read_weights, path)
    path.write_text("name,mass\nship,5\n")
    assert "columns name, mass, lcg, tcg, vcg" in error_of(read_weights, path)
    form = prism(box(10.0, 5.0), 50.0)
    with pytest.raises(Unavailable, match="does not float"):
        form.floating(3000.0, SEA)
    with pytest.raises(Unavailable, match="beyond what the hull can trim"):
        form.floating(1000.0, SEA, lcg=60.0)


def test_section_at_a_station():
    text = outline_at(of(wigley(5, 3)), 52.0)
    assert text.startswith("# the section at 50 m\n[ship]\noutline = [[")
