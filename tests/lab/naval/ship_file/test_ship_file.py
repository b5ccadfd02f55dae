"""A ship file beside the tables of the same ship, sums by hand, the transfer of liquids in her levers, other units."""

import csv
import json
import re
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

import cargolab
from lab.cli.naval import hull
from lab.naval import sheet, tables
from lab.naval.ship_file import sheets
from lab.naval.ship_file.imperial import imperial
from lab.naval.ship_file.keys import ShipKeys
from lab.naval.ship_file.ship import read_ship
from lab.preset.fields import walk
from tests.oracles.presets import error_of
from tests.oracles.ship_file import HALF, HOLD, LENGTH, changed, write

SHARE = 0.95 * 4.0 * 20.0  # m² that a wing tank fills at each level


@pytest.fixture
def box(tmp_path) -> Path:
    """The Handysize's box as a ship file."""
    return write(tmp_path)


def run(*words: object) -> str:
    answer = CliRunner().invoke(hull, [str(word) for word in words])
    assert answer.exit_code == 0, answer.output
    return answer.output


def rows_of(path: Path) -> list[dict[str, str]]:
    with path.open() as file:
        return list(csv.DictReader(file))


def test_masses_and_centres_of_three_conditions(box):
    """By hand: tanks 4 × 20 m, 0.95 of it, 2 m up; the grain's centre is that of the hold up to its level."""
    ship = cargolab.hull(box)
    departure, mid, arrival = ship.conditions.values()
    area = 2.0 * (0.5 * (9.0 + 13.3) * 4.3 + 13.3 * (7.93 - 5.9))
    grain, water = 25.0 * area / 1.3, 2.0 * SHARE * 2.0
    assert departure.weights.mass == pytest.approx(29_000.0 + water + grain, rel=1e-12)
    moment = 9000.0 * 65.35 + 20_000.0 * 65.0 + water * 90.0 + grain * 62.5
    assert departure.weights.lcg == pytest.approx(moment / departure.weights.mass, rel=1e-12)
    up = 9000.0 * 9.8 + 20_000.0 * 8.0 + water * 3.0
    floor = 9.0 * 4.3 * 0.5 * 4.3 + 0.5 * 4.3 * 4.3 * 2.0 * 4.3 / 3.0 + 13.3 * 2.03 * (4.3 + 0.5 * 2.03)
    centre = 1.6 + floor / (0.5 * area)
    assert departure.weights.vcg == pytest.approx((up + grain * centre) / departure.weights.mass, rel=1e-12)
    fsm = 2.0 * 0.95 * 4.0**3 * 20.0 / 12.0
    assert departure.weights.free_surface == pytest.approx(fsm, rel=1e-9)
    assert mid.weights.mass == pytest.approx(29_300.0)
    assert mid.weights.tcg == pytest.approx((200.0 * 1.5 - 100.0 * 11.0) / 29_300.0)
    assert mid.weights.free_surface == pytest.approx(0.5 * fsm + 30.0)
    assert mid.side == "port" and arrival.water.density == 1000.0
    draughts = [one.weights.mass / one.water.density * 1000.0 / (LENGTH * 2.0 * HALF) for one in (mid, arrival)]
    assert [one.draughts[2] for one in (mid, arrival)] == pytest.approx(draughts, rel=1e-9)
    assert ship.tanks["wing-s"].volume == pytest.approx(0.95 * 4.0 * 4.0 * 20.0)
    assert ship.at(8.0).km > 0.0


def test_the_route_by_tables_gives_the_same_numbers(box, tmp_path):
    """The same hull, weights, points, hold and grain as CSV: the same criteria, levers and grain moments."""
    run(box, "--out", tmp_path / "file")
    weights = (tmp_path / "file" / "departure-weights.csv").read_text().splitlines()
    ship = read_ship(box).conditions["departure"]
    rows = [f"{one.name},{one.mass!r},{one.lcg!r},{one.tcg!r},{one.vcg!r},{one.fsm!r}" for one in ship.items]
    (tmp_path / "weights.csv").write_text("\n".join(["name,mass,lcg,tcg,vcg,fsm", *rows]) + "\n")
    (tmp_path / "points.csv").write_text("name,kind,x,y,z\nhatch,opening,65,12,12\n")
    corners = [f"h3,50,75,{z},{y}" for y, z in HOLD if y]
    (tmp_path / "holds.csv").write_text("\n".join(["hold,aft,forward,z,half_breadth", *corners]) + "\n")
    (tmp_path / "grain.csv").write_text("name,filling,stowage,moment,level\nh3,partly-filled,1.3,,7.93\n")
    given = [
        word for name in ("weights", "points", "holds", "grain") for word in (f"--{name}", tmp_path / f"{name}.csv")
    ]
    run(tmp_path / "box.csv", *given, "--wind", 1500, 10, "--out", tmp_path / "tables")
    names = {
        "departure-righting-levers": "righting-levers",
        "departure-weights": "weights",
        "hydrostatics": "hydrostatics",
    }
    for file, table in names.items():
        own = (tmp_path / "file" / f"{file}.csv").read_text()
        assert own == (tmp_path / "tables" / f"{table}.csv").read_text(), file
    assert len(weights) == 7
    own = [row for row in rows_of(tmp_path / "file" / "criteria.csv") if row.pop("condition") == "departure"]
    assert own == rows_of(tmp_path / "tables" / "criteria.csv") and len(own) == 11
    moments = [rows_of(tmp_path / one)[0] for one in ("file/departure-grain.csv", "tables/grain.csv")]
    assert {row["heeling moment t m"] for row in moments} == {moments[0]["heeling moment t m"]}


