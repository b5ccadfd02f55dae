"""Videos, pictures and posters of a recording, and the messages if there can be none."""

import shutil

import h5py
import imageio.v2 as imageio
import numpy as np
import pytest
import scipy.ndimage

from lab.base.errors import LabError
from lab.paint.bulk.colours import FIELDS as BULK_FIELDS
from lab.paint.colours import MODES
from lab.paint.film import Film, choose_beds, choose_look
from lab.paint.footage import Bed, open_footage
from lab.paint.page.texts import Texts
from lab.paint.page.theme import LIGHT, luminance
from lab.paint.video import playback, poster, render_grid, render_recording
from lab.paint.water.colours import FIELDS
from lab.paint.water.colours import OF_WET as WET_FIELDS
from lab.preset.fields import taken_of
from lab.preset.sections.video import OF_AIR, OF_WET, Video, colours_of
from solvers.machine.runtime import initialise
from tests.oracles.synthetic import box, frame, recorder, sample
from tests.oracles.tampering import sealed

WIDTH, HEIGHT, DIAMETER = 0.18, 0.09, 4e-3


def make_recording(folder, worlds=1, frames=6, samples=40, tilt=0.6, sway=0.0, duration=8.0):
    """Record a made-up run in a folder: the upper layers slide the more the further the tank tilts."""
    y, z = np.meshgrid(
        np.arange(-WIDTH / 2 + DIAMETER / 2, WIDTH / 2 - DIAMETER / 4, DIAMETER),
        np.arange(DIAMETER / 2, 0.5 * HEIGHT, DIAMETER),
    )
    start = np.column_stack([y.ravel(), z.ravel()])
    radius = DIAMETER / 2 * np.random.default_rng(1).uniform(0.9, 1.0, (worlds, len(start)))
    late = 0.3 + 0.05 * np.arange(worlds)[:, None]

    def slide(time):
        share = np.clip(time / duration - late, 0, 1)
        return -0.4 * WIDTH * share * np.exp((start[:, 1] - 0.5 * HEIGHT) / 0.012)

    def place(time):
        y = np.clip(start[:, 0] + slide(time), -WIDTH / 2 + DIAMETER / 2, None)
        return np.stack([y, np.broadcast_to(start[:, 1], y.shape)], axis=-1)

    def pose(time):
        return np.tile([sway * np.sin(2 * np.pi * time), 0.0, tilt * time / duration], (worlds, 1))

    video = {"width": 640, "height": 360}
    settings = {"resolved": {"title": "A made-up bed of discs", "video": video}, "radius": radius}
    with recorder(folder, outline=box(WIDTH, HEIGHT), **settings) as run:
        for time in np.linspace(0, duration, samples):
            centre = np.stack([slide(time).mean(axis=1), np.zeros(worlds)], axis=-1)
            run.sample(sample(time, worlds, pose=pose(time), centre_of_mass=centre))
        step = duration / max(frames - 1, 1)
        for k in range(frames):
            now, then = place(step * k), place(step * max(k - 1, 0))
            moved = {"position": now, "velocity": (now - then) / step, "angle": slide(step * k) / radius}
            run.frame(frame(step * k, worlds, len(start), pose=pose(step * k), **moved))
    return run.path


@pytest.fixture(scope="module")
def recording(tmp_path_factory):
    """A small recording of one bed."""
    return make_recording(tmp_path_factory.mktemp("run"))


@pytest.fixture(scope="module")
def four_beds(tmp_path_factory):
    """A small recording of four beds, tilting and swaying."""
    return make_recording(tmp_path_factory.mktemp("run"), worlds=4, sway=0.02)


def pictures_of(recording, frames, world=None, **wishes):
    """Pictures of some frames of a recording."""
    initialise(fields=False)
    with open_footage(recording) as footage:
        film = Film(choose_beds(footage, world), choose_look(footage, **wishes))
        return [film.picture(frame).astype(int) for frame in frames]


def test_a_video_has_the_frames_the_size_and_the_colours_of_its_pictures(recording, tmp_path):
    told = []
    out = tmp_path / "film.mp4"
    written = render_recording(recording, out, progress=lambda *done: told.append(done))
    assert written == out and list(tmp_path.iterdir()) == [out]
    film = [frame.astype(int) for frame in imageio.get_reader(out)]
    assert len(film) == 6 and film[0].shape == (360, 640, 3)
    assert told == [(k, 6) for k in range(1, 7)]
    (last,) = pictures_of(recording, [5])
    assert np.abs(film[5] - last).mean() < 3


