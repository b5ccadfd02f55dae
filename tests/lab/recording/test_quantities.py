"""Quantities are declared once: the file, the labelled arrays, the sentences and the figures follow."""

from pathlib import Path

import h5py
import numpy as np
import pytest
import taichi as ti

import lab
from lab.base.errors import LabError
from lab.preset.find import load
from lab.recording import open_recording
from lab.recording.layout import STEERING, frames_of, series_of
from lab.sweeps.dry_run import available_measures
from solvers.grains import quantities as grains
from solvers.grains.diagnostics import Diagnostics
from solvers.machine.quantity import SPACE, Quantity, directions, freedoms, parted, places, rotations
from tests.oracles.synthetic import frame, recorder, sample

TINY = {
    "grains.count": 12,
    "run.repeats": 2,
    "run.duration": "0.1 s",
    "record.series_rate": "100 Hz",
    "motion.tilt.rate": "90 deg/s",
}
HIGHEST = Quantity("highest", "m", label="height of the highest grain in the tank", plot=True)


@ti.data_oriented
class WithHighest(Diagnostics):
    """Fills one number more."""

    @ti.func
    def write_row(self, w, time, sums, contacts):
        Diagnostics.write_row(self, w, time, sums, contacts)
        self.rows[w, self.at.highest] = self.top(w)

    @ti.func
    def top(self, w):
        highest = self.grains.place[1][w, 0]
        for i in range(self.grains.mobile):
            highest = ti.max(highest, self.grains.place[1][w, i])
        return highest


@pytest.mark.slow  # the recipe in docs/extending.md is run on every change
def test_a_new_quantity_is_one_declaration_and_one_line_that_fills_it(tmp_path, monkeypatch):
    monkeypatch.setattr(grains, "SERIES", (*grains.SERIES, HIGHEST))
    monkeypatch.setattr("solvers.grains.matter.Diagnostics", WithHighest)
    result = lab.run("tilting/quick", tmp_path / "run", video=False, quiet=True, **TINY)
    with open_recording(result.folder) as found:
        place, times = found.frames["position"][:], found.frames["time"][:]
        rows = np.searchsorted(found.series["time"], times - 1e-9)
        highest = found.series["highest"]
        assert highest.shape == (11, 2) and highest.min() > 0.0
        np.testing.assert_allclose(highest[rows], place[..., 1].max(axis=2), rtol=1e-6)
        assert found.quantities["highest"] == HIGHEST
        of_all = found.labelled()["highest"]
        assert (of_all.dims, of_all.units, of_all.long_name) == (("time", "world"), "m", HIGHEST.label)
    assert (result.folder / "highest.png").stat().st_size > 1000
    assert "highest.png" in (result.folder / "summary.md").read_text()
    available_measures(load("tilting/quick", TINY))
    monkeypatch.undo()
    with open_recording(result.folder) as found:  # by a version that does not know it
        assert found.quantities["highest"] == HIGHEST and found.series["highest"].tobytes() == highest.tobytes()


PARTICLES = "grains", "water", "air"  # bulk, which is never with these, has some names in common with grains
LISTED = [one for matters in (PARTICLES, ("bulk",)) for one in (*series_of(True, matters), *frames_of(True, matters))]
EVERY = {q.name: q for q in reversed(LISTED)}


def test_every_quantity_has_a_unit_and_a_label_for_each_component():
    for quantity in LISTED:
        assert quantity.unit and quantity.label and len(quantity.units) == quantity.width, quantity.name
        assert len(set(quantity.components)) == len(quantity.components)
    kinds = PARTICLES, ("bulk",)
    lists = *(series_of(True, kind) for kind in kinds), *(frames_of(True, kind) for kind in kinds), STEERING
    assert all(len({q.name for q in listed}) == len(listed) for listed in lists)


def test_a_row_is_split_as_it_was_laid_out():
    listed = Quantity("a", "m", directions), Quantity("b", "J"), Quantity("c", "N, N, N m", freedoms)
    assert places(listed) == {"a": 0, "b": 2, "c": 3}
    found = parted(np.arange(12.0).reshape(2, 6), listed)
    assert found["a"].tolist() == [[0, 1], [6, 7]] and found["b"].tolist() == [2, 8]
    assert found["c"].tolist() == [[3, 4, 5], [9, 10, 11]] and listed[2].units == ("N", "N", "N m")