def test_levers_by_transfer_lose_what_the_liquid_moves(box):
    """KG is not raised; each tank takes m ((y − y0) cos φ + (z − z0) sin φ)/Δ, here while it meets both its sides."""
    raised = read_ship(box).conditions["departure"]
    moved = read_ship(changed(box, '"second-moment"', '"transfer"')).conditions["departure"]
    heel = np.radians(np.array([-20.0, 10.0, 40.0]))
    still = raised.levers.at(heel) + raised.weights.free_surface / raised.weights.mass * np.sin(heel)
    mass, tan = 2.0 * SHARE * 2.0, np.tan(heel)
    taken = mass * (16.0 * tan / 24.0 * np.cos(heel) + 16.0 * tan**2 / 48.0 * np.sin(heel))
    assert moved.levers.at(heel) == pytest.approx(still - taken / moved.weights.mass, abs=1e-6)
    assert moved.metacentric_height == raised.metacentric_height
    assert moved.levers.metacentric_height == pytest.approx(moved.metacentric_height, rel=1e-3)


def test_nominally_full_tanks_have_no_free_surface_and_consumables_the_largest(box):
    full = read_ship(changed(box, '"50 %"', '"98 %"')).conditions["departure"]
    assert full.weights.free_surface == 0.0
    emptied = read_ship(changed(box, "permeability = 0.95", "permeability = 0.95\nconsumable = true"))
    assert emptied.conditions["departure"].weights.free_surface == pytest.approx(2.0 * 0.95 * 64.0 * 20.0 / 12.0)


def test_weights_spread_along_her(box):
    """A distribution gives mass and centre; a centre beside the middle makes the density rise, m/l (1 + 12 e s/l²)."""
    text = "distribution = [[0, 40, 6000], [40, 130, 3000]]"
    ship = read_ship(changed(box, "mass = 9000\nlcg = 65.35", text)).conditions["arrival"]
    lightship, ore = ship.items[:2]
    assert (lightship.mass, lightship.lcg) == pytest.approx((9000.0, (6000.0 * 20.0 + 3000.0 * 85.0) / 9000.0))
    assert ore.spread == [(30.0, 100.0, 20_000.0)]
    ore = (
        read_ship(changed(box, "forward = 100\nvcg = 8", "forward = 100\nlcg = 69\nvcg = 8"))
        .conditions["arrival"]
        .items[1]
    )
    blocks = np.array(ore.spread)
    middles = 0.5 * (blocks[:, 0] + blocks[:, 1])
    assert blocks[:, 2].sum() == pytest.approx(20_000.0)
    assert blocks[:, 2] @ middles / 20_000.0 == pytest.approx(69.0, abs=0.01)


def test_a_tank_that_narrows_forward(box):
    """A prismatoid: V = l (A_aft + 4 A_middle + A_fore)/6, LCG from ∫ x A dx."""
    text = "section = [[9, 2], [13, 2], [13, 6], [9, 6]]\nforward_section = [[9, 4], [10, 4], [10, 6], [9, 6]]"
    tank = read_ship(changed(box, text.splitlines()[0], text)).tanks["wing-s"]
    middle = 2.5 * 3.0
    assert tank.volume == pytest.approx(0.95 * 20.0 * (16.0 + 4.0 * middle + 2.0) / 6.0, rel=1e-12)
    share = np.linspace(0.0, 1.0, 2001)
    area = (4.0 - 3.0 * share) * (4.0 - 2.0 * share)
    assert tank.centre(tank.volume)[0] == pytest.approx(80.0 + 20.0 * (share @ area) / area.sum(), abs=0.02)
    assert tank.ends == (80.0, 100.0) and tank.floor == pytest.approx(2.0, abs=0.1)


def test_filled_holds_have_the_centre_of_their_whole_volume(box):
    """With it goes the Grain Code's factor of 1.00; filled as loaded has its own centre and 1.06."""
    level, found = 'level = 7.93, stowage = 1.3, filling = "partly-filled"', {}
    changed(box, level, 'full = "97 %", stowage = 1.3, filling = "filled"')
    found["filled"] = read_ship(box).conditions["departure"]
    found["loaded"] = read_ship(changed(box, '"filled"', '"filled-as-loaded"')).conditions["departure"]
    hold = read_ship(box).holds["h3"]
    filled, loaded = (one.cargo[0] for one in found.values())
    assert filled.item.vcg == pytest.approx(float(hold.centre(hold.volume)[2]))
    assert (
        loaded.item.vcg == pytest.approx(float(hold.centre(0.97 * hold.volume)[2]))
        and loaded.item.vcg < filled.item.vcg
    )
    assert loaded.grain.heeling / filled.grain.heeling == pytest.approx(1.06)


