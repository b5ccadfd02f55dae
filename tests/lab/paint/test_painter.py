"""The raster: areas, symmetry, spin marks, walls, and bytes that do not depend on the threads."""

import numpy as np
import pytest

from lab.paint.painter import (
    Camera,
    Edges,
    paint_below,
    paint_grains,
    paint_lines,
    paint_plate,
    paint_strokes,
    paint_tank,
    to_discs,
)
from solvers.grains.shapes.cargo import cargo, cargoes
from solvers.grains.shapes.contour import Contour
from solvers.machine.runtime import initialise

WHITE, BLACK = 255.0, 0.0


@pytest.fixture(autouse=True, scope="module")
def _taichi():
    initialise(fields=False)


def painted(discs, colour=BLACK, mark=BLACK, size=(64, 96), edges=None):
    """A white picture with discs (x, y, radius, mark right, mark down) on it, or outlines of these sizes."""
    picture = np.full((*size, 3), 255, dtype=np.uint8)
    discs = np.atleast_2d(np.asarray(discs, dtype=float))
    shape = len(discs), 3
    paint_grains(picture, discs, np.full(shape, colour), np.full(shape, mark), edges)
    return picture


def outline(name):
    """An outline of a cargo with the area of a disc of radius 1."""
    return cargo(name).outline(np.random.default_rng(1), 2.0)


def area(picture):
    """Pixels covered by black."""
    return (1.0 - picture[..., 0] / 255.0).sum()


@pytest.mark.parametrize("radius", [4.0, 7.3, 15.5, 27.0])
def test_a_disc_covers_its_area(radius):
    places = np.random.default_rng(1).uniform(30, 31, (8, 2))
    areas = [area(painted([*place, radius, 1, 0])) for place in places]
    np.testing.assert_allclose(areas, np.pi * radius**2, rtol=5e-3)


@pytest.mark.parametrize("radius", [0.2, 0.5, 0.7, 1.4, 2.2])
def test_small_discs_cover_their_area_on_average(radius):
    places = 4.0 + 8.0 * np.stack(np.meshgrid(np.arange(10), np.arange(6)), -1).reshape(-1, 2)
    places += np.random.default_rng(2).uniform(0, 1, places.shape)
    discs = np.column_stack([places, np.tile([radius, 1, 0], (len(places), 1))])
    assert area(painted(discs)) / len(places) == pytest.approx(np.pi * radius**2, rel=0.03)


def test_touching_discs_do_not_hide_each_other():
    pair = painted([[20.3, 30.0, 8.0, 1, 0], [36.3, 30.0, 8.0, 1, 0]])
    assert area(pair) == pytest.approx(2 * np.pi * 64, rel=5e-3)


def test_where_discs_overlap_the_first_is_visible():
    first, second = [40.0, 30.0, 20.0, 1, 0], [44.0, 30.0, 12.0, 0, 1]
    once, both = painted([first], 90.0, 250.0), painted([first, second], 90.0, 250.0)
    np.testing.assert_array_equal(both, once)


@pytest.mark.parametrize("name", cargoes())
def test_an_outline_covers_its_area_however_it_is_turned(name):
    random = np.random.default_rng(5)
    edges, radius = Edges.of([outline(name)], np.zeros(1, dtype=int)), 14.0
    for angle in random.uniform(0, 2 * np.pi, 6):
        disc = [*random.uniform(31.5, 32.5, 2), radius, np.cos(angle), np.sin(angle)]
        assert area(painted(disc, edges=edges)) == pytest.approx(np.pi * radius**2, abs=1.0)


