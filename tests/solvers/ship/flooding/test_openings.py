"""What flows through openings: the closed forms of weirs and orifices, and at any heel the integral over strips."""

import numpy as np
import pytest
from scipy.integrate import quad

from solvers.ship.flooding.balance import Pose
from solvers.ship.flooding.openings import Opening, Side, circle, rectangle, through

G = 9.81
DEPTH = 10.0
UPRIGHT = Pose(0.0)


def flow(opening: Opening, outside: Side, inside: Side, pose: Pose = UPRIGHT):
    at = float(pose.heights(opening.centre))
    return through(opening, pose.up, at, (outside, inside), G, DEPTH)


def door(width=1.5, height=2.0, sill=0.0, **more) -> Opening:
    return Opening("door", ("a", "b"), rectangle((0.0, 0.0, sill + 0.5 * height), width, height, "bulkhead"), **more)


def test_a_free_rectangle_is_a_weir():
    """Q = (2/3) C_d b √(2g) [H^(3/2) − (H − D)^(3/2)], exactly: here the sill is at 0 and H above the lintel."""
    width, height, head = 1.5, 2.0, 3.0
    exact = 2.0 / 3.0 * 0.6 * width * np.sqrt(2.0 * G) * (head**1.5 - (head - height) ** 1.5)
    assert flow(door(width, height), Side(head), Side(-5.0)).water == pytest.approx(exact, rel=1e-12)
    low = 2.0 / 3.0 * 0.6 * width * np.sqrt(2.0 * G) * 1.2**1.5
    assert flow(door(width, height), Side(1.2), Side(-5.0)).water == pytest.approx(low, rel=1e-12)


def test_a_drowned_rectangle_is_an_orifice_both_ways():
    exact = 0.7 * 1.5 * 2.0 * np.sqrt(2.0 * G * 0.25)
    assert flow(door(discharge=0.7), Side(3.25), Side(3.0)).water == pytest.approx(exact, rel=1e-12)
    assert flow(door(discharge=0.7), Side(3.0), Side(3.25)).water == pytest.approx(-exact, rel=1e-12)


@pytest.mark.parametrize("roll", [0.0, 0.3, -0.9])
@pytest.mark.parametrize("face", ["bulkhead", "side", "deck"])
def test_a_heeled_and_trimmed_opening_is_the_sum_of_its_strips(roll, face):
    """Against quadrature of √(2 g Δh) over the rectangle, at levels that cut it, with air pressed into one room."""
    width, height, centre = 1.5, 2.0, np.array([3.0, 4.0, 5.0])
    opening = Opening("hole", ("a", "b"), rectangle(centre, width, height, face))
    pose = Pose(4.0, 0.05, roll)
    middle = float(pose.heights(centre))
    sides = Side(middle + 0.4), Side(middle - 0.3, 0.2)
    kept = [axis for axis in range(3) if axis != {"side": 1, "bulkhead": 0, "deck": 2}[face]]

    n = 600
    one, two = (size * ((np.arange(n) + 0.5) / n - 0.5) for size in (width, height))
    places = np.zeros((n, n, 3)) + centre
    places[..., kept[0]] += one[:, None]
    places[..., kept[1]] += two[None]
    z = pose.heights(places)
    head = sides[0].head(z) - sides[1].head(z)
    source = np.where(head > 0.0, sides[0].level, sides[1].level)
    speeds = np.sign(head) * np.sqrt(2.0 * G * np.abs(head)) * 0.6 * width * height / n**2
    found = flow(opening, *sides, pose)
    if face == "deck" and roll == 0.0:
        return  # nearly level: the layer in which it changes from air to water is wider than it is high
    scale = np.abs(speeds).sum()
    assert found.water == pytest.approx(speeds[z < source].sum(), abs=2e-3 * scale)
    assert found.air == pytest.approx(speeds[z >= source].sum(), abs=1e-2 * scale)


def test_water_and_air_pass_in_opposite_directions():
    """A level below the lintel on the side with more air: water leaves low, air enters high; at rest nothing moves."""
    found = flow(door(), Side(1.5, -0.2), Side(0.5, 0.0))
    assert found.water > 0.0 > found.air
    assert flow(door(), Side(1.0), Side(1.0)).water == 0.0


def test_a_circle_has_its_area():
    hole = Opening("hole", ("a", "b"), circle((0.0, 0.0, 0.0), 0.09, "deck"))
    assert hole.area == pytest.approx(np.pi * 0.045**2, rel=1e-12)
    exact = 0.6 * np.pi * 0.045**2 * np.sqrt(2.0 * G * 0.04)
    found = through(hole, np.array([0.0, 0.0, 1.0]), 0.0, (Side(0.04), Side(-1.0)), G, 0.11)
    assert found.water == pytest.approx(exact, rel=1e-12)
    whole, _ = quad(lambda z: 2.0 * np.sqrt(0.045**2 - z * z) * np.sqrt(2.0 * G * (0.06 - z)), -0.045, 0.045)
    upright = Opening("hole", ("a", "b"), circle((0.0, 0.0, 0.0), 0.09, "side"))
    assert flow(upright, Side(0.06), Side(-1.0)).water == pytest.approx(0.6 * whole, rel=1e-4)


def test_a_door_leaks_then_gives_way():
    one = door(opens=None, leak=0.05, leak_head=0.5, collapse=2.0)
    assert [one.share(9.0, head, False) for head in (0.4, 0.6)] == [0.0, 0.05]
    assert one.share(0.0, 0.0, True) == 1.0
    assert [door(opens=5.0).share(time, 1.0, False) for time in (4.9, 5.0)] == [0.0, 1.0]