def test_an_interrupted_video_leaves_nothing_behind(recording, tmp_path):
    def interrupt(done, of):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        render_recording(recording, tmp_path / "film.mp4", progress=interrupt)
    assert not list(tmp_path.iterdir())


def test_a_run_folder_gets_its_pictures_and_its_poster(recording):
    folder = recording.parent
    (folder / "pictures").mkdir()
    (folder / "pictures" / "picture_00099.png").write_bytes(b"of an older film")
    made = render_recording(folder, png=True, width=320, height=180)
    assert made == folder / "pictures"
    names = sorted(file.name for file in made.iterdir())
    assert names == [f"picture_{k:05d}.png" for k in range(6)]
    assert imageio.imread(made / names[0]).shape == (180, 320, 3)
    end = imageio.imread(poster(folder, width=320, height=180))
    np.testing.assert_array_equal(end, imageio.imread(made / names[5]))
    middle = poster(folder, folder / "middle.png", time=3.3, width=320, height=180)
    np.testing.assert_array_equal(imageio.imread(middle), imageio.imread(made / names[2]))


def test_playback_keeps_the_requested_speed():
    time = np.arange(0, 4, 0.04)
    assert playback(time, 1.0) == (25.0, 1)
    assert playback(time, 0.5) == (12.5, 1)
    assert playback(time, 8.0) == (50.0, 4)
    assert playback(time[:1], 1.0) == (25.0, 1)


@pytest.mark.parametrize("frame", ["tank", "earth"])
def test_only_the_tanks_and_the_readings_change(four_beds, frame):
    first, *others = pictures_of(four_beds, range(6), frame=frame, width=640, height=360)
    changed = np.any([(other != first).any(axis=2) for other in others], axis=0)
    assert changed[:, 20:425].any() and changed[:, 450:620].any()
    edges = np.ones_like(changed)
    edges[30:346, 14:428] = edges[14:346, 456:626] = False
    assert not changed[edges].any()


@pytest.mark.parametrize(("frame", "tilt"), [("tank", 0.0), ("earth", 0.6)])
def test_the_tank_is_drawn_at_its_pose_with_the_grains_inside(recording, frame, tilt):
    (picture,) = pictures_of(recording, [5], width=640, height=360, frame=frame)
    wall = (np.abs(picture - (86, 97, 110)).max(axis=2) == 0)[:, :430]
    rows, columns = np.nonzero(wall)
    arrow = drive_arrow(picture)
    tall = HEIGHT * np.cos(tilt) + WIDTH * np.sin(tilt)
    wide = WIDTH * np.cos(tilt) + HEIGHT * np.sin(tilt)
    ratio = np.ptp(rows) / np.ptp(columns)
    assert ratio == pytest.approx(tall / wide, abs=0.02)
    grains = np.nonzero(((np.ptp(picture, axis=2) > 60) & ~arrow)[:, :430])
    for grain, edge in zip(grains, (rows, columns), strict=True):
        assert edge.min() < grain.min() and edge.max() - 12 < grain.max() < edge.max()


@pytest.mark.slow
def test_one_of_four_beds_is_shown_larger(four_beds):
    all_beds, one_bed = (
        (np.ptp(pictures_of(four_beds, [0], world=world)[0][:, :430], axis=2) > 60).sum() for world in (None, 2)
    )
    assert one_bed > 0.9 * all_beds
    assert not np.array_equal(*(pictures_of(four_beds, [5], world=k)[0] for k in (0, 3)))


