"""A hull with weights, openings, holds and grain: the sheet of the preset of that ship, closed forms, bad input."""

import csv
from importlib.resources import files as files_of
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from lab.assembly.lines.offsets import from_offsets, read_offsets
from lab.assembly.scene import vessels
from lab.cli.naval import hull
from lab.naval import sheet
from lab.naval.compartments import read_holds
from lab.naval.condition import condition
from lab.naval.loaded import Loaded, Wind
from lab.naval.points import check_near, read_points
from lab.naval.stowed import Stowed, read_stowed
from lab.naval.weights import Weights, read_weights
from lab.preset.find import load
from lab.report.hull import Asked, examine
from solvers.ship.naval.form import Form, prism
from solvers.ship.naval.immersion import deck_edges
from solvers.ship.section import Section, box
from solvers.ship.water import Water
from tests.oracles.presets import error_of

SEA, LENGTH, HALF, DEPTH, DRAUGHT, KG = Water(1025.0), 130.7, 13.5, 14.0, 9.7, 9.11
MASS = 1.025 * LENGTH * 2.0 * HALF * DRAUGHT
HOLD = "9 1.6, 13.3 5.9, 13.3 9.96, 7 13.6, 7 14"  # half-breadth and z of the Handysize's


@pytest.fixture
def files(tmp_path) -> dict[str, Path]:
    """The Handysize as tables."""
    corners = [pair.split() for pair in HOLD.split(", ")]
    texts = {
        "hull": ["station,z,half_breadth", *(f"{x},{z},{HALF}" for x in (0, 60, LENGTH) for z in (0, DEPTH))],
        "weights": ["name,mass,lcg,tcg,vcg", f"all,{MASS},{LENGTH / 2},0,{KG}"],
        "points": ["name,kind,x,y,z", "hatch,opening,65,12,12"],
        "holds": ["hold,aft,forward,z,half_breadth", *(f"3,50,75,{z},{half}" for half, z in corners)],
        "grain": ["name,filling,stowage,moment,level", "3,partly-filled,1.3,,7.93"],
    }
    return {name: _write(tmp_path / f"{name}.csv", lines) for name, lines in texts.items()}


def _write(path: Path, lines: list[str]) -> Path:
    path.write_text("\n".join(lines) + "\n")
    return path


def of_box(tcg: float = 0.0, **more) -> Loaded:
    """The Handysize's box."""
    form = prism(box(2.0 * HALF, DEPTH), LENGTH)
    return Loaded(form, SEA, Weights(MASS, LENGTH / 2, tcg, KG, 0.0), **more)


def by_name(rows) -> dict[str, float]:
    """What was attained, rounded as it is printed."""
    found = {f"{row.criterion.rule} {row.criterion.what}": row.criterion for row in rows}
    return {name: float(sheet.shown(one.attained, one.unit)) for name, one in found.items()}


def test_tables_of_the_preset_give_its_sheet(files, tmp_path):
    """`cargolab hull` with the Handysize as tables attains what `cargolab stability` does with her preset."""
    preset = load("ship/handysize-grain", {"stability.length": False}).resolved
    expected = by_name(sheet.rows(condition(preset, vessels(preset)[0])))
    del files["points"]
    given = [text for name, path in files.items() if name != "hull" for text in (f"--{name}", str(path))]
    given = [str(files["hull"]), *given, "--wind", "1500", "10", "--out", str(tmp_path / "out")]
    answer = CliRunner().invoke(hull, given)
    assert answer.exit_code == 0, answer.output
    with (tmp_path / "out" / "criteria.csv").open() as file:
        found = {f"{row['rule']} {row['criterion']}": float(row["attained"]) for row in csv.DictReader(file)}
    assert found == pytest.approx(expected, rel=2e-3, abs=1e-4)
    assert "No opening limits her levers" in answer.output
    grain = (tmp_path / "out" / "grain.csv").read_text().splitlines()
    arm = 13_920.0 * 1.12 / 1.3 / MASS  # by the preset's hold, see docs/naval/grain.md
    assert float(grain[-2].split(",")[-1]) == pytest.approx(arm, rel=1e-3)
    assert float(grain[-1].split(",")[-1]) == pytest.approx(0.8 * arm, rel=1e-3)
    last = (tmp_path / "out" / "hold-3.csv").read_text().splitlines()[-1].split(",")
    assert float(last[1]) == pytest.approx(25.0 * 283.376, rel=1e-4)  # full: the area of the outline


