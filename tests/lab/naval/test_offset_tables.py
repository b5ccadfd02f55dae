"""Offsets and weights as spreadsheets leave them: all forms are the same hull, what is unclear is asked."""

import numpy as np
import pytest

from lab.assembly.lines.offsets import COLUMNS, from_offsets, read_offsets, rows_of
from lab.naval.hull import read_hull
from lab.naval.weights import read_weights
from lab.preset.tables import read_table
from lab.report.hull import Asked, examine
from solvers.ship.water import Water
from tests.oracles.presets import error_of

LENGTH, BREADTH, DEPTH = 100.0, 10.0, 6.25  # m, of Wigley's hull up to her waterline
STATIONS, LEVELS = np.linspace(0.0, LENGTH, 11), np.linspace(0.0, DEPTH, 7)
HALF = np.round(
    0.5 * BREADTH * np.outer(1.0 - (2.0 * STATIONS / LENGTH - 1.0) ** 2, 1.0 - (1.0 - LEVELS / DEPTH) ** 2), 6
)
FLAT = [(x, z, y) for x, row in zip(STATIONS, HALF, strict=True) for z, y in zip(LEVELS, row, strict=True)]


def cells(value: float, comma: bool = False) -> str:
    return f"{value:.9g}".replace(".", "," if comma else ".")


def columns(header: str, by: str = ",", comma: bool = False, times: float = 1.0) -> str:
    """A row a point; the last number `times` as large."""
    rows = [by.join(cells(value, comma) for value in (x, z, times * y)) for x, z, y in FLAT]
    return "\r\n".join([header, *rows, ""])


def matrix(corner: str, by: str = ",", comma: bool = False, times: float = 1.0, **more) -> str:
    """A row a station, or with `turned` a row a waterline; `words` before the places of stations and waterlines."""
    words, unit = more.get("words", ("", "")), more.get("unit", "")
    rows = [[corner, *(words[1] + cells(z, comma) + unit for z in LEVELS)]]
    for x, row in zip(STATIONS, HALF * times, strict=True):
        rows.append([words[0] + cells(x, comma) + unit, *(cells(y, comma) for y in row)])
    rows = list(zip(*rows, strict=True)) if more.get("turned") else rows
    return "\n".join(by.join(row) for row in rows) + "\n"


GOOD = {
    "as the lab has it": columns("station,z,half_breadth"),
    "names with units": columns("Station [m],z (m),Half-breadth [m]"),
    "tabs and decimal commas": columns("Station\tWL\ty", "\t", comma=True),
    "blanks": columns("Station [m] z [m] half_breadth", " "),
    "full breadths": columns("x;z;full_breadth [m]", ";", times=2.0),
    "a matrix": matrix("Station/WL"),
    "a matrix turned": matrix("", turned=True),
    "a matrix of blanks with decimal commas": matrix("x\\z", " ", comma=True),
    "a matrix of tabs with words": matrix("", "\t", words=("St. ", "WL "), unit=" m"),
    "a matrix of semicolons": "# lines of the yard\n\n" + matrix("Half-breadths (m)", ";", comma=True, turned=True),
    "a matrix of full breadths": matrix("Full breadth", times=2.0),
}


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "utf-16-le", "latin-1"])
@pytest.mark.parametrize("name", GOOD)
def test_all_forms_of_a_table_are_the_same_hull(name, encoding, tmp_path):
    path = tmp_path / "hull.csv"
    path.write_bytes(GOOD[name].encode(encoding))
    found, expected = read_offsets(path), from_offsets(*np.array(FLAT).T)
    assert found.x == pytest.approx(expected.x)
    for one, other in zip(found.sections, expected.sections, strict=True):
        assert (one is None) == (other is None)
        if one is not None:
            assert one.outline == pytest.approx(other.outline, abs=1e-6)


def test_latin_letters_are_no_hindrance(tmp_path):
    path = tmp_path / "hull.csv"
    path.write_bytes(("# Spanten, gemessen für die Werft\n" + matrix("Spant", ";", comma=True)).encode("latin-1"))
    assert read_offsets(path).volume == pytest.approx(from_offsets(*np.array(FLAT).T).volume, rel=1e-6)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (columns("station,z,breadth"), "the column breadth may be a half-breadth or a full one; call it half_breadth"),
        (matrix("Breadth [m]"), "Breadth [m] may be a half-breadth or a full one"),
        (columns("station [mm],z,half_breadth"), "line 1: station [mm] is not in metres; give all lengths in m."),
        (matrix("[mm]"), "[mm] is not in metres"),
        (matrix("", unit=" mm"), "0 mm is not in metres"),
        (columns("station,z,half_breadth", times=1000.0), "half-breadths go up to 5000 m, more than any ship's; give"),
        (columns("station,half_breadth,remark"), 'unknown column "remark"; a table of offsets has station, z and'),
        (columns("station,z,y").replace("100,0,0", "100,0"), "has 2 cells for 3 columns"),
        (columns("station,z,y").replace("100,0,0", "100,0,deck"), 'a number is needed for half_breadth (got "deck")'),
        (columns("station;z;y", ";").replace("100;0;0", "100;0,5;0"), "decimals are behind a comma in line"),
        (columns("").lstrip(), "0 m is there twice as a place of the matrix; a table with a row a point begins with"),
        (matrix("").replace("\n10,", "\nhere,"), 'the place of a station or waterline is needed in m (got "here")'),
        ("station,z,half_breadth\n" + "".join(f"{k},{z},9\n" for k in range(11) for z in (0, 9)), "not its number"),
        ("station,z,half_breadth\n", "has no numbers below its column names"),
        ("\n", "is empty"),
        ("a\0b", "is no text but binary data"),
    ],
)
def test_what_is_no_table_of_offsets_is_one_sentence(text, words, tmp_path):
    path = tmp_path / "hull.csv"
    path.write_text(text)
    told = error_of(read_offsets, path)
    assert words in told and told.startswith("hull.csv: ") and told.count(". ") == 0


