"""A recording as one tree of labelled data: the same numbers, read as they are asked for, named, placed and checked."""

import shutil

import h5py
import numpy as np
import pytest
from pint import UnitRegistry

from lab.base.errors import LabError
from lab.recording import open_recording
from lab.recording.layout import STEERING, frames_of, series_of
from lab.recording.tables import Frames
from lab.recording.tree import lazy
from lab.recording.tree.attributes import attributes
from solvers.machine.quantity import PLANE, SPACE
from tests.oracles.recorded_water import DROPS, record_pool
from tests.oracles.synthetic import DIAMETER, frame, preset, recorder, sample

FRAMES, BEDS, GRAINS = 8, 2, 5
ALL = {"afloat": True, "axled": True, "floating": True, "leaking": True, "in_space": True}


@pytest.fixture(scope="module")
def chance() -> np.ndarray:
    return np.random.default_rng(3).random((FRAMES, BEDS, GRAINS, 2)).astype("f4")


@pytest.fixture(scope="module")
def run(tmp_path_factory, chance):
    """Two beds of five grains of two kinds and a gate, the run not ended."""
    folder = tmp_path_factory.mktemp("tree")
    said = preset()
    said["run"]["seed"] = 7
    options = {"kind": np.tile([0, 1, 0, 1, 1], (BEDS, 1)), "fixed": [[0.01, 0.0, 0.002]], "open_edges": [2]}
    writer = recorder(folder, BEDS, GRAINS, resolved=said, parts={"gate": [(0.0, 0.0), (0.0, 0.1)]}, **options)
    for k in range(FRAMES):
        writer.sample(sample(0.1 * k, BEDS, kinetic=[k, -k], wall_force=np.full((BEDS, 3), k)))
        writer.frame(frame(0.1 * k, BEDS, GRAINS, position=chance[k], part=np.full((BEDS, 1, 2), k)))
    writer.flush()
    yield folder
    writer.close("stopped: for a test")


@pytest.fixture
def opened(run):
    with open_recording(run) as recording:
        yield recording


def everything():
    """All quantities that the lab records, in the plane and in space."""
    matters = ("grains", "water", "air"), ("bulk",)
    listed = [*STEERING]
    for kinds in matters:
        listed += [*series_of(matters=kinds, **ALL), *frames_of(True, kinds, True, True)]
    return [one.within(axes) for one in listed for axes in (PLANE, SPACE)]


def test_pint_reads_the_unit_of_every_quantity():
    """As attributes say it, in SI; where components differ, that of each."""
    pint, known = UnitRegistry(), everything()
    assert len(known) > 200
    for quantity in known:
        told = attributes(quantity)
        assert ("units" in told) != ("component_units" in told)
        for unit in told.get("units", told.get("component_units")).split(", "):
            one = pint.Quantity(1.0, pint.parse_units(unit))
            assert one.to_base_units().magnitude == pytest.approx(1.0, rel=1e-12)


def test_the_tree_has_the_tables_numbers_and_says_what_they_are_of(opened, chance):
    tree = opened.tree()
    assert set(tree.children) == {"series", "frames", "tank", "grains", "parts"}
    assert tree["frames/position"].values.tobytes() == chance.tobytes()
    assert tree["series/wall_force"].sel(freedom="roll", world=1).values.tolist() == [*range(FRAMES)]
    force = tree["series/wall_force"].attrs
    assert force["component_units"] == "N, N, N m" and "units" not in force and force["cell_methods"] == "time: mean"
    for name in ("series", "frames"):
        table = getattr(opened, name)
        for quantity in table.quantities.values():
            called = {"part": "part_displacement"}.get(quantity.name, quantity.name)
            np.testing.assert_array_equal(tree[name][called].values, np.asarray(table[quantity.name][:]))
            assert tree[name][called].dims == quantity.axes
    assert tree["frames"].part.values.tolist() == ["gate"]
    position = tree["frames/position"]
    assert position.sel(axis="z").attrs["units"] == "m" and position.seed.values.tolist() == [7, 8]
    assert position.radius.dims == position.kind.dims == ("world", "grain")
    of_pellets = position.where(position.kind == 1).isel(world=0).dropna("grain", how="all")
    assert of_pellets.grain.values.tolist() == [1, 3, 4]


def test_the_tree_says_what_does_not_change(opened):
    tree = opened.tree()
    assert tree["tank/outline"].values.tolist() == opened.outline.tolist()
    assert tree["tank/edge_is_open"].values.tolist() == [0, 0, 1, 0]
    assert tree["tank/fixed_radius"].values.tolist() == [0.002]
    assert tree["parts/gate"].values.tolist() == opened.parts["gate"].tolist()
    assert (tree["grains/radius"].values == DIAMETER / 2).all()
    assert tree["grains/kind"].attrs["flag_meanings"].split()[0] == "material"
    assert tree.attrs["preset"] == "tilting/acetate" and tree.attrs["preset_toml"] == opened.given
    assert tree.attrs["status"] == "running" and tree.attrs["created"] == opened.created
    assert "taichi" in tree.attrs["versions"]