def test_every_colour_mode_has_one_scale_for_the_whole_film(four_beds):
    with open_footage(four_beds) as footage:
        beds = choose_beds(footage)
        for name, mode in MODES.items():
            if name == "pressure":  # the grains of this bed lie in each other: see test_forces
                continue
            colouring = mode(beds)
            values = [colouring.values(beds[1], frame) for frame in range(6)]
            assert np.min(values) >= colouring.low - 1e-9 and np.max(values) <= 1.1 * colouring.high, name
            tables = [colouring.colours(beds[1], frame) for frame in range(6)]
            assert all(table.shape == (len(footage.radius[1]), 3) for table in tables)
        moved = MODES["displacement"](beds).values(beds[0], 5).max()
        farthest = 0.4 * WIDTH * 0.7 * np.exp(-0.003 / 0.012)  # of the uppermost layer
        assert moved == pytest.approx(farthest / beds[0].diameter, rel=1e-3)
        layers = MODES["layer"](beds).values(beds[0], 3)
        assert np.ptp(layers[beds[0].position(0)[:, 1] < DIAMETER]) == 0
        assert len(np.unique(layers)) == MODES["layer"](beds).high == 6
        assert MODES["layer"](beds).label == "starting layer (2 diameters)"
        assert MODES["size"](beds).values(beds[2], 4) == pytest.approx(2000 * footage.radius[2])


def test_painted_grains_have_the_colours_of_their_values(four_beds):
    """The further a grain has moved the darker it is, and grains at both ends of the scale are seen in its colours."""
    (picture,) = pictures_of(four_beds, [5], world=0, colour="displacement", frame="tank")
    with open_footage(four_beds) as footage:
        bed = choose_beds(footage, 0)
        moved = MODES["displacement"](bed)
        values, tints = moved.values(bed[0], 5), moved.colours(bed[0], 5)
    order = np.argsort(values)
    assert (np.diff([luminance(tint) for tint in tints[order]]) <= 0.0).all()
    for grain in order[[0, -1]]:
        assert (np.abs(picture - tints[grain]).max(axis=2) < 12).sum() > 20


def test_spin_is_coloured_in_turns_a_second(tmp_path):
    with recorder(tmp_path) as run:
        run.sample(sample(0.0))
        run.frame(frame(0.0, spin=np.array([[0.0, 2 * np.pi, -4 * np.pi, np.nan]])))
    with open_footage(tmp_path) as footage:
        bed = Bed(footage, 0, "")
        np.testing.assert_allclose(MODES["spin"]([bed]).values(bed, 0), [0, 1, 2, np.nan])


def test_a_preset_may_name_every_colour_and_no_other():
    water = [name for name in ("water", *FIELDS) if name not in MODES]
    bulk = [name for name in BULK_FIELDS if name not in (*MODES, *water)]
    assert taken_of(Video)["colour"].words == (*MODES, *water, *OF_AIR, *OF_WET, *bulk)
    assert colours_of(("bulk",)) == tuple(BULK_FIELDS)
    assert colours_of(("grains",)) == tuple(MODES)
    assert colours_of(("water",)) == ("water", *FIELDS)
    assert colours_of(("grains", "water"))[-1:] == OF_WET and set(WET_FIELDS) == set(OF_WET)
    assert set(colours_of(("water", "air"))) >= set(OF_AIR)


def test_the_curves_grow_with_the_film(four_beds):
    column = np.s_[100:280, 450:]
    drawn = [(np.ptp(picture[column], axis=2) > 60).sum() for picture in pictures_of(four_beds, [0, 2, 5])]
    assert 0 < drawn[0] < drawn[1] < drawn[2]


@pytest.mark.slow
def test_beds_with_different_motions_share_only_the_clock(four_beds, tmp_path, monkeypatch):
    """Their readings stand beside their names; those of beds that move alike beside the clock."""
    apart, write, told = shutil.copy(four_beds, tmp_path), Texts.write, []

    def noted(texts, name, box, text, *rest, **kept):
        told.append((name, text))
        return write(texts, name, box, text, *rest, **kept)

    monkeypatch.setattr(Texts, "write", noted)
    with h5py.File(apart, "r+") as file:
        file["frames/pose"][:, 1] *= 0.5
        sealed(file)
    (together,) = pictures_of(four_beds, [5])
    names = {text for name, text in told if name.startswith("bed ")}
    told.clear()
    (alone,) = pictures_of(apart, [5])
    with_readings = {text for name, text in told if name.startswith("bed ")}
    readings = np.s_[44:80, 456:626]
    assert (together[readings] < 100).any() and (alone[readings] == 255).all()
    assert names == {"bed 1", "bed 2", "bed 3", "bed 4"}
    assert len(with_readings) == 4 and all("(" in text for text in with_readings)


