"""Films of scenes in space: the tank stays in its box, grains are where the camera says, wishes are kept or refused."""

import numpy as np
import pytest

from lab.base.errors import LabError
from lab.paint.cargo.looks import Stowage
from lab.paint.film import Film, choose_look
from lab.paint.space.marks import TurningAxes
from lab.paint.space.scene import SpaceScene
from lab.paint.space.stance import carried, rotation, turned_axes
from lab.paint.space.walls import drawn_out, prism
from lab.preset.find import load
from lab.preset.sections.video import Video
from solvers.machine.runtime import initialise
from tests.oracles.heaps import ALONG, BOX, MadeFootage, tilted
from tests.oracles.pools import standing_wave

SMALL = {"width": 640, "height": 360}


@pytest.fixture(autouse=True, scope="module")
def _taichi():
    initialise(fields=False)


@pytest.fixture(scope="module")
def made():
    return tilted(0.012)


def one_sphere(place=(0.05, 0.1, 0.02), radius=0.02, **more):
    """A footage of one sphere in a box that goes a way in all six freedoms."""
    share = np.linspace(0.0, 1.0, 3)
    stance = share[:, None] * [0.03, 0.02, -0.04, 0.3, -0.5, 0.4]
    position = np.tile(np.array(place), (3, 1, 1))
    return MadeFootage(position, np.array([radius]), stance, share, **more)


@pytest.mark.parametrize("wishes", [{}, {"frame": "tank"}, {"orbit": 1.0, "azimuth": "-50 deg", "elevation": "60 deg"}])
def test_the_tank_is_in_the_view_in_every_picture_and_fills_it(made, wishes):
    film = Film([made.bed], choose_look(made, **SMALL, **wishes))
    left, top, right, bottom = film.layout["view"]
    corners = np.concatenate([film.tank_camera(0, frame).pixels(made.space.walls.points) for frame in range(3)])
    assert (corners >= [left, top]).all() and (corners <= [right, bottom]).all()
    assert (np.ptp(corners, axis=0) / [right - left, bottom - top]).max() > 0.6
    film.picture(1)
    assert {"title", "clock", "scale", "note"} <= film.written.keys()


@pytest.mark.parametrize("frame", ["earth", "tank"])
def test_a_grain_is_painted_where_the_camera_of_the_tank_sees_it(frame):
    footage = one_sphere()
    footage.cargo = Stowage("iron-ore")
    film = Film([footage.bed], choose_look(footage, **SMALL, frame=frame, orbit=0.5))
    ways = []
    for k in range(3):
        (x, y), picture = film.tank_camera(0, k).pixels(footage.position[k])[0], film.picture(k)
        red, green, blue = picture[int(y), int(x)].astype(int)
        assert red > green + 30 and red > blue + 30
        ways.append((x, y))
    assert np.linalg.norm(np.diff(ways, axis=0), axis=1).min() > 5.0


def test_in_the_earths_frame_the_tanks_camera_sees_its_points_where_they_are_over_the_earth():
    footage = one_sphere()
    film = Film([footage.bed], choose_look(footage, **SMALL, orbit=0.25))
    earth = film._view.earth_camera(0, 2)
    moved = carried(footage.position[2], footage.stance[2])
    np.testing.assert_allclose(film.tank_camera(0, 2).pixels(footage.position[2]), earth.pixels(moved), atol=1e-9)


def test_a_cut_and_a_slice_leave_out_grains_in_a_film():
    footage = one_sphere()
    bare = one_sphere((np.nan, np.nan, np.nan))
    shots = {}
    for name, wishes in {
        "all": {},
        "in": {"slice": "60 mm"},
        "cut": {"cut": "10 mm"},
        "behind": {"cut": "30 mm"},
    }.items():
        shots[name] = Film([footage.bed], choose_look(footage, **SMALL, **wishes)).picture(0)
    empty = Film([bare.bed], choose_look(bare, **SMALL)).picture(0)
    view = Film([bare.bed], choose_look(bare, **SMALL)).layout["view"]
    part = slice(view[1], view[3]), slice(view[0], view[2])
    assert (shots["in"] == shots["all"]).all() and (shots["behind"] == shots["all"]).all()
    assert (shots["cut"][part] == empty[part]).all() and (shots["all"][part] != empty[part]).any()