def slope_of_levers(ship: Loaded, heel: float = 1e-4) -> float:
    """dGZ/dφ (m) upright, trimming freely, by a central difference whose error is of the order GM φ²."""
    given = ship.weights
    levers = ship.form.righting_levers(
        given.mass, SEA, np.array([-heel, heel]), (given.tcg, given.fluid_vcg), given.lcg
    )
    return float(np.diff(levers)[0]) / (2.0 * heel)


@pytest.mark.parametrize("aside", [0.0, 3.0])
def test_trimmed_box_has_the_metacentre_of_her_own_waterplane(aside):
    """G lies d aft of amidships: t = 12 T d/L; KB = T/2 + t²/24T, BM = B²/12T, also if y is not from her middle."""
    middle = np.add(box(2.0 * HALF, DEPTH).outline, [aside, 0.0])
    ship = Loaded(prism(Section(middle), LENGTH), SEA, Weights(MASS, LENGTH / 2 - 8.0, aside, KG, 0.0))
    trim, found = 12.0 * DRAUGHT * 8.0 / LENGTH, ship.upright
    assert ship.draughts[0] - ship.draughts[1] == pytest.approx(trim, rel=1e-9)
    kb, bm = DRAUGHT / 2.0 + trim**2 / (24.0 * DRAUGHT), (2.0 * HALF) ** 2 / (12.0 * DRAUGHT)
    assert (found.kb, found.bm, found.displacement) == pytest.approx((kb, bm, MASS), rel=1e-9)
    assert ship.metacentric_height == pytest.approx(kb + bm - KG, rel=1e-9)
    assert slope_of_levers(ship) == pytest.approx(ship.metacentric_height, rel=1e-6)


def test_trimmed_container_ship_has_the_metacentre_of_her_own_levers():
    """S175 by the stern, also with her sides unlike: GM is the slope of GZ, and what floats is what she weighs."""
    lines = read_offsets(Path(str(files_of("presets"))) / "ship" / "s175.csv")
    sheared = [
        one and Section(np.add(one.outline, [0.01 * x, 0.0])) for x, one in zip(lines.x, lines.sections, strict=True)
    ]
    for form in (lines, Form(lines.x, tuple(sheared))):
        ship = Loaded(form, SEA, Weights(15_000.0, 78.0, 0.0, 8.0, 0.0))
        assert ship.upright.displacement == pytest.approx(15_000.0, rel=1e-9)
        assert slope_of_levers(ship) == pytest.approx(ship.metacentric_height, rel=1e-5)


def test_deck_edge_and_opening_of_a_box():
    """Wall-sided: tan φ = freeboard over half the breadth, and (z − T)/y of an opening."""
    opening = {"opening": np.array([[65.0, 12.0, 12.0], [65.0, -5.0, 13.9]])}
    ship = of_box(points=opening)
    assert np.tan(ship.deck_edge_angle) == pytest.approx((DEPTH - DRAUGHT) / HALF, rel=1e-6)
    assert np.tan(ship.flooding) == pytest.approx((12.0 - DRAUGHT) / 12.0, rel=1e-6)
    port = of_box(tcg=-0.05, points=opening)
    assert port.side == "port" and port.flooding > ship.flooding  # the low one is to starboard
    edge = of_box(points={"deck": np.array([[0.0, HALF, 10.7]])})
    assert np.tan(edge.deck_edge_angle) == pytest.approx(1.0 / HALF, rel=1e-6)


def test_deck_edge_of_a_flared_side_is_its_top():
    """A counter that opens outwards by 60 deg from upright is side up to the deck, also with a wall below."""
    counter = Section(np.array([[0.0, 5.0], [1.0, 6.0], [8.0, 9.0], [-8.0, 9.0], [-1.0, 6.0]]))
    assert sorted(map(tuple, deck_edges(prism(counter, 50.0))[:2])) == [(0.0, -8.0, 4.0), (0.0, 8.0, 4.0)]
    lines = read_offsets(Path(str(files_of("presets"))) / "ship" / "s175.csv")
    assert {z for _, _, z in deck_edges(lines)} == {11.0}  # where her lines end