def test_a_run_without_frames_or_a_file_cut_short_is_refused_in_one_sentence(tmp_path):
    empty = make_recording(tmp_path / "empty", frames=0)
    refused(empty, "has no picture frames yet")
    whole = make_recording(tmp_path / "cut")
    whole.write_bytes(whole.read_bytes()[:4000])
    refused(whole, "cannot be read as a recording")
    refused(tmp_path / "nothing", "does not exist")


def test_a_run_in_progress_can_be_filmed(tmp_path):
    with recorder(tmp_path) as run:
        run.sample(sample(0.0))
        run.frame(frame(0.0, position=np.full((1, 4, 2), 0.02)))
        run.flush()
        film = render_recording(tmp_path, width=320, height=180)
    assert sum(1 for _ in imageio.get_reader(film)) == 1


@pytest.mark.parametrize(
    ("wishes", "said"),
    [
        ({"width": 641}, "641 x 360 pixels cannot be filmed"),
        ({"height": 90}, "640 x 90 pixels cannot be filmed"),
        (
            {"colour": "taste"},
            "Unknown colour 'taste': choose one of cargo, speed, displacement, pressure, layer, size, kind, shape, ",
        ),
        ({"frame": "moon"}, "Unknown frame 'moon': choose one of tank, earth"),
        ({"world": 1}, "no world 1 in this recording: choose 0 to 0"),
        ({"speed": 0.0}, "playback speed 0.0"),
        ({"out": "film.avi"}, "a video is an .mp4 file"),
    ],
)
def test_impossible_options_are_refused_in_one_sentence(recording, wishes, said):
    refused(recording, said, **wishes)


def refused(path, said, **wishes):
    """Filming raises a LabError of one sentence that says so."""
    with pytest.raises(LabError) as caught:
        render_recording(path, **wishes)
    sentence = str(caught.value)
    assert said in sentence and sentence.endswith(".") and "\n" not in sentence
    assert not path.parent.joinpath("video.mp4").exists()


# --- open tanks, rough walls, moving parts

WALL, HOLD, FIXED, PART = (86, 97, 110), LIGHT.hold, (158, 166, 175), (128, 70, 27)


def low_tank(folder, open_edges=(2,), place=(0.0, 0.02), fixed=(), parts=None, drop=0.0, tilt=0.0):
    """A recording of one grain in a tank 180 x 90 mm, that is at `place` in the last of two frames."""
    parts = parts or {}
    resolved = {"title": "A tank", "video": {"width": 640, "height": 360}}
    scene = {"radius": np.full((1, 1), 0.004), "outline": box(WIDTH, HEIGHT), "resolved": resolved}
    with recorder(folder, open_edges=open_edges, fixed=fixed, parts=parts, **scene) as run:
        for time, where in ((0.0, (0.0, 0.02)), (1.0, place)):
            run.sample(sample(time, spilled=[0.0]))
            moved = {"position": np.array([[where]]), "part": np.full((1, len(parts), 2), [0.0, -drop * time])}
            run.frame(frame(time, count=1, pose=np.array([[0.0, 0.0, tilt * time]]), **moved))
    return run.path


def drive_arrow(picture):
    """The pixels of the arrow of the drive, with those around it."""
    return scipy.ndimage.binary_dilation(np.abs(picture - LIGHT.accent).max(axis=2) < 60, iterations=3)


def coloured(picture, colour, off=12):
    """Rows and columns of the view's pixels of about that colour."""
    return np.nonzero((np.abs(picture - colour).max(axis=2) <= off)[:, :430])


def test_an_open_edge_has_no_wall_and_the_others_have(tmp_path):
    (shut,) = pictures_of(low_tank(tmp_path / "a", ()), [0])
    (lidless,) = pictures_of(low_tank(tmp_path / "b", (2,)), [0])
    for picture, lid in ((shut, True), (lidless, False)):
        rows, columns = coloured(picture, WALL, 3)
        middle = rows[np.abs(columns - columns.mean()) < 5]
        assert middle.max() > rows.max() - 2  # the floor
        assert (middle.min() < rows.min() + 2) == lid
        sides = columns[np.abs(rows - rows.mean()) < 5]
        assert sides.min() == columns.min() and sides.max() == columns.max()


