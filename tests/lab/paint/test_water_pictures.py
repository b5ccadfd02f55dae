"""Water in pictures: its area, its edge at walls and in waves, its colours, its spray, and its gauges."""

from dataclasses import replace

import numpy as np
import pytest

from lab.paint import palette
from lab.paint.curves import MOST_SAMPLES, plots
from lab.paint.film import Film, choose_look
from lab.paint.painter import Camera
from lab.paint.water.colours import FIELDS, field
from lab.paint.water.foam import foam, trapped
from lab.paint.water.gauges import hues_of
from lab.paint.water.grid import REACH
from lab.paint.water.layer import DEEP, LIT, SPRAY, WaterLayer
from lab.paint.water.vorticity import vorticity
from solvers.fluid.given import Gauge, Level
from solvers.machine.runtime import initialise
from tests.oracles.pools import MadeFootage, filled, standing_wave, tank

SPACING, DEPTH, SCALE = 0.01, 0.2, 400.0  # m, m, pixels a metre
SIZE = 300, 480  # pixels


@pytest.fixture(autouse=True, scope="module")
def _taichi():
    initialise(fields=False)


def footage(place, outline=None, velocity=0.0, spacing=SPACING, **more):
    """Water of one frame at places (n, 2), with a pressure by depth."""
    place = np.asarray(place, dtype=float)
    moving = np.broadcast_to(velocity, place.shape).astype(float)
    pressure = 1e4 * np.maximum(DEPTH - place[:, 1], 0.0)
    outline = tank() if outline is None else outline
    now = {"time": np.zeros(1), "series_time": np.zeros(1), "series": {"water_centre": np.zeros((1, 2))}}
    return MadeFootage(outline, spacing, [place], [moving], [pressure], **now, **more)


def still(outline=None, rough=0.2, spacing=SPACING):
    """Water at rest up to DEPTH, its particles not in line."""
    outline = tank() if outline is None else outline
    return footage(filled(lambda p: p[:, 1] < DEPTH, outline, spacing, rough), outline, spacing=spacing)


def camera_of(turn=0.0):
    """A camera on the tank, which may have turned about the middle of its floor."""
    return Camera(SCALE, (0.5 * SIZE[1], SIZE[0] - 40.0), turn)


def painted(made, colour="water", camera=None, grey=255, frame=0):
    """The water alone, over a grey page."""
    picture = np.full((*SIZE, 3), grey, dtype=np.uint8)
    WaterLayer([made.bed], colour, 20.0).paint(picture, camera or camera_of(), made.bed, frame, (grey,) * 3)
    return picture.astype(int)


def shares(made, colour="water", camera=None, frame=0):
    """Share of each pixel that is covered by water, from pictures over white and over black."""
    white, black = (painted(made, colour, camera, grey, frame) for grey in (255, 0))
    return 1.0 - (white - black).mean(axis=2) / 255.0


def area(made, camera=None):
    """The painted area, m²."""
    return shares(made, camera=camera).sum() / SCALE**2


@pytest.mark.parametrize("turn", [0.0, 0.3])
@pytest.mark.parametrize("spacing", [0.02, 0.01, 0.004, 0.002])
def test_the_painted_area_of_still_water_is_its_volume(spacing, turn):
    """Within 1 %; beside slanted walls this measure leaves out the pixels that wall and water share, half a row."""
    made = still(spacing=spacing)
    shared = 0.5 * (0.9 + 2.0 * 0.2) / SCALE if turn else 0.0
    assert area(made, camera_of(turn)) + shared == pytest.approx(len(made.position[0]) * spacing**2, rel=0.01)


def test_the_painted_area_of_a_drop_and_of_spray_is_their_volume():
    drop = filled(lambda p: np.hypot(p[:, 0], p[:, 1] - 0.3) < 0.1, tank(), SPACING, rough=0.1)
    assert area(footage(drop)) == pytest.approx(len(drop) * SPACING**2, rel=0.01)
    apart = filled(lambda p: p[:, 1] > 0.1, tank(), 0.06, rough=0.2)
    assert area(footage(apart)) == pytest.approx(len(apart) * SPACING**2, rel=0.01)


def chamfered():
    """A tank whose lower corners are cut off."""
    return np.array([(-0.35, 0.0), (0.35, 0.0), (0.45, 0.1), (0.45, 0.5), (-0.45, 0.5), (-0.45, 0.1)])


def pointed():
    """A tank with a narrow bottom."""
    return np.array([(0.0, 0.0), (0.45, 0.3), (0.45, 0.5), (-0.45, 0.5), (-0.45, 0.3)])


