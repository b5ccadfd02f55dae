"""A ship with her cargo frozen beside the one with loose cargo."""

import numpy as np
import pytest

from lab.base.errors import LabError
from lab.measures.ship_frozen import frozen
from lab.paint.edit.frozen import frozen_bed
from lab.paint.film import Film, choose_beds, choose_look
from lab.paint.footage import open_footage
from lab.paint.page.layout import overlap
from lab.paint.scene.cells import Room, lay_cells
from lab.preset.find import load
from lab.preset.recorded import to_table
from lab.recording import open_recording
from solvers.machine.runtime import initialise
from tests.oracles.synthetic import frame, of_a_ship, recorder, sample

LASTS = 3.0  # s
DRIFT = 0.4  # m


@pytest.fixture(autouse=True, scope="module")
def _taichi():
    initialise(fields=False)


@pytest.fixture(scope="module")
def sailed(tmp_path_factory):
    """A ship that drifts far, whose grains slide, and which floods at 1 s of 3."""
    folder = tmp_path_factory.mktemp("sailed")
    preset = load("ship/capsize-map-quick", {"run.duration": f"{LASTS} s"}).resolved
    hold = np.array(preset.tank.corners)
    place = np.array([[[-0.02, 0.02], [0.0, 0.02], [0.02, 0.02], [0.0, 0.03]]])
    with recorder(folder, resolved=to_table(preset), outline=hold) as writer:
        for now in (0.0, 0.5, 1.0):
            pose, lost = np.array([[DRIFT * now, 0.0, -0.3 * now]]), [-1.0 if now < 1.0 else 1.0]
            writer.sample(sample(now, pose=pose, **of_a_ship(flooded=lost)))
            writer.frame(frame(now, pose=pose, position=place + np.array([0.01 * now, 0.0]), velocity=place))
    return folder


def test_in_space_the_hold_of_the_frozen_ship_stands_as_she_does(tmp_path):
    """From where it is as she rests; and her cargo lies as it did."""
    preset = load("space/barge-quick", {"run.duration": f"{LASTS} s"}).resolved
    place = np.array([[[-0.02, 0.02, 0.0], [0.0, 0.02, 0.01], [0.02, 0.02, 0.0], [0.0, 0.03, 0.0]]])
    rest = [*preset.ship.hold_at_rest, 0.0, 0.0, 0.0]
    with recorder(tmp_path, resolved=to_table(preset), outline=np.array(preset.tank.corners)) as writer:
        for now in (0.0, 0.5, 1.0):
            pose, lost = np.array([[*rest, -0.3 * now]]), [-1.0 if now < 1.0 else 1.0]
            writer.sample(sample(now, axes=3, faces=len(preset.faces), pose=pose, **of_a_ship(flooded=lost)))
            writer.frame(frame(now, axes=3, pose=pose, position=place, velocity=place))
    with open_footage(tmp_path) as footage:
        loose, still, (time, roll, _) = beds_of(footage, tmp_path)
        assert loose.footage.space.stance[:, 0] == pytest.approx(np.outer([0.0, 0.5, 1.0], [0, 0, 0, 0, 0, -0.3]))
        stance = still.footage.space.series_stance[:, 0]
        assert stance[:, 5] == pytest.approx(roll) and len(stance) == len(time)
        assert np.abs(stance[:, :2]).max() < 0.02  # about an axis in the waterline
        hull = still.footage.space.hull.points
        assert hull[:, :2].min(axis=0) == pytest.approx(preset.ship.corners.min(axis=0) - preset.ship.hold)


def beds_of(footage, folder):
    (loose,) = choose_beds(footage)
    with open_recording(folder) as recording:
        return loose, frozen_bed(loose, recording, "frozen"), frozen(recording)


def test_frozen_cargo_stays_as_it_lay_and_she_rolls_as_computed_by_herself(sailed):
    with open_footage(sailed) as footage:
        loose, still, (time, roll, end) = beds_of(footage, sailed)
        assert still.footage.time[-1] == pytest.approx(time[-1]) and time[-1] > loose.footage.time[-1]
        middle = still.frames // 2
        assert np.array_equal(still.position(middle), loose.position(0)) and not still.speed(middle).any()
        assert np.array_equal(still.position(middle + 0.4), loose.position(0))
        expected = np.interp(still.footage.time, time, roll)
        assert still.pose[:, 2] == pytest.approx(expected) and np.ptp(roll) > 0.005
        assert still.footage.ends == [end]
        assert not np.array_equal(loose.position(2), loose.position(0))  # the loose ones go on sliding


