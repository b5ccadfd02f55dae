"""Each format as its readers find it: their libraries where these are installed, and the structure by itself."""

import csv
from pathlib import Path

import h5py
import numpy as np
import pytest

from lab.base.errors import LabError
from lab.export.exporting import export_recording
from lab.export.vtkhdf import KINDS
from lab.preset.find import load
from lab.recording import open_recording
from tests.oracles.exported import PLACE, SHIP, TIMES, in_space, placed, pose_at, ship

EXTRA = "is not installed: pip install 'cargo-shift-lab[export]'"


@pytest.fixture(scope="module")
def barge(tmp_path_factory) -> Path:
    return ship(tmp_path_factory.mktemp("barge"), lost=True)


def expected(row: int) -> np.ndarray:
    """Where the grains are in the earth's axes."""
    pose = pose_at(TIMES[row], load(SHIP).resolved.ship.hold_at_rest)
    return placed(PLACE + 0.001 * TIMES[row], pose)


def test_vtkhdf_has_a_time_a_step_and_where_its_points_begin(barge, tmp_path):
    folder = export_recording(barge, "vtkhdf", tmp_path / "out")
    assert {path.name for path in folder.iterdir()} == {
        f"{name}.vtkhdf" for name in ("grains", "tank", "hull", "waterline")
    }
    with h5py.File(folder / "grains.vtkhdf") as file:
        root, steps = file["VTKHDF"], file["VTKHDF/Steps"]
        assert root.attrs["Type"] == b"PolyData" and tuple(root.attrs["Version"]) == (2, 0)
        assert steps.attrs["NSteps"] == 3 and steps["Values"][:].tolist() == TIMES.tolist()
        assert root["NumberOfPoints"][:].tolist() == [4, 4, 3] and steps["PointOffsets"][:].tolist() == [0, 4, 8]
        assert steps["CellOffsets"].shape == (3, len(KINDS)) and root["Points"].shape == (11, 3)
        assert root["Vertices/NumberOfCells"][:].tolist() == [4, 4, 3] and not root["Lines/NumberOfCells"][:].any()
        np.testing.assert_allclose(root["Points"][4:8, :2], expected(1), atol=1e-7)
        radius, offsets = root["PointData/radius"], steps["PointDataOffsets/radius"][:].tolist()
        assert offsets == [0, 0, 4] and len(radius) == 7  # written again where it changes


@pytest.mark.parametrize("made", [ship, in_space])
def test_vtk_reads_every_step(tmp_path, made):
    vtk = pytest.importorskip("vtk", reason="VTK is not installed: pip install vtk")
    from vtk.util.numpy_support import vtk_to_numpy

    folder = export_recording(made(tmp_path / "run"), "vtkhdf")
    reader = vtk.vtkHDFReader()
    reader.SetFileName(str(folder / "grains.vtkhdf"))
    reader.UpdateInformation()
    assert reader.GetNumberOfSteps() == len(TIMES)
    for row in range(len(TIMES)):
        reader.SetStep(row)
        reader.Update()
        points = vtk_to_numpy(reader.GetOutput().GetPoints().GetData())
        if made is ship:
            np.testing.assert_allclose(points[:, :2], expected(row), atol=1e-7)
        assert reader.GetOutput().GetNumberOfVerts() == 4
    reader.SetFileName(str(folder / "tank.vtkhdf"))
    reader.SetStep(0)
    reader.Update()
    assert reader.GetOutput().GetNumberOfLines() + reader.GetOutput().GetNumberOfPolys() == (4 if made is ship else 6)


def test_extended_xyz_says_what_its_columns_are(barge, tmp_path):
    lines = export_recording(barge, "xyz", tmp_path / "out.xyz", every=2).read_text().splitlines()
    assert lines[0] == "4" and lines[6] == "3" and len(lines) == 4 + 3 + 4
    columns = [part.split(":") for part in lines[1].split()[0].removeprefix("Properties=").split(":S:1:", 1)]
    names = ["species", *columns[1][0::3]]
    assert names == ["species", "pos", "radius", "kind", "id", "velo", "angle", "spin"]
    assert 'Time=1 pbc="F F F"' in lines[7]
    rows = np.array([line.split()[1:3] for line in lines[2:6]], dtype=float)
    np.testing.assert_allclose(rows, expected(0), atol=1e-7)
    assert [line.split()[6] for line in lines[8:11]] == ["0", "1", "3"]