def test_gauges_have_names_and_places(tmp_path):
    pressure = np.arange(10.0).reshape(5, 1, 2)
    folder = record_pool(tmp_path / "run", 0.1 * np.arange(5), {"gauge_pressure": pressure})
    with open_recording(folder) as found:
        tree = found.tree()
        gauge = tree["series/gauge_pressure"].sel(gauge="P2")
        assert gauge.values[:, 0].tolist() == pressure[:, 0, 1].tolist()
        assert (float(gauge.gauge_y), float(gauge.gauge_z)) == (0.5, 0.1)
        assert float(tree["series/level_depth"].sel(level="L-1").level_y) == -0.48
        assert (
            tree["water/volume"].dims == ("world", "water_particle") and tree["water"].sizes["water_particle"] == DROPS
        )
        assert tree["water/volume"].attrs["units"] == "m^2" and "grains" not in tree.children


@pytest.mark.parametrize("block", [2**24, 64])
def test_any_part_of_the_frames_is_that_of_the_whole_array(opened, chance, monkeypatch, block):
    monkeypatch.setattr(lazy, "BLOCK", block)
    position = opened.tree()["frames/position"].variable
    parts = (
        (slice(2, 7), 1, slice(None), 0),
        (slice(None, None, -2), slice(None), [4, 0, 0], slice(None)),
        ([6, 1, 1, 3], slice(None), slice(1, 3), slice(None)),
        (-1, slice(None), [2, 1], 1),
        (slice(1, 8, 3), 0, 2, slice(None)),
        ([], slice(None), slice(None), 0),
        (slice(5, 5), 1, slice(None), slice(None)),
    )
    for part in parts:
        outer = chance
        for axis, one in reversed(list(enumerate(part))):
            outer = outer[(slice(None),) * axis + (np.array(one, int) if isinstance(one, list) else one,)]
        np.testing.assert_array_equal(position[part].values, outer)


def test_no_more_frames_are_read_than_are_asked_for(opened, monkeypatch):
    rows, read = [], Frames.read

    def counted(table, data, part):
        if data.name.startswith("/frames"):
            rows.append((data.name.rpartition("/")[2], *part.indices(len(data))))
        return read(table, data, part)

    monkeypatch.setattr(Frames, "read", counted)
    frames = opened.tree()["frames"]
    assert rows == [("time", 0, FRAMES, 1)]  # the coordinate along which one selects
    repr(frames)
    chosen = frames["position"].sel(time=[0.2, 0.5], method="nearest").isel(world=0)
    assert len(rows) == 1
    chosen.load()
    assert rows[1:] == [("position", 2, 3, 1), ("position", 5, 6, 1)]


def test_damaged_rows_are_reported_when_they_are_read(tmp_path, run):
    folder = tmp_path / "copy"
    folder.mkdir()
    with recorder(folder, BEDS, GRAINS) as writer:
        for k in range(FRAMES):
            writer.sample(sample(0.1 * k, BEDS))
            writer.frame(frame(0.1 * k, BEDS, GRAINS))
    with h5py.File(folder / "recording.h5", "r+") as file:
        file["frames/position"][5] = 1.0  # without its checksum
    with open_recording(folder) as found:
        position = found.tree()["frames/position"]
        assert not position[:5].values.any()
        with pytest.raises(LabError, match=r"frames/position is damaged from row 5 of 8"):
            position[4:7].load()
    with open_recording(folder, sound=True) as found:
        assert found.tree()["frames"].sizes["time"] == 5


def test_what_is_closed_says_so(run):
    with open_recording(run) as found:
        tree = found.tree()
    with pytest.raises(LabError, match=r"recording\.h5 has been closed: open it again"):
        tree["frames/position"].load()


def test_netcdf_holds_the_tree_of_a_run_that_is_not_ended(opened, chance, tmp_path):
    pytest.importorskip("h5netcdf")
    import xarray

    opened.tree().to_netcdf(tmp_path / "run.nc", engine="h5netcdf")
    with xarray.open_datatree(tmp_path / "run.nc", engine="h5netcdf") as again:
        assert again["frames/position"].values.tobytes() == chance.tobytes()
        assert again["frames/position"].attrs["units"] == "m" and again.attrs["preset_toml"] == opened.given
        assert again["frames"].part.values.tolist() == ["gate"]


def test_attributes_are_such_that_any_file_holds_them(opened):
    for node in opened.tree().subtree:
        for one in (node, *node.variables.values()):
            for value in one.attrs.values():
                assert isinstance(value, str | int | float | np.ndarray) and not isinstance(value, bool)


def test_a_recording_says_in_a_notebook_what_it_holds(tmp_path, opened):
    assert repr(opened) == "<Recording of tilting/acetate: 2 beds, 5 grains, 8 samples, 8 frames; running>"
    page = opened._repr_html_()
    assert "frames: 8 quantities, 8 frames" in page and "rad/s" in page and "time × world × grain × axis" in page
    said = preset() | {"title": "<script>alert(1)</script>"}
    recorder(tmp_path, resolved=said).close()
    with open_recording(tmp_path) as hostile:
        assert "<script" not in hostile._repr_html_() and "&lt;script&gt;" in hostile._repr_html_()


def test_a_copied_folder_opens(run, tmp_path):
    """A recording is one file: nothing else of its folder is needed."""
    shutil.copy(run / "recording.h5", tmp_path / "mine.h5")
    with open_recording(tmp_path / "mine.h5") as found:
        assert found.tree()["frames"].sizes["time"] == FRAMES
