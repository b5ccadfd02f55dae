"""The bench of graphics processors: what it allows for rounding, and the processor in the part of the device."""

import numpy as np
import pytest

from lab.report.page import Page
from lab.studies.bench.gpu import water
from lab.studies.bench.water.cases import gentle

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
    place = case.drops[:, :2]
    rows = water.compared(numbers(place, **changes), numbers(place), "f32", case)
    assert [words for _, words, *_, verdict in rows if verdict == "fail"] == failing


def test_rounding_is_that_of_the_numbers_of_places_and_of_forces():
    case, step = gentle(ROWS), 4e-3
    (place, force), mixed, double = (water.rounding(kind, case, step) for kind in ("f32", "mixed", "f64"))
    assert 1e-5 < place < 1e-3 and mixed[0] < place and mixed[1] == force
    assert double[1] == pytest.approx(force * np.finfo(np.float64).eps / np.finfo(np.float32).eps)


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