@pytest.mark.slow
def test_opening_forward_of_a_ship_by_the_head_goes_under_sooner():
    """Trimmed by t she has t x/L less at an opening: the closed form of the even keel, with that draught."""
    head = Weights(MASS, LENGTH / 2 + 1.0, 0.0, KG, 0.0)
    angles = []
    for x in (10.0, 120.0):
        ship = Loaded(prism(box(2.0 * HALF, DEPTH), LENGTH), SEA, head, {"opening": np.array([[x, 12.0, 11.0]])})
        aft, fore, _ = ship.draughts
        angles.append(ship.flooding)
        # While no deck or keel is under or out, heel leaves draughts on the middle line as they are.
        assert np.tan(ship.flooding) == pytest.approx((11.0 - aft - (fore - aft) * x / LENGTH) / 12.0, rel=2e-2)
    assert angles[1] < angles[0]


def test_deck_edge_is_where_the_steep_side_ends():
    """A camber and a hatch's coaming on it are no side; a bilge is none either."""
    cambered = Section(np.array([[-9, 0], [9, 0], [10, 1], [10, 6], [0, 6.8], [-10, 6], [-10, 1]]))
    found = deck_edges(prism(cambered, 50.0))
    assert sorted(map(tuple, found[:2])) == [(0.0, -10.0, 6.0), (0.0, 10.0, 6.0)] and len(found) == 6


def test_flooding_makes_her_fail():
    """Each criterion that stops at the angle of flooding, here 10.9 deg: met without the opening, missed with it."""
    low = {"opening": np.array([[65.0, 12.0, 12.0]])}
    grain, wind = (Stowed("3", "partly-filled", 1.3, 13_920.0),), Wind(1500.0, 10.0)
    dry, wet = (sheet.rows(of_box(points=points, grain=grain, wind=wind)) for points in ({}, low))
    assert all(row.criterion.passed for row in dry) and len(dry) == 11
    missed = {row.criterion.rule for row in wet if not row.criterion.passed}
    levers = {"IS Code A 2.2.1", "IS Code A 2.2.2", "IS Code A 2.2.3"}
    assert missed == {"Grain Code A 7.1.2", *levers, "IS Code A 2.3.1.4"}


def test_hull_that_tapers_has_room_straight_between_stations(tmp_path):
    rows = [(x, z, half) for x, half in ((0, 2.0), (50, 8.0), (100, 2.0)) for z in (0, 10)]
    form = from_offsets(*np.array(rows, dtype=float).T)
    lines = "hold,aft,forward,z,half_breadth\n" + "".join(f"1,{{}},60,{z},6\n" for z in (1, 9))
    (tmp_path / "in.csv").write_text(lines.format(34, 34))
    assert read_holds(tmp_path / "in.csv", form)["1"].volume == pytest.approx(26.0 * 8.0 * 12.0)
    (tmp_path / "out.csv").write_text(lines.format(30, 30))
    assert "hold 1: it stands out of the hull at x 30, y 6, z 1 m, where her half-breadth is 5.6 m" in error_of(
        read_holds, tmp_path / "out.csv", form
    )


@pytest.mark.parametrize(
    ("name", "lines", "words"),
    [
        (
            "holds",
            "hold,aft,forward,z,half_breadth\n3,50,75,1,14\n3,50,75,9,14\n",
            "stands out of the hull at x 50, y 14",
        ),
        ("holds", "hold,aft,forward,z,half_breadth\n3,50,175,1,4\n3,50,175,9,4\n", "stations reach from 0 to 130.7 m"),
        ("holds", "hold,aft,forward,z,half_breadth\n3,50,75,9,4\n3,50,75,1,4\n", "from the floor up"),
        ("holds", "hold,aft,forward,z,half_breadth\n3,50,75,1,4\n3,50,76,9,4\n", "the same in all its rows"),
        (
            "grain",
            "name,filling,stowage,level\n3,heaped,1.3,8\n",
            "row 1 (3) has the filling heaped; give partly-filled",
        ),
        ("grain", "name,filling,stowage,level\n4,filled,1.3,8\n", "--holds has no hold of that name"),
        ("grain", "name,filling,stowage,level\n3,filled,1.3,99\n", "at most 14 m"),
        (
            "grain",
            "name,filling,stowage,moment\n3,filled,0,1\n",
            "needs a number of at least 0.001 for stowage (got 0)",
        ),
        ("points", "name,kind,x,y,z\nhatch,hole,1,2,3\n", "row 1 (hatch) has the kind hole; give opening or deck"),
        ("points", "name,kind,x,y,z\nhatch,deck,1,2,high\n", "row 1 (hatch) needs a number for z (got high)"),
        ("points", "name,x\nhatch,1\n", "a table of points has the columns name, kind, x, y, z"),
        ("points", "name,kind,x,y,z,height\nhatch,deck,1,2,3,4\n", 'unknown column "height"'),
    ],
)
def test_bad_tables_are_one_sentence(files, name, lines, words):
    files[name].write_text(lines)
    form = prism(box(2.0 * HALF, DEPTH), LENGTH)
    if name == "points":
        assert words in error_of(read_points, files[name])
    elif name == "holds":
        assert words in error_of(read_holds, files[name], form)
    else:
        assert words in error_of(read_stowed, files[name], read_holds(files["holds"], form))