def distance_inside(outline, points):
    """Distance (n,) of points from the nearest edge's line of a convex outline, negative outside."""
    after = np.roll(outline, -1, axis=0)
    along = (after - outline) / np.linalg.norm(after - outline, axis=1)[:, None]
    away = points[:, None] - outline
    return (along[:, 0] * away[..., 1] - along[:, 1] * away[..., 0]).min(axis=1)


def places_of_pixels(camera):
    """Places (height, width, 2) in the tank of the middles of the pixels."""
    x, y = np.meshgrid(np.arange(SIZE[1]) + 0.5, np.arange(SIZE[0]) + 0.5)
    seen = ((x - camera.offset[0]) - 1j * (y - camera.offset[1])) / camera.scale * np.exp(-1j * camera.turn)
    return np.stack([seen.real, seen.imag], axis=-1)


@pytest.mark.parametrize("turn", [0.0, -0.25])
@pytest.mark.parametrize("shape", [tank, chamfered, pointed])
def test_no_gap_shows_between_water_and_walls_and_none_is_painted_behind_them(shape, turn):
    """On the lattice of a slanted wall there is no water within half a spacing; the picture still fills it."""
    outline, camera = shape(), camera_of(turn)
    inset = filled(lambda p: distance_inside(outline, p) > 0.25 * SPACING, outline, SPACING, rough=0.1)
    made = footage(inset[inset[:, 1] < DEPTH], outline)
    covered, place = shares(made, camera=camera), places_of_pixels(camera).reshape(-1, 2)
    within = distance_inside(outline, place).reshape(SIZE)
    wet = place[:, 1].reshape(SIZE) < DEPTH - 2.0 * SPACING
    corner = place[:, 1].reshape(SIZE) < SPACING  # there a lattice may lack its last particle
    assert covered[(within > 0.5 / SCALE) & wet & ~(corner & (shape is pointed))].min() > 0.97
    assert covered[within < -0.75 / SCALE].max() < 0.01


@pytest.mark.parametrize("colour", ["water", *FIELDS])
def test_mirrored_water_gives_the_mirrored_picture(colour):
    wave = standing_wave(SPACING)
    turned = [place * [-1.0, 1.0] for place in wave.position], [u * [-1.0, 1.0] for u in wave.velocity]
    mirrored = replace(wave, position=turned[0], velocity=turned[1], pose=wave.pose[:, 0])
    one, other = (painted(made, colour, frame=4) for made in (wave, mirrored))
    if colour == "vorticity":  # a mirror turns it to the other side
        assert np.abs(shares(wave, colour, frame=4)[:, ::-1] - shares(mirrored, colour, frame=4)).max() < 0.02
    else:
        assert np.abs(one[:, ::-1] - other).max() <= 3  # of 255: one entry of a table of colours


@pytest.mark.parametrize("frame", [0, 3, 6, 11])
def test_a_standing_wave_is_painted_where_it_is(frame):
    wave = standing_wave(SPACING)
    covered, place = shares(wave, frame=frame), places_of_pixels(camera_of())
    y = place[0, :, 0]
    inside = np.abs(y) < 0.445
    found = covered.sum(axis=0)[inside] / SCALE
    assert np.abs(found - wave.surface(y[inside], frame)).max() < 0.2 * SPACING


@pytest.mark.parametrize("colour", FIELDS)
def test_a_scale_covers_nearly_all_values_of_all_frames_and_not_much_more(colour):
    wave = standing_wave(SPACING)
    scale = field(colour, [wave.bed])
    along = np.concatenate([scale.shares(wave.bed, frame) for frame in range(len(wave.time))])
    assert ((along >= 0.0) & (along <= 1.0)).mean() > 0.985
    if colour not in ("vorticity", "excess-pressure"):  # the one is nothing but noise here, the other has two sides
        assert along.max() > 0.6
        assert scale.low == 0.0


def test_suction_gets_its_part_of_the_scale():
    made = still()
    made.pressure[0] -= 1000.0
    scale = field("pressure", [made.bed])
    assert scale.label == "pressure (kPa)"
    assert scale.low <= -0.9
    assert scale.high >= 0.9


