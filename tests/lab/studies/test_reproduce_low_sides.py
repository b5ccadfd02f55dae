"""The barge with a low deck: her lever from its parts, her edge of loss."""

from dataclasses import replace
from math import atan, cos, radians, sin, tan

import numpy as np
import pytest

from lab.assembly.scene import build
from lab.measures.value import over_worlds
from lab.preset.find import load
from lab.studies.reproduce.estimates import Verdict
from lab.studies.reproduce.runs import Outcome
from lab.studies.reproduce.ships import low_sides
from lab.studies.reproduce.ships.capsizes import swung
from lab.studies.reproduce.ships.low_sides import low_ship, report, report_map, report_tank
from lab.studies.reproduce.ships.rolls import AMPLITUDE, FREQUENCY

BREADTH, DRAUGHT, SIDE, HATCH = 0.34, 0.11, 0.03, 0.06  # m, SIDE above the water, half of the hatch
HEIGHT = 0.5 * DRAUGHT + BREADTH**2 / (12.0 * DRAUGHT) - 0.0926  # m, GM


def test_the_lever_is_that_of_a_box_until_the_deck_is_wet():
    """Beyond, the box's less the triangle of side above the deck that holds no water out; none near 85 deg.

    At 25 deg the water on deck has not come to the hatch yet.
    """
    ship = low_ship()

    def boxs(roll):
        return sin(roll) * (HEIGHT + BREADTH**2 / (24.0 * DRAUGHT) * tan(roll) ** 2)

    wet = atan(2.0 * SIDE / BREADTH)
    for roll in (0.3 * wet, 0.9 * wet):
        assert ship.lever(roll) == pytest.approx(boxs(roll), abs=1e-5)
    roll = radians(25.0)
    # Corners from the axis: deck's edge, where the deck meets the water, where the side would
    corners = np.array([[0.5 * BREADTH, SIDE], [SIDE / tan(roll), SIDE], [0.5 * BREADTH, 0.5 * BREADTH * tan(roll)]])
    area = 0.5 * (corners[0, 0] - corners[1, 0]) * (corners[2, 1] - corners[0, 1])
    y, z = corners.mean(axis=0)
    lost = area * (y * cos(roll) + z * sin(roll)) / (BREADTH * DRAUGHT)
    assert ship.lever(roll) == pytest.approx(boxs(roll) - lost, abs=1e-5)
    assert corners[1, 0] > HATCH
    assert ship.lever(radians(82.0)) > 0.0 > ship.lever(radians(88.0))


def test_the_heap_has_the_mass_of_the_bed():
    """Grains of 6 mm, equally spread by a tenth about it: their mean cube is d³ (1 + 0.1²); a sheet of 6 mm."""
    resolved = load(low_sides.PRESET).resolved
    scene, _ = build(resolved)
    mass = (4.0 / 3.0 * np.pi * scene.grains.radius**3).sum() * 1319.0 / 0.006
    assert low_ship().heap.mass == pytest.approx(mass, rel=0.02)


def test_the_barge_floods_with_loose_cargo_and_not_with_frozen():
    """A heap that slides puts her hatch under in waves of 24 mm; high waves do so with any cargo."""
    ship, waves = low_ship(), (np.array([15.0, 24.0, 35.0]), np.full(3, 4.4))
    assert swung(ship, *waves)[1].tolist() == [0.0, 1.0, 1.0]
    assert swung(replace(ship, heap=None), *waves)[1].tolist() == [0.0, 0.0, 1.0]
    closed = replace(ship, openings=None)
    assert swung(replace(closed, heap=None), *waves)[1].tolist() == [0.0, 0.0, 0.0]


def measures(capsized, flooded, alone):
    """Of beds, and of the ship with her cargo frozen, which floods at `alone` (s) or never."""
    frozen = {"frozen_capsized_at": over_worlds([np.nan], "s"), "frozen_flooded_at": over_worlds([alone], "s")}
    return {"capsized_at": over_worlds(capsized, "s"), "flooded_at": over_worlds(flooded, "s"), **frozen}


def test_beds_are_counted(monkeypatch):
    monkeypatch.setattr(low_sides, "CURVE", np.array([25.0]))  # of heaps, behind the beds

    def run(size, capsized, flooded):
        return Outcome({AMPLITUDE: size}, None, "complete", measures(capsized, flooded, np.nan), {})

    never = [np.nan, np.nan]
    told = report({"low sides": [run("19 mm", never, never), run("30 mm", [np.nan, 9.0], [12.0, np.nan])]})
    assert told.rows[0].ours.startswith("stands with 2 beds; lost with 0 %")
    assert told.rows[1].ours.startswith("floods at 12 s (1 of 2 beds), capsizes at 9 s (1 of 2 beds)")
    assert told.rows[1].ours.endswith("frozen stands")


def test_the_map_has_the_lowest_capsizing_waves_with_loose_and_frozen_cargo(monkeypatch):
    monkeypatch.setattr(low_sides, "FINE", (np.array([15.0, 25.0]), np.array([4.0, 4.4])))  # of heaps, behind the beds

    def run(size, omega, when, alone):
        found = measures([np.nan, np.nan], when, alone)
        return Outcome({AMPLITUDE: f"{size} mm", FREQUENCY: f"{omega} rad/s"}, None, "complete", found, {})

    runs = [
        run(15, 4.4, [np.nan, 12.0], np.nan),
        run(25, 4.4, [9.0, 8.0], 20.0),
        run(15, 4.0, [np.nan, np.nan], np.nan),
        run(25, 4.0, [np.nan, np.nan], np.nan),
    ]
    told = report_map({"low sides": runs})
    assert [row.ours for row in told.rows] == [
        "in none of these waves",
        "from 15 mm on",
        "in 1 of 4 waves, from 25 mm on",
    ]
    assert [row.verdict for row in told.rows] == [None, None, Verdict.AGREES]
    higher = low_sides.frozen_row(runs[1:])  # nothing is lost up to 19 mm: nothing to hold
    assert higher.verdict is None and "not judged" in higher.ours
    points = [line for line in told.figure.axes[0].lines if len(line.get_xdata())]
    assert [(line.get_marker(), line.get_fillstyle()) for line in points] == [
        ("o", "left"),
        ("o", "full"),
        ("x", "full"),
        ("o", "none"),
        ("o", "none"),
    ]


def test_survived_waves_above_capsizing_ones_are_named():
    assert low_sides._from([20.0, 30.0], [15.0, 25.0]) == "from 20 mm on, but for 25 mm"
    assert low_sides._from([20.0, 30.0], [15.0]) == "from 20 mm on"
    assert low_sides._from([], [15.0]) == "in none of these waves"


def test_what_the_watch_stopped_is_neither_lost_nor_survived():
    def run(size, status, flooded):
        found = measures([np.nan], [flooded], np.nan)
        return Outcome({AMPLITUDE: f"{size} mm", FREQUENCY: "4.4 rad/s"}, None, status, found, {})

    runs = [run(15, "complete", np.nan), run(25, "stopped: too fast", np.nan), run(35, "complete", 5.0)]
    told = report_tank({"anti-roll tank": runs})
    assert [row.ours for row in told.rows] == ["from 35 mm on; not known at 25 mm"]
    points = [line for line in told.figure.axes[0].lines if len(line.get_xdata())]
    assert [point.get_fillstyle() for point in points] == ["none", "left", "full"]
