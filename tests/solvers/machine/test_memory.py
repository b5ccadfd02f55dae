"""Fields that are read and written in place, without a copy."""

import numpy as np
import pytest

from solvers.machine import runtime
from solvers.machine.state import State
from tests.oracles.axes import axes


@pytest.fixture
def arrays():
    """Fields of all types and layouts; their sizes are not powers of two."""
    runtime.initialise()
    arrays = State("mixed")
    arrays.reals(axes(3, 37), "places", kind=arrays.place)
    arrays.integers(axes(6, 11), "across", across=True)
    arrays.vectors(axes(5, 7, 3), "vectors")
    arrays.vectors(axes(5, 7, 8), "vectors across", across=True)
    arrays.integer_vectors(axes(5, 13, 2), "integers", across=True)
    arrays.reals(axes(9), "row")
    arrays.reals(axes(2, 3, 4), "cube")
    arrays.finish()
    yield arrays
    arrays.release()


def made():
    """Arrays of a single field."""
    arrays = State()
    arrays.reals(axes(4), "row")
    arrays.finish()
    return arrays


def numbers(field):
    """A different number for each element."""
    shape = (*field.shape, field.n) if hasattr(field, "n") else field.shape
    return np.arange(np.prod(shape)).reshape(shape).astype(field.to_numpy().dtype)


def test_taichi_reads_the_written_values(arrays):
    for field in arrays.fields:
        values = numbers(field)
        field.from_numpy(values)
        assert np.array_equal(type(field).to_numpy(field), values)
    assert all(np.array_equal(field.to_numpy(), numbers(field)) for field in arrays.fields)  # nor have others been hit


def test_values_written_by_taichi_are_read(arrays):
    for field in arrays.fields:
        type(field).from_numpy(field, numbers(field))
    for field in arrays.fields:
        assert np.array_equal(field.to_numpy(), numbers(field))
        assert field.to_numpy().dtype == type(field).to_numpy(field).dtype


def test_filling_a_field_leaves_earlier_copies_unchanged(arrays):
    field = arrays.fields[2]
    before = field.to_numpy()
    field.fill(3)
    assert np.all(type(field).to_numpy(field) == 3) and np.all(before == 0)


def test_a_wrong_shape_is_refused(arrays):
    with pytest.raises(ValueError, match="does not fit"):
        arrays.fields[0].from_numpy(np.zeros((1, 37)))


def test_released_fields_are_accessed_by_taichi_itself():
    runtime.initialise()
    both = made(), made()
    both[0].release()
    runtime.initialise(threads=1 if runtime.available_cores() > 1 else 2)
    for arrays in both:
        assert not {"to_numpy", "from_numpy", "fill"} & set(vars(arrays.fields[0]))
