"""What is exported: places in the earth's axes by the pose, vectors with them, and things where they are."""

import numpy as np
import pytest

from lab.base.errors import LabError
from lab.export.exporting import export_recording, left_out
from lab.export.stage import Stage
from lab.paint.footage import Footage
from lab.preset.find import load
from lab.recording import open_recording
from tests.oracles.exported import IN_SPACE, PLACE, SHIP, SPEED, TIMES, in_space, placed, pose_at, ship, turn_of

LAST = len(TIMES) - 1


@pytest.fixture(scope="module")
def barge(tmp_path_factory):
    return ship(tmp_path_factory.mktemp("barge"), lost=True)


@pytest.fixture
def stage(barge):
    with open_recording(barge) as recording:
        yield Stage(recording, Footage(recording), 0)


def rest() -> tuple[float, float]:
    return load(SHIP).resolved.ship.hold_at_rest


def test_grains_are_placed_and_turned_with_the_ship(stage):
    pose = pose_at(TIMES[1], rest())
    cloud = stage.cloud("grains", 1)
    np.testing.assert_allclose(cloud.place[:, :2], placed(PLACE + 0.001 * TIMES[1], pose), atol=1e-7)
    np.testing.assert_allclose(cloud.values["velocity"][:, :2], placed(SPEED, pose * [0, 0, 1]), atol=1e-7)
    np.testing.assert_allclose(cloud.values["angle"], 0.25 + pose[2], atol=1e-7)
    assert not cloud.place[:, 2].any() and stage.units("grains")["velocity"] == "m/s"


def test_a_grain_that_has_left_is_left_out_and_the_others_keep_their_numbers(stage):
    cloud = stage.cloud("grains", LAST)
    assert cloud.values["id"].tolist() == [0, 1, 3] and np.isfinite(cloud.place).all()


def test_in_the_tanks_axes_nothing_is_moved(stage):
    np.testing.assert_allclose(stage.of_tank().cloud("grains", 0).place[:, :2], PLACE, atol=1e-7)


def test_at_rest_the_keel_is_a_draught_below_the_still_water_and_the_hold_in_the_hull(stage):
    shapes, vessel = stage.shapes(0), load(SHIP).resolved.ship
    assert {"tank", "hull", "waterline"} == shapes.keys()
    assert shapes["hull"].points[:, 1].min() == pytest.approx(-vessel.draught)
    hull, hold = shapes["hull"].points, shapes["tank"].points
    assert (hold.min(axis=0) >= hull.min(axis=0) - 1e-9).all() and (hold.max(axis=0) <= hull.max(axis=0) + 1e-9).all()


def test_the_waterline_is_the_waves_in_both_frames_of_reference(stage):
    line, pose = stage.shapes(LAST)["waterline"].points, pose_at(TIMES[LAST], rest())
    elevation = stage.footage.sea_of(LAST).elevation(line[:, 0], TIMES[LAST])
    np.testing.assert_allclose(line[:, 1], elevation, atol=1e-12)
    seen = stage.of_tank().shapes(LAST)["waterline"].points
    np.testing.assert_allclose(placed(seen[:, :2], pose), line[:, :2], atol=1e-7)


def test_in_space_all_six_freedoms_place_spheres_and_walls(tmp_path):
    with open_recording(in_space(tmp_path)) as recording:
        stage = Stage(recording, Footage(recording), 0)
        cloud, tank = stage.cloud("grains", LAST), stage.shapes(LAST)["tank"]
        still = stage.of_tank().shapes(LAST)["tank"].points
    turn = turn_of(0.4, -0.5, 0.6)
    np.testing.assert_allclose(cloud.place, [0.1, 0.2, 0.3] + IN_SPACE @ turn.T, atol=1e-6)
    np.testing.assert_allclose(tank.points, [0.1, 0.2, 0.3] + still @ turn.T, atol=1e-12)
    assert tank.filled and len(tank.cells) == 6


@pytest.mark.parametrize(
    ("wishes", "sentence"),
    [
        ({"to": "xdmf"}, r"to: choose one of vtkhdf, gsd, .* \(got \"xdmf\"\)"),
        ({"every": 0}, "every: a whole number from 1 on"),
        ({"world": 3}, r"world: .* has the repeats 0 to 0 \(got 3\)"),
        ({"frame": "moon"}, "frame: choose one of earth, tank"),
        ({"to": "netcdf", "frame": "earth"}, "frame: netcdf holds places in the tank's axes"),
    ],
)
def test_what_cannot_be_is_refused_in_a_sentence(barge, tmp_path, wishes, sentence):
    with pytest.raises(LabError, match=sentence):
        export_recording(barge, **{"to": "xyz", "out": tmp_path / "out", **wishes})
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("to", ["xyz", "csv"])
def test_nothing_is_written_over_and_a_place_that_takes_nothing_is_named(barge, tmp_path, to):
    (tmp_path / "mine").write_text("a letter")
    with pytest.raises(LabError, match=r"mine exists: remove it, or name another place with --out"):
        export_recording(barge, to, tmp_path / "mine")
    assert (tmp_path / "mine").read_text() == "a letter"
    with pytest.raises(LabError, match=r"cannot be written \((Not a directory|File exists)\): name another place"):
        export_recording(barge, to, tmp_path / "mine" / "below")


def test_what_stops_halfway_leaves_nothing(barge, tmp_path):
    def stop(done: int, total: int) -> None:
        raise KeyboardInterrupt

    for to in ("xyz", "csv", "vtkhdf"):
        with pytest.raises(KeyboardInterrupt):
            export_recording(barge, to, tmp_path / to, progress=stop)
    assert not list(tmp_path.iterdir())


def test_a_run_that_was_killed_is_exported_as_far_as_it_came(tmp_path):
    folder = ship(tmp_path / "run", close=False)
    (tmp_path / "killed").mkdir()
    copy = tmp_path / "killed" / "recording.h5"
    copy.write_bytes((folder / "recording.h5").read_bytes())
    for to in ("xyz", "csv", "vtkhdf", "html"):
        assert export_recording(copy, to).parent == copy.parent
    assert (copy.parent / "recording.xyz").read_text().count("Time=") == len(TIMES)
    assert "The run is not complete: running." in (copy.parent / "player.html").read_text()


def test_one_world_is_exported_and_what_is_left_out_is_said(tmp_path):
    folder = ship(tmp_path / "run", worlds=3)
    assert left_out(folder, "xyz", None) == "this is repeat 0 of 3: --world K exports another."
    assert left_out(folder, "xyz", 1) == left_out(folder, "netcdf", None) == ""