def test_sheet_and_tables_in_both_units(box, tmp_path):
    """Feet and long tons are only on paper: each cell of the other sheet by the exact factors."""
    ship = read_ship(box)
    judged = {name: sheet.rows(one) for name, one in ship.conditions.items()}
    metric = {name: tables.objects(table) for name, table in sheets.all_of(ship, judged).items()}
    metric["hydrostatics"] = tables.objects(tables.hydrostatics(ship.form, ship.water, ship.draughts()))
    other = json.loads(run(box, "--out", tmp_path / "i", "--units", "imperial", "--json"))
    foot, long_ton = 0.3048, 1.0160469088
    for one, two in zip(metric["conditions"], other["conditions"], strict=True):
        factor = {"m": 1.0 / foot, "t": 1.0 / long_ton, "t m": 1.0 / long_ton / foot}.get(one["unit"])
        if factor:
            assert two["unit"] == {"m": "ft", "t": "LT", "t m": "LT ft"}[one["unit"]]
            assert two["arrival"] == pytest.approx(one["arrival"] * factor, rel=1e-4, abs=0.006)
    tank = metric["tank-wing-s"][9], other["tank-wing-s"][9]
    assert tank[0]["level m"] == pytest.approx(4.0) and tank[0]["FSM t m"] == pytest.approx(101.3)
    assert tank[1]["volume ft3"] == pytest.approx(152.0 / foot**3, rel=1e-3)
    hydro = metric["hydrostatics"][0], other["hydrostatics"][0]
    assert hydro[1]["TPC LT/in"] == pytest.approx(hydro[0]["TPC t/cm"] * 2.54 / long_ton, rel=1e-3)
    assert hydro[1]["Cb"] == hydro[0]["Cb"]


def test_imperial_leaves_texts_and_angles():
    header, (line,) = imperial((("heel deg", "GZ m", "name"), [("10.0", "1.000", "m")]))
    assert header == ["heel deg", "GZ ft", "name"] and line == ("10.0", "3.28", "m")


def test_the_labs_own_handysize_meets_the_codes_in_three_conditions():
    """`ship/handysize` by its name: it floats near its marks, with free surfaces, and all its conditions are judged."""
    ship = cargolab.hull("ship/handysize")
    assert list(ship.conditions) == ["departure", "mid", "arrival"]
    assert sum(hold.volume for hold in ship.holds.values()) == pytest.approx(33_000.0, rel=0.02)
    for one in ship.conditions.values():
        assert 8.0 < one.draughts[2] < 9.78 and one.metacentric_height < one.solid_gm
        assert abs(one.draughts[0] - one.draughts[1]) < 1.0 and one.assumed_arm == pytest.approx(0.297, abs=0.01)


def test_options_that_the_file_replaces_are_refused(box, tmp_path):
    answer = CliRunner().invoke(hull, [str(box), "--lbp", "100", "--out", str(tmp_path / "o")])
    assert isinstance(answer.exception, Exception) and "write hull.lbp in the file" in str(answer.exception)
    said = error_of(lambda: cargolab.hull(box, fair=True))
    assert said.startswith("ship.toml: a ship file says the options of the hull itself")


def test_the_page_names_every_key():
    page = (Path(__file__).parents[4] / "docs" / "naval" / "ship-file.md").read_text(encoding="utf-8")
    tables = {"hull", "water", "tanks", "holds", "openings", "conditions", "fills", "cargo", "wind"}
    keys = {key.split(".")[-1] for key, _ in walk(ShipKeys)} - tables
    assert len(keys) > 40 and [key for key in keys if f"`{key}" not in page] == []
    assert [table for table in tables if not re.search(rf"\[({table}|\w+\.NAME\.{table})[.\]]", page)] == []


def test_strength_of_a_condition_carries_all_that_she_weighs():
    """The integral of weight along her, with what stands at a point, is her mass; shear and moment close."""
    from lab.report.ship_file.further import beam_of

    for condition in cargolab.hull("ship/handysize").conditions.values():
        beam = beam_of(condition)
        spread = np.trapezoid(beam.weight, beam.x) / 9.81
        total = spread + sum(one.mass for one in beam.points)
        assert total == pytest.approx(condition.weights.mass, rel=2e-3)  # of steps at the blocks' ends
        assert abs(beam.open_shear) < 1e-3 * 9.81 * condition.weights.mass
        assert abs(beam.moment[-1]) < 1e-6 * np.abs(beam.moment).max()


@pytest.mark.slow
def test_limits_and_strength_of_conditions_are_written(tmp_path):
    given = ["ship/handysize", "--strength", "--limiting-kg", "--draught", "9", "--out", str(tmp_path / "out")]
    told = CliRunner().invoke(hull, given)
    assert told.exit_code == 0, told.exception
    assert "departure: As loaded" in told.output and "largest sagging moment" in told.output
    assert {"departure-strength.csv", "departure-strength.png", "limiting-kg.csv"} <= {
        path.name for path in (tmp_path / "out").iterdir()
    }
