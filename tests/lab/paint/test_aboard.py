"""Grains in a room of a hull are painted where the hull is, turned as she is."""

from types import SimpleNamespace

import numpy as np
import pytest

from lab.paint.footage import Bed
from lab.paint.scene.bodies import Hold
from solvers.grains.pressing import Pressing

TURN, SHIFT = 0.3, np.array([0.2, -0.1])  # rad, m


@pytest.fixture
def bed() -> Bed:
    """A hull that has turned about the drawn origin and moved, with a grain, a shelf that slides in her, and a gate."""
    press = Pressing(np.array([[0, -1]]), np.array([[0.0, 1.0]]), np.array([[0.0, 2.0]]))
    rows = {"position": np.array([[1.0, 2.0]]), "angle": np.array([0.1])}
    footage = SimpleNamespace(
        hold=Hold(0, (1,)), grains=lambda name, frame, world: rows[name], pressing=lambda frame, world: press,
        part=np.tile(np.array([SHIFT, (0.0, 0.5), (0.0, 0.25)]), (2, 1, 1, 1)),
        part_turn=np.tile(np.array([TURN, 0.0, 0.0]), (2, 1, 1)), time=np.arange(2.0),
    )  # fmt: skip
    return Bed(footage, 0, "")


def turned(y: float, z: float) -> list[float]:
    return [y * np.cos(TURN) - z * np.sin(TURN), y * np.sin(TURN) + z * np.cos(TURN)]


def test_grains_go_and_turn_with_the_hull(bed):
    assert bed.position(0)[0] == pytest.approx(SHIFT + turned(1.0, 2.0))
    assert bed.angle(0)[0] == pytest.approx(0.1 + TURN)


def test_forces_act_where_the_hull_is_and_turn_with_her(bed):
    found = bed.pressing(0.4)
    assert found.place[0] == pytest.approx(SHIFT + turned(0.0, 1.0))
    assert found.force[0] == pytest.approx(turned(0.0, 2.0))


def test_a_part_in_the_room_moves_in_the_hull_and_another_one_in_the_tank(bed):
    point = np.array([[0.3, 0.0]])
    assert bed.moved(point, 1, 0)[0] == pytest.approx(SHIFT + turned(0.3, 0.5))
    assert bed.moved(point, 2, 0)[0] == pytest.approx([0.3, 0.25])