@pytest.mark.parametrize(
    ("flow", "turning"),
    [
        (lambda y, z: (-3.0 * z, 3.0 * y), 6.0),
        (lambda y, z: (2.0 * z, 0.0 * y), -2.0),
        (lambda y, z: (1.5 * y, -1.5 * z), 0.0),
    ],
    ids=["turns", "shears", "stretches"],
)
def test_vorticity_of_linear_flows_is_exact_at_every_particle(flow, turning):
    place = filled(lambda p: p[:, 1] < DEPTH, tank(), SPACING, rough=0.2)
    found = vorticity(place, np.column_stack(flow(*place.T)) + np.array([0.3, -0.2]), SPACING)
    np.testing.assert_allclose(found, turning, atol=1e-9)


def test_vorticity_of_what_is_alone_is_zero_and_of_what_is_gone_nothing():
    place = np.array([[0.0, 0.1], [0.3, 0.1], [0.3, 0.105], [np.nan, np.nan]])
    found = vorticity(place, np.ones((4, 2)), SPACING)
    np.testing.assert_array_equal(found, [0.0, 0.0, 0.0, np.nan])


def close(colour, other, off=14.0):
    return np.abs(np.asarray(colour, dtype=float) - other).max() < off


def test_only_what_is_alone_and_fast_is_foam():
    """A surface that moves as a whole is water at any speed; a slow drop is no foam."""
    line = np.array(LIT) + np.linspace(0.0, 1.0, 50)[:, None] * (np.array(DEEP) - LIT)
    place = filled(lambda p: p[:, 1] < DEPTH, tank(), SPACING, rough=0.1)
    quick = painted(footage(place, velocity=(0.0, 5.0)))
    middle = quick[:, SIZE[1] // 2]
    assert all(np.abs(line - colour).max(axis=1).min() < 5.0 for colour in middle[SIZE[0] - 40 - 76 : SIZE[0] - 42])
    several = 0.5 * SPACING * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) + [0.0, 0.3]  # one surface
    at = tuple(camera_of().pixels([[0.0, 0.3]])[0][::-1].astype(int))
    slow, fast = (painted(footage(several, velocity=(0.0, speed)), grey=246)[at] for speed in (0.0, 5.0))
    assert fast.sum() > slow.sum() + 60
    alone = painted(footage([[0.1, 0.4]], spacing=0.03), grey=246)
    x, y = camera_of().pixels([[0.1, 0.4]])[0].astype(int)
    assert close(alone[y, x], SPRAY)


def test_particles_are_discs_that_do_not_touch():
    place = filled(lambda p: p[:, 1] < 0.1, tank(), 0.05)
    covered = shares(footage(place, spacing=0.05), "particles")
    middles = camera_of().pixels(place).astype(int)
    assert covered[middles[:, 1], middles[:, 0]].min() > 0.99
    between = camera_of().pixels(place + 0.025).astype(int)
    assert covered[between[:, 1], between[:, 0]].max() < 0.01


def test_water_that_is_gone_or_far_away_is_left_out():
    made = still()
    before = painted(made)
    made.position[0] = np.concatenate([made.position[0], [[np.nan, np.nan], [1e9, 0.0], [0.0, -np.inf]]])
    made.velocity[0] = np.concatenate([made.velocity[0], np.full((3, 2), np.nan)])
    made.pressure[0] = np.concatenate([made.pressure[0], [np.nan] * 3])
    np.testing.assert_array_equal(painted(made), before)
    assert (painted(made, "vorticity") < 255).any()


def test_water_above_an_open_edge_is_painted_too():
    low = tank(height=0.2)
    place = filled(lambda p: np.hypot(p[:, 0], p[:, 1] - 0.2) < 0.08, tank(), SPACING)
    assert area(footage(place, low, open_edges=(2,))) == pytest.approx(len(place) * SPACING**2, rel=0.02)
    assert area(footage(place, low)) < 0.6 * len(place) * SPACING**2  # a lid cuts it off


def test_the_picture_of_water_does_not_depend_on_the_number_of_threads():
    wave, pictures = standing_wave(SPACING), []
    for threads in (1, 2):
        initialise(threads)
        pictures.append(painted(wave, "pressure", frame=3))
    initialise(fields=False)
    assert pictures[0].tobytes() == pictures[1].tobytes()


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, 1e300, -1e300])
@pytest.mark.parametrize("colour", ["water", *FIELDS])
def test_odd_numbers_of_water_give_a_picture(colour, value):
    made = still()
    for values in (made.position[0][:5], made.velocity[0][5:10], made.pressure[0][10:15]):
        values[:] = value
    assert (painted(made, colour) < 255).any()


# Films


def film_of(made, **wishes):
    return Film([made.bed], choose_look(made, **wishes))


def near(picture, colour, off=12):
    return np.abs(picture.astype(int) - colour).max(axis=2) < off