def test_both_ships_are_in_one_film_each_in_her_sea_and_a_loss_is_told_below_the_ship(sailed):
    with open_footage(sailed) as footage:
        loose, still, _ = beds_of(footage, sailed)
        film = Film([loose, still], choose_look(footage, width=1280, height=720))
        last = len(film.time) - 1
        before, after = film.picture(0), film.picture(last)
        assert film.time[-1] == pytest.approx(LASTS)
        red = (np.abs(after.astype(int) - film._theme.lost).max(axis=2) < 2).nonzero()
        assert len(red[0]) > 500 and not (np.abs(before.astype(int) - film._theme.lost).max(axis=2) < 2).any()
        keel = film.tank_camera(0, last).pixels(footage.sea.hull)[:, 1].max()
        assert red[0].min() > keel
        one, other = film._view._cells.boxes
        assert not overlap(one, other) and one[1] == other[1] and one[3] == other[3]
        for left, top, right, bottom in (one, other):  # sea from edge to edge
            sea = after[bottom - 60, left:right].astype(int)
            assert (np.ptp(sea, axis=0) < 4).all() and top < bottom - 60


def test_the_camera_goes_with_a_ship_that_drifts(sailed):
    """Without that she would leave the middle, and be small in the picture."""
    with open_footage(sailed) as footage:
        film = Film(choose_beds(footage), choose_look(footage, width=640, height=360))
        hull = footage.sea.hull
        middles = [film.tank_camera(0, k).pixels(hull)[:, 0] for k in range(3)]
        assert np.ptp([0.5 * (places.min() + places.max()) for places in middles]) < 30.0
        assert np.ptp(middles[0]) > 0.3 * 430


def test_without_a_ship_there_is_nothing_to_freeze(tmp_path):
    with recorder(tmp_path) as writer:
        writer.sample(sample(0.0))
        writer.frame(frame(0.0))
    with open_footage(tmp_path) as footage, open_recording(tmp_path) as recording:
        (bed,) = choose_beds(footage)
        with pytest.raises(LabError, match="no ship whose cargo could be frozen"):
            frozen_bed(bed, recording, "frozen")


@pytest.mark.parametrize("filled", [False, True])
@pytest.mark.parametrize("count", [1, 2, 5, 24])
def test_cells_lie_in_the_stage_and_show_all_to_one_scale(count, filled):
    ground = np.array([-1.0, -0.5]), np.array([1.0, 0.5])
    view = (20, 40, 820, 640)
    cells = lay_cells([ground] * count, view, 10.0, Room(5.0, 18.0, 20.0, filled))
    assert len({camera.scale for camera in cells.cameras}) == 1
    for k, (camera, box) in enumerate(zip(cells.cameras, cells.boxes, strict=True)):
        (left, bottom), (right, top) = camera.pixels(np.array(ground))
        assert box[0] <= left and right <= box[2] and box[1] <= top and bottom <= box[3] - 20
        assert view[0] - 1 <= box[0] and box[2] <= view[2] + 1 and box[3] <= view[3] + 1
        assert not any(overlap(box, other) for other in cells.boxes[:k])
    edges = np.array(cells.boxes)
    reached = *edges[:, :1].min(axis=0), *edges[:, 2:].max(axis=0)
    assert (reached == (view[0], *view[2:])) == filled or count == 1  # those of ships leave none of the view empty


@pytest.mark.parametrize("count", [1, 2, 4, 5, 24])
def test_names_stand_beside_beds_where_these_are_larger_so(count):
    """Square beds in a wide view have room at their sides; a name is left of its bed and on no other one."""
    ground, view = (np.array([-1.0, -1.0]), np.array([1.0, 1.0])), (20, 40, 820, 640)
    above = lay_cells([ground] * count, view, 10.0, Room(5.0, 18.0))
    beside = lay_cells([ground] * count, view, 10.0, Room(5.0, 18.0, beside=60.0))
    assert beside.cameras[0].scale >= above.cameras[0].scale
    if count == 4:  # two rows, for which the height decides
        assert beside.cameras[0].scale > above.cameras[0].scale
    beds = [np.sort(camera.pixels(np.array(ground)), axis=0) for camera in beside.cameras]
    for x, y in beside.names if beside.width == 60.0 else ():
        name = np.array([[x, y - 13.0], [x + 60.0, y]])
        assert view[0] <= x and view[1] <= y - 13.0
        assert not any((name[0] < bed[1]).all() and (bed[0] < name[1]).all() for bed in beds)
