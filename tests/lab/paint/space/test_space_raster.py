"""Pictures of spheres in space: perspective, what hides what, frames around a tank, cuts, and bytes at any threads."""

from itertools import pairwise

import numpy as np
import pytest

from lab.paint.painter import Camera
from lab.paint.space.camera import Gaze, SpaceCamera, framing, gaze_at, orbit
from lab.paint.space.painter import Skin, paint_space
from lab.paint.space.raster.faces import find_walls
from lab.paint.space.raster.layers import FAR, NOTHING, WALL, Layers
from lab.paint.space.raster.lines import lines_between, paint_lines_in_space
from lab.paint.space.raster.panes import TINT
from lab.paint.space.raster.shade import Paints
from lab.paint.space.raster.spheres import Spheres, find_spheres
from lab.paint.space.viewpoint import across
from lab.paint.space.walls import FACETS, Walls, lying_tank, prism, turned_plate, turned_tank
from solvers.machine.runtime import initialise

SKIN = Skin((250, 252, 253), (90, 98, 110), 1.0)
SIZE = 150, 200
NOWHERE = Walls.of([])
BOX = np.array([(-0.15, 0.0), (0.15, 0.0), (0.15, 0.2), (-0.15, 0.2)])


@pytest.fixture(autouse=True, scope="module")
def _taichi():
    initialise(fields=False)


def ahead(scale=100.0, distance=1.0, azimuth=0.0, elevation=0.0):
    """A camera at (0, 0, distance) that looks at the origin, in the middle of a picture of SIZE, if not turned."""
    gaze = Gaze(np.zeros(3), distance, azimuth, elevation)
    return SpaceCamera(gaze, Camera(scale, (SIZE[1] / 2, SIZE[0] / 2)))


def black(place, radius, camera, walls=NOWHERE):
    """A white picture with black spheres, and what is seen where."""
    picture = np.full((*SIZE, 3), 255, dtype=np.uint8)
    place, radius = np.atleast_2d(place).astype(float), np.atleast_1d(radius).astype(float)
    layers = paint_space(picture, camera, place, radius, Paints(np.zeros((len(place), 3))), walls, SKIN)
    return picture, layers


def seen(place, radius, camera, walls=NOWHERE):
    """Which of these spheres are seen anywhere."""
    layers = Layers(*SIZE)
    layers.clear(camera)
    find_walls(layers, camera, walls)
    spheres = Spheres.seen(camera, np.asarray(place, dtype=float), np.asarray(radius, dtype=float))
    find_spheres(layers, spheres)
    return set(spheres.which[np.unique(layers.who[layers.who >= 0])].tolist())


def rays(camera):
    """Directions (h, w, 3) through the middles of all pixels, in camera coordinates."""
    row, column = np.mgrid[: SIZE[0], : SIZE[1]] + 0.5
    across_, up = (column - camera.screen.offset[0]) / camera.focal, (camera.screen.offset[1] - row) / camera.focal
    return np.stack([across_, up, np.ones(SIZE)], axis=-1)


@pytest.mark.parametrize("place", [(0.0, 0.0, 0.0), (0.55, 0.3, 0.2), (-0.3, 0.15, 0.3)])
def test_a_sphere_is_seen_where_rays_meet_it_as_large_as_its_ellipse(place):
    """Rays within α = asin(r/d) of the middle's direction; the ellipse that this cone cuts has the semi-axes below.

    With θ between gaze and middle: f sin α cos α / (cos²θ − sin²α) and f sin α / √(cos²θ − sin²α). The edge's ramp of
    one pixel adds π/12, and the pixels sample it to less than one more.
    """
    camera, radius = ahead(), 0.17
    picture, layers = black(place, radius, camera)
    centre, ray = camera.gaze.seen(np.array([place]))[0], rays(camera)
    distance = np.linalg.norm(centre)
    cosine = ray @ centre / np.linalg.norm(ray, axis=-1) / distance
    alpha, theta = np.arcsin(radius / distance), np.arccos(centre[2] / distance)
    np.testing.assert_array_equal(layers.who == 0, cosine > np.cos(alpha))
    squared = np.cos(theta) ** 2 - np.sin(alpha) ** 2
    ellipse = np.pi * camera.focal**2 * np.sin(alpha) ** 2 * np.cos(alpha) / squared**1.5
    assert (1.0 - picture[..., 0] / 255.0).sum() == pytest.approx(ellipse, abs=np.pi / 12 + 1.0)
    surface = layers.depth[..., None] * ray - centre
    np.testing.assert_allclose(np.linalg.norm(surface, axis=-1)[layers.who == 0], radius, rtol=3e-6)  # 32-bit depths