@pytest.mark.parametrize("view", ["tank", "earth"])
def test_a_spilled_grain_is_painted_below_and_beside_the_tank_until_it_is_gone(tmp_path, view):
    fallen = low_tank(tmp_path / "a", place=(-0.13, -0.03), tilt=0.1)
    (picture,) = pictures_of(fallen, [1], frame=view)
    arrow = drive_arrow(picture)
    grain = np.nonzero(((np.ptp(picture, axis=2) > 60) & ~arrow)[:, :430])
    rows, columns = coloured(picture, WALL, 3)
    assert len(grain[0]) > 20
    assert grain[1].max() < columns.min() and grain[0].min() > (0 if view == "earth" else rows.max())
    gone = low_tank(tmp_path / "b", place=(np.nan, np.nan), tilt=0.1)
    (picture,) = pictures_of(gone, [1], frame=view)
    arrow = drive_arrow(picture)
    assert not ((np.ptp(picture, axis=2) > 60) & ~arrow)[:, :430].any()


def test_a_grain_outside_the_shown_part_is_not_painted_elsewhere(tmp_path):
    (picture,) = pictures_of(low_tank(tmp_path, place=(-0.152, 0.05)), [1])
    assert not (np.ptp(picture, axis=2) > 60)[:, :430].any()
    assert (coloured(picture, WALL, 3)[1].max() - coloured(picture, WALL, 3)[1].min()) > 150  # not shrunk to nothing


@pytest.mark.slow
def test_fixed_grains_are_grey_unmarked_and_behind_the_others(tmp_path):
    fixed = np.array([(0.0, 0.02, 0.003), (0.05, 0.0, 0.004), (0.07, 0.03, 0.004)])
    plain = low_tank(tmp_path / "bare")
    for view in ("tank", "earth"):
        (bare,) = pictures_of(plain, [0], frame=view)
        (picture,) = pictures_of(low_tank(tmp_path / view, fixed=fixed), [0], frame=view)
        rows, columns = np.nonzero((picture != bare).any(axis=2)[:, :430])
        assert len(rows) > 40 and columns.min() > 260  # none at the middle, where a movable grain covers it
        assert np.median(picture[rows, columns], axis=0) == pytest.approx(FIXED, abs=12)
        assert (np.ptp(picture[rows, columns], axis=1) < 25).all()


def test_moving_parts_are_plates_at_their_displacement(tmp_path):
    plate = {"floor": np.array([(-0.05, 0.05), (0.05, 0.05)])}
    path = low_tank(tmp_path, parts=plate, drop=0.04)
    start, end = (coloured(picture, PART) for picture in pictures_of(path, [0, 1]))
    scale = (np.ptp(end[1]) + 1) / 0.1  # pixels a metre
    assert end[0].mean() - start[0].mean() == pytest.approx(0.04 * scale, rel=0.06)
    assert np.ptp(start[0]) < 6
    assert end[1].mean() == pytest.approx(start[1].mean(), abs=0.5)


# --- grids


@pytest.mark.slow
def test_a_grid_shows_every_bed_with_its_caption_on_one_scale(four_beds, recording, tmp_path):
    beds = [(four_beds, k) for k in range(4)] * 4 + [recording] * 8
    out = render_grid(
        beds, [f"{k / 5:.1f} Hz" for k in range(24)], tmp_path / "grid.png", width=1280, height=720, frame="tank"
    )
    picture = imageio.imread(out).astype(int)
    parts, _ = scipy.ndimage.label((picture[:, :860] == HOLD).all(axis=2))
    assert (np.bincount(parts.ravel())[1:] > 100).sum() == 24  # the air over each bed
    with pytest.raises(LabError, match=r"room for 1 to 24 beds \(got 25\)"):
        render_grid([*beds, recording], [""] * 25, out)


def test_a_bed_of_a_grid_that_ends_sooner_keeps_its_last_frame(recording, tmp_path):
    longer = make_recording(tmp_path / "longer", frames=11, duration=16.0)
    film = render_grid([recording, longer], ["short", "long"], tmp_path / "grid.mp4")
    frames = [frame.astype(int) for frame in imageio.get_reader(film)]
    assert len(frames) == 11
    changed = np.abs(frames[-1] - frames[-3]).max(axis=2) > 60
    half = np.s_[60:300, 20:225], np.s_[60:300, 225:430]
    short, long = (changed[part].sum() for part in half)
    if short > long:  # one above the other
        half = np.s_[50:180, 20:430], np.s_[190:320, 20:430]
        short, long = (changed[part].sum() for part in half)
    assert short < 0.05 * long