@pytest.mark.parametrize(
    ("wishes", "key"),
    [
        ({"overlay": "forces"}, "video.overlay"),
        ({"inset": "surface"}, "video.inset"),
        ({"colour": "pressure"}, "video.colour"),
        ({"azimuth": "30"}, "video.azimuth"),
        ({"elevation": "100 deg"}, "video.elevation"),
        ({"slice": "-3 mm"}, "video.slice"),
    ],
)
def test_a_wish_that_a_scene_in_space_cannot_fulfil_is_refused_by_its_key(made, wishes, key):
    with pytest.raises(LabError, match=f"^{key}: .*\\.$"):
        choose_look(made, **wishes)


@pytest.mark.parametrize("name", ["azimuth", "elevation", "orbit", "cut", "slice"])
def test_keys_of_space_are_refused_in_the_plane(name):
    value = {"orbit": "1"}.get(name, "20 mm" if name in ("cut", "slice") else "20 deg")
    with pytest.raises(LabError, match=f"^video.{name}: goes with a scene in space"):
        load("tilting/quick", {f"video.{name}": value})
    with pytest.raises(LabError, match=f"^video.{name}: goes with a scene in space"):
        choose_look(standing_wave(frames=2), **{name: value})


def test_scenes_in_the_plane_and_in_space_are_not_filmed_together(made):
    with pytest.raises(LabError, match="film them apart"):
        Film([made.bed, standing_wave(frames=2).bed], choose_look(made, **SMALL))


def test_the_settings_of_a_preset_hold_where_nothing_is_asked():
    footage = one_sphere(settings=Video(azimuth=1.0, elevation=0.1, orbit=2.0))
    view = Film([footage.bed], choose_look(footage, **SMALL, elevation="30 deg"))._view
    gazes = [view.earth_camera(0, frame).gaze for frame in (0, 2)]
    np.testing.assert_allclose([gaze.azimuth for gaze in gazes], [1.0, 1.0 + 4.0 * np.pi])
    assert gazes[0].elevation == pytest.approx(np.radians(30.0))


def test_plates_move_as_they_are_recorded_in_a_plane_and_in_space():
    """A plate on the y axis, moved by 0.02 m upwards and turned by 90° about x: y becomes z."""
    line, still = np.array([(0.0, 0.0), (0.1, 0.0)]), np.zeros((2, 1, 3))
    shift, turn = np.array([(0.0, 0.02)]), np.array([0.5 * np.pi])
    flat = (np.stack([0.0 * shift, shift])[:, None], np.stack([0.0 * turn, turn])[:, None])
    whole = (np.pad(flat[0], [(0, 0), (0, 0), (0, 0), (0, 1)]), np.stack([0.0 * flat[1], 0.0 * flat[1], flat[1]], -1))
    for moves in (flat, whole):
        scene = SpaceScene.of(prism(BOX, ALONG), [drawn_out(line, ALONG)], (still, still), moves)
        end = carried(scene.plates[0].points, scene.part_at(0, 0, 1.0))
        np.testing.assert_allclose(end[:, 0], 0.0, atol=1e-12)
        np.testing.assert_allclose(sorted(set(np.round(end[:, 1], 9))), [0.02, 0.12])
        np.testing.assert_allclose(scene.part_at(0, 0, 0.5), [0, 0.01, 0, 0, 0, 0.25 * np.pi])
        np.testing.assert_allclose(np.abs(end[:, 2]), 0.5 * ALONG)


def test_marks_turn_by_one_axis_after_the_other():
    """A quarter turn about z, then one about y: the integral of the spin is both, and no turn about their sum."""
    footage = one_sphere()
    angle = np.array([(0.0, 0.0, 0.0), (0.0, 0.5 * np.pi, 0.0), (0.5 * np.pi, 0.5 * np.pi, 0.0)])
    grains = footage.grains
    footage.grains = lambda name, row, world: angle[row][None] if name == "angle" else grains(name, row, world)
    axes = TurningAxes(footage.bed)
    (start,), (end,) = axes.at(0), axes.at(2)
    wanted = rotation(np.array([0.5 * np.pi, 0.0, 0.0])) @ rotation(np.array([0.0, 0.5 * np.pi, 0.0])) @ start
    np.testing.assert_allclose(end, wanted, atol=1e-12)
    np.testing.assert_allclose(axes.at(0)[0], start)  # and back


def test_turns_are_right_handed_about_their_vectors():
    np.testing.assert_allclose(
        rotation(np.array([0.0, 0.0, 0.5 * np.pi])) @ [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], atol=1e-15
    )
    random = np.random.default_rng(1)
    vectors, axes = random.normal(size=(2, 5, 3))
    np.testing.assert_allclose(
        turned_axes(axes, vectors), [rotation(v) @ a for v, a in zip(vectors, axes, strict=True)]
    )
