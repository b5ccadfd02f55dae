"""The bench of graphics processors: what it allows for rounding, and the processor in the part of the device."""

from threading import Lock

import numpy as np
import pytest

from benchmarks.gpu import water
from benchmarks.gpu.turns import Sizes, in_turns
from benchmarks.water.cases import gentle
from lab.base.errors import LabError
from lab.report.page import Page

ROWS = 10


def numbers(place: np.ndarray, **changes: float) -> dict[str, np.ndarray]:
    """What a way to run gives, as the bench keeps it."""
    found = {"place": place, "step": 4e-3, "momentum": 0.0, "pressure": 0.5, "rate": 1.3, "loss": 2.9} | changes
    return {name: np.asarray(value, dtype=float) for name, value in found.items()}


@pytest.mark.parametrize(
    ("changes", "failing"),
    [
        ({}, []),
        ({"momentum": 1e-3}, ["momentum, of the weight"]),
        ({"pressure": 0.56}, ["pressure at rest, %"]),
        ({"rate": 1.1, "loss": 3.0}, ["frequency, %"]),
    ],
)
def test_what_differs_by_more_than_rounding_fails(changes, failing):
    case = gentle(ROWS)
    place = case.drops["position"]
    rows = water.compared(numbers(place, **changes), numbers(place), "f32", case)
    assert [words for _, words, *_, verdict in rows if verdict == "fail"] == failing


def test_rounding_is_that_of_the_numbers_of_places_and_of_forces():
    case, step = gentle(ROWS), 4e-3
    (place, force), mixed, double = (water.rounding(kind, case, step) for kind in ("f32", "mixed", "f64"))
    assert 1e-5 < place < 1e-3 and mixed[0] < place and mixed[1] == force
    assert double[1] == pytest.approx(force * np.finfo(np.float64).eps / np.finfo(np.float32).eps)


class Room:
    """A device with room for so many workers, which it counts."""

    def __init__(self, most: int) -> None:
        self.most, self.held, self.made, self.door = most, 0, 0, Lock()

    def make(self) -> "Room":
        with self.door:
            if self.held == self.most:
                raise LabError("no room is left.")
            self.held, self.made = self.held + 1, self.made + 1
        return self

    def close(self) -> None:
        self.held -= 1


def test_a_worker_that_finds_no_room_beside_others_is_timed_alone():
    room, none = Room(2), Room(0)
    makers = {"f64": room.make, "mixed": room.make, "f32": room.make, "processor": none.make}
    found, faults = in_turns(makers, lambda made: made.held, 3)
    assert sorted(found) == ["f32", "f64", "mixed"] and faults == {"processor": "no room is left."}
    assert sorted(found.values()) == [[1, 1, 1], [2, 2, 2], [2, 2, 2]] and room.held == 0


def test_sizes_that_are_done_are_kept_and_broken_ones_tried_again(tmp_path):
    one, none = Room(1), Room(0)
    for _ in range(2):
        kept = Sizes(tmp_path, "trial", fast=True)
        assert kept.timed("small", {"f32": one.make}, lambda made: 7.0, 2) == ({"f32": [7.0, 7.0]}, {})
        assert kept.timed("large", {"f32": none.make}, lambda made: 7.0, 2)[0] == {}
    assert one.made == 1
    none.most = 1
    assert Sizes(tmp_path, "trial", fast=True).timed("large", {"f32": none.make}, lambda made: 7.0, 1)[0] == {
        "f32": [7.0]
    }


@pytest.mark.slow
def test_particles_one_by_one_in_32_bits_pass_as_a_device(tmp_path):
    page = Page(tmp_path, "gpu")
    water.correctness(page, tmp_path, "cpu", ("f32",), ROWS)
    (rows,) = (block["rows"] for block in page.blocks if "rows" in block)
    assert len(rows) == 5 and {row[-1] for row in rows} == {"pass"}
    water.speed(page, tmp_path, "cpu", ("f32",), fast=True)
    assert all(
        float(cell) > 0.0 for block in page.blocks[2:] if "rows" in block for row in block["rows"] for cell in row[2:]
    )