def test_ship_that_does_not_stand_is_told_so(files, tmp_path):
    """G so high that no lever rights her: no list, no period of roll, all criteria missed; and weights too heavy."""
    told = []
    for mass, height in ((MASS, 14.0), (3 * MASS, KG)):
        _write(files["weights"], ["name,mass,lcg,tcg,vcg", f"all,{mass},{LENGTH / 2},0,{height}"])
        given = [str(files["hull"]), "--weights", str(files["weights"]), "--wind", "1500", "10"]
        given += ["--out", str(tmp_path / "out")]
        told.append(CliRunner().invoke(hull, given))
    high, heavy = told
    assert "none: she comes to rest nowhere" in high.output and "she has none" in high.output
    assert "without a positive GM" in high.output and " pass" not in high.output
    assert "does not float: it must be above 0 and below the 50640 t" in str(heavy.exception)


def test_a_misspelt_column_is_no_free_surface_left_out(tmp_path):
    told = error_of(read_weights, _write(tmp_path / "w.csv", ["name,mass,lcg,tcg,vcg,fsmom", "all,9,1,0,1,500"]))
    assert 'unknown column "fsmom"' in told and "fsm" in told.split(";")[1]
    sums, _ = read_weights(_write(tmp_path / "r.csv", ["name,mass,lcg,tcg,vcg,fsm,Remark", "all,9,1,0,1,500,empty it"]))
    assert sums.free_surface == 500.0


@pytest.mark.parametrize("place", ["65000,12,12", "65,12000,12", "-40,0,12", "65,12,700"])
def test_an_opening_far_from_the_hull_is_refused(tmp_path, place):
    path = _write(tmp_path / "p.csv", ["name,kind,x,y,z", f"hatch,opening,{place}"])
    assert "far from the hull" in error_of(check_near, read_points(path), prism(box(2.0 * HALF, DEPTH), LENGTH), path)


def test_the_opening_that_floods_is_named_and_the_other_side_is_told(files, tmp_path):
    _write(
        files["points"],
        ["name,kind,x,y,z", "vent,opening,60,-12,12", "hatch,opening,65,12,13", "door,opening,65,3,13.9"],
    )
    given = [str(files["hull"]), "--weights", str(files["weights"]), "--points", str(files["points"])]
    told = CliRunner().invoke(hull, [*given, "--out", str(tmp_path / "out")]).output
    ship = of_box(points=read_points(files["points"]), openings=("vent", "hatch", "door"))
    hatch, vent = (np.degrees(np.arctan((z - DRAUGHT) / 12.0)) for z in (13.0, 12.0))  # wall-sided: z' = z − y tan φ
    assert ship.flooded_by == "hatch" and np.degrees(ship.flooding) == pytest.approx(hatch, abs=0.05)
    assert np.degrees(ship.flooding_to_the_other_side) == pytest.approx(vent, abs=0.05)
    assert "by hatch" in told and "Heeled to the other side an opening floods" in told


def test_criteria_need_weights(files, tmp_path):
    told = error_of(examine, files["hull"], tmp_path, Asked(grain=files["grain"]))
    assert told == "--grain: needs --weights, by which she floats; give both."