def test_empty_cells_and_zeros_are_where_she_is_not(tmp_path):
    """A counter over the water, a bulb with a stem above it, an even deck: areas by hand."""
    path = tmp_path / "hull.csv"
    rows = ("z,0,2,4,6,8", "0,,0,0,0,2", "20,0,0,0,3,3", "40,3,3,3,3,3", "60,0,1,0,0,1", "80,0,1,0,-,")
    path.write_text("\n".join(["station" + rows[0], *rows[1:]]).replace("stationz", "x"))
    areas = [section.area for section in read_offsets(path).sections]
    assert areas == pytest.approx([4.0, 18.0, 48.0, 6.0, 4.0], rel=1e-4)


def test_fair_lines_are_those_of_a_parabola(tmp_path):
    """Chords of a parabola over n equal distances lack 1/(4 n²) of its area: 0.7 % with 7 waterlines, fair in 48."""
    path = tmp_path / "hull.csv"
    path.write_text(GOOD["as the lab has it"])
    exact = 4.0 / 9.0 * LENGTH * BREADTH * DEPTH
    for curved, pieces in ((False, 6), (True, 48)):
        found = read_offsets(path, curved).hydrostatics(DEPTH, Water()).volume
        assert found == pytest.approx(exact * (1.0 - 0.25 / pieces**2), rel=1e-6)


def test_fair_lines_leave_a_box_and_its_written_offsets_as_they_are(tmp_path):
    rows = [(x, z, y) for x in (0, 20, 40) for z, y in ((0, 0), (0, 5), (2, 5), (4, 5), (6, 5))]
    straight, fair = (from_offsets(*np.array(rows, dtype=float).T, curved=curved) for curved in (False, True))
    assert fair.volume == pytest.approx(straight.volume, rel=1e-12)
    assert from_offsets(*np.array(list(rows_of(fair))).T).volume == pytest.approx(straight.volume, rel=1e-9)


def test_a_preset_takes_no_breadth_for_half_of_it(tmp_path):
    path = tmp_path / "hull.csv"
    path.write_text(columns("station,z,breadth"))
    told = error_of(read_table, str(path), COLUMNS)
    assert told.endswith('unknown column "breadth"; known here: station, z, half_breadth.')


def test_weights_of_a_spreadsheet(tmp_path):
    path, plain = tmp_path / "weights.csv", tmp_path / "plain.csv"
    path.write_bytes("Name;Mass [t];LCG [m];TCG;VCG [m]\nÖl, vorn;1000,5;34;-0,5;2,25\n".encode("utf-16"))
    plain.write_text('name,mass,lcg,tcg,vcg\n"Öl, vorn",1000.5,34,-0.5,2.25\n', encoding="utf-8")
    assert read_weights(path) == read_weights(plain)
    path.write_text("name,mass [kg],lcg,tcg,vcg\nall,1000,0,0,1\n")
    assert error_of(read_weights, path) == "weights.csv: line 1: mass [kg] has to be in t; give it so."


def test_files_that_are_read_are_not_written_over(tmp_path):
    """A box named offsets.csv that is written anew, and her weights.csv, with the results beside them."""
    box = "".join(f"{x};{z};5\n" for x in (0, 20, 40) for z in (0, 6))
    hull, plain, weights = (tmp_path / f"{name}.csv" for name in ("offsets", "hull", "weights"))
    hull.write_text("x;z;y\n" + box)
    plain.write_text("station;z;half_breadth\n" + box)
    weights.write_text("name,mass,lcg,tcg,vcg\nall,800,20,0,2\n")
    before = hull.read_text(), weights.read_text()
    for path, asked, name in ((hull, Asked(), hull), (plain, Asked(weights=weights), weights)):
        told = error_of(examine, path, tmp_path, asked)
        assert told == f"--out: {name} was read and would be written over; choose another folder."
    assert (hull.read_text(), weights.read_text()) == before


def test_stations_too_uneven_for_simpsons_rule_are_refused(tmp_path):
    """A barge with bevelled ends has more than its box by parabolas over 4, 32 and 4 m; even stations are exact."""
    path = tmp_path / "barge.csv"
    for stations, holds in (((0.0, 4.0, 36.0, 40.0), False), (np.linspace(0.0, 40.0, 21), True)):
        rows = [(x, z, 5.0 * min(1.0, x / 4.0, (40.0 - x) / 4.0)) for x in stations for z in (0.0, 4.0)]
        path.write_text("x,z,y\n" + "".join(f"{x},{z},{y}\n" for x, z, y in rows))
        if holds:
            assert read_hull(path).form.volume == pytest.approx(1440.0, rel=5e-3)
        else:
            assert "between x = 4 m and 36 m" in error_of(lambda: read_hull(path))
