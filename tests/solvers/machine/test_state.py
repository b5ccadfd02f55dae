"""The state: arrays by name and axis."""

import numpy as np
import pytest
import taichi as ti

from solvers.machine import runtime
from solvers.machine.state import Axis, State
from solvers.machine.wide import real_vectors
from tests.oracles.axes import axes


@pytest.fixture
def arrays():
    runtime.initialise(1)
    state = State()
    yield state
    state.release()


def test_array_names_are_unique(arrays):
    arrays.under("pairs").reals(axes(3), "mate")
    arrays.under("contacts").reals(axes(3), "mate")
    with pytest.raises(ValueError, match=r"two arrays are named pairs\.mate"):
        arrays.under("pairs").integers(axes(3), "mate")
    arrays.finish()


def test_arrays_are_read_and_written_by_name(arrays):
    (places,) = arrays.under("list").integers(axes(3), "places", below=5)
    arrays.reals(axes(2), "scratch", kept=False)
    arrays.finish()
    places.from_numpy(np.array([4, 0, 1], dtype=np.int32))
    kept = arrays.read()
    assert list(kept) == list(arrays.axes()) == ["list.places"]
    for wrong, why in ((np.array([5, 0, 1]), "are no places"), (np.zeros(4, dtype=int), "has the shape")):
        with pytest.raises(ValueError, match=rf"array list\.places .*{why}"):
            arrays.write({"list.places": wrong})
    with pytest.raises(KeyError):
        arrays.write({"000": kept["list.places"]})
    assert places.to_numpy().tolist() == [4, 0, 1]


def test_arrays_along_an_axis_are_reordered_in_the_given_worlds(arrays):
    world, grain = Axis("world", 2), Axis("grain", 4)
    (number,) = arrays.under("grains").reals((world, grain), "number")
    (vector,) = arrays.under("of another owner").vectors((world, grain, Axis("lane", 2)), "vector")
    (other,) = arrays.reals((world, Axis("cell", 4)), "other")
    arrays.finish()
    values = np.arange(8.0).reshape(2, 4)
    number.from_numpy(values)
    vector.from_numpy(np.stack([values, -values], axis=2))
    other.from_numpy(values)
    arrays.reorder("grain", {1: np.array([2, 0, 1])})
    moved = np.array([[0, 1, 2, 3], [6, 4, 5, 7]])
    assert np.array_equal(number.to_numpy(), moved)
    assert np.array_equal(vector.to_numpy(), np.stack([moved, -moved], axis=2))
    assert np.array_equal(other.to_numpy(), values)


@ti.data_oriented
class Both:
    """A kernel on whole vectors, from scalars in blocks of lanes, beside one on fields of vectors."""

    LANES, BLOCKS = 16, 5

    def __init__(self, state: State):
        within = axes(self.BLOCKS, self.LANES)
        self.x, self.y = state.under("wide").wide(within, "x", "y")
        self.v, self.w = state.under("usual").vectors(within, "v", "w")

    @ti.kernel
    def wide(self):
        """y = √(x² + 1)/(x + 3)."""
        for b in range(self.BLOCKS):
            x = ti.Vector([self.x[b, k] for k in ti.static(range(self.LANES))])
            y = ti.sqrt(x * x + 1.0) / (x + 3.0)
            for k in ti.static(range(self.LANES)):
                self.y[b, k] = y[k]

    @ti.kernel
    def usual(self):
        """w = |−v| + v[0]: what a kernel on real vectors could not do."""
        for b in range(self.BLOCKS):
            v = self.v[b]
            self.w[b] = ti.abs(-v) + v[0]


@pytest.mark.parametrize("fails", [False, True])
def test_kernels_on_real_vectors_work_beside_others(arrays, fails):
    both = Both(arrays)
    arrays.finish()
    values = np.random.default_rng(1).uniform(0.5, 2.0, (both.BLOCKS, both.LANES))
    both.x.from_numpy(values)
    both.v.from_numpy(-values)
    config = ti.lang.impl.current_cfg()
    try:
        with real_vectors():
            assert not config.real_matrix_scalarize
            both.wide()
            if fails:
                raise RuntimeError
    except RuntimeError:
        pass
    assert config.real_matrix_scalarize  # else `usual` would abort the process
    both.usual()
    np.testing.assert_allclose(both.y.to_numpy(), np.sqrt(values**2 + 1.0) / (values + 3.0), rtol=1e-14)
    np.testing.assert_allclose(both.w.to_numpy(), values - values[:, :1], rtol=1e-14, atol=1e-15)