def test_components_are_those_of_the_scenes_axes():
    """y, z, x, then about y, z and x; a rotation in the plane is a single number, and one unit is that of all."""
    force, spin = Quantity("a", "N, N, N m", freedoms), Quantity("b", "rad/s", rotations)
    assert (force.components, force.dimension) == (("y", "z", "roll"), "freedom")
    assert (spin.shape, spin.width, spin.units, spin.axes) == ((), 1, ("rad/s",), ("time", "world"))
    force, spin, place = (one.within(SPACE) for one in (force, spin, Quantity("c", "m", directions)))
    assert (force.components, force.dimension) == (("y", "z", "x", "pitch", "yaw", "roll"), "freedom")
    assert force.units == ("N",) * 3 + ("N m",) * 3
    assert (spin.components, spin.units, spin.dimension) == (("pitch", "yaw", "roll"), ("rad/s",) * 3, "rotation")
    assert (place.components, place.units, place.axes) == (("y", "z", "x"), ("m",) * 3, ("time", "world", "axis"))
    named = Quantity("d", "m, 1/m", ("long", "bent")).within(SPACE)
    assert (named.components, named.units) == (("long", "bent"), ("m", "1/m"))
    assert Quantity("e", "J").within(SPACE).shape == ()


@pytest.fixture(scope="module")
def recorded(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("recorded")
    with recorder(folder, 2, parts={"gate": [(0.0, 0.0), (0.0, 0.1)]}) as run:
        for k in range(6):
            run.sample(sample(0.1 * k, 2, wall_force=np.full((2, 3), k), kinetic=[k, -k]))
            if k % 2 == 0:
                spin = np.arange(8.0).reshape(2, 4) + k
                run.frame(frame(0.1 * k, 2, spin=spin, part=np.full((2, 1, 2), 0.5 * k)))
    return folder


def test_every_data_set_is_described_by_its_attributes(recorded):
    with h5py.File(recorded / "recording.h5") as file:
        force, spin = file["series/wall_force"], file["frames/spin"]
        assert force.attrs["units"] == b"N, N, N m" and force.attrs["mean_over_sample"]
        assert force.attrs["components"].tolist() == [b"y", b"z", b"roll"]
        assert force.attrs["axes"].tolist() == [b"time", b"world", b"freedom"]
        assert [dimension.label for dimension in spin.dims] == ["time", "world", "grain"]
        assert spin.attrs["units"] == b"rad/s" and not spin.attrs["mean_over_sample"]
        for table in ("series", "frames"):
            for name, data in file[table].items():
                assert data.attrs["long_name"].decode() == EVERY[name].label
                assert len(data.attrs["axes"]) == data.ndim and data.attrs["units"].decode() == EVERY[name].unit


def test_labelled_arrays_equal_the_plain_ones(recorded):
    with open_recording(recorded) as found:
        series, frames = found.labelled(), found.labelled(frames=slice(1, 3))
        assert series["wall_force"].sel(freedom="roll", world=1).values.tolist() == [0, 1, 2, 3, 4, 5]
        assert series["wall_force"].attrs["mean_over_sample"] and series.attrs["preset"] == "tilting/acetate"
        assert dict(series.sizes) == {"time": 6, "world": 2, "freedom": 3, "axis": 2}
        assert series["kinetic"].sel(time=0.3, method="nearest").values.tolist() == [3.0, -3.0]
        assert frames["spin"].dims == ("time", "world", "grain") and frames["time"].values.tolist() == [0.2, 0.4]
        assert frames["spin"].values.tobytes() == found.frames["spin"][1:3].tobytes()
        assert frames["part"].dims == ("time", "world", "part", "axis")
        assert frames["position"].attrs["units"] == "m" and frames["time"].attrs["units"] == "s"


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("axes", np.array(["time"], "S")),
        ("axes", np.array(["time", "world", "grain"], "S")),
        ("components", np.array(["y", "z"], "S")),
        ("units", "J" * 2_000_000),
        ("units", np.array([1.0, 2.0])),
        ("units", np.array(b"J, J")),
        ("long_name", np.array([b"a", b"b"])),
    ],
)
def test_attributes_that_do_not_fit_their_data_are_refused(recorded, tmp_path, name, value):
    path = tmp_path / "recording.h5"
    path.write_bytes((recorded / "recording.h5").read_bytes())
    with h5py.File(path, "r+") as file:
        del file["series/kinetic"].attrs[name]
        file["series/kinetic"].attrs[name] = value
    with pytest.raises(LabError, match=r"recording\.h5"):
        open_recording(path)


@pytest.mark.parametrize("matters", [("grains", "water", "air"), ("bulk",)])
def test_no_two_quantities_of_a_run_have_one_name(matters):
    """Of a run that has everything at once."""
    for quantities in (series_of(True, matters, True, True, True, True, True), frames_of(True, matters, True, True)):
        names = [quantity.name for quantity in quantities]
        assert len(names) == len(set(names))