def test_an_outline_is_painted_at_its_points():
    contour = outline("beans")
    camera, angle, radius = Camera(1000.0, (46.3, 31.1), 0.4), 1.9, 0.016
    disc = to_discs(camera, np.zeros((1, 2)), np.array([radius]), np.array([angle]))
    there = painted(disc, edges=Edges.of([contour], np.zeros(1, dtype=int)))[..., 0]
    finer = 6  # each pixel is asked so many times across and down whether it is inside
    right, down = np.meshgrid((np.arange(96 * finer) + 0.5) / finer, (np.arange(64 * finer) + 0.5) / finer)
    y, z = (right - 46.3) / 1000.0, (31.1 - down) / 1000.0
    inside = np.hypot(y, z) < radius * contour.polar(np.arctan2(z, y) - angle - 0.4)
    share = inside.reshape(64, finer, 96, finer).mean(axis=(1, 3))
    np.testing.assert_allclose(1.0 - there / 255.0, share, atol=0.12)


def test_small_outlines_cover_their_area_on_average():
    random = np.random.default_rng(6)
    places = 6.0 + 12.0 * np.stack(np.meshgrid(np.arange(7), np.arange(5)), -1).reshape(-1, 2)
    angle = random.uniform(0, 2 * np.pi, len(places))
    edges = Edges.of([outline("corn"), outline("soybeans")], np.arange(len(places)) % 2)
    for radius in (0.3, 0.8, 2.0):
        put = places + random.uniform(0, 1, places.shape)
        discs = np.column_stack([put, np.full(len(put), radius), np.cos(angle), np.sin(angle)])
        assert area(painted(discs, edges=edges)) / len(put) == pytest.approx(np.pi * radius**2, rel=0.05)


def test_a_round_outline_looks_like_a_disc():
    random = np.random.default_rng(7)
    place = random.uniform([0, 0], [96, 64], (30, 2))
    discs = np.column_stack([place, random.uniform(0.3, 12, 30), np.full(30, 0.6), np.full(30, 0.8)])
    there = painted(discs, 90.0, 250.0, edges=Edges.of([Contour(1.0)], np.zeros(30, dtype=int)))
    here = painted(discs, 90.0, 250.0)
    np.testing.assert_allclose(there.astype(int), here.astype(int), atol=3)  # the rim is set off by its width alone


def test_outlines_of_several_beds_keep_their_grains():
    one = Edges.of([outline("rice"), Contour(1.0)], np.array([1, 0, 1]))
    two = Edges.of([outline("corn")], np.array([0, 0]))
    both = Edges.joined([one, two])
    np.testing.assert_array_equal(both.radii[both.which[:3]], one.radii[one.which])
    np.testing.assert_array_equal(both.radii[both.which[3:]], two.radii[two.which])


def test_a_mirrored_scene_gives_the_mirrored_picture():
    random = np.random.default_rng(3)
    places = random.integers(0, [96 * 16, 64 * 16], (60, 2)) / 16  # exact in binary, on both sides
    discs = np.column_stack([places, random.uniform(0.3, 9, 60), np.full(60, 0.6), np.full(60, 0.8)])
    mirrored = discs * [-1, 1, 1, -1, 1] + [96, 0, 0, 0, 0]
    there, here = painted(mirrored, 90.0, 250.0), painted(discs, 90.0, 250.0)
    np.testing.assert_array_equal(there, here[:, ::-1])


def test_the_spin_mark_points_where_the_grain_and_the_camera_have_turned():
    for angle, turn in [(0.0, 0.0), (1.1, 0.0), (1.1, 0.9), (-2.5, 0.4)]:
        camera = Camera(1000.0, (48.0, 32.0), turn)
        disc = to_discs(camera, np.zeros((1, 2)), np.array([0.02]), np.array([angle]))
        marked = painted(disc, 90.0, 250.0).astype(float) - painted(disc, 90.0, 90.0)
        rows, columns = np.indices(marked.shape[:2]) + 0.5
        weight = np.abs(marked[..., 0])
        right = (weight * (columns - 48)).sum() / weight.sum()
        up = (weight * (32 - rows)).sum() / weight.sum()
        assert np.hypot(right, up) == pytest.approx(0.52 * 20, rel=0.02)
        assert np.exp(1j * np.arctan2(up, right)) == pytest.approx(np.exp(1j * (angle + turn)), abs=0.02)