def test_a_film_of_water_is_blue_by_default_and_has_a_bar_for_fields_alone():
    wave = standing_wave(SPACING)
    assert choose_look(wave).colour == "water"
    plain, fields = (film_of(wave, colour=colour).picture(3) for colour in ("water", "pressure"))
    assert near(plain[400:, :800], DEEP, 30).mean() > 0.1
    bar = slice(642, 656), slice(915, 1245)
    assert near(fields[bar], palette.PAPER).mean() < 0.1
    assert "legend" not in film_of(wave, colour="water").layout


@pytest.mark.parametrize("frame", ["tank", "earth"])
def test_gauges_are_marked_where_they_are(frame):
    wave = standing_wave(SPACING)
    wave.pose[:] = [0.05, 0.0, 0.2]
    film = film_of(wave, frame=frame)
    picture, hues = film.picture(6), hues_of(wave.water)
    camera = film.tank_camera(0, 6)
    for name, place in {"P1": (-0.45, 0.05), "P2": (0.45, 0.05), "P3": (0.0, 0.0)}.items():
        x, y = camera.pixels([place])[0].astype(int)
        assert near(picture[y - 8 : y + 9, x - 8 : x + 9], hues[name]).sum() > 40, name
    for name, level in wave.water.levels.items():
        depth = np.interp(
            wave.time[6], wave.series_time, wave.series["level_depth"][:, list(wave.water.levels).index(name)]
        )
        x, y = camera.pixels([(level.y, depth)])[0].astype(int)
        assert near(picture[y - 3 : y + 4, x - 3 : x + 4], hues[name]).mean() > 0.6, name


def test_gauges_close_to_each_other_and_their_names_can_be_told_apart():
    """Four gauges 12 mm apart in a wall: of each the dot, the name and the name over the curves are seen."""
    gauges = tuple(Gauge((0.45, 0.02 + 0.012 * k)) for k in range(4))
    made = replace(still(), gauges=gauges, series={"gauge_pressure": np.ones((1, 4))})
    film = film_of(made)
    picture, hues, wall = (
        film.picture(0),
        hues_of(made.water),
        round(film.tank_camera(0, 0).pixels([(0.45, 0.0)])[0, 0]),
    )
    top = film.layout["plots"][1]
    for name, hue in hues.items():
        there = near(picture, hue)
        assert there[:, wall - 13 : wall + 13].sum() > 30, name  # the dot
        assert there[:, wall + 15 : wall + 47].sum() > 60, name  # the name
        assert there[top : top + 30, 1000:].sum() > 60, name


def test_the_curves_of_gauges_grow_and_are_named():
    wave = standing_wave(SPACING)
    pressures, depths = plots([wave.bed], [palette.INK])
    assert (pressures.labels, depths.labels) == (("time (s)", "pressure (kPa)"), ("time (s)", "depth (mm)"))
    assert [name for name, _ in pressures.names] == ["P1", "P2", "P3"]
    assert [name for name, _ in depths.names] == ["L1", "L2"]
    assert depths.curves[-1][1][0] == pytest.approx(1e3 * wave.surface(-0.36, 0))
    film = film_of(wave)
    column = slice(180, 700), slice(900, 1260)
    drawn = [near(film.picture(frame)[column], hues_of(wave.water)["L1"]).sum() for frame in (1, 5, 10)]
    assert drawn[0] < drawn[1] < drawn[2]


def test_the_peak_of_a_pressure_is_on_its_curve_however_short_it_is():
    made = still()
    time = np.linspace(0.0, 10.0, 20 * MOST_SAMPLES)
    pressure = np.ones((len(time), 1))
    pressure[7777] = 5e4
    gauged = replace(made, gauges=(Gauge((0.45, 0.1)),), series_time=time, series={"gauge_pressure": pressure})
    gauged.series_pose = np.zeros((len(time), 1, 3))
    (plot,) = plots([gauged.bed], [palette.INK])
    assert plot.curves[0][1].max() == pytest.approx(50.0)
    assert len(plot.curves[0][0]) < 1.1 * MOST_SAMPLES


def test_beds_in_one_film_have_their_own_hues_and_one_scale():
    wave, calm = standing_wave(SPACING), still()
    beds = [calm.bed, wave.bed]
    blue, red = (0, 0, 255), (255, 0, 0)
    assert [plot.colours for plot in plots(beds, [blue, red])] == [[red], [red]]  # the first one has no gauges
    assert plots(beds, [blue])[0].colours == [palette.LINE]  # the other one is not shown
    film = Film(beds, choose_look(calm, colour="speed"))
    highest = np.hypot(*wave.velocity[6].T).max()
    assert film._bar.high >= 990.0 * highest
    assert film.picture(0).shape == (720, 1280, 3)