def test_tables_name_units_in_their_headers(barge, tmp_path):
    folder = export_recording(barge, "csv", tmp_path / "out")
    series, grains, hull = (list(csv.reader((folder / f"{name}.csv").open())) for name in ("series", "grains", "hull"))
    assert {"time (s)", "pose_roll (rad)", "kinetic (J)", "wall_force_roll (N m)", "contacts"} <= set(series[0])
    roll = [float(row[series[0].index("pose_roll (rad)")]) for row in series[1:]]
    np.testing.assert_allclose(roll, 0.6 * TIMES, atol=1e-9)
    assert grains[0][:5] == ["time (s)", "position_y (m)", "position_z (m)", "position_x (m)", "radius (m)"]
    np.testing.assert_allclose(np.array(grains[1:5], dtype=float)[:, 1:3], expected(0), atol=1e-7)
    assert len(grains) == 1 + 4 + 4 + 3
    assert hull[0] == ["time (s)", "name", "cell", "corner", "position_y (m)", "position_z (m)", "position_x (m)"]


def test_gsd_is_read_back(barge, tmp_path):
    gsd = pytest.importorskip("gsd.hoomd", reason=f"gsd {EXTRA}")
    with gsd.open(export_recording(barge, "gsd", tmp_path / "out.gsd")) as file:
        frame, last = file[1], file[-1]
    np.testing.assert_allclose(frame.particles.position[:4, :2], expected(1), atol=1e-6)
    assert frame.particles.types == ["grains", "tank", "hull", "waterline"] and frame.configuration.dimensions == 2
    np.testing.assert_allclose(frame.particles.diameter[:4], 0.003, rtol=1e-6)
    angle = 2.0 * np.arctan2(frame.particles.orientation[0, 3], frame.particles.orientation[0, 0])
    assert angle == pytest.approx(0.25 + 0.6 * TIMES[1], abs=1e-6)
    assert frame.log["time"] == pytest.approx(TIMES[1]) and last.log["particles/id"][:3].tolist() == [0, 1, 3]
    ends = frame.particles.typeid[frame.bonds.group]
    assert (ends[:, 0] == ends[:, 1]).all()  # a bond joins corners of one thing
    assert np.bincount(frame.bonds.typeid)[0] == 4 and (frame.bonds.group >= 4).all()
    half = 0.5 * frame.configuration.box[:2]
    assert (np.abs(frame.particles.position[:, :2]) <= half).all()


def test_netcdf_is_the_recording(barge, tmp_path):
    pytest.importorskip("h5netcdf", reason=f"h5netcdf {EXTRA}")
    xarray = pytest.importorskip("xarray")
    written = export_recording(barge, "netcdf", tmp_path / "out.nc", every=2)
    found = xarray.open_datatree(written, engine="h5netcdf")
    with open_recording(barge) as recording:
        np.testing.assert_array_equal(found["frames/position"].values, recording.frames["position"][::2])
        np.testing.assert_array_equal(found["series/pose"].values, recording.series["pose"])
    assert found["series/pose"].sel(freedom="roll").values[-1, 0] == pytest.approx(0.6)
    assert found["frames/position"].attrs["units"] == "m" and found["grains/radius"].values.max() == 0.0015
    found.close()


@pytest.mark.parametrize(("to", "library"), [("gsd", "gsd"), ("netcdf", "h5netcdf")])
def test_a_library_that_is_missing_is_named(barge, tmp_path, monkeypatch, to, library):
    monkeypatch.setitem(__import__("sys").modules, "gsd", None)
    monkeypatch.setitem(__import__("sys").modules, "gsd.hoomd", None)
    monkeypatch.setattr("lab.export.netcdf.find_spec", lambda name: None)
    with pytest.raises(
        LabError, match=rf"to {to} needs the library {library}: pip install 'cargo-shift-lab\[export\]'"
    ):
        export_recording(barge, to, tmp_path / "out")
    assert not list(tmp_path.iterdir())