def test_a_camera_moved_with_the_tank_shows_its_points_in_the_earth_frame():
    camera, pose = Camera(300.0, (10.0, 20.0)), np.array([0.1, -0.05, 0.7])
    point = np.array([0.03, 0.08])
    cosine, sine = np.cos(0.7), np.sin(0.7)
    earth = pose[:2] + np.array([[cosine, -sine], [sine, cosine]]) @ point
    expected = [10 + 300 * earth[0], 20 - 300 * earth[1]]
    np.testing.assert_allclose(camera.carried(pose).pixels(point[None])[0], expected)


def test_the_wall_lies_outside_the_outline():
    picture = np.full((64, 96, 3), 255, dtype=np.uint8)
    outline = np.array([(0.0, 0.0), (0.04, 0.0), (0.04, 0.03), (0.0, 0.03)])
    paint_tank(picture, Camera(1000.0, (20.0, 50.0)), outline, 5.0, (80, 80, 80), (240, 240, 240))
    row = picture[35, :, 0]
    assert (row[15:20] == 80).all() and (row[20:60] == 240).all() and (row[60:65] == 80).all()
    assert row[14] == 255 and row[65] == 255
    column = picture[:, 40, 0]
    assert (column[50:55] == 80).all() and (column[20:50] == 240).all() and column[55] == 255


def test_a_wall_ends_in_a_straight_cut_at_an_open_edge():
    picture = np.full((64, 96, 3), 255, dtype=np.uint8)
    outline = np.array([(0.0, 0.0), (0.04, 0.0), (0.04, 0.03), (0.0, 0.03)])
    paint_tank(picture, Camera(1000.0, (20.0, 50.0)), outline, 5.0, (80,) * 3, (240,) * 3, open_edges=(2,))
    assert (picture[:20] == 255).all()  # nothing above the open edge
    assert (picture[20:50, 20:60] == 240).all()
    for wall in (np.s_[20:50, 15:20], np.s_[20:50, 60:65], np.s_[50:55, 20:60]):
        assert (picture[wall] == 80).all()


def test_a_plate_covers_its_length_and_its_round_ends():
    picture = np.full((64, 96, 3), 255, dtype=np.uint8)
    line = np.array([(0.0, 0.0), (0.03, 0.01), (0.05, 0.01)])
    paint_plate(picture, Camera(1000.0, (20.3, 40.2), 0.1), line, 6.0, (0, 0, 0))
    length = np.hypot(30, 10) + 20
    bend = np.arctan2(10, 30)  # the pieces overlap on its inner side, a round joint fills the outer
    overlap = 9 * (np.tan(bend / 2) - bend / 2)
    assert area(picture) == pytest.approx(6 * length + 9 * np.pi - overlap, rel=5e-3)


def stroked(*strokes):
    picture = np.full((64, 96, 3), 255, dtype=np.uint8)
    paint_strokes(picture, np.array(strokes, dtype=float), (0, 0, 0))
    return area(picture)


def test_a_line_covers_its_length_and_its_round_ends_and_may_end_in_a_point():
    """Ends of one line on each of three bands of the raster."""
    length = np.hypot(50.0, 41.0)
    assert stroked([20.3, 12.1, 2.0, 70.3, 53.1, 2.0]) == pytest.approx(4.0 * length + 4.0 * np.pi, rel=5e-3)
    assert stroked([20.3, 12.1, 3.0, 70.3, 53.1, 0.0]) == pytest.approx(3.0 * length + 4.5 * np.pi, rel=2e-2)
    assert stroked([20.3, 12.1, 0.1, 70.3, 53.1, 0.1]) == pytest.approx(0.2 * length, rel=2e-2)


def test_lines_are_painted_once_where_they_cross_and_not_off_the_page():
    across, up = [10.0, 30.5, 1.5, 80.0, 30.5, 1.5], [45.5, 5.0, 1.5, 45.5, 60.0, 1.5]
    assert stroked(across, up) == pytest.approx(stroked(across) + stroked(up) - 9.0, abs=1e-3)
    assert stroked(across, across) == stroked(across)
    assert stroked([np.nan, 3.0, 1.0, 9.0, 9.0, 1.0], [200.0, 300.0, 1.0, 400.0, 300.0, 1.0]) == 0.0


