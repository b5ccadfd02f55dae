"""Every mistake in a ship file is one sentence with its line, the key and what to do."""

import pytest

from lab.naval.ship_file.lines import line_of, places
from lab.naval.ship_file.ship import read_ship
from tests.oracles.presets import error_of
from tests.oracles.ship_file import BOX, changed, write


@pytest.fixture
def box(tmp_path):
    return write(tmp_path)


def line(text: str) -> int:
    """The line of the file on which a text stands."""
    return next(number for number, one in enumerate(BOX.splitlines(), start=1) if text in one)


@pytest.mark.parametrize(
    ("old", "new", "at", "said"),
    [
        ("lever = 10", "lever = ", "lever = 10", "not valid TOML: Invalid value"),
        ("lever = 10", "levr = 10", "lever = 10", "wind.levr: unknown key; did you mean 'lever'?"),
        ("lever = 10", 'lever = "10 t"', "lever = 10", 'wind.lever: "10 t" is a mass'),
        ("area = 1500", "area = -3", "area = 1500", "wind.area: must be at least 0"),
        ("place = [65, 12, 12]", "place = [65, 12]", "place =", "openings.hatch.place: a list of 3 is needed"),
        ('lines = "box.csv"', 'lines = "hull.csv"', "lines =", "hull.lines: there is no file hull.csv beside"),
        ('lines = "box.csv"', 'lines = "box.csv"\nlbp = 500', "lines =", "hull.lbp: 500 m is no length of a hull"),
        ("forward = 75", "forward = 45", "forward = 75", "holds.h3.forward: 45 m must be forward of aft, 50 m"),
        ("forward = 75", "", "[holds.h3]", "holds.h3: has no forward; give aft, forward and section, or lengths"),
        ("[13.3, 5.9]", "[14, 5.9]", "[holds.h3]", "holds.h3: stands out of the hull at x 50, y 14, z 5.9 m"),
        ("[13, 2], [13, 6]", "[13, 6], [13, 2]", "[[9, 2]", "tanks.wing.section: its outline crosses or touch"),
        ("[9, 2], [13, 2]", "[-9, 2], [13, 2]", 'side = "pair"', "tanks.wing.side: pair is of a section with y of at"),
        ("aft = 80", "aft = 70", "[holds.h3]", "holds.h3: shares 47.6 m3 with tanks.wing-p"),
        ("density = 1000", "density = 1.025", "density = 1000", "tanks.wing.density: must be at least 500 kg/m^3"),
        ('full = "50 %"', "full = 95", "wing = { full", "conditions.departure.fills.wing.full: must be at most 1"),
        ('full = "50 %"', "level = 7", "wing = { full", "wing.level: a level of 7 m must be at least 2"),
        ('full = "50 %"', 'full = 0.5, mass = 3', "wing = { full", "fills.wing: has full and mass; give one of"),
        ("wing-p = {", "wings = {", "wing-p", "fills.wings: there is no tank of that name; the tanks are wing-p"),
        ("h3 = { level = 7.93", "h3 = { mass = 90000", "h3 = {", "cargo.h3.mass: 1.17e+05 m3 must be at least 0"),
        ('filling = "partly-filled"', 'filling = "half"', "h3 = {", "cargo.h3.filling: \"half\" is unknown"),
        ("stowage = 1.3, ", "", "h3 = {", "conditions.departure.cargo.h3.stowage: missing; a quantity"),
        ("mass = 9000\nlcg", "lcg", "[weights.lightship]", "weights.lightship: has no mass; give mass (t), or dist"),
        ("aft = 30\n", "", "[weights.ore]", "weights.ore: is spread from aft to forward; give both, or none"),
        ("vcg = 8", "lcg = 80\nvcg = 8", "vcg = 8", "weights.ore.lcg: lies 15 m from the middle of aft and forward"),
        ("mass = 20000", "mass = 90000", "[conditions.departure", "conditions.departure: the weight of "),
    ],
)  # fmt: skip
def test_mistakes_are_told_with_their_line(box, old, new, at, said):
    found = error_of(read_ship, changed(box, old, new))
    below = "lbp" in new  # a line that the text does not have
    assert found.startswith(f"ship.toml: line {line(at) + below}: "), found
    assert said in found


def test_an_unknown_key_in_a_list_of_lengths_is_told(box):
    """And the line of a wrong length is its own, also if two stand on one line."""
    lengths = """lengths = [
  { aft = 50, forward = 60, section = [[0, 2], [9, 2], [9, 6], [0, 6]] },
  { aft = 60, forward = 75, sectoin = [[0, 2], [9, 2], [9, 6], [0, 6]] },
]"""
    section = next(one for one in BOX.splitlines() if one.startswith("section = [[0, 1.6]"))
    changed(box, f"aft = 50\nforward = 75\n{section}", lengths)
    at = line("[holds.h3]") + 4
    found = error_of(read_ship, box)
    assert found.startswith(f"ship.toml: line {at}: holds.h3.lengths[1].sectoin: unknown key"), found
    changed(box, "sectoin", "section")
    found = error_of(read_ship, changed(box, "forward = 60", "forward = 61"))
    assert f"line {at}: holds.h3.lengths[1].aft: 60 m lies in the length before, which ends at 61 m" in found


def test_lines_of_keys():
    text = 'a = 1\n[b."c d"]\nx = [ # [ {\n  [1, 2], [3,\n 4],\n  [5, 6],\n]\ny.z = """\nx = 2\n[no]\n"""\n'
    text += "[e]\nq = {r = 1}\n"
    known = places(text)
    expected = {"a": 1, "b": 2, "b.c d.x": 3, "b.c d.x[0]": 4, "b.c d.x[1]": 4, "b.c d.x[2][0]": 6, "b.c d.y.z": 8}
    expected |= {"e.q.r": 13, "e.w": 12, "no": None}
    known[("b",)] = 2
    assert {key: line_of(known, key) for key in expected} == expected


def test_a_folder_without_a_ship_file(tmp_path):
    assert "cannot be read" in error_of(read_ship, tmp_path)