def test_from_azimuth_0_the_picture_is_that_of_the_plane():
    pixels = ahead().pixels(np.array([(0.0, 0.0, 0.0), (0.1, 0.0, 0.0), (0.0, 0.1, 0.0)]))
    np.testing.assert_allclose(pixels - pixels[0], [(0, 0), (10, 0), (0, -10)], atol=1e-9)
    depth = ahead().gaze.seen(np.array([(0.0, 0.0, 0.0), (0.0, 0.0, 0.1)]))[:, 2]
    np.testing.assert_allclose(depth, [1.0, 0.9])


@pytest.mark.parametrize(("azimuth", "elevation"), [(0.3, 0.4), (-2.0, -0.7), (4.0, 1.2)])
def test_a_camera_does_not_mirror_and_keeps_the_vertical_upright(azimuth, elevation):
    right, up, away = Gaze(np.zeros(3), 1.0, azimuth, elevation).axes
    np.testing.assert_allclose(np.cross(right, up), -away, atol=1e-15)
    assert right[1] == 0.0 and up[1] > 0.0
    assert away[1] == pytest.approx(-np.sin(elevation))


def test_each_pixel_shows_the_sphere_that_its_ray_meets_first_in_any_order():
    """Of 40 spheres of all sizes that overlap; depths are kept in 32 bits, so where two are as close both will do."""
    random, camera = np.random.default_rng(4), ahead()
    place, radius = random.uniform(-0.4, 0.4, (40, 3)), random.uniform(0.02, 0.2, 40)
    centre, ray = camera.gaze.seen(place), rays(camera)
    along, squared = ray @ centre.T, (ray**2).sum(axis=-1)[..., None]
    inside = along**2 - squared * ((centre**2).sum(axis=1) - radius**2)
    met = np.where(inside > 0.0, (along - np.sqrt(np.maximum(inside, 0.0))) / squared, np.inf)
    least = np.sort(met, axis=-1)
    with np.errstate(invalid="ignore"):  # both are missed
        clear = (least[..., 1] - least[..., 0] > 1e-6) | np.isinf(least[..., 0])
    nearest = np.where(np.isfinite(least[..., 0]), met.argmin(axis=-1), NOTHING)
    for order in (np.arange(40), np.arange(40)[::-1]):
        _, layers = black(place[order], radius[order], camera)
        which = Spheres.seen(camera, place[order], radius[order]).which
        number = np.where(layers.who >= 0, order[which[np.maximum(layers.who, 0)]], NOTHING)
        np.testing.assert_array_equal(number[clear], nearest[clear])


@pytest.mark.parametrize("elevation", [-30.0, 0.0, 25.0, 80.0])
def test_a_frame_holds_all_corners_from_every_side_and_is_no_larger_than_needed(elevation):
    corners, box = prism(BOX, 0.4).points, (30.0, 10.0, 190.0, 140.0)
    azimuths = np.linspace(0.0, 2.0 * np.pi, 73)
    camera = framing(gaze_at(corners, 0.0, np.radians(elevation)), corners, azimuths, box)
    pixels = np.concatenate([camera.from_azimuth(azimuth).pixels(corners) for azimuth in azimuths])
    low, high = pixels.min(axis=0), pixels.max(axis=0)
    assert (low >= np.array(box[:2]) - 1e-9).all() and (high <= np.array(box[2:]) + 1e-9).all()
    np.testing.assert_allclose((low + high) / 2.0, [110.0, 75.0], atol=1e-9)
    assert ((high - low) / [160.0, 130.0]).max() == pytest.approx(1.0)


def test_an_orbit_goes_round_as_often_as_it_is_told():
    np.testing.assert_allclose(orbit(0.5, 1.5, np.array([2.0, 3.0, 6.0])), 0.5 + np.pi * np.array([0.0, 0.75, 3.0]))


@pytest.mark.parametrize("thick", [None, 0.1])
def test_a_cut_leaves_out_exactly_what_is_in_front_of_it(thick):
    line = np.linspace(-0.3, 0.3, 7)
    place = np.column_stack([line, 0.1 * np.sin(9.0 * line), line])
    radius = np.full(7, 0.03)
    wanted = line <= 0.05 if thick is None else np.abs(line - 0.05) <= 0.05 + 1e-12
    cut = across(0.05, thick if thick is None else thick + 1e-12)
    assert seen(place, radius, ahead(azimuth=0.4)) == set(range(7))
    assert seen(cut.shown(place), radius, ahead(azimuth=0.4)) == set(np.flatnonzero(wanted).tolist())