def test_without_gauges_the_shift_of_the_water_is_drawn():
    (plot,) = plots([still().bed], [palette.INK])
    assert plot.labels[1] == "shift Δy (mm)"


def test_the_way_of_a_body_in_the_water_is_drawn():
    made = still()
    made.time = np.array([0.0, 1.0])
    square = 0.1 * np.array([[0, 0], [1, 0], [1, 1], [0, 1], [0, 0]])
    made.parts = {"gate": np.array([[0.2, 0.0], [0.2, 0.3]]), "square": square}
    made.part = np.zeros((2, 1, 2, 2))
    made.part[1, 0] = (0.0, 0.4), (0.01, -0.05)
    (plot,) = plots([made.bed], [palette.INK])
    assert plot.labels[1] == "square Δz (mm)"
    assert plot.curves[0][1] == pytest.approx([0.0, -50.0])
    made.part[1, 0, 1] = (1e-4, 0.0)  # as good as fixed
    assert plots([made.bed], [palette.INK])[0].labels[1] == "shift Δy (mm)"


def test_air_is_trapped_where_water_meets_and_not_where_it_moves_as_one_or_parts():
    """Of two particles I is 2 |v| (1 − r/R) as they meet, and 0 as they part (Ihmsen 2012, eq. 2)."""
    place = np.array([[0.0, 0.0], [SPACING, 0.0], [1.0, 0.0]])
    towards = np.array([[1.0, 0.0], [-2.0, 0.0], [5.0, 5.0]])
    near = 1.0 - 1.0 / REACH
    assert trapped(place, towards, SPACING) == pytest.approx([6.0 * near, 6.0 * near, 0.0])
    assert trapped(place, -towards, SPACING) == pytest.approx(0.0, abs=1e-12)
    across = np.array([[0.0, 1.0], [0.0, -2.0], [0.0, 0.0]])
    assert trapped(place, across, SPACING) == pytest.approx([3.0 * near, 3.0 * near, 0.0])
    alike = np.tile([3.0, 4.0], (3, 1))
    assert not trapped(place, alike, SPACING).any()


def test_a_breaking_surface_foams_and_a_gravity_wave_does_not():
    place = filled(lambda p: p[:, 1] < DEPTH, tank(), SPACING, rough=0.1)
    surface = DEPTH - place[:, 1] < 3.0 * SPACING
    jostled = np.where(surface[:, None], np.random.default_rng(0).normal(0.0, 1.0, place.shape), 0.0)
    level = np.where(surface, 0.8, 1.0)
    assert foam(place, jostled, level, SPACING, 0.5)[surface].mean() > 0.3
    assert not foam(place, jostled, level, SPACING, 0.5)[~surface].any()
    wave = standing_wave()
    for frame in range(len(wave.time)):
        velocity, at = wave.velocity[frame], wave.position[frame]
        assert foam(at, velocity, np.full(len(at), 0.8), wave.spacing, float(np.ptp(wave.outline[:, 1]))).max() < 0.1


def test_a_long_low_tank_shows_its_surface_larger_unless_told_otherwise():
    flume = np.array([[-1.0, 0.0], [1.0, 0.0], [1.0, 0.2], [-1.0, 0.2]])
    place = filled(lambda p: p[:, 1] < 0.1, flume, 0.02)
    made = footage(place, flume, velocity=np.where(np.abs(place[:, :1] - 0.4) < 0.1, 1.0, 0.0), spacing=0.02)
    film = Film([made.bed], choose_look(made, width=640, height=360))
    left, top, right, bottom = film.layout["inset"]
    part = film.picture(0)[top + 4 : bottom - 4, left + 4 : right - 4].astype(int)
    blue = (part[..., 2] - part[..., 0] > 60).mean()
    assert 0.25 < blue < 0.5  # the water is half of the tank, which is three quarters of the inset
    assert film._inset.middle[0] == pytest.approx(0.4, abs=0.05)
    assert choose_look(made, width=640, height=360, inset="none").inset == "none"
    assert choose_look(still(), width=640, height=360).inset == "none"


def test_a_level_outside_of_the_tank_and_a_tank_that_is_small_do_no_harm():
    made = replace(still(), levels=(Level(5.0),), series={"level_depth": np.full((1, 1), np.nan)}, pose=None)
    assert film_of(made, width=320, height=180).picture(0).shape == (180, 320, 3)