def test_the_sea_is_painted_below_its_surface_and_its_lines_are_as_thick_as_they_are():
    picture, surface = np.full((64, 96, 3), 255, dtype=np.uint8), 30.3 + 5.0 * np.sin(0.1 * np.arange(96))
    paint_below(picture, (8, 4, 88, 60), surface[8:88], np.zeros((56, 3)))
    assert area(picture) == pytest.approx((60.0 - surface[8:88]).sum(), rel=1e-3)
    picture[:] = 255
    paint_lines(
        picture, (8, 4, 88, 60), np.array([surface[8:88], surface[8:88] + 20.0]), [(3.0, 1.0), (2.0, 0.5)], (0,) * 3
    )
    assert area(picture) == pytest.approx(80 * (3.0 + 0.5 * 2.0), rel=5e-3)


def test_a_slanted_hold_has_its_area():
    picture = np.full((64, 96, 3), 255, dtype=np.uint8)
    outline = np.array([(0.0, 0.0), (0.05, 0.0), (0.03, 0.01), (0.04, 0.03), (0.0, 0.03)])
    y, z = 1000 * outline.T
    exact = 0.5 * (y * np.roll(z, -1) - z * np.roll(y, -1)).sum()
    paint_tank(picture, Camera(1000.0, (30.3, 50.1), 0.3), outline, 3.0, (255,) * 3, (0,) * 3)
    assert area(picture) == pytest.approx(exact, rel=5e-3)


def test_grains_without_a_finite_position_or_off_the_page_are_left_out():
    discs = [[np.nan, 3, 2, 1, 0], [1e12, 3, 2, 1, 0], [3, -1e12, 2, 1, 0], [np.inf, 3, 2, 1, 0]]
    assert area(painted(discs)) == 0
    assert area(painted(np.empty((0, 5)))) == 0


def test_the_picture_does_not_depend_on_the_number_of_threads():
    random = np.random.default_rng(4)
    count = 3000
    place = random.uniform(-20, 420, (count, 2))
    discs = np.column_stack([place, random.uniform(0.2, 12, count), np.ones(count), np.zeros(count)])
    outline = np.array([(0.0, 0.0), (0.3, 0.0), (0.2, 0.3)])
    pictures = []
    for threads in (1, 2):
        initialise(threads)
        picture = painted(discs, 120.0, 30.0, (400, 400))
        paint_tank(picture, Camera(900.0, (50.0, 300.0), 0.2), outline, 9.0, (9,) * 3, (99,) * 3)
        pictures.append(picture)
    initialise(fields=False)
    assert pictures[0].tobytes() == pictures[1].tobytes()


def test_a_pane_has_two_faces_and_glass_between_them_and_its_whole_thickness():
    outline = np.array([(0.2, 0.2), (0.8, 0.2), (0.8, 0.8), (0.2, 0.8)])
    picture, plain = np.zeros((2, 100, 100, 3), "u1")
    camera, steel, hold, glass = Camera(100.0, (0.0, 100.0)), (90, 90, 90), (10, 10, 10), (200, 220, 240)
    paint_tank(picture, camera, outline, 12.0, steel, hold, (2,), core=glass)
    paint_tank(plain, camera, outline, 12.0, steel, hold, (2,))
    across = picture[50, 81:92]
    assert (across[0] == steel).all() and (across[5] == glass).all() and (across[10] == steel).all()
    assert ((picture > 0).any(axis=2) == (plain > 0).any(axis=2)).all()  # it covers what a wall of steel does
    assert (picture[10] == 0).all() and (picture[15, 50] == 0).all()  # none at the open edge
    thin = np.zeros((100, 100, 3), "u1")
    paint_tank(thin, camera, outline, 3.0, steel, hold, core=glass)
    assert not (thin[..., 2] > 100).any()