@pytest.mark.parametrize("outline", [BOX, BOX[::-1]])
def test_walls_never_hide_what_is_in_the_tank(outline):
    """The faces towards the camera are left out, whichever way the outline runs."""
    box, inside = prism(outline, 0.15), np.array([(0.0, 0.1, 0.0)])
    for azimuth, elevation in np.random.default_rng(2).uniform(-3.0, 3.0, (12, 2)) * [1.0, 0.5]:
        camera = ahead(200.0, 1.0, azimuth, elevation)
        assert seen(inside, [0.02], camera, box) == {0}


def test_a_pane_tints_what_is_behind_it_and_nothing_else():
    sphere, square = np.array([(0.0, 0.0, 0.0)]), np.array([(-0.1, -0.1), (0.1, -0.1), (0.1, 0.1), (-0.1, 0.1)])
    plain, pictures = black(sphere, 0.05, ahead(azimuth=0.2))[0], {}
    for x in (-0.1, 0.1):
        pane = Walls.of([np.column_stack([square, np.full(4, x)])], pane=True)
        pictures[x] = black(sphere, 0.05, ahead(azimuth=0.2), pane)[0]
    middle = (SIZE[0] // 2, SIZE[1] // 2)
    np.testing.assert_array_equal(pictures[-0.1][middle], plain[middle])
    tint = np.array(SKIN.wall) * TINT
    np.testing.assert_allclose(pictures[0.1][middle], tint, atol=1.0)


def test_a_line_is_hidden_by_what_is_in_front_of_it_and_not_by_the_walls_that_it_bounds():
    camera = ahead()
    picture, layers = black([(0.0, 0.0, 0.3)], 0.1, camera)
    line = lines_between(camera, np.array([[(-0.6, 0.0, 0.0), (0.6, 0.0, 0.0)]]), 1.0, 1.0)
    paint_lines_in_space(picture, layers, line, (255, 0, 0))
    row, middle = SIZE[0] // 2, SIZE[1] // 2
    assert picture[row, middle].tolist() == [0, 0, 0] and picture[row, middle + 40].tolist() == [255, 0, 0]
    under = SpaceCamera(Gaze(np.zeros(3), 1.0, 0.0, 0.05), camera.screen)  # a lid 0.1 m up, seen from 0.05 m up
    lid = Walls.of([np.array([(-0.3, 0.1, -0.3), (0.3, 0.1, -0.3), (0.3, 0.1, 0.3), (-0.3, 0.1, 0.3)])])
    picture, layers = black([(5.0, 0.0, 0.0)], 0.1, under, lid)
    assert (layers.who == WALL).sum() > 100
    (left, row), (right, _) = under.pixels(np.array([(-0.25, 0.1, -0.3), (0.25, 0.1, -0.3)]))
    rows = [int(row - 0.5), int(row + 0.5)]  # which the line of two pixels covers
    assert picture[rows, int(left) : int(right)].max() < 150  # of 185 for the lid and 110 for its edge


def test_a_turned_tank_is_seen_from_inside_and_has_the_area_of_its_cone():
    """A barrel over a cone with an opening: faces inwards from anywhere; regular prisms and pyramids of 96 sides."""
    half = np.array([(0.0, 0.0), (0.03, 0.0), (0.1, 0.07), (0.1, 0.2), (0.0, 0.2)])
    whole = np.concatenate([half[:-1], half[:0:-1] * [-1.0, 1.0]])[1:]
    for outline in (whole, whole[::-1]):
        tank = turned_tank(outline)
        middles = np.array([tank.points[a:b].mean(axis=0) for a, b in pairwise(tank.first)])
        assert (((np.array([0.0, 0.1, 0.0]) - middles) * tank.normals).sum(axis=1) > 0.0).all()
    side = 2.0 * np.sin(np.pi / FACETS)
    wanted = FACETS * side * (0.1 * 0.13 + 0.065 * np.hypot(0.07, 0.07 * np.cos(np.pi / FACETS)))
    wanted += FACETS * 0.5 * side * np.cos(np.pi / FACETS) * (0.03**2 + 0.1**2)
    assert sum(area(tank.points[a:b]) for a, b in pairwise(tank.first)) == pytest.approx(wanted, rel=1e-9)
    hopper = turned_plate(np.array([(-0.05, 0.1), (-0.02, 0.05), (0.02, 0.05), (0.05, 0.1)]))
    assert len(hopper.pane) == 2 * FACETS and hopper.pane.sum() == FACETS
    slant = ~hopper.pane
    starts = hopper.points[hopper.first[:-1]][slant] * [1.0, 0.0, 1.0]
    assert ((starts * hopper.normals[slant]).sum(axis=1) < 0.0).all()


def test_a_lying_tank_is_seen_from_inside_and_has_the_area_of_its_barrel_and_ends():
    """A drum about x, whichever way round its section is given."""
    profile = np.array([(-0.1, -0.03), (0.1, -0.03), (0.1, 0.03), (-0.1, 0.03)])
    for section in (profile, profile[::-1]):
        tank = lying_tank(section)
        middles = np.array([tank.points[a:b].mean(axis=0) for a, b in pairwise(tank.first)])
        assert ((-middles * tank.normals).sum(axis=1) > 0.0).all()
        np.testing.assert_allclose(np.hypot(*tank.points[:, :2].T).max(), 0.1)
        np.testing.assert_allclose(sorted(set(np.round(tank.points[:, 2], 9))), [-0.03, 0.03])
    wanted = 2.0 * FACETS * np.sin(np.pi / FACETS) * 0.1 * (0.06 + 0.1 * np.cos(np.pi / FACETS))
    assert sum(area(tank.points[a:b]) for a, b in pairwise(tank.first)) == pytest.approx(wanted, rel=1e-9)


def area(corners):
    """Area of a flat polygon (k, 3)."""
    off = corners - corners[0]
    return 0.5 * np.linalg.norm(np.cross(off, np.roll(off, -1, axis=0)).sum(axis=0))


def test_an_end_wall_that_is_not_convex_has_its_area_and_the_depth_of_its_plane():
    corner = np.array([(-0.4, -0.3), (0.4, -0.3), (0.4, 0.0), (0.1, 0.0), (0.1, 0.3), (-0.4, 0.3)])
    tank, camera, layers = prism(corner, 0.2), ahead(distance=2.0), Layers(*SIZE)
    layers.clear(camera)
    find_walls(layers, camera, tank)
    far = layers.who == WALL - (len(tank.pane) - 2)
    np.testing.assert_allclose(layers.depth[far], 2.1, rtol=1e-6)
    assert far.sum() == pytest.approx(0.39 * (200.0 / 2.1) ** 2, abs=2 * 280)  # at most the pixels along its border
    assert (layers.depth[layers.who == NOTHING] == np.float32(FAR)).all()


def test_carried_walls_keep_their_edges():
    turned = np.array([(0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)])
    place, tank = np.array([0.1, 0.2, 0.3]), prism(BOX, 0.15, (2,))
    ends, faces = tank.edges
    moved, same = tank.carried(place, turned).edges
    assert len(ends) == 12 and (faces[:, 1] < 0).sum() == 4  # the rim of a box without a lid
    np.testing.assert_allclose(moved, place + ends @ turned.T)
    np.testing.assert_array_equal(same, faces)


def test_walls_apart_have_the_edges_and_normals_that_are_found_in_all_of_them():
    several = [prism(BOX, 0.15, (2,)), Walls.of([]), turned_plate(np.array([(0.02, 0.3), (0.02, 0.25), (0.05, 0.25)]))]
    apart, joined = Walls.apart(several), Walls.joined(several)
    np.testing.assert_allclose(apart.normals, joined.normals)
    found = [
        sorted(
            (*np.sort(np.round(ends, 9), axis=0).ravel().tolist(), *np.sort(faces).tolist())
            for ends, faces in zip(*one.edges, strict=True)
        )
        for one in (apart, joined)
    ]
    assert len(found[0]) == len(found[1]) and np.allclose(found[0], found[1])


def test_the_picture_does_not_depend_on_the_number_of_threads():
    random, pictures = np.random.default_rng(3), []
    place = random.uniform(-1.0, 1.0, (800, 3)) * [0.14, 0.06, 0.06] + [0.0, 0.07, 0.0]
    paints = Paints(random.uniform(0, 255, (800, 3)), 0.5, np.tile([0.0, 1.0, 0.0], (800, 1)), np.zeros((800, 3)))
    box = prism(BOX, 0.15, (2,))
    camera = framing(gaze_at(box.points, 0.5, 0.4), box.points, [0.5], (5, 5, 195, 145))
    for threads in (1, 2):
        initialise(threads)
        picture = np.full((*SIZE, 3), 240, dtype=np.uint8)
        paint_space(picture, camera, place, np.full(800, 0.006), paints, box, SKIN)
        pictures.append(picture)
    initialise(fields=False)
    np.testing.assert_array_equal(*pictures)
